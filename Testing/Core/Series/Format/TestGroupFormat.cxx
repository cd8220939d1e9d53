// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Codec/BlockModes.h"
#include "Series/Format/GroupFormat.h"
#include "Series/ScalarStepTable.h"

#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

namespace banyan::testing
{
namespace
{

using group::BlockEntry;
using group::FieldHead;
using group::NodeEntry;
using group::StepTable;

constexpr std::uint64_t PayloadEnd = 100000;
const group::TableShape Shape = group::ShapeOf({ 66, 37, 18 }, { 2, 0, 1 }, 8, 4);

std::size_t CountOf(const glm::ivec3& size)
{
  return static_cast<std::size_t>(size.x * size.y * size.z);
}

FieldHead SomeHead()
{
  FieldHead head;
  head.Axes = { 2, 0, 1 };
  head.Origin = -3.25;
  head.Step = 0.001;
  head.Bin = 31;
  head.Least = -1000;
  head.Greatest = 70000;
  for (auto& set : head.Frequencies)
  {
    set.resize(308); // contexts
    for (std::size_t c = 0; c < set.size(); c += 2)
    {
      set[c].Count[c % 72] += 488;
      set[c].Count[0] = static_cast<std::uint16_t>(set[c].Count[0] + 24);
    }
  }
  return head;
}

class Heads : public ::testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Kinds, Heads, ::testing::Values(0, 1, 2));

TEST_P(Heads, ComeBack)
{
  FieldHead head = SomeHead();
  head.Exact = GetParam() == 1;
  head.Open = GetParam() == 2;
  const Bytes packed = PackHead(head);
  const FieldHead back = group::UnpackHead(packed.data(), packed.size());
  EXPECT_EQ(back.Axes, head.Axes);
  EXPECT_EQ(back.Exact, head.Exact);
  EXPECT_EQ(back.Open, head.Open);
  EXPECT_EQ(back.Origin, head.Origin);
  EXPECT_EQ(back.Step, head.Step);
  EXPECT_EQ(back.Bin, head.Bin);
  EXPECT_EQ(back.Least, head.Least);
  EXPECT_EQ(back.Greatest, head.Greatest);
  EXPECT_EQ(PackHead(back), packed);
}

TEST(GroupFormat, HeadsOutOfRangeAreRefused)
{
  const auto refused = [](const std::function<void(FieldHead&)>& change)
  {
    FieldHead head = SomeHead();
    change(head);
    const Bytes packed = PackHead(head);
    EXPECT_THROW(group::UnpackHead(packed.data(), packed.size()), Error);
  };
  refused([](FieldHead& head) { head.Axes = { 0, 0, 1 }; });
  refused([](FieldHead& head) { head.Axes = { 0, 1, 3 }; });
  refused([](FieldHead& head) { head.Origin = std::numeric_limits<double>::infinity(); });
  refused([](FieldHead& head) { head.Step = 0; });
  refused([](FieldHead& head) { head.Step = -1; });
  refused([](FieldHead& head) { head.Step = std::numeric_limits<double>::quiet_NaN(); });
  refused([](FieldHead& head) { head.Bin = 0; });
  refused([](FieldHead& head) { head.Bin = 30; });
  refused([](FieldHead& head) { head.Bin = -31; });
  refused([](FieldHead& head) { head.Least = head.Greatest + 1; });
  refused([](FieldHead& head) { head.Exact = head.Open = true; });
  refused([](FieldHead& head) { head.Frequencies[1][5].Count[3] += 1; });
}

TEST(GroupFormat, LatticesDifferByAnyOfTheirNumbers)
{
  FieldHead other = SomeHead();
  other.Open = true;
  other.Frequencies[0].clear();
  EXPECT_TRUE(group::SameLattice(SomeHead(), other));
  const auto differs = [](const std::function<void(FieldHead&)>& change)
  {
    FieldHead head = SomeHead();
    change(head);
    EXPECT_FALSE(group::SameLattice(SomeHead(), head));
  };
  differs([](FieldHead& head) { head.Axes = { 0, 1, 2 }; });
  differs([](FieldHead& head) { head.Exact = true; });
  differs([](FieldHead& head) { head.Origin = 0; });
  differs([](FieldHead& head) { head.Step *= 2; });
  differs([](FieldHead& head) { head.Bin = 29; });
  differs([](FieldHead& head) { --head.Least; });
  differs([](FieldHead& head) { ++head.Greatest; });
}

/// All kinds of entries. Some bricks are the same as in the reference.
StepTable SomeTable(int step, const group::TableReference& reference = {})
{
  std::mt19937 random(static_cast<unsigned>(step + 1));
  StepTable table;
  table.FirstPayload = 5000;
  std::uint64_t next = table.FirstPayload;
  const auto place = [&]
  {
    const std::uint32_t bytes = 1 + random() % 300;
    const bool elsewhere = random() % 4 == 0;
    const group::Place where{ elsewhere ? 64 + random() % 4000 : next, bytes };
    next += elsewhere ? 0 : bytes;
    return where;
  };
  for (const glm::ivec3& size : Shape.Blocks)
  {
    table.Planes.emplace_back(CountOf(size));
    for (BlockEntry& block : table.Planes.back())
    {
      const unsigned kind = random() % 4;
      block.Uniform = kind == 0;
      block.Same = kind == 1 && reference.Table != nullptr;
      block.Value = block.Uniform ? static_cast<std::int32_t>(random()) : 0;
      block.Mode = block.Uniform ? 0 : block.Same ? 1 : random() % block::ModeCount;
      if (kind > 1)
      {
        block.Payload = place();
      }
      if (random() % 5 == 0)
      {
        block.Exceptions = place();
      }
    }
  }
  for (std::size_t i = 0; i < CountOf(Shape.Planes.back()); ++i)
  {
    table.Top.push_back(static_cast<std::int32_t>(random()));
  }
  for (const glm::ivec3& size : Shape.Bricks)
  {
    table.Levels.emplace_back(CountOf(size));
    for (std::size_t b = 0; b < table.Levels.back().size(); ++b)
    {
      NodeEntry& node = table.Levels.back()[b];
      const std::uint32_t since = static_cast<std::uint32_t>(reference.Step - step);
      const NodeEntry* before =
        reference.Table ? &reference.Table->Levels[table.Levels.size() - 1][b] : nullptr;
      const bool same = before && before->Age >= since;
      if (same)
      {
        node = *before;
        node.Age -= since;
      }
      else
      {
        const unsigned kind = random() % 4;
        node.NothingFinite = kind == 0;
        node.Explicit = kind == 1;
        node.Uniform = kind == 2;
        node.HasNonFinite = kind == 0;
        node.Age = random() % static_cast<unsigned>(step + 1);
        node.Low = kind > 1 ? static_cast<std::int32_t>(random() % 2000) - 1000 : 0;
        node.High = kind == 3 ? INT_MAX : node.Low;
        node.LowValue = node.Explicit ? (b % 2 == 0 ? -1.5e300 : -0.0) : 0;
        node.HighValue = node.Explicit ? 2.5 + (b % 3 == 0 ? 1e-9 * double(random()) : 0) : 0;
      }
      const bool kept =
        (step == 0 || !reference.Table) && !node.Uniform && (same || random() % 2 == 0);
      node.Content = kept ? (std::uint64_t{ random() } << 32 | random()) >> 16 : 0;
    }
  }
  return table;
}

StepTable Unpack(const Bytes& bytes, int step, const group::TableReference& reference = {})
{
  return group::UnpackStep(bytes.data(), bytes.size(), Shape, step, reference, PayloadEnd);
}

void ExpectSame(const StepTable& back, const StepTable& table)
{
  EXPECT_EQ(back.FirstPayload, table.FirstPayload);
  EXPECT_EQ(back.Top, table.Top);
  for (std::size_t p = 0; p < table.Planes.size(); ++p)
  {
    for (std::size_t b = 0; b < table.Planes[p].size(); ++b)
    {
      const BlockEntry& want = table.Planes[p][b];
      const BlockEntry& have = back.Planes[p][b];
      EXPECT_EQ(have.Uniform, want.Uniform);
      EXPECT_EQ(have.Same, want.Same);
      EXPECT_EQ(have.Mode, want.Mode);
      EXPECT_EQ(have.Value, want.Value);
      EXPECT_EQ(have.Payload.Bytes, want.Payload.Bytes);
      EXPECT_EQ(have.Exceptions.Bytes, want.Exceptions.Bytes);
      EXPECT_TRUE(want.Payload.Bytes == 0 || have.Payload.Offset == want.Payload.Offset);
      EXPECT_TRUE(want.Exceptions.Bytes == 0 || have.Exceptions.Offset == want.Exceptions.Offset);
    }
  }
  for (std::size_t l = 0; l < table.Levels.size(); ++l)
  {
    for (std::size_t b = 0; b < table.Levels[l].size(); ++b)
    {
      const NodeEntry& want = table.Levels[l][b];
      const NodeEntry& have = back.Levels[l][b];
      EXPECT_EQ(have.HasNonFinite, want.HasNonFinite);
      EXPECT_EQ(have.NothingFinite, want.NothingFinite);
      EXPECT_EQ(have.Uniform, want.Uniform);
      EXPECT_EQ(have.Explicit, want.Explicit);
      EXPECT_EQ(have.Age, want.Age);
      EXPECT_EQ(have.Low, want.Low);
      EXPECT_EQ(have.High, want.High);
      EXPECT_EQ(have.LowValue, want.LowValue);
      EXPECT_EQ(std::signbit(have.LowValue), std::signbit(want.LowValue));
      EXPECT_EQ(have.HighValue, want.HighValue);
      EXPECT_EQ(have.Content, want.Content);
    }
  }
}

/// The reader that is written from the documentation gets the same.
TEST(GroupFormat, StepTablesComeBack)
{
  const StepTable last = SomeTable(7);
  const group::TableReference reference{ 7, &last };
  for (const auto& [step, from] : std::vector<std::pair<int, group::TableReference>>{
         { 0, {} }, { 7, {} }, { 0, reference }, { 1, reference }, { 5, reference } })
  {
    const StepTable table = SomeTable(step, from);
    const Bytes packed = PackStep(table, Shape, step, from);
    const StepTable back = Unpack(packed, step, from);
    ExpectSame(back, table);
    ExpectSame(ReadStepTable(packed, Shape, step, from), table);
    EXPECT_EQ(PackStep(back, Shape, step, from), packed);
  }
}

TEST(GroupFormat, EveryCutAndEveryByteTooManyIsRefused)
{
  const Bytes head = PackHead(SomeHead());
  for (std::size_t bytes = 0; bytes < head.size(); ++bytes)
  {
    EXPECT_THROW(group::UnpackHead(head.data(), bytes), Error) << bytes;
  }
  // Of a table some short ends may be guessed right; none is taken for one with more bytes.
  Bytes table = PackStep(SomeTable(0), Shape, 0, {});
  int accepted = 0;
  for (std::size_t bytes = 0; bytes < table.size(); ++bytes)
  {
    try
    {
      Unpack({ table.begin(), table.begin() + static_cast<std::ptrdiff_t>(bytes) }, 0);
      ++accepted;
    }
    catch (const Error&)
    {
    }
  }
  EXPECT_LE(accepted, 1);
  table.push_back(0);
  EXPECT_THROW(Unpack(table, 0), Error);
}

/// Whatever is accepted keeps the promises that decoding relies on.
TEST(GroupFormat, DamageGivesAnErrorOrATableThatFits)
{
  std::mt19937 random(4);
  int errors = 0;
  const StepTable last = SomeTable(7);
  const Bytes tables[] = { PackStep(last, Shape, 7, {}),
    PackStep(SomeTable(5, { 7, &last }), Shape, 5, { 7, &last }) };
  for (int i = 0; i < 4000; ++i)
  {
    const int step = i % 2 == 0 ? 7 : 5;
    const group::TableReference from =
      step == 7 ? group::TableReference{} : group::TableReference{ 7, &last };
    Bytes bytes = tables[i % 2];
    bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    try
    {
      const StepTable table = Unpack(bytes, step, from);
      for (const auto& plane : table.Planes)
      {
        for (const BlockEntry& block : plane)
        {
          EXPECT_LT(block.Mode, block::ModeCount);
          EXPECT_FALSE(block.Uniform && block.Same);
          for (const group::Place& place : { block.Payload, block.Exceptions })
          {
            EXPECT_TRUE(
              place.Bytes == 0 || (place.Offset >= 64 && place.Offset + place.Bytes <= PayloadEnd));
          }
        }
      }
      for (const auto& level : table.Levels)
      {
        for (const NodeEntry& node : level)
        {
          EXPECT_LE(node.Age, static_cast<std::uint32_t>(step));
          EXPECT_LE(node.Low, node.High);
          EXPECT_LE(node.LowValue, node.HighValue);
        }
      }
    }
    catch (const Error&)
    {
      ++errors;
    }
  }
  EXPECT_GT(errors, 400);
}

/// A table must cost little where nothing happens, and not be believed when it has no room for what
/// it should hold.
TEST(GroupFormat, ManyBlocksNeedSomeBytes)
{
  const group::TableShape shape = group::ShapeOf({ 8193, 4097, 17 }, { 0, 1, 2 }, 8, 1);
  StepTable table;
  table.Top.resize(CountOf(shape.Planes.back()));
  for (const glm::ivec3& size : shape.Blocks)
  {
    table.Planes.emplace_back(CountOf(size));
  }
  for (const glm::ivec3& size : shape.Bricks)
  {
    table.Levels.emplace_back(CountOf(size));
    for (NodeEntry& node : table.Levels.back())
    {
      node.Uniform = true;
    }
  }
  const Bytes packed = PackStep(table, shape, 0, {});
  ASSERT_GT(table.Planes[0].size(), 1000000u);
  EXPECT_LT(packed.size(), table.Planes[0].size() / 200);
  EXPECT_THROW(group::UnpackStep(packed.data(), 80, shape, 0, {}, PayloadEnd), Error);
}

TEST(GroupFormat, PlanesEndWithTwoSamplesPerAxis)
{
  for (const glm::ivec3& samples :
    { glm::ivec3{ 1 }, glm::ivec3{ 2 }, glm::ivec3{ 3, 1, 1 }, glm::ivec3{ 128, 5, 17 } })
  {
    const std::vector<glm::ivec3> planes = group::PlanesOf(samples);
    ASSERT_GE(planes.size(), 2u);
    EXPECT_EQ(planes[0], samples);
    for (std::size_t p = 1; p < planes.size(); ++p)
    {
      for (int a = 0; a < 3; ++a)
      {
        // The last sample of the plane before lies at or before the last one here.
        EXPECT_GE(4 * (planes[p][a] - 1), planes[p - 1][a] - 1);
        EXPECT_LT(4 * (planes[p][a] - 1), planes[p - 1][a] - 1 + 4);
      }
    }
    EXPECT_LE(std::max(planes.back().x, std::max(planes.back().y, planes.back().z)), 2);
  }
}

} // namespace
} // namespace banyan::testing
