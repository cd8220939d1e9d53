// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_FramebufferExchange_h
#define banyan_Rendering_FramebufferExchange_h

#include "Parallel/Composite/ReduceNearest.h"
#include "Render/Scene/RayCamera.h"

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

class vtkOpenGLRenderWindow;
class vtkRenderer;
class vtkWindow;

namespace banyan
{

/// Reads what is drawn so far and writes a finished rectangle of pixels with their depths, to and
/// from whatever framebuffer is bound. Rectangles are relative to the renderer's own viewport,
/// bottom left is (0, 0).
class FramebufferExchange
{
public:
  FramebufferExchange();
  ~FramebufferExchange();

  /// Colours (8 bit) and depths, `[y][x]`, y up. A multisampled framebuffer is resolved first.
  void Read(vtkRenderer* renderer, const PixelRect& rect, OpaquePixels& pixels);

  /// Writes colours and depths of parts of a rectangle; depths always replace what is there.
  /// @param pixels rect.Count() of them, premultiplied
  /// @param parts in `rect`: nothing else is drawn, which is what takes time where OpenGL is
  /// software
  /// @param blend over the colours that are there, as ParaView's compositor does with what several
  ///        ranks have drawn; otherwise replaces them
  void Write(vtkRenderer* renderer, const PixelRect& rect, const OpaquePixels& pixels,
    const std::vector<PixelRect>& parts, bool blend);

  /// Of one window, with its context current; of all of them when it is null.
  void ReleaseGraphicsResources(vtkWindow* window);

private:
  struct Resources;

  void ReadBound(const glm::ivec2& corner, const glm::ivec2& size, OpaquePixels& pixels);
  void ReadResolved(vtkOpenGLRenderWindow* window, int framebuffer, int buffer,
    const glm::ivec2& corner, const glm::ivec2& size, OpaquePixels& pixels);

  std::map<vtkWindow*, std::unique_ptr<Resources>> OfWindow; ///< each has a context of its own
  std::vector<std::uint8_t> Colors; ///< on their way; kept, as pictures come one after the other
  std::vector<float> Depths;
};

} // namespace banyan

#endif
