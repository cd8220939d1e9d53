// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_SubsamplingProbe_h
#define banyan_Render_Sampling_SubsamplingProbe_h

#include "Render/Sampling/ProbeImages.h"

#include <optional>
#include <vector>

namespace banyan
{

/// What pixels without rays would be off, for each RaySampling::PixelStride: found from one small
/// picture, whose pixels are every fourth one of the large one. Those of its pixels that every
/// second or every fourth of it does not hold are compared with what lies between these
/// (InterpolateSkippedPixels), so that a stride of 8 is measured, and how errors grow from 8 to 16
/// tells those of 4 and 2: as the square of the stride where the picture is smooth, and not at all
/// at edges. Where much is allowed, its pixels are every eighth one, and strides of 16 and 32 tell.
class SubsamplingProbe
{
public:
  /// @param scene refers to it, which must stay
  /// @param allowed errors of the picture, in 1/255
  SubsamplingProbe(
    const RayScene& scene, std::function<FloatImage(const RayScene& probe)> draw, double allowed);

  /// Whether a scene is one of which pixels may be left out: its volume is not narrow.
  /// @param pixelsApart probes of it that tell enough
  static bool MaySay(const RayScene& scene, int pixelsApart);

  /// Whether it may be worth its time, which is that of an eighth of the picture and more: whether
  /// any tile may be content with every second pixel. No tile is taken to be much better than the
  /// worst one, and how much that one is off between pixels is told by pictures of samples: by what
  /// lies between theirs, and how fast it falls as they come closer.
  /// @param samples of which some were drawn
  /// @param allowed in 1/255
  static bool MayPay(const ProbeImages& samples, double allowed);

  /// Draws it. Once.
  void Draw(const RaySampling& sampling);

  /// What tiles are expected to be off, in 1/255, by leaving pixels out; infinite in tiles that
  /// need all of their rays: those with geometry, and at the edges of what is drawn.
  /// @param stride 2, 4 or 8
  TileErrors ErrorsAt(int stride) const;

private:
  std::vector<bool> MakeWholeTiles() const;
  bool HasGeometry(const PixelRect& pixels) const;

  const RayScene& Scene;
  ProbeImages Pictures;
  TileErrors Near;         ///< measured: of a stride of two probes
  TileErrors Far;          ///< of four
  std::vector<bool> Whole; ///< per tile, whether pixels of it may be left out
};

} // namespace banyan

#endif
