// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_PictureCaster_h
#define banyan_Render_Scene_PictureCaster_h

namespace banyan
{

class PictureWatcher;
struct FloatImage;
struct PixelRect;

/// Casts the rays of those tiles of a picture that are sampled at one level.
class PictureCaster
{
public:
  virtual ~PictureCaster() = default;

  /// Pixels that what can be seen may touch, those of other levels' tiles included.
  virtual const PixelRect& Rect() const = 0;

  /// Draws the tiles of the level, and makes them final: premultiplied colours and opacities.
  /// @param picture its pixels in tiles of the level are set, whatever they were; while they are
  /// drawn, they have the *transmittance* in the fourth component
  /// @param watcher is told of tiles that are final; null for none
  virtual void Draw(FloatImage& picture, PictureWatcher* watcher) = 0;
};

} // namespace banyan

#endif
