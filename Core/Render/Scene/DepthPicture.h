// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_DepthPicture_h
#define banyan_Render_Scene_DepthPicture_h

#include "Render/Scene/RayCamera.h"

#include <vector>

namespace banyan
{

/// At which depth something opaque is, in a part of a picture. Elsewhere nothing is.
struct DepthPicture
{
  glm::ivec2 Size{ 0 };      ///< of the whole picture
  PixelRect Rect;            ///< in it
  std::vector<float> Depths; ///< in [0, 1], `[y][x]`, y up; Rect.Count() of them; 1 for nothing

  /// The depths of a part of the picture, as RayScene takes them; empty where nothing is.
  std::vector<float> In(const PixelRect& part) const;

  /// The same without edges in which nothing is.
  DepthPicture Trimmed() const;

  /// The depths of a smaller picture: each pixel has that of one in its middle.
  /// @param every so many columns and rows become one, as in CoarserSize
  DepthPicture Coarser(int every) const;
};

/// What is nearest in several parts of one picture, in the rectangle around them; the whole
/// picture's size is that of the first one.
DepthPicture NearestOf(const std::vector<DepthPicture>& parts);

/// The size of a picture with a pixel for so many columns and rows, or for the part of them that is
/// left at the end.
glm::ivec2 CoarserSize(const glm::ivec2& size, int every);

} // namespace banyan

#endif
