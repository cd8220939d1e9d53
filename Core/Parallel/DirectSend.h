#ifndef banyan_Parallel_DirectSend_h
#define banyan_Parallel_DirectSend_h

#include "Parallel/Communicator.h"
#include "Render/ProjectionTable.h"

#include <vector>

namespace banyan
{

/// front over back, premultiplied.
inline glm::vec4 Over(const glm::vec4& front, const glm::vec4& back)
{
  return front + (1.0f - front.a) * back;
}

struct CompositeStatistics
{
  std::uint64_t BytesSent = 0; ///< by this rank
};

/// Direct send: the picture is cut into one strip of rows per rank, every rank sends each strip's
/// owner its pixels there, the owner blends them in visibility order in float, and the strips go to
/// the root. Collective; every rank may have an empty image.
///
/// @param mine this rank's pixels, anywhere inside `viewport`
/// @param frontToBack ranks in visibility order, the same on all ranks
/// @param combination what is done with the pixels of two ranks; the same on all ranks
/// @return on rank 0 the whole viewport (0 where nothing was drawn); elsewhere empty.
/// Exact: the over operator in float in visibility order, as a single rank would blend; largest
/// numbers are those of any order, and sums are made in visibility order.
FloatImage CompositeDirectSend(Communicator& communicator, const FloatImage& mine,
  const std::vector<int>& frontToBack, const PixelRect& viewport, CompositeStatistics& statistics,
  Combination combination = Combination::Over);

/// Opaque geometry as one rank sees it: nearest depth in [0, 1] and 8-bit colour per pixel.
struct OpaquePixel
{
  float Depth;
  std::uint8_t Color[4]; ///< RGBA, premultiplied
};

/// Collective: every rank gets, per pixel, the nearest of all ranks (the lower rank wins a tie).
void ReduceNearest(Communicator& communicator, std::vector<OpaquePixel>& pixels);

} // namespace banyan

#endif
