#include "Render/PilotPictures.h"

#include "Render/PilotSpacing.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

double PilotErrors::Largest() const
{
  return this->Pixels.empty() ? 0.0 : *std::max_element(this->Pixels.begin(), this->Pixels.end());
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

PilotPictures::PilotPictures(
  const RayScene& scene, std::function<FloatImage(const RayScene& pilot)> draw)
  : Scene(scene)
  , DrawScene(std::move(draw))
{
  this->SetSpacing(PilotSpacing(scene));
}

PilotPictures::PilotPictures(const RayScene& scene,
  std::function<FloatImage(const RayScene& pilot)> draw, int spacing, double around)
  : Scene(scene)
  , DrawScene(std::move(draw))
  , TilesAround(around)
  , FixedSpacing(true)
{
  this->SetSpacing(spacing);
}

void PilotPictures::SetSpacing(int pixels)
{
  this->Spacing = pixels;
  this->Size = (this->ImageSize() + pixels - 1) / pixels;
  const glm::dvec2 perPixel = glm::dvec2(this->Size) / glm::dvec2(this->ImageSize());
  const PixelRect wanted = VolumeOnScreen(this->Scene);
  this->View = Intersection({ glm::ivec2(glm::floor(glm::dvec2(wanted.Lo) * perPixel)),
                              glm::ivec2(glm::ceil(glm::dvec2(wanted.Hi) * perPixel)) },
    { glm::ivec2(0), this->Size });
}

PilotPicture PilotPictures::Draw(const RaySampling& sampling)
{
  const bool first = this->Drawn == 0 && !this->FixedSpacing;
  PilotPicture picture = this->DrawAsItIs(sampling);
  // Little of a volume may be seen of which much is on the screen.
  for (bool enough = !first; !enough;)
  {
    const auto seen = std::count_if(picture.Pixels.begin(), picture.Pixels.end(),
      [](const glm::vec4& pixel) { return pixel.a > 0.0f; });
    const int spacing = PilotSpacingAfter(this->Spacing, static_cast<int>(seen));
    enough = spacing == this->Spacing;
    if (!enough)
    {
      this->SetSpacing(spacing);
      picture = this->DrawAsItIs(sampling);
    }
  }
  return picture;
}

PilotPicture PilotPictures::DrawAsItIs(const RaySampling& sampling)
{
  RayScene pilot = this->Scene;
  pilot.Camera = this->Scene.Camera.WithSize(this->Size);
  pilot.Viewport = this->View;
  pilot.Depth = this->DepthOf(pilot);
  pilot.Samplings = std::make_shared<const TileSamplings>(this->Size, std::vector{ sampling });
  pilot.Pilot = true;
  const FloatImage image = this->DrawScene(pilot);

  PilotPicture picture;
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
glm::ivec2 PilotPictures::ToImage(int x, int y) const
{
  const glm::dvec2 centre =
    (glm::dvec2(x, y) + 0.5) / glm::dvec2(this->Size) * glm::dvec2(this->ImageSize());
  return glm::ivec2(centre);
}

/// Geometry where the pilots look; none where the large picture has no depths.
std::vector<float> PilotPictures::DepthOf(const RayScene& pilot) const
{
  std::vector<float> depths;
  if (this->Scene.Depth.empty())
  {
    return depths;
  }
  const PixelRect& view = this->Scene.Viewport;
  for (int y = pilot.Viewport.Lo.y; y < pilot.Viewport.Hi.y; ++y)
  {
    for (int x = pilot.Viewport.Lo.x; x < pilot.Viewport.Hi.x; ++x)
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

PilotErrors PilotPictures::Difference(const PilotPicture& a, const PilotPicture& b) const
{
  const std::size_t count = a.Pixels.size();
  PilotErrors errors;
  errors.Pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i)
  {
    const glm::vec4& p = a.Pixels[i];
    const glm::vec4& q = b.Pixels[i];
    const float light = std::max(std::abs(p.r - q.r), std::abs(p.g - q.g));
    const float rest = std::max(std::abs(p.b - q.b), std::abs(p.a - q.a));
    errors.Pixels[i] = 255.0f * std::max(light, rest);
  }
  return errors;
}

std::size_t PilotPictures::TileCount() const
{
  const glm::ivec2 tiles = TileSamplings::TilesOf(this->ImageSize());
  return static_cast<std::size_t>(tiles.x) * tiles.y;
}

TileErrors PilotPictures::ErrorsOf(const PilotErrors& errors, double factor, double share) const
{
  const glm::ivec2 tiles = TileSamplings::TilesOf(this->ImageSize());
  const int width = this->View.Size().x;
  const double atLeast = share * errors.Largest();
  TileErrors result;
  std::vector<float> columns(static_cast<std::size_t>(width));
  for (int y = 0; y < tiles.y; ++y)
  {
    // Columns first: what lies in them is then looked at once for a row of tiles.
    std::fill(columns.begin(), columns.end(), 0.0f);
    const PilotsAround rows = this->Around(y, 1);
    for (int j = rows.Begin; j < rows.End; ++j)
    {
      const float* const row = errors.Pixels.data() + static_cast<std::ptrdiff_t>(j) * width;
      for (int i = 0; i < width; ++i)
      {
        columns[i] = columns[i] < row[i] ? row[i] : columns[i];
      }
    }
    for (int x = 0; x < tiles.x; ++x)
    {
      const PilotsAround near = this->Around(x, 0);
      float largest = 0.0f;
      for (int i = near.Begin; i < near.End; ++i)
      {
        largest = std::max(largest, columns[i]);
      }
      result.Tiles.push_back(std::max(factor * largest, atLeast));
    }
  }
  return result;
}

/// Along one axis, the pilots within TilesAround of a tile: their positions in View.
PilotPictures::PilotsAround PilotPictures::Around(int tile, int axis) const
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
