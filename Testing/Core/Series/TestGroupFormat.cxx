#include "Base/Error.h"
#include "Series/GroupFormat.h"

#include <gtest/gtest.h>

#include <climits>
#include <functional>
#include <random>
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
const std::vector<std::size_t> BlockCounts = { 40, 8, 1 };
const std::vector<std::size_t> BrickCounts = { 40, 8, 1 };
constexpr std::size_t TopSamples = 8;

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
    set.resize(99); // contexts
    for (std::size_t c = 0; c < set.size(); c += 2)
    {
      set[c].Count[c % 72] += 1000;
      set[c].Count[0] = static_cast<std::uint16_t>(set[c].Count[0] + 24);
    }
  }
  return head;
}

TEST(GroupFormat, HeadsComeBack)
{
  const FieldHead head = SomeHead();
  const Bytes packed = PackHead(head);
  const FieldHead back = group::UnpackHead(packed.data(), packed.size());
  EXPECT_EQ(back.Axes, head.Axes);
  EXPECT_EQ(back.Exact, head.Exact);
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
  refused([](FieldHead& head) { head.Frequencies[1][5].Count[3] += 1; });
}

/// All kinds of entries.
StepTable SomeTable(bool first, int step)
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
  for (const std::size_t count : BlockCounts)
  {
    table.Planes.emplace_back(count);
    for (BlockEntry& block : table.Planes.back())
    {
      const unsigned kind = random() % 4;
      block.Uniform = kind == 0;
      block.Same = kind == 1 && !first;
      block.Value = block.Uniform ? static_cast<std::int32_t>(random()) : 0;
      block.Mode = block.Uniform ? 0 : block.Same ? 1 : random() % 15;
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
  for (std::size_t i = 0; i < TopSamples; ++i)
  {
    table.Top.push_back(static_cast<std::int32_t>(random()));
  }
  for (const std::size_t count : BrickCounts)
  {
    table.Levels.emplace_back(count);
    for (NodeEntry& node : table.Levels.back())
    {
      const unsigned kind = random() % 4;
      node.NothingFinite = kind == 0;
      node.Explicit = kind == 1;
      node.Uniform = kind == 2;
      node.HasNonFinite = kind == 0;
      node.Age = step > 0 ? random() % static_cast<unsigned>(step + 1) : 0;
      node.Low = kind > 1 ? static_cast<std::int32_t>(random() % 2000) - 1000 : 0;
      node.High = kind == 3 ? INT_MAX : node.Low;
      node.LowValue = node.Explicit ? -1.5e300 : 0;
      node.HighValue = node.Explicit ? 2.5 : 0;
      node.Content = first && !node.Uniform ? random() : 0;
    }
  }
  return table;
}

StepTable Unpack(const Bytes& bytes, bool first, int step)
{
  return group::UnpackStep(
    bytes.data(), bytes.size(), first, step, BlockCounts, TopSamples, BrickCounts, PayloadEnd);
}

TEST(GroupFormat, StepTablesComeBack)
{
  for (const int step : { 0, 1, 5 })
  {
    const StepTable table = SomeTable(step == 0, step);
    const Bytes packed = PackStep(table, step == 0);
    const StepTable back = Unpack(packed, step == 0, step);
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
        EXPECT_EQ(have.HighValue, want.HighValue);
        EXPECT_EQ(have.Content, want.Content);
      }
    }
    EXPECT_EQ(PackStep(back, step == 0), packed);
  }
}

TEST(GroupFormat, EveryCutAndEveryByteTooManyIsRefused)
{
  const Bytes head = PackHead(SomeHead());
  for (std::size_t bytes = 0; bytes < head.size(); ++bytes)
  {
    EXPECT_THROW(group::UnpackHead(head.data(), bytes), Error) << bytes;
  }
  Bytes table = PackStep(SomeTable(true, 0), true);
  for (std::size_t bytes = 0; bytes < table.size(); ++bytes)
  {
    EXPECT_THROW(
      Unpack({ table.begin(), table.begin() + static_cast<std::ptrdiff_t>(bytes) }, true, 0), Error)
      << bytes;
  }
  table.push_back(0);
  EXPECT_THROW(Unpack(table, true, 0), Error);
}

/// Whatever is accepted keeps the promises that decoding relies on.
TEST(GroupFormat, DamageGivesAnErrorOrATableThatFits)
{
  std::mt19937 random(4);
  int errors = 0;
  for (int i = 0; i < 4000; ++i)
  {
    const int step = i % 2 == 0 ? 0 : 5;
    Bytes bytes = PackStep(SomeTable(step == 0, step), step == 0);
    bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    bytes[random() % bytes.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    try
    {
      const StepTable table = Unpack(bytes, step == 0, step);
      for (const auto& plane : table.Planes)
      {
        for (const BlockEntry& block : plane)
        {
          EXPECT_LT(block.Mode, 15);
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
