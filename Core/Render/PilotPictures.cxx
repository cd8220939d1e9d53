#include "Render/PilotPictures.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Pixels of the picture per pixel of a pilot: 4096 pilots see enough of most scenes, and small
/// pictures must not cost much more than themselves.
int SpacingFor(const glm::ivec2& size)
{
  const double edge = std::sqrt(static_cast<double>(size.x) * size.y);
  return std::clamp(static_cast<int>(edge / 64.0 + 0.5), 8, 16);
}

} // namespace

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
  const int spacing = SpacingFor(this->ImageSize());
  this->Size = (this->ImageSize() + spacing - 1) / spacing;
  const glm::dvec2 perPixel = glm::dvec2(this->Size) / glm::dvec2(this->ImageSize());
  this->View = Intersection({ glm::ivec2(glm::floor(glm::dvec2(scene.Viewport.Lo) * perPixel)),
                              glm::ivec2(glm::ceil(glm::dvec2(scene.Viewport.Hi) * perPixel)) },
    { glm::ivec2(0), this->Size });
}

PilotPicture PilotPictures::Draw(const RaySampling& sampling)
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
  PilotErrors errors;
  errors.Pixels.reserve(a.Pixels.size());
  for (std::size_t i = 0; i < a.Pixels.size(); ++i)
  {
    const glm::vec4 off = glm::abs(a.Pixels[i] - b.Pixels[i]) * 255.0f;
    errors.Pixels.push_back(std::max({ off.r, off.g, off.b, off.a }));
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
  constexpr double around = 2.5 * TileSamplings::Edge;
  const glm::ivec2 tiles = TileSamplings::TilesOf(this->ImageSize());
  const glm::dvec2 perPixel = glm::dvec2(this->Size) / glm::dvec2(this->ImageSize());
  const double atLeast = share * errors.Largest();
  TileErrors result;
  for (int y = 0; y < tiles.y; ++y)
  {
    for (int x = 0; x < tiles.x; ++x)
    {
      const glm::dvec2 low = glm::dvec2(x, y) * static_cast<double>(TileSamplings::Edge) - around;
      const glm::dvec2 high = low + (2.0 * around + TileSamplings::Edge);
      const PixelRect near = Intersection(
        { glm::ivec2(glm::floor(low * perPixel)), glm::ivec2(glm::ceil(high * perPixel)) },
        this->View);
      float largest = 0.0f;
      for (int j = near.Lo.y; j < near.Hi.y; ++j)
      {
        const float* const row =
          &errors.Pixels[static_cast<std::size_t>(j - this->View.Lo.y) * this->View.Size().x];
        largest = std::max(largest,
          *std::max_element(row + near.Lo.x - this->View.Lo.x, row + near.Hi.x - this->View.Lo.x));
      }
      result.Tiles.push_back(std::max(factor * largest, atLeast));
    }
  }
  return result;
}

} // namespace banyan
