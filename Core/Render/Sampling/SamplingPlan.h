// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_SamplingPlan_h
#define banyan_Render_Sampling_SamplingPlan_h

#include "Render/Levels/RayCaster.h"

#include <functional>
#include <memory>
#include <vector>

namespace banyan
{

struct PlanBasis;

/// What a picture may cost and how wrong it may be.
struct SamplingWish
{
  /// Largest error of a pixel's red, green or blue, in 1/255, against the integral along its ray;
  /// above 0.
  double Tolerance = 1.0;
  /// World length that samples are usually apart: an edge of a cell. Samples are taken from 1/8 of
  /// it to 8 times as far apart.
  double Distance = 1.0;
  /// The coarsest level that may be drawn from; 0 allows the finest only.
  int CoarsestLevel = 0;
  /// The finest level that probes are drawn from, at most CoarsestLevel: what finer ones would
  /// show is extrapolated. For volumes of which more is visible than memory may hold.
  int FinestProbeLevel = 0;
  /// Levels with fewer cells along the longest axis are not used: two of them may look alike
  /// because both have lost what there is to see.
  int LeastCells = 64;
  /// The largest RaySampling::PixelStride: whoever draws a plan has to call
  /// InterpolateSkippedPixels unless it is 1.
  int LargestPixelStride = RaySampling::LargestStride;
  /// The finest level that may be drawn from, whatever the tolerance: see FinestLevelFor. One below
  /// the coarsest that is used, if need be: of one level alone no error could be told.
  int FinestLevel = 0;
  /// Per tile of the picture, row by row, the same, where it is coarser than FinestLevel: see
  /// FinestLevelsOfTiles. Empty: nowhere.
  std::vector<int> FinestLevelOfTile = {};
  /// Whether FinestProbeLevel is also the finest level that is drawn from, whatever the tolerance:
  /// of finer ones more is visible than memory may hold, so that each frame would load it anew.
  bool StaysInMemory = false;
};

/// The reason why a plan misses its tolerance.
enum class SamplingLimit
{
  None,     ///< nothing: the tolerance is kept
  Distance, ///< samples get no closer
  Level     ///< the wish allows no finer level
};

/// How a picture is to be sampled so that its error stays within a tolerance.
struct SamplingPlan
{
  /// Null when nothing was seen to decide from: then sample the finest level at the usual distance.
  std::shared_ptr<const TileSamplings> Samplings;
  /// The largest error expected of any tile, in 1/255. Estimated: see PlanSamplings. It is above
  /// the tolerance where even the finest sampling is not expected to meet it.
  double EstimatedError = 0.0;
  SamplingLimit Limit =
    SamplingLimit::None; ///< not None where EstimatedError is above the tolerance
  /// Whether the error of finer levels was extrapolated: FinestProbeLevel allowed no probes of
  /// them.
  bool Extrapolated = false;
  /// To be used with it: what rays that end early leave away is part of the error.
  float OpacityLimit = 0.999f;
  /// What it was chosen from; null when nothing was seen, and for a SharedPlan.
  std::shared_ptr<const PlanBasis> Basis;
  int Probes = 0;             ///< small pictures that were drawn to find out
  double ProbeSeconds = 0.0;  ///< what finding distances and levels took, by the clock
  double StrideSeconds = 0.0; ///< what finding the pixels without rays took
};

/// Draws a small picture of the scene's viewport: all pixels of it, on all ranks alike.
using DrawProbe = std::function<FloatImage(const RayScene& probe)>;

/// Finds for each tile the cheapest sampling that keeps its error within the tolerance.
///
/// How: *probes*, small pictures whose pixels are ProbeSpacing apart, are drawn with ever smaller
/// distances between samples at the coarsest level, which costs least, then with ever finer levels
/// at the distance that was needed, and then with distances from the longest on at the coarsest of
/// these levels that is good enough for all tiles, each until all tiles are content
/// (ProbeSequence). Which level and which distance a tile gets is chosen from the sums of both
/// errors: finer levels than needed are never loaded. How many pixels need rays of their own one
/// more small picture tells (SubsamplingProbe), and that error counts with the others.
///
/// The error is estimated, then, and not bounded: `ctest -R SamplingPlan` shows that it is above
/// the true one on the standard scenes. Where the opacity function jumps, or reaches 1, single
/// pixels may be off by more: no probe met them.
///
/// Why not from bounds on the values: they take no account of how errors cancel along a ray, and
/// are 30 to 100 times too large for smooth scenes (Documentation/rendering.md).
///
/// @param scene all of it, its Samplings apart; the picture's size decides the tiles
/// Throws Error when the wish or the scene is not usable.
SamplingPlan PlanSamplings(const RayScene& scene, SamplingWish wish, const DrawProbe& draw);

} // namespace banyan

#endif
