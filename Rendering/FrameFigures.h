// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_FrameFigures_h
#define banyan_Rendering_FrameFigures_h

#include "Cache/BrickCache.h"
#include "Parallel/Fields/DrawnField.h"

#include <cstdint>
#include <memory>

class vtkBanyanFrameStatistics;

namespace banyan
{

class Communicator;
struct FrameStatistics;

/// What a frame took, counted from where it is made to where it is published.
class FrameFigures
{
public:
  FrameFigures() = default;
  explicit FrameFigures(DrawnField& field);

  /// Counts what a picture moved, or a part of it.
  /// @param kept whether it was drawn for an earlier picture: no brick has moved for this one
  void Add(const DrawnField& field, bool kept);

  /// Collective: one message.
  /// @param frame of all ranks
  /// @param geometryBytes that this rank has sent of what other props have drawn
  /// @param out gets sums over all ranks, and seconds of the slowest
  void Publish(Communicator& communicator, const DrawnField& field, const FrameStatistics& frame,
    std::uint64_t geometryBytes, vtkBanyanFrameStatistics* out) const;

  /// The part of it that has nothing to do with the field.
  /// @param geometryBytes that all ranks have sent
  static void PublishFrame(
    const FrameStatistics& frame, std::uint64_t geometryBytes, vtkBanyanFrameStatistics* out);

private:
  std::shared_ptr<CacheContext> Caches;
  std::uint64_t BytesBefore = 0;
  std::uint64_t AheadBefore = 0;
  BrickCache::Statistics CacheBefore;
  DrawnField::Movement Moved;
};

} // namespace banyan

#endif
