// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_ProbeImages_h
#define banyan_Render_Sampling_ProbeImages_h

#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayScene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace banyan
{

/// A small picture of a scene.
struct ProbeImage
{
  std::vector<glm::vec4> Pixels; ///< `[y][x]` of the part that is wanted; empty before it is drawn
};

/// How far each pixel of a probe is off, in 1/255: the largest of red, green, blue and opacity.
struct ProbeErrors
{
  std::vector<float> Pixels;

  static float Between(const glm::vec4& a, const glm::vec4& b)
  {
    const float light = std::max(std::abs(a.r - b.r), std::abs(a.g - b.g));
    const float rest = std::max(std::abs(a.b - b.b), std::abs(a.a - b.a));
    return 255.0f * std::max(light, rest);
  }
  double Largest() const;
};

/// Probes along one axis that a tile is judged by.
struct ProbesAround
{
  int Begin;
  int End;
};

/// What is expected of the tiles of a picture, in 1/255.
struct TileErrors
{
  std::vector<double> Tiles;

  double Of(std::size_t tile) const { return this->Tiles[tile]; }
  double Smallest() const;
  double Largest() const;
  void Add(const TileErrors& other);
  /// Takes the smaller error of each tile.
  void Lower(const TileErrors& other);
  /// Takes the larger error of each tile.
  void Raise(const TileErrors& other);
};

/// Small pictures of a scene, and what they say of the tiles of the large one.
class ProbeImages
{
public:
  /// @param scene refers to it, which must stay
  ProbeImages(const RayScene& scene, std::function<FloatImage(const RayScene& probe)> draw);
  /// @param spacing of the probes in pixels, whatever they see
  /// @param around ErrorsOf looks so many tiles around a tile
  ProbeImages(const RayScene& scene, std::function<FloatImage(const RayScene& probe)> draw,
    int spacing, double around);

  /// The first picture may be drawn several times, until enough of its pixels see something; no
  /// other one is drawn twice.
  ProbeImage Draw(const RaySampling& sampling);
  int Count() const { return this->Drawn; }
  /// Whether a pixel of any picture had an opacity.
  bool SawSomething() const { return this->Saw; }

  ProbeErrors Difference(const ProbeImage& a, const ProbeImage& b) const;

  /// Of a tile: the largest error of the pixels within two and a half tiles (or as constructed),
  /// times `factor`, and at least that of all pixels times `share`.
  TileErrors ErrorsOf(const ProbeErrors& errors, double factor, double share) const;

  /// Pixels of the large picture from one probe to the next.
  int PixelsApart() const { return this->Spacing; }
  /// Where the pixels of pictures lie among those of a small picture of all.
  const PixelRect& Part() const { return this->View; }
  /// The picture that was drawn last; there must be one.
  const ProbeImage& Last() const { return this->Known.back().second; }

  glm::ivec2 ImageSize() const { return this->Scene.Camera.ImageSize(); }
  std::size_t TileCount() const;
  /// The worst pixel of a tile may be so many times worse than the worst of its probes.
  static constexpr double Safety() { return 4.0; }

private:
  ProbesAround Around(int tile, int axis) const;
  std::vector<ProbesAround> AroundAll(int tiles, int axis) const;
  void SetSpacing(int pixels);
  ProbeImage DrawAsItIs(const RaySampling& sampling);
  std::vector<float> DepthOf(const RayScene& probe) const;
  glm::ivec2 ToImage(int x, int y) const;

  const RayScene& Scene;
  std::function<FloatImage(const RayScene& probe)> DrawScene;
  int Spacing = 1; ///< pixels of the large picture from one of a small one to the next
  double TilesAround = 2.5;
  bool FixedSpacing = false;
  glm::ivec2 Size;
  PixelRect View; ///< the part that is wanted
  int Drawn = 0;
  std::vector<std::pair<RaySampling, ProbeImage>> Known;
  bool Saw = false;
};

} // namespace banyan

#endif
