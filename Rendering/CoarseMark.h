// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_CoarseMark_h
#define banyan_Rendering_CoarseMark_h

#include "FramebufferExchange.h"

namespace banyan
{

/// A small orange square in the upper right corner of a view, or of a part of it: its picture will
/// become better.
class CoarseMark
{
public:
  static constexpr int Side = 10;  ///< pixels
  static constexpr int Margin = 6; ///< to the edges

  /// @param bounds the part is the rectangle around these on the screen; null for the whole view
  void Write(vtkRenderer* renderer, const double* bounds = nullptr);

  void ReleaseGraphicsResources(vtkWindow* window)
  {
    this->Framebuffer.ReleaseGraphicsResources(window);
  }

private:
  FramebufferExchange Framebuffer;
};

} // namespace banyan

#endif
