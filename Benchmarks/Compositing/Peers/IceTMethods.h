// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_IceTMethods_h
#define banyan_Benchmarks_IceTMethods_h

#include "Parallel/Composite/Compositing.h"

#include <string>
#include <vector>

namespace banyan::bench
{

/// The strategies of IceT that blend in an order, by the names that the table has.
std::vector<std::string> IceTStrategies();

/// A picture as IceT wants it: the whole viewport, `[y][x]`, RGBA, premultiplied.
struct IceTPicture
{
  PixelRect Viewport;
  PixelRect Active;
  std::vector<std::uint8_t> Bytes; ///< 4 per pixel; empty for floats
  std::vector<float> Floats;       ///< 4 per pixel; empty for bytes
};
IceTPicture PictureOf(const FloatImage& image, const PixelRect& viewport, bool floats);

/// IceT, unmodified, over MPI_COMM_WORLD: a communicator of our own counts what it sends.
class IceTCompositor
{
public:
  /// @param floats whether pixels are floats; otherwise they have 8 bits per channel
  explicit IceTCompositor(bool floats);
  ~IceTCompositor();
  IceTCompositor(const IceTCompositor&) = delete;
  IceTCompositor& operator=(const IceTCompositor&) = delete;

  /// @param mine floats or bytes, as the compositor
  /// @return whether the picture is here: on rank 0
  bool Composite(const std::string& strategy, const IceTPicture& mine,
    const std::vector<int>& frontToBack, CompositeStatistics& statistics);
  /// A channel of the last picture, in [0, 255].
  double Channel(std::size_t index) const;

private:
  struct Internals;
  Internals* Self;
};

} // namespace banyan::bench

#endif
