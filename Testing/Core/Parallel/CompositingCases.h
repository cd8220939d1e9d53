// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_CompositingCases_h
#define banyan_Testing_CompositingCases_h

#include "Parallel/Composite/Compositing.h"
#include "Parallel/Composite/ReduceNearest.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

// Pictures that ranks bring to a compositing, the same on simulated ranks and under MPI. Every rank
// can make the picture of every other rank, so each can compute what the result must be.
namespace banyan::testing
{

/// What a rank draws, named after the tests of IceT where it has the same one.
enum class Case
{
  BackgroundCorrect, ///< a different rectangle per rank, background between them
  BlankTiles,        ///< everything lies in the lowest rows
  RenderEmpty,       ///< nobody has anything
  RanksWithoutData,  ///< every second rank has nothing
  OneRankHasAll,     ///< the last rank covers the viewport, the others have nothing
  AllOverlap,        ///< every rank covers every pixel
  Interlaced,        ///< every rank has every n-th row
  SparseCopy,        ///< a few single pixels in full-size images
  OpaqueFront,       ///< every rank covers every pixel, and some pixels hide all behind them
  Count
};

inline std::string NameOf(Case which)
{
  static const char* const names[] = { "BackgroundCorrect", "BlankTiles", "RenderEmpty",
    "RanksWithoutData", "OneRankHasAll", "AllOverlap", "Interlaced", "SparseCopy", "OpaqueFront" };
  return names[static_cast<int>(which)];
}

/// Viewports: odd, one pixel, one row, one column, fewer rows than ranks, away from the origin.
inline std::vector<PixelRect> Viewports()
{
  return { { { 0, 0 }, { 37, 41 } }, { { 0, 0 }, { 1, 1 } }, { { 0, 0 }, { 53, 1 } },
    { { 0, 0 }, { 1, 29 } }, { { 5, 7 }, { 8, 10 } }, { { -3, -11 }, { 60, 20 } },
    { { 2, 2 }, { 2, 2 } } };
}

inline std::mt19937 Seeded(Case which, int rank, int size, const PixelRect& viewport)
{
  std::seed_seq seed{ static_cast<int>(which), rank, size, viewport.Lo.x, viewport.Hi.y };
  return std::mt19937(seed);
}

inline PixelRect RectOf(Case which, int rank, int size, const PixelRect& viewport)
{
  std::mt19937 random = Seeded(which, rank, size, viewport);
  const auto between = [&](int low, int high)
  { return std::uniform_int_distribution<int>(low, high)(random); };
  PixelRect part = viewport;
  switch (which)
  {
    case Case::RenderEmpty:
      return {};
    case Case::OneRankHasAll:
      return rank == size - 1 ? viewport : PixelRect{};
    case Case::RanksWithoutData:
      return rank % 2 == 1 ? viewport : PixelRect{};
    case Case::BlankTiles:
      part.Hi.y = part.Lo.y + (viewport.Size().y + 9) / 10;
      return part;
    case Case::BackgroundCorrect:
      for (int axis = 0; axis < 2; ++axis)
      {
        const int middle = (viewport.Lo[axis] + viewport.Hi[axis]) / 2;
        part.Lo[axis] = between(viewport.Lo[axis], middle);
        part.Hi[axis] = between(middle, viewport.Hi[axis]);
      }
      return part;
    default:
      return viewport;
  }
}

inline FloatImage ImageOf(Case which, int rank, int size, const PixelRect& viewport)
{
  FloatImage image{ RectOf(which, rank, size, viewport), {} };
  std::mt19937 random = Seeded(which, rank, size, viewport);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y; ++y)
  {
    for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
    {
      float alpha = 0.4f * unit(random);
      alpha = which == Case::OpaqueFront && unit(random) < 0.2f ? 1.0f : alpha;
      alpha = which == Case::SparseCopy && unit(random) < 0.97f ? 0.0f : alpha;
      alpha = which == Case::Interlaced && (y - viewport.Lo.y) % size != rank ? 0.0f : alpha;
      const glm::vec3 color(unit(random), unit(random), unit(random));
      image.Pixels.push_back(glm::vec4(color * alpha, alpha));
    }
  }
  return image;
}

/// A visibility order that is neither the ranks' nor its reverse.
inline std::vector<int> OrderOf(Case which, int size)
{
  std::vector<int> order(static_cast<std::size_t>(size));
  for (int i = 0; i < size; ++i)
  {
    order[i] = i;
  }
  std::mt19937 random(static_cast<unsigned>(which) * 131u + static_cast<unsigned>(size));
  std::shuffle(order.begin(), order.end(), random);
  return order;
}

/// Numbers of two pixels made into one, in the arithmetic of doubles.
inline glm::dvec4 CombinedSlowly(
  const glm::dvec4& front, const glm::dvec4& back, Combination combination)
{
  switch (combination)
  {
    case Combination::Largest:
      return glm::max(front, back);
    case Combination::Sum:
      return front + back;
    default:
      return front + (1 - front.a) * back;
  }
}

/// A case with the images of all ranks, and the picture as it must be, made in the obvious way;
/// made once for all ranks.
struct PreparedCase
{
  PreparedCase(Case which, int size, const PixelRect& viewport, Combination combination)
    : Name(NameOf(which) + " on " + std::to_string(size) + " ranks, viewport " +
           std::to_string(viewport.Size().x) + "x" + std::to_string(viewport.Size().y))
    , Viewport(viewport)
    , Combine(combination)
    , Order(OrderOf(which, size))
    , Reference(static_cast<std::size_t>(viewport.Count()), glm::dvec4(0))
  {
    for (int rank = 0; rank < size; ++rank)
    {
      this->Images.push_back(ImageOf(which, rank, size, viewport));
    }
    for (const int rank : this->Order)
    {
      const FloatImage& image = this->Images[rank];
      for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y; ++y)
      {
        for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
        {
          const glm::ivec2 at = glm::ivec2(x, y) - viewport.Lo;
          glm::dvec4& pixel =
            this->Reference[static_cast<std::size_t>(at.y) * viewport.Size().x + at.x];
          pixel = CombinedSlowly(pixel, glm::dvec4(image.At(x, y)), combination);
        }
      }
    }
  }

  std::string Name;
  PixelRect Viewport;
  Combination Combine;
  std::vector<int> Order;
  std::vector<FloatImage> Images;
  std::vector<glm::dvec4> Reference;
};

/// Compares a picture with the slow one on rank 0: as floats within 1e-5, otherwise rounded to 8
/// bits within 1, over black and, inside `behind`, over white too.
/// @return what is wrong, or an empty string
inline std::string CheckPicture(const Communicator& communicator, const PreparedCase& prepared,
  const FloatImage& picture, bool floats, const PixelRect& behind = {})
{
  const PixelRect& viewport = prepared.Viewport;
  if (communicator.Rank() != 0)
  {
    return picture.Pixels.empty() ? ""
                                  : prepared.Name + ": a rank other than the root has a picture";
  }
  if (!(picture.Rect == viewport) ||
      static_cast<long long>(picture.Pixels.size()) != viewport.Count())
  {
    return prepared.Name + ": the picture is not the viewport";
  }
  const auto rounded = [](double value) { return std::lround(255.0 * std::min(value, 1.0)); };
  const std::vector<glm::dvec4>& reference = prepared.Reference;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    const glm::dvec4 got(picture.Pixels[i]);
    const glm::ivec2 at = viewport.Lo + glm::ivec2(i % viewport.Size().x, i / viewport.Size().x);
    const bool blended =
      at.x >= behind.Lo.x && at.x < behind.Hi.x && at.y >= behind.Lo.y && at.y < behind.Hi.y;
    for (int c = 0; c < 4; ++c)
    {
      const double right = reference[i][c];
      bool wrong =
        floats ? std::abs(got[c] - right) > 1e-5 : std::abs(rounded(got[c]) - rounded(right)) > 1;
      wrong =
        wrong || (!floats && blended &&
                   std::abs(rounded(got[c] + 1 - got.a) - rounded(right + 1 - reference[i].a)) > 1);
      if (wrong)
      {
        return prepared.Name + ": channel " + std::to_string(c) + " of pixel " + std::to_string(i) +
               " is " + std::to_string(got[c]) + " instead of " + std::to_string(right);
      }
    }
  }
  return "";
}

/// Composites a case as the options say, and compares with the slow picture.
/// @return what is wrong, or an empty string
inline std::string CheckComposite(
  Communicator& communicator, const PreparedCase& prepared, CompositeOptions options = {})
{
  options.Combine = prepared.Combine;
  CompositeStatistics statistics;
  const FloatImage picture = Composite(communicator, prepared.Images[communicator.Rank()],
    prepared.Order, prepared.Viewport, options, statistics);
  const bool floats =
    options.Transport == PixelTransport::Floats || options.Combine != Combination::Over;
  const std::string wrong = CheckPicture(communicator, prepared, picture, floats, options.Behind);
  return wrong.empty()
           ? wrong
           : "combination " + std::to_string(static_cast<int>(options.Combine)) + ", transport " +
               std::to_string(static_cast<int>(options.Transport)) + ", " + wrong;
}

/// Opaque pixels of a rank: few different depths, so that ties are common; the colour tells whose.
inline OpaquePixels OpaqueOf(int rank, std::size_t count)
{
  OpaquePixels pixels(count);
  std::mt19937 random(static_cast<unsigned>(rank) + 1u);
  for (OpaquePixel& pixel : pixels)
  {
    pixel.Depth = static_cast<float>(random() % 5) / 4.0f;
    pixel.Color[0] = static_cast<std::uint8_t>(rank);
    pixel.Color[1] = static_cast<std::uint8_t>(random() % 256);
    pixel.Color[2] = 7;
    pixel.Color[3] = 255;
  }
  return pixels;
}

/// @return what is wrong, or an empty string
inline std::string CheckNearest(Communicator& communicator, std::size_t count)
{
  OpaquePixels expected = OpaqueOf(0, count);
  for (int rank = 1; rank < communicator.Size(); ++rank)
  {
    const OpaquePixels other = OpaqueOf(rank, count);
    for (std::size_t i = 0; i < count; ++i)
    {
      expected[i] = other[i].Depth < expected[i].Depth ? other[i] : expected[i];
    }
  }
  OpaquePixels pixels = OpaqueOf(communicator.Rank(), count);
  ReduceNearest(communicator, pixels);
  for (std::size_t i = 0; i < count; ++i)
  {
    if (pixels[i].Depth != expected[i].Depth ||
        !std::equal(pixels[i].Color, pixels[i].Color + 4, expected[i].Color))
    {
      return "pixel " + std::to_string(i) + " of " + std::to_string(count) +
             " is not the nearest one";
    }
  }
  return "";
}

} // namespace banyan::testing

#endif
