// SPDX-License-Identifier: BSD-3-Clause
#include "WallBox.h"

#include "vtkActor.h"
#include "vtkMath.h"
#include "vtkOutlineSource.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"

namespace banyan
{

WallBox::WallBox()
{
  vtkMath::UninitializeBounds(this->Around.data());
  this->Mapper->SetInputConnection(this->Lines->GetOutputPort());
  this->Actor->SetMapper(this->Mapper);
  this->Actor->GetProperty()->LightingOff();
}

WallBox::~WallBox() = default;

void WallBox::Set(vtkDataObject* corners)
{
  if (!corners)
  {
    return;
  }
  vtkMath::UninitializeBounds(this->Around.data());
  auto* const points = vtkPolyData::SafeDownCast(corners);
  if (points && points->GetNumberOfPoints() > 0)
  {
    points->GetBounds(this->Around.data());
    this->Lines->SetBounds(this->Around.data());
  }
}

void WallBox::Render(vtkRenderer* renderer, vtkMatrix4x4* matrix)
{
  if (!vtkMath::AreBoundsInitialized(this->Around.data()))
  {
    return;
  }
  // Seen before any background.
  const double* const behind = renderer->GetBackground();
  const double line = behind[0] + behind[1] + behind[2] > 1.5 ? 0.0 : 1.0;
  this->Actor->GetProperty()->SetColor(line, line, line);
  this->Actor->SetUserMatrix(matrix);
  this->Actor->RenderOpaqueGeometry(renderer);
}

void WallBox::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Actor->ReleaseGraphicsResources(window);
}

} // namespace banyan
