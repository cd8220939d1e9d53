// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_RunMerger_h
#define banyan_Render_Cells_RunMerger_h

#include "Render/Cells/CellTile.h"
#include "Render/Cells/RayRuns.h"
#include "Render/Raycast/RaySegments.h"

#include <glm/vec4.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

/// The pixels of a tile, x fastest.
using TilePixels = std::array<glm::vec4, RayTile::Slots>;

/// Makes pixels of what ranks have of a tile: sorts it along each ray, decides who owns each raw
/// sample, and blends front to back. About 2 MB.
class RunMerger
{
public:
  RunMerger();
  ~RunMerger();

  /// What a rank has, in any number of parts. Must stay.
  void Add(int rank, const TileRuns& part);

  /// Finds intervals in which a run of one rank meets anything of another one: what the first rank
  /// alone has decided, others may have decided differently. Nothing is found once these intervals
  /// have come raw.
  /// @param asked by rank; is added to
  /// @return whether there are none
  bool Agree(std::vector<std::vector<AskedIntervals>>& asked) const;

  /// Merges what was added, and forgets it. Where ranks do not agree, runs come one after the other
  /// as they begin.
  /// @param limit pixels end when their transmittance is not above this
  /// @param pixels set to premultiplied colour and opacity, or to what a projection has met
  void Merge(const SlabBlend& blend, float limit, TilePixels& pixels);

  /// Merges what was added, and forgets it: what is composited stays interval by interval. Runs
  /// must have one interval each.
  /// @param distance world length of an interval
  /// @param segments is added to
  void MergeToSegments(const SlabBlend& blend, double distance, RaySegments& segments);

private:
  /// Something of a ray that cannot be divided.
  struct Element
  {
    std::int64_t First;
    std::int64_t Last;
    const RayRun* Run;      ///< null for raw intervals
    const RawInterval* Raw; ///< null for runs
    int Rank;
    std::uint16_t Pixel;
  };
  struct Room;

  void Sort() const;
  void Resolve(const SlabBlend& blend);
  void ResolveBatch(const SlabBlend& blend, std::size_t begin, std::size_t end);
  template <class Function>
  void ForRuns(const Function& function) const;
  void BlendPixels(const SlabBlend& blend, float limit, TilePixels& pixels) const;

  mutable std::vector<Element> Elements;
  mutable bool Sorted = false;
  /// Raw intervals of all ranks, each as if one rank had it, in the order of elements; then what
  /// they are.
  std::vector<RawInterval> Decided;
  std::vector<RayRun> Resolved;
  std::unique_ptr<Room> Work;
};

} // namespace banyan

#endif
