// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/GroupFormat.h"

#include "Base/Varint.h"
#include "Codec/BlockEncoder.h"
#include "Codec/BlockModes.h"
#include "Codec/SymbolWriter.h"

#include <cmath>

namespace banyan::group
{
namespace
{

constexpr std::uint8_t HeadExact = 1;
constexpr std::uint8_t HeadOpen = 2;
constexpr std::uint8_t HeadStatic = 4;

void Append(Bytes& out, const Bytes& more)
{
  out.insert(out.end(), more.begin(), more.end());
}

template <class T>
void AppendNumber(Bytes& out, T value)
{
  const std::size_t at = out.size();
  out.resize(at + sizeof(T));
  StoreNumber(out.data() + at, value);
}

} // namespace

bool SameLattice(const FieldHead& a, const FieldHead& b)
{
  return a.Axes == b.Axes && a.Exact == b.Exact && a.Origin == b.Origin && a.Step == b.Step &&
         a.Bin == b.Bin && a.Least == b.Least && a.Greatest == b.Greatest;
}

Bytes PackHead(const FieldHead& head)
{
  Bytes out;
  out.insert(out.end(), head.Axes.begin(), head.Axes.end());
  out.push_back(static_cast<std::uint8_t>(
    (head.Exact ? HeadExact : 0) | (head.Open ? HeadOpen : 0) | (head.Static ? HeadStatic : 0)));
  AppendNumber(out, head.Origin);
  AppendNumber(out, head.Step);
  AppendNumber(out, head.Bin);
  AppendNumber(out, head.Least);
  AppendNumber(out, head.Greatest);
  for (const std::vector<tans::Frequencies>& set : head.Frequencies)
  {
    const Bytes packed = PackFrequencies(set);
    PutVarint(out, packed.size());
    Append(out, packed);
  }
  return out;
}

bool IsStatic(const Bytes& head)
{
  return head.size() > 3 && head[3] == HeadStatic; // behind the axes
}

FieldHead UnpackHead(const std::uint8_t* data, std::size_t bytes)
{
  ByteReader in(data, bytes);
  FieldHead head;
  int seen = 0;
  for (std::uint8_t& axis : head.Axes)
  {
    axis = in.Byte();
    seen |= axis < 3 ? 1 << axis : 0;
  }
  const std::uint8_t flags = in.Byte();
  head.Exact = flags == HeadExact;
  head.Open = flags == HeadOpen;
  head.Static = flags == HeadStatic;
  head.Origin = in.Number<double>();
  head.Step = in.Number<double>();
  head.Bin = in.Number<std::int32_t>();
  head.Least = in.Number<std::int32_t>();
  head.Greatest = in.Number<std::int32_t>();
  if (seen != 7 || (flags > HeadOpen && flags != HeadStatic) || !std::isfinite(head.Origin) ||
      !std::isfinite(head.Step) || !(head.Step > 0) || head.Bin < 1 || head.Bin % 2 == 0 ||
      head.Least > head.Greatest)
  {
    throw Error("The head of a field of the segment is not valid");
  }
  for (std::vector<tans::Frequencies>& set : head.Frequencies)
  {
    const std::uint64_t size = in.Varint();
    set = UnpackFrequencies(in.Skip(std::min<std::uint64_t>(size, in.Left() + 1)), size);
  }
  in.MustBeDone();
  return head;
}

std::uint64_t StepTable::MemoryBytes() const
{
  std::uint64_t bytes = this->Top.size() * sizeof(std::int32_t);
  for (const auto& plane : this->Planes)
  {
    bytes += plane.size() * sizeof(BlockEntry);
  }
  for (const auto& level : this->Levels)
  {
    bytes += level.size() * sizeof(NodeEntry);
  }
  return bytes;
}

std::vector<glm::ivec3> PlanesOf(glm::ivec3 samples)
{
  std::vector<glm::ivec3> planes{ samples };
  do
  {
    samples = CoarserSamples(samples);
    planes.push_back(samples);
  } while (std::max(samples.x, std::max(samples.y, samples.z)) > 2);
  return planes;
}

TableShape ShapeOf(
  const glm::ivec3& samples, const std::array<std::uint8_t, 3>& axes, int brickCells, int levels)
{
  glm::ivec3 ordered;
  for (int a = 0; a < 3; ++a)
  {
    ordered[a] = samples[axes[static_cast<std::size_t>(a)]];
  }
  TableShape shape;
  shape.Planes = PlanesOf(ordered);
  for (std::size_t p = 0; p + 1 < shape.Planes.size(); ++p)
  {
    shape.Blocks.push_back((shape.Planes[p] + brickCells - 1) / brickCells);
  }
  for (int level = 0; level < levels; ++level)
  {
    shape.Bricks.push_back(BrickLayout(samples, brickCells, level).Bricks());
  }
  return shape;
}

} // namespace banyan::group

namespace banyan
{

std::uint64_t PageBytesOf(std::uint64_t payloadEnd)
{
  std::uint64_t bytes = 4096;
  while (payloadEnd / bytes > 65536)
  {
    bytes *= 2;
  }
  return bytes;
}

} // namespace banyan
