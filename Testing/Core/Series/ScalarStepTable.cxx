// SPDX-License-Identifier: BSD-3-Clause
#include "Series/ScalarStepTable.h"

#include "Series/CodedBits.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string>

namespace banyan::testing
{
namespace
{

using group::BlockEntry;
using group::NodeEntry;
using group::Place;
using group::StepTable;

int BitsOf(std::uint64_t number)
{
  return number > 0 ? 1 + BitsOf(number / 2) : 0;
}

template <class Entry>
struct Lattice
{
  const std::vector<Entry>& Entries;
  glm::ivec3 Size;

  const Entry* At(const glm::ivec3& p) const
  {
    const bool inside =
      glm::min(p, glm::ivec3(0)) == glm::ivec3(0) && glm::min(p, this->Size - 1) == p;
    return inside ? &this->Entries[static_cast<std::size_t>(
                      (p.z * this->Size.y + p.y) * this->Size.x + p.x)]
                  : nullptr;
  }
  std::vector<const Entry*> Before(const glm::ivec3& p) const
  {
    std::vector<const Entry*> found;
    for (const glm::ivec3& back : { glm::ivec3{ 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } })
    {
      if (const Entry* entry = this->At(p - back))
      {
        found.push_back(entry);
      }
    }
    return found;
  }
};

template <class Body>
void ForEach(const glm::ivec3& size, Body&& body)
{
  for (int i = 0; i < size.x * size.y * size.z; ++i)
  {
    body(static_cast<std::size_t>(i),
      glm::ivec3{ i % size.x, i / size.x % size.y, i / size.x / size.y });
  }
}

bool Knows(const NodeEntry* node)
{
  return node != nullptr && !node->NothingFinite && !node->Explicit;
}

class TableReader
{
public:
  TableReader(const Bytes& bytes, const group::TableShape& shape, int step,
    const group::TableReference& reference)
    : In(bytes)
    , Shape(shape)
    , Step(step)
    , R(reference.Table)
    , Since(reference.Step - step)
  {
  }

  StepTable Read()
  {
    this->Out.FirstPayload = this->Furthest = this->In.Long();
    const glm::ivec3 top = this->Shape.Planes.back();
    for (int i = 0; i < top.x * top.y * top.z; ++i)
    {
      const std::size_t at = static_cast<std::size_t>(i);
      const std::int32_t e = this->R ? this->R->Top[at] : i > 0 ? this->Out.Top[at - 1] : 0;
      this->Out.Top.push_back(this->In.Near("top", e));
    }
    for (std::size_t p = 0; p < this->Shape.Blocks.size(); ++p)
    {
      const glm::ivec3 size = this->Shape.Blocks[p];
      this->Out.Planes.emplace_back(static_cast<std::size_t>(size.x * size.y * size.z));
      ForEach(size, [&](std::size_t i, const glm::ivec3& at) { this->Block(p, i, at); });
    }
    for (std::size_t l = 0; l < this->Shape.Bricks.size(); ++l)
    {
      const glm::ivec3 size = this->Shape.Bricks[l];
      this->Out.Levels.emplace_back(static_cast<std::size_t>(size.x * size.y * size.z));
      ForEach(size, [&](std::size_t i, const glm::ivec3& at) { this->Brick(l, i, at); });
    }
    return this->Out;
  }

private:
  Place ReadPlace(const std::string& sizes)
  {
    Place place;
    place.Bytes = this->In.Number(sizes);
    place.Offset = this->Furthest + (this->In.Bit("follows") ? 0 : this->In.Long());
    this->Furthest = std::max(this->Furthest, place.Offset + place.Bytes);
    return place;
  }

  void Block(std::size_t plane, std::size_t index, const glm::ivec3& at)
  {
    BlockEntry& block = this->Out.Planes[plane][index];
    const BlockEntry* r = this->R ? &this->R->Planes[plane][index] : nullptr;
    int payloads = 0, plains = 0, exceptions = 0;
    std::uint64_t e = 0;
    const auto before =
      Lattice<BlockEntry>{ this->Out.Planes[plane], this->Shape.Blocks[plane] }.Before(at);
    for (const BlockEntry* other : before)
    {
      payloads += other->Payload.Bytes > 0;
      plains += other->Uniform || other->Same;
      exceptions += other->Exceptions.Bytes > 0;
      e += other->Payload.Bytes;
    }
    e = before.empty() ? 0 : e / before.size();
    if (r)
    {
      e = before.empty() ? r->Payload.Bytes : (e + r->Payload.Bytes) / 2;
    }
    const std::string there = !r ? "no reference" : r->Payload.Bytes > 0 ? "payload" : "none";
    const bool payload = this->In.Bit("payload " + there + std::to_string(payloads));
    const bool plain = !payload && this->In.Bit("plain " + std::to_string(plains));
    const bool exceptional = this->In.Bit("exceptions " + std::to_string(exceptions));
    if (plain)
    {
      block.Same = this->In.Bit("same");
      block.Uniform = !block.Same;
      block.Mode = block.Same ? 1 : 0;
    }
    else
    {
      block.Mode =
        static_cast<std::uint8_t>(this->In.Tree(payload ? "mode" : "mode without payload", 4));
    }
    if (payload)
    {
      block.Payload = this->ReadPlace("size " + std::to_string(std::min(BitsOf(e), 13)));
    }
    if (block.Uniform)
    {
      block.Value = this->LastUniform = this->In.Near("uniform", this->LastUniform);
    }
    if (exceptional)
    {
      block.Exceptions = this->ReadPlace("size of exceptions");
    }
  }

  /// Extreme of the children of a brick in a table, if all know theirs.
  bool Children(const StepTable& table, std::size_t level, const glm::ivec3& at, bool high,
    std::int64_t& extreme) const
  {
    if (level == 0)
    {
      return false;
    }
    const Lattice<NodeEntry> finer{ table.Levels[level - 1], this->Shape.Bricks[level - 1] };
    extreme = high ? INT64_MIN : INT64_MAX;
    for (int i = 0; i < 8; ++i)
    {
      const glm::ivec3 child = 2 * at + glm::ivec3{ i % 2, i / 2 % 2, i / 4 };
      const NodeEntry* node = finer.At(child);
      if (node && !Knows(node))
      {
        return false;
      }
      if (node)
      {
        extreme = high ? std::max<std::int64_t>(extreme, node->High)
                       : std::min<std::int64_t>(extreme, node->Low);
      }
    }
    return true;
  }

  std::int64_t Expected(std::size_t level, std::size_t index, const glm::ivec3& at, bool high) const
  {
    const auto extremeOf = [high](const NodeEntry& node) -> std::int64_t
    { return high ? node.High : node.Low; };
    std::int64_t here = 0, there = 0;
    const bool children = this->Children(this->Out, level, at, high, here);
    const NodeEntry* r = this->R ? &this->R->Levels[level][index] : nullptr;
    if (Knows(r))
    {
      const bool both = children && this->Children(*this->R, level, at, high, there);
      return extremeOf(*r) + (both ? here - there : 0);
    }
    if (children)
    {
      return here;
    }
    std::int64_t sum = 0, count = 0;
    for (const NodeEntry* other :
      Lattice<NodeEntry>{ this->Out.Levels[level], this->Shape.Bricks[level] }.Before(at))
    {
      sum += Knows(other) ? extremeOf(*other) : 0;
      count += Knows(other) ? 1 : 0;
    }
    return count > 0 ? sum / count : 0;
  }

  double Real(const std::string& which)
  {
    double& last = this->LastReals[which];
    if (this->In.Bit("repeats " + which))
    {
      return last;
    }
    const bool single = this->In.Bit("f32");
    const std::string model = single ? "byte of f32 " : "byte of f64 ";
    std::uint64_t bits = this->In.Tree(model + "0", 8);
    bits = bits << 8 | this->In.Tree(model + "1", 8);
    bits = bits << (single ? 16 : 48) | this->In.Raw(single ? 16 : 48);
    if (single)
    {
      const std::uint32_t half = static_cast<std::uint32_t>(bits);
      float value = 0;
      std::memcpy(&value, &half, sizeof(value));
      last = value;
    }
    else
    {
      std::memcpy(&last, &bits, sizeof(last));
    }
    return last;
  }

  void Brick(std::size_t level, std::size_t index, const glm::ivec3& at)
  {
    NodeEntry& node = this->Out.Levels[level][index];
    const NodeEntry* r = this->R ? &this->R->Levels[level][index] : nullptr;
    const bool same = r && this->Since > 0 && static_cast<int>(r->Age) >= this->Since;
    if (same)
    {
      node = *r;
      node.Age -= static_cast<std::uint32_t>(this->Since);
    }
    else
    {
      const bool flagged = r && (r->HasNonFinite || r->NothingFinite || r->Uniform || r->Explicit);
      this->LastFlags = this->In.Tree(
        std::string("flags") + (this->LastFlags != 0 ? " after" : "") + (flagged ? " where" : ""),
        4);
      node.HasNonFinite = this->LastFlags & 1;
      node.NothingFinite = this->LastFlags & 2;
      node.Uniform = this->LastFlags & 4;
      node.Explicit = this->LastFlags & 8;
      this->LastAge = this->In.Near("age", this->LastAge);
      node.Age = static_cast<std::uint32_t>(this->LastAge);
      const std::string kind = std::string(level > 0 ? " coarse" : "") + (r ? " with R" : "");
      if (node.Explicit)
      {
        node.LowValue = this->Real("least");
        node.HighValue = this->Real("greatest");
      }
      else if (!node.NothingFinite)
      {
        node.Low = node.High =
          this->In.Near("least" + kind, this->Expected(level, index, at, false));
        if (!node.Uniform)
        {
          node.High = this->In.Near("greatest" + kind, this->Expected(level, index, at, true));
        }
      }
    }
    node.Content = 0;
    if ((this->Step == 0 || !r) && !node.Uniform)
    {
      const std::string rests = same || node.Age > 0 ? " at rest" : "";
      const bool there = this->In.Bit("content" + rests + (this->LastHasContent ? " after" : ""));
      node.Content = there ? this->In.Raw(48) : 0;
      this->LastHasContent = node.Content != 0;
    }
  }

  CodedBits In;
  const group::TableShape& Shape;
  int Step;
  const StepTable* R;
  int Since;
  StepTable Out;
  std::uint64_t Furthest = 0;
  std::int32_t LastUniform = 0;
  std::int32_t LastAge = 0;
  std::uint64_t LastFlags = 0;
  bool LastHasContent = false;
  std::map<std::string, double> LastReals;
};

} // namespace

group::StepTable ReadStepTable(const Bytes& bytes, const group::TableShape& shape, int step,
  const group::TableReference& reference)
{
  return TableReader(bytes, shape, step, reference).Read();
}

} // namespace banyan::testing
