// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_SamplingChoices_h
#define banyan_Render_Sampling_SamplingChoices_h

#include "Render/Sampling/ProbeImages.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace banyan
{

/// One value of what can be chosen, and the errors that it adds to those of others.
struct Choice
{
  double Value = 0.0; ///< a level, a distance or a stride
  TileErrors Errors;
};

/// Levels, distances and strides that tiles may be sampled with, and which of them cost least.
class SamplingChoices
{
public:
  std::vector<Choice> Levels;    ///< from the coarsest on
  std::vector<Choice> Distances; ///< from the largest on
  std::vector<Choice> Strides; ///< RaySampling::PixelStride: 1, which has no error, and larger ones

  /// Packets of rays go no further per step: see RayTile::LongestStep.
  static constexpr double MostCellsPerStep = 16.0;

  /// @param usualDistance SamplingWish::Distance
  explicit SamplingChoices(double usualDistance)
    : UsualDistance(usualDistance)
  {
  }

  /// Positions in the lists.
  struct Chosen
  {
    std::size_t Level = 0;
    std::size_t Distance = 0;
    std::size_t Stride = 0;
    double Error = 0.0;
  };

  /// All that packets can draw, in the order of what they cost.
  std::vector<Chosen> CheapestFirst() const;

  /// The cheapest sampling of all rays whose error is allowed in so many tiles of all, or the most
  /// exact.
  Chosen CheapestForMost(double share, double allowed) const;

  /// Says that strides were judged by a picture of this sampling. Finer levels show more, so tiles
  /// whose pixels are left out have the errors of its level at least. Closer samples show less: too
  /// few of them look like edges.
  void StridesAreThoseOf(const Chosen& probe) { this->SubsamplingProbe = probe; }

  /// All of them; NumberOf is a position in this list.
  std::vector<RaySampling> Samplings() const;
  int NumberOf(const Chosen& chosen) const;
  RaySampling SamplingOf(const Chosen& chosen) const;
  /// The finest level and the smallest distance that are no finer than the sampling's, with its
  /// stride: the sampling's error is at most theirs. Nothing where one of them is not there.
  std::optional<Chosen> NoFinerThan(const RaySampling& sampling) const;
  /// What is expected of a tile, in 1/255.
  double ErrorOf(const Chosen& chosen, std::size_t tile) const;

private:
  bool CanStep(std::size_t level, std::size_t distance) const;
  double CostOf(const Chosen& chosen) const;

  double UsualDistance;
  std::optional<Chosen> SubsamplingProbe;
};

} // namespace banyan

#endif
