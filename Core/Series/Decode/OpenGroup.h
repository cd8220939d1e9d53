// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_OpenGroup_h
#define banyan_Series_Decode_OpenGroup_h

#include "Series/Decode/GroupField.h"
#include "Series/Decode/LatticeDecoder.h"
#include "Series/Decode/OpenSeries.h"
#include "Series/Grid/PlaneRegion.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace banyan
{

/// A component in a segment, with what turns its lattice numbers into values.
struct OpenGroup
{
  std::unique_ptr<GroupField> Field;
  ScalarType Type = ScalarType::Float32;
  std::shared_ptr<const void> Decoder; ///< LatticeDecoder of the type
  std::uint64_t DecodingHash =
    0;            ///< hash of what turns lattice numbers into values, and orders them
  Hash128 Before; ///< hash of the header of the segment that this one refers to; 0: none
  std::mutex NodeMutex;
  /// By step and level; -1 less the step where a later one rests on it.
  std::map<std::pair<int, int>, std::shared_ptr<const std::vector<BrickNode>>> Nodes;
  std::atomic<std::uint64_t> NodeBytes{ 0 };
  std::atomic<int> EndsToCheck{
    16
  }; ///< bricks, for some milliseconds; see FieldReader::VerifyBricks

  std::uint64_t MemoryBytes() const { return this->Field->MemoryBytes() + this->NodeBytes; }
};

template <class T>
const LatticeDecoder<T>& DecoderOf(const OpenGroup& open)
{
  return *static_cast<const LatticeDecoder<T>*>(open.Decoder.get());
}

/// The samples of a brick on the planes of the codec.
inline PlaneRegion RegionOf(
  const OpenSeries& series, const OpenGroup& open, const FieldKey& field, std::int64_t brick)
{
  return PlaneRegion(field.Level,
    series.Layouts[static_cast<std::size_t>(field.Level)].SamplesOf(brick), open.Field->Head().Axes,
    open.Field->Planes()[static_cast<std::size_t>(field.Level / 2)], open.Field->Edge());
}

/// Calls body(position) for each block that holds samples of a region.
template <class Body>
void ForEachBlock(const PlaneRegion& region, Body&& body)
{
  for (int z = region.FirstBlock.z; z < region.EndBlock.z; ++z)
  {
    for (int y = region.FirstBlock.y; y < region.EndBlock.y; ++y)
    {
      for (int x = region.FirstBlock.x; x < region.EndBlock.x; ++x)
      {
        body(glm::ivec3{ x, y, z });
      }
    }
  }
}

inline const group::BlockEntry& EntryOf(
  GroupField& field, int step, const PlaneRegion& region, const glm::ivec3& block)
{
  const glm::ivec3 blocks = field.BlocksOf(region.Plane);
  return field.Step(step).Planes[static_cast<std::size_t>(
    region.Plane)][(static_cast<std::size_t>(block.z) * static_cast<std::size_t>(blocks.y) +
                     static_cast<std::size_t>(block.y)) *
                     static_cast<std::size_t>(blocks.x) +
                   static_cast<std::size_t>(block.x)];
}

/// The nodes of a step and level. Throws Error when the segment is damaged.
std::vector<BrickNode> NodesOf(const OpenSeries& series, OpenGroup& open, const FieldKey& field);

} // namespace banyan

#endif
