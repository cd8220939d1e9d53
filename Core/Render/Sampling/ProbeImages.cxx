// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/ProbeImages.h"

#include "Render/Sampling/ProbeSpacing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// The largest power of 2 that is no longer than any window that is not empty.
int CommonPart(const std::vector<ProbesAround>& windows)
{
  int shortest = std::numeric_limits<int>::max();
  for (const ProbesAround& window : windows)
  {
    shortest = window.Begin < window.End ? std::min(shortest, window.End - window.Begin) : shortest;
  }
  int part = 1;
  while (2 * part <= shortest && shortest < std::numeric_limits<int>::max())
  {
    part *= 2;
  }
  return part;
}

/// Raises numbers to others.
void Raise(float* numbers, const float* others, int count)
{
  for (int i = 0; i < count; ++i)
  {
    numbers[i] = numbers[i] < others[i] ? others[i] : numbers[i];
  }
}

/// Makes each row the largest numbers of `part` rows from it on, or of what there is of them.
/// @param part a power of 2
void MakeMaxima(float* numbers, int rows, int rowLength, int part)
{
  for (int step = 1; step < part; step *= 2)
  {
    for (int row = 0; row + step < rows; ++row)
    {
      float* const here = numbers + static_cast<std::ptrdiff_t>(row) * rowLength;
      Raise(here, here + static_cast<std::ptrdiff_t>(step) * rowLength, rowLength);
    }
  }
}

/// Calls function(begin) for parts of one length that cover a window.
/// @param part no longer than the window
template <class Function>
void ForParts(const ProbesAround& window, int part, Function&& function)
{
  for (int i = window.Begin; i < window.End; i += part)
  {
    function(std::min(i, window.End - part));
  }
}

} // namespace

double ProbeErrors::Largest() const
{
  // Several maxima side by side, which compilers make vectors of.
  constexpr std::size_t width = 16;
  float largest[width] = {};
  const std::size_t whole = this->Pixels.size() / width * width;
  for (std::size_t i = 0; i < whole; i += width)
  {
    Raise(largest, this->Pixels.data() + i, static_cast<int>(width));
  }
  Raise(largest, this->Pixels.data() + whole, static_cast<int>(this->Pixels.size() - whole));
  return *std::max_element(largest, largest + width);
}

double TileErrors::Smallest() const
{
  return this->Tiles.empty() ? 0.0 : *std::min_element(this->Tiles.begin(), this->Tiles.end());
}

double TileErrors::Largest() const
{
  return this->Tiles.empty() ? 0.0 : *std::max_element(this->Tiles.begin(), this->Tiles.end());
}

void TileErrors::Add(const TileErrors& other)
{
  for (std::size_t i = 0; i < this->Tiles.size(); ++i)
  {
    this->Tiles[i] += other.Tiles[i];
  }
}

void TileErrors::Lower(const TileErrors& other)
{
  for (std::size_t i = 0; i < this->Tiles.size(); ++i)
  {
    this->Tiles[i] = std::min(this->Tiles[i], other.Tiles[i]);
  }
}

void TileErrors::Raise(const TileErrors& other)
{
  for (std::size_t i = 0; i < this->Tiles.size(); ++i)
  {
    this->Tiles[i] = std::max(this->Tiles[i], other.Tiles[i]);
  }
}

ProbeImages::ProbeImages(
  const RayScene& scene, std::function<FloatImage(const RayScene& probe)> draw)
  : Scene(scene)
  , DrawScene(std::move(draw))
{
  this->SetSpacing(ProbeSpacing(scene));
}

ProbeImages::ProbeImages(const RayScene& scene,
  std::function<FloatImage(const RayScene& probe)> draw, int spacing, double around)
  : Scene(scene)
  , DrawScene(std::move(draw))
  , TilesAround(around)
  , FixedSpacing(true)
{
  this->SetSpacing(spacing);
}

void ProbeImages::SetSpacing(int pixels)
{
  this->Spacing = pixels;
  this->Size = (this->ImageSize() + pixels - 1) / pixels;
  const glm::dvec2 perPixel = glm::dvec2(this->Size) / glm::dvec2(this->ImageSize());
  const PixelRect wanted = VolumeOnScreen(this->Scene);
  this->View = Intersection({ glm::ivec2(glm::floor(glm::dvec2(wanted.Lo) * perPixel)),
                              glm::ivec2(glm::ceil(glm::dvec2(wanted.Hi) * perPixel)) },
    { glm::ivec2(0), this->Size });
}

ProbeImage ProbeImages::Draw(const RaySampling& sampling)
{
  for (const auto& [known, picture] : this->Known)
  {
    if (known == sampling)
    {
      return picture;
    }
  }
  const bool first = this->Drawn == 0 && !this->FixedSpacing;
  ProbeImage picture = this->DrawAsItIs(sampling);
  // Little of a volume may be seen of which much is on the screen.
  for (bool enough = !first; !enough;)
  {
    const auto seen = std::count_if(picture.Pixels.begin(), picture.Pixels.end(),
      [](const glm::vec4& pixel) { return pixel.a > 0.0f; });
    const int spacing = ProbeSpacingAfter(this->Spacing, static_cast<int>(seen));
    enough = spacing == this->Spacing;
    if (!enough)
    {
      this->SetSpacing(spacing);
      picture = this->DrawAsItIs(sampling);
    }
  }
  this->Known.emplace_back(sampling, picture);
  return picture;
}

ProbeImage ProbeImages::DrawAsItIs(const RaySampling& sampling)
{
  RayScene probe = this->Scene;
  probe.Camera = this->Scene.Camera.WithSize(this->Size);
  probe.Viewport = this->View;
  probe.Depth = this->DepthOf(probe);
  probe.Samplings = std::make_shared<const TileSamplings>(this->Size, std::vector{ sampling });
  probe.Probe = true;
  const FloatImage image = this->DrawScene(probe);

  ProbeImage picture;
  picture.Pixels.assign(static_cast<std::size_t>(this->View.Count()), glm::vec4(0.0f));
  for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y; ++y)
  {
    for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
    {
      const glm::vec4& pixel = image.At(x, y);
      picture.Pixels[static_cast<std::size_t>(y - this->View.Lo.y) * this->View.Size().x + x -
                     this->View.Lo.x] = pixel;
      this->Saw = this->Saw || pixel.a > 0.0f;
    }
  }
  ++this->Drawn;
  return picture;
}

/// The pixel of the large picture that holds the centre of one of the small one.
glm::ivec2 ProbeImages::ToImage(int x, int y) const
{
  const glm::dvec2 centre =
    (glm::dvec2(x, y) + 0.5) / glm::dvec2(this->Size) * glm::dvec2(this->ImageSize());
  return glm::ivec2(centre);
}

/// Geometry where the probes look; none where the large picture has no depths.
std::vector<float> ProbeImages::DepthOf(const RayScene& probe) const
{
  std::vector<float> depths;
  if (this->Scene.Depth.empty())
  {
    return depths;
  }
  const PixelRect& view = this->Scene.Viewport;
  for (int y = probe.Viewport.Lo.y; y < probe.Viewport.Hi.y; ++y)
  {
    for (int x = probe.Viewport.Lo.x; x < probe.Viewport.Hi.x; ++x)
    {
      const glm::ivec2 at = this->ToImage(x, y);
      const bool inside =
        at.x >= view.Lo.x && at.y >= view.Lo.y && at.x < view.Hi.x && at.y < view.Hi.y;
      const std::size_t pixel =
        inside ? static_cast<std::size_t>(at.y - view.Lo.y) * view.Size().x + (at.x - view.Lo.x)
               : 0;
      depths.push_back(inside ? this->Scene.Depth[pixel] : 1.0f);
    }
  }
  return depths;
}

ProbeErrors ProbeImages::Difference(const ProbeImage& a, const ProbeImage& b) const
{
  const std::size_t count = a.Pixels.size();
  ProbeErrors errors;
  errors.Pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    errors.Pixels[i] = ProbeErrors::Between(a.Pixels[i], b.Pixels[i]);
  }
  return errors;
}

std::size_t ProbeImages::TileCount() const
{
  const glm::ivec2 tiles = TileSamplings::TilesOf(this->ImageSize());
  return static_cast<std::size_t>(tiles.x) * tiles.y;
}

TileErrors ProbeImages::ErrorsOf(const ProbeErrors& errors, double factor, double share) const
{
  const glm::ivec2 tiles = TileSamplings::TilesOf(this->ImageSize());
  const std::vector<ProbesAround> rows = this->AroundAll(tiles.y, 1);
  const std::vector<ProbesAround> columns = this->AroundAll(tiles.x, 0);
  const int width = this->View.Size().x;
  const int height = this->View.Size().y;
  const double atLeast = share * errors.Largest();

  // Windows overlap, so what several of them share is looked at once.
  const int tall = CommonPart(rows);
  std::vector<float> fromRow = errors.Pixels;
  MakeMaxima(fromRow.data(), height, width, tall);
  const int wide = CommonPart(columns);
  std::vector<float> fromColumn(static_cast<std::size_t>(width));
  TileErrors result;
  result.Tiles.reserve(rows.size() * columns.size());
  for (const ProbesAround& near : rows)
  {
    std::fill(fromColumn.begin(), fromColumn.end(), 0.0f);
    ForParts(near, tall,
      [&](int y) {
        Raise(fromColumn.data(), fromRow.data() + static_cast<std::ptrdiff_t>(y) * width, width);
      });
    MakeMaxima(fromColumn.data(), width, 1, wide);
    for (const ProbesAround& beside : columns)
    {
      float largest = 0.0f;
      ForParts(beside, wide, [&](int x) { largest = std::max(largest, fromColumn[x]); });
      result.Tiles.push_back(std::max(factor * largest, atLeast));
    }
  }
  return result;
}

/// Of all tiles along an axis.
std::vector<ProbesAround> ProbeImages::AroundAll(int tiles, int axis) const
{
  std::vector<ProbesAround> around;
  for (int tile = 0; tile < tiles; ++tile)
  {
    around.push_back(this->Around(tile, axis));
  }
  return around;
}

/// Along one axis, the probes within TilesAround of a tile: their positions in View.
ProbesAround ProbeImages::Around(int tile, int axis) const
{
  const double around = this->TilesAround * TileSamplings::Edge;
  const double perPixel = static_cast<double>(this->Size[axis]) / this->ImageSize()[axis];
  const double low = tile * static_cast<double>(TileSamplings::Edge) - around;
  const double high = low + (2.0 * around + TileSamplings::Edge);
  const int first = this->View.Lo[axis];
  const int count = this->View.Size()[axis];
  return { std::clamp(static_cast<int>(std::floor(low * perPixel)) - first, 0, count),
    std::clamp(static_cast<int>(std::ceil(high * perPixel)) - first, 0, count) };
}

} // namespace banyan
