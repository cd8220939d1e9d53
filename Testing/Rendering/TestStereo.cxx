// SPDX-License-Identifier: BSD-3-Clause
// Each eye, and each kind of camera, sees a volume where it sees surfaces: a full cube in both
// ways.

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCubeSource.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkSphereSource.h"

#include <cmath>

using namespace mapper_testing;

namespace
{

using Picture = std::vector<unsigned char>;

/// A cube that is opaque and of one colour, as a volume and as a surface.
class Cube : public Stage
{
public:
  explicit Cube(vtkBanyanVolumeMapper* mapper)
    : Stage(mapper)
  {
    mapper->SetInputDataObject(
      PlainImage([](double, double, double, int) { return 1.0f; }, glm::ivec3(9)));
    this->Volume->GetProperty()->GetRGBTransferFunction()->RemoveAllPoints();
    this->Volume->GetProperty()->GetRGBTransferFunction()->AddRGBPoint(0.0, 1.0, 1.0, 1.0);
    this->Volume->GetProperty()->GetScalarOpacity()->AddPoint(1.0, 1.0);
    this->Volume->GetProperty()->SetScalarOpacityUnitDistance(0.01);
    vtkNew<vtkCubeSource> cube;
    cube->SetBounds(0, 8, 0, 8, 0, 8);
    vtkNew<vtkPolyDataMapper> polygons;
    polygons->SetInputConnection(cube->GetOutputPort());
    this->Surface->SetMapper(polygons);
    this->Surface->GetProperty()->LightingOff();
    this->Renderer->AddActor(this->Surface);
    vtkCamera* const camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(20, 17, 30);
    camera->SetFocalPoint(4, 4, -5);
    camera->SetViewUp(0, 1, 0);
    camera->SetEyeAngle(6.0);
    this->Renderer->ResetCameraClippingRange(-2, 10, -2, 10, -2, 10);
  }
  Picture DrawOne(bool asVolume)
  {
    this->Volume->SetVisibility(asVolume);
    this->Surface->SetVisibility(!asVolume);
    return this->Draw();
  }

  vtkNew<vtkActor> Surface;
};

std::size_t Unlike(const Picture& a, const Picture& b)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    count += std::abs(int{ a[i] } - int{ b[i] }) > 60 ? 1 : 0;
  }
  return count;
}

/// But for pixels at its edges, whose rays are short.
void CheckAlike(Cube& cube, const std::string& name)
{
  const Picture volume = cube.DrawOne(true);
  const Picture surface = cube.DrawOne(false);
  const std::size_t unlike = Unlike(volume, surface);
  Check(Covered(surface) > 5000, name + " shows a cube");
  Check(unlike * 100 < Covered(surface), name + ": " + std::to_string(unlike) + " colours differ");
}

void EachKindOfStereo()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  Cube cube(mapper);
  const Picture middle = cube.DrawOne(true);
  cube.Window->StereoRenderOn();
  for (const int type : { VTK_STEREO_RED_BLUE, VTK_STEREO_INTERLACED, VTK_STEREO_LEFT,
         VTK_STEREO_RIGHT, VTK_STEREO_DRESDEN, VTK_STEREO_ANAGLYPH, VTK_STEREO_CHECKERBOARD,
         VTK_STEREO_SPLITVIEWPORT_HORIZONTAL, VTK_STEREO_EMULATE })
  {
    cube.Window->SetStereoType(type);
    cube.Renderer->GetActiveCamera()->Modified(); // VTK forgets that stereo is on
    CheckAlike(cube, std::string("stereo ") + vtkRenderWindow::GetStereoTypeAsString(type));
    const Picture drawn = cube.DrawOne(true);
    Check(Difference(drawn, middle) > 60, "which is not that without stereo");
    for (int again = 0; again < 2; ++again)
    {
      Check(Difference(cube.DrawOne(true), drawn) <= 1, "and the next one is as this one");
    }
  }
  cube.Window->SetStereoTypeToLeft();
  const Picture left = cube.DrawOne(true);
  cube.Window->SetStereoTypeToRight();
  Check(Unlike(left, cube.DrawOne(true)) > 500, "eyes see the cube in two places");
}

void EachKindOfCamera()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  Cube cube(mapper);
  vtkCamera* const camera = cube.Renderer->GetActiveCamera();
  CheckAlike(cube, "a plain camera");
  camera->SetWindowCenter(0.2, -0.3);
  CheckAlike(cube, "a window aside");
  camera->SetWindowCenter(0, 0);
  camera->SetViewShear(0.1, 0.2, 1.0);
  CheckAlike(cube, "shear");
  camera->ParallelProjectionOn();
  camera->SetParallelScale(8);
  CheckAlike(cube, "parallel shear");
  cube.Window->StereoRenderOn();
  cube.Window->SetStereoTypeToRight();
  CheckAlike(cube, "parallel stereo");
  camera->ParallelProjectionOff();
  camera->SetViewShear(0, 0, 1);
  camera->UseOffAxisProjectionOn();
  camera->SetScreenBottomLeft(-8, -6, 4);
  camera->SetScreenBottomRight(16, -6, 4);
  camera->SetScreenTopRight(16, 12, 4);
  camera->SetEyeSeparation(3.0);
  double eye[3] = { 8, 6.3, 40 }; // edges not in the middle of pixels
  camera->SetEyePosition(eye);
  camera->SetClippingRange(10, 60);
  for (const int type : { VTK_STEREO_LEFT, VTK_STEREO_RIGHT })
  {
    cube.Window->SetStereoType(type);
    CheckAlike(cube, "off axis, as walls do");
  }
  cube.Window->StereoRenderOff();
  CheckAlike(cube, "off axis without stereo");
}

/// Column in the middle of what is not background.
double MiddleColumn(const Picture& picture, int width)
{
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < picture.size(); i += 3)
  {
    if (std::abs(int{ picture[i] } - int{ picture[0] }) > 60)
    {
      sum += static_cast<double>(i / 3 % static_cast<std::size_t>(width));
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : -1.0;
}

/// A cube's outline says nothing of rays that begin between the eyes: they enter at the right place
/// and go on in a wrong direction. A ball within the volume must stand where its surface does.
void WhatLiesInside()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  Cube cube(mapper);
  mapper->SetInputDataObject(PlainImage([](double x, double y, double z, int)
    { return std::hypot(x - 0.5, y - 0.5, z - 0.5) < 0.2 ? 1.0f : 0.0f; },
    glm::ivec3(65)));
  cube.Volume->SetScale(8.0 / 64);
  vtkPiecewiseFunction* const opacity = cube.Volume->GetProperty()->GetScalarOpacity();
  opacity->RemoveAllPoints();
  opacity->AddPoint(0.45, 0.0);
  opacity->AddPoint(0.55, 1.0);
  vtkNew<vtkSphereSource> ball;
  ball->SetCenter(4, 4, 4);
  ball->SetRadius(1.6);
  ball->SetThetaResolution(64);
  ball->SetPhiResolution(64);
  vtkNew<vtkPolyDataMapper> polygons;
  polygons->SetInputConnection(ball->GetOutputPort());
  cube.Surface->SetMapper(polygons);
  cube.Window->StereoRenderOn();
  const int width = cube.Window->GetSize()[0];
  double columns[2] = { 0.0, 0.0 };
  for (const bool right : { false, true })
  {
    cube.Window->SetStereoType(right ? VTK_STEREO_RIGHT : VTK_STEREO_LEFT);
    cube.Renderer->GetActiveCamera()->Modified(); // VTK forgets that stereo is on
    const double volume = MiddleColumn(cube.DrawOne(true), width);
    const double surface = MiddleColumn(cube.DrawOne(false), width);
    Check(std::abs(volume - surface) < 0.5, "a ball inside is at column " + std::to_string(volume) +
                                              ", its surface at " + std::to_string(surface));
    columns[right ? 1 : 0] = volume;
  }
  Check(std::abs(columns[0] - columns[1]) > 2.0, "and the eyes see it in two places");
}

} // namespace

int main()
{
  EachKindOfStereo();
  EachKindOfCamera();
  WhatLiesInside();
  return Failures();
}
