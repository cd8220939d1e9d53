// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_IceTMethods_h
#define banyan_Benchmarks_IceTMethods_h

#include "Parallel/Compositing.h"

#include <string>
#include <vector>

namespace banyan::bench
{

/// The strategies of IceT that blend in an order, by the names that the table has.
std::vector<std::string> IceTStrategies();

/// A picture of 8 bits per channel, as IceT wants it: the whole viewport, `[y][x]`, premultiplied.
struct BytesImage
{
  PixelRect Viewport;
  PixelRect Active;
  std::vector<std::uint8_t> Pixels;
};
BytesImage ToBytes(const FloatImage& image, const PixelRect& viewport);

/// IceT, unmodified, over MPI_COMM_WORLD: a communicator of our own counts what it sends.
class IceTCompositor
{
public:
  IceTCompositor();
  ~IceTCompositor();
  IceTCompositor(const IceTCompositor&) = delete;
  IceTCompositor& operator=(const IceTCompositor&) = delete;

  /// @return the picture on rank 0, RGBA, until the next call; null elsewhere
  const std::uint8_t* Composite(const std::string& strategy, const BytesImage& mine,
    const std::vector<int>& frontToBack, CompositeStatistics& statistics);

private:
  struct Internals;
  Internals* Self;
};

} // namespace banyan::bench

#endif
