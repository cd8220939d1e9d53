// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_WallBox_h
#define banyan_Representations_WallBox_h

#include "vtkNew.h"

#include <array>

class vtkActor;
class vtkDataObject;
class vtkMatrix4x4;
class vtkOutlineSource;
class vtkPolyDataMapper;
class vtkRenderer;
class vtkWindow;

namespace banyan
{

/// The box of a volume, in the window of a client whose server shows the volume itself on displays.
class WallBox
{
public:
  WallBox();
  ~WallBox();
  WallBox(const WallBox&) = delete;
  WallBox& operator=(const WallBox&) = delete;

  /// @param corners what the ranks have sent of their pieces (HeldPiece); null, where nothing new
  /// has come, leaves the box as it is
  void Set(vtkDataObject* corners);

  /// In the coordinates of the data; without a volume, none.
  const std::array<double, 6>& Bounds() const { return this->Around; }

  /// Draws the box where the volume is.
  void Render(vtkRenderer* renderer, vtkMatrix4x4* matrix);
  void ReleaseGraphicsResources(vtkWindow* window);

private:
  std::array<double, 6> Around;
  vtkNew<vtkOutlineSource> Lines;
  vtkNew<vtkPolyDataMapper> Mapper;
  vtkNew<vtkActor> Actor;
};

} // namespace banyan

#endif
