// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_IceTMethods_h
#define banyan_Benchmarks_IceTMethods_h

#include "Parallel/Composite/Compositing.h"
#include "Parallel/Composite/PicturePlace.h"

#include <memory>
#include <string>
#include <vector>

namespace banyan::bench
{

/// The strategies of IceT that blend in an order, by the names that the table has.
std::vector<std::string> IceTStrategies();

/// A picture as IceT wants it: the whole viewport, `[y][x]`, RGBA, premultiplied.
class IceTPicture
{
public:
  /// Nothing is drawn. Memory is taken where something is put.
  /// @param floats whether pixels are floats; otherwise they have 8 bits per channel
  IceTPicture(const PixelRect& viewport, bool floats);

  /// Puts a part of an image into its place.
  void Put(const FloatImage& image, const PixelRect& part);

  const PixelRect Viewport;
  const bool Floats;
  PixelRect Active; ///< around what is drawn
  std::shared_ptr<void> Pixels;
};

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
  /// @param tiles where pixels end, of equal sizes
  /// @return whether this rank has a tile
  bool Composite(const std::string& strategy, const IceTPicture& mine,
    const std::vector<int>& frontToBack, const std::vector<PicturePlace>& tiles,
    CompositeStatistics& statistics);
  /// A channel of this rank's tile of the last picture, in [0, 255].
  double Channel(std::size_t index) const;

private:
  struct Internals;
  Internals* Self;
};

} // namespace banyan::bench

#endif
