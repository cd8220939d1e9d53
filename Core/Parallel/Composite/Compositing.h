// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_Compositing_h
#define banyan_Parallel_Composite_Compositing_h

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Composite/CompositePlan.h"
#include "Parallel/Composite/CompositePlanCache.h"
#include "Parallel/Composite/CompositeStatistics.h"
#include "Parallel/Composite/FragmentFormat.h"
#include "Render/Scene/FloatImage.h"
#include "Render/Scene/ProjectionTable.h"

#include <functional>
#include <string>
#include <vector>

namespace banyan
{

/// How exactly pixels travel.
enum class PixelTransport
{
  Floats,   ///< as they are: the picture is within 1e-5 of one rank's
  WithinOne ///< as few bits as keep each pixel, rounded to 8 bits, within 1 of one rank's
};

enum class PixelPacking
{
  ByCosts, ///< where PackingPays
  Always,
  Never
};

struct CompositeOptions
{
  /// Says how the pixels of two ranks are combined; all but Over always travel as floats.
  Combination Combine = Combination::Over;
  PixelTransport Transport = PixelTransport::Floats;
  PixelPacking Packing = PixelPacking::ByCosts;
  CompositeCosts Costs;
  /// Where each rank may draw; none if only the ranks themselves know (they then tell each other).
  std::vector<Footprint> Footprints;
  /// Pixels under which the root has something that it will blend them over.
  PixelRect Behind;
  /// The rank that gets the picture.
  int Root = 0;
  /// Largest colour over opacity of a pixel: above 1 where there are highlights.
  float Brightest = 1.0f;
  /// Where the plan is kept from frame to frame; null for nowhere.
  CompositePlanCache* Plans = nullptr;
  /// Whether the ranks know already that ProblemOf finds nothing, and that all have the same
  /// options, order and viewport: saves a collective message.
  bool Agreed = false;

  /// Whether DrawDistributed begins to composite while rays are still cast, on more than one
  /// rank that sends at once (Communicator::SendsAtOnce). The picture is the same to the last bit.
  bool WhileCasting = true;

  /// How many bytes of pixels any rank may have cast for several places before they are composited.
  /// One place may take more.
  std::uint64_t MostBytes = std::uint64_t{ 256 } << 20;

  /// Called by DrawDistributed when this rank has cast its rays: begins what can go on in the
  /// background while pictures are composited and shown. Must not throw.
  std::function<void()> AfterCasting;
};

/// Makes one picture of those of all ranks. Collective; all arguments but `mine` are the same on
/// all ranks.
///
/// @param mine this rank's pixels, anywhere inside `viewport`; may be empty
/// @param frontToBack ranks in visibility order
/// @param statistics is added to
/// @return on the root the whole viewport (0 where nothing was drawn); elsewhere empty.
/// When one rank is called wrongly, all ranks throw the same Error.
FloatImage Composite(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics);

/// One of several pictures that are composited at once. All but `Mine` are the same on all ranks.
struct PictureOfRanks
{
  const FloatImage& Mine;       ///< this rank's pixels, anywhere inside the viewport; may be empty
  std::vector<int> FrontToBack; ///< ranks in visibility order
  PixelRect Viewport;
  CompositeOptions Options; ///< with footprints; nothing is left to agree on
};

/// Makes several pictures at once, of which each may have another root. Collective. All ranks know
/// already that ProblemOf finds nothing.
/// @return each as of Composite
std::vector<FloatImage> CompositeTogether(Communicator& communicator,
  const std::vector<PictureOfRanks>& pictures, CompositeStatistics& statistics);

/// How many pictures fit into memory together, before they are composited: at least one. All ranks
/// come to the same.
/// @param pictures with footprints
/// @param mostBytes of pixels, on the rank that has most of them
/// @return the number behind that of the last picture, counted from 0
std::size_t EndOfBatch(
  const std::vector<PictureOfRanks>& pictures, std::size_t first, std::uint64_t mostBytes);

/// Why Composite cannot work with these arguments on this rank; empty if it can.
std::string ProblemOf(int rank, int ranks, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options);

/// Smallest rectangle around the drawn pixels (not all zero) of `image` inside `rect`.
PixelRect ActiveRect(const FloatImage& image, const PixelRect& rect);

/// How pixels travel of which up to `meeting` are blended, `shares` times one after the other.
FragmentFormat FormatFor(const CompositeOptions& options, int meeting, int shares);
/// And those that are not blended any more.
FragmentFormat FormatOfFinal(const CompositeOptions& options);
bool Packs(const CompositeOptions& options);

} // namespace banyan

#endif
