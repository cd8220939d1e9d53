// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_SeveralVolumes_h
#define banyan_Testing_SeveralVolumes_h

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"

#include "Render/Scene/RayCamera.h"

#include "vtkActor.h"
#include "vtkCommand.h"
#include "vtkMatrix4x4.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkSphereSource.h"
#include "vtkTestErrorObserver.h"

#include <glm/gtc/matrix_transform.hpp>

#include <limits>
#include <memory>

namespace several_volumes
{

using namespace mapper_testing;
using Picture = std::vector<unsigned char>;

constexpr int Width = 72;
constexpr int Height = 54;

inline glm::dmat4 FromVtk(vtkMatrix4x4* matrix)
{
  glm::dmat4 result;
  for (int i = 0; i < 16; ++i)
  {
    result[i % 4][i / 4] = matrix->GetElement(i / 4, i % 4);
  }
  return result;
}

/// One volume, its box in the world, and what its mapper has said.
struct Shown
{
  Shown(const glm::ivec3& samples, const glm::dvec3& color, double opacity)
    : Image(PlainImage(Balls, samples))
    , High(samples - 1)
  {
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(0.0, color.r, color.g, color.b);
    colors->AddRGBPoint(1.0, color.b, color.r, color.g);
    vtkNew<vtkPiecewiseFunction> opacities;
    opacities->AddPoint(0.0, 0.2 * opacity);
    opacities->AddPoint(1.0, opacity);
    this->Volume->GetProperty()->SetColor(colors);
    this->Volume->GetProperty()->SetScalarOpacity(opacities);
    this->Volume->GetProperty()->SetInterpolationTypeToLinear();
    this->Mapper->SetInputDataObject(this->Image);
    this->Mapper->SetSampleDistanceVoxels(1.0); // takes no probes
    this->Mapper->AddObserver(vtkCommand::WarningEvent, this->Messages);
    this->Mapper->AddObserver(vtkCommand::ErrorEvent, this->Messages);
    this->Mapper->AddObserver(vtkCommand::WarningEvent, this, &Shown::Count);
    this->Volume->SetMapper(this->Mapper);
  }
  void Count(vtkObject*, unsigned long, void*) { ++this->Warnings; }
  void Place(const glm::dmat4& matrix)
  {
    this->ToWorld = matrix;
    vtkNew<vtkMatrix4x4> own;
    for (int i = 0; i < 16; ++i)
    {
      own->SetElement(i / 4, i % 4, matrix[i % 4][i / 4]);
    }
    this->Volume->SetUserMatrix(own);
  }
  /// The farthest that its box reaches in a direction.
  double Reaches(const glm::dvec3& direction) const
  {
    double most = -1e300;
    for (int i = 0; i < 8; ++i)
    {
      const glm::dvec4 corner(
        (i & 1) * this->High.x, (i >> 1 & 1) * this->High.y, (i >> 2) * this->High.z, 1);
      most = std::max(most, glm::dot(direction, glm::dvec3(this->ToWorld * corner)));
    }
    return most;
  }
  /// Where a ray enters its box; infinite if it does not.
  double Enters(const banyan::Ray& ray) const
  {
    const glm::dmat4 inverse = glm::inverse(this->ToWorld);
    const glm::dvec3 origin(inverse * glm::dvec4(ray.Origin, 1.0));
    const glm::dvec3 step(inverse * glm::dvec4(ray.Direction, 0.0));
    double enters = -1e300;
    double leaves = 1e300;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = -origin[axis] / step[axis];
      const double b = (this->High[axis] - origin[axis]) / step[axis];
      enters = std::max(enters, std::min(a, b));
      leaves = std::min(leaves, std::max(a, b));
    }
    return enters < leaves ? enters : std::numeric_limits<double>::infinity();
  }

  vtkSmartPointer<vtkImageData> Image;
  glm::dvec3 High;
  glm::dmat4 ToWorld{ 1.0 };
  int Warnings = 0;
  vtkNew<vtkTest::ErrorObserver> Messages;
  vtkNew<vtkBanyanVolumeMapper> Mapper;
  vtkNew<vtkVolume> Volume;
};

/// To make one takes longer than to draw a picture.
inline vtkRenderWindow* TheWindow()
{
  static const auto window = []
  {
    auto made = vtkSmartPointer<vtkRenderWindow>::New();
    made->SetMultiSamples(0);
    made->SetSize(Width, Height);
    return made;
  }();
  return window;
}

/// Volumes and spheres that have one colour, in the window.
class Scene
{
public:
  Scene()
  {
    this->Window->AddRenderer(this->Renderer);
    this->Renderer->SetBackground(0.1, 0.2, 0.3);
    this->Renderer->SetBackground2(0.9, 0.7, 0.4);
    this->Renderer->GradientBackgroundOn();
  }
  ~Scene() { this->Window->RemoveRenderer(this->Renderer); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Shown& Add(const glm::ivec3& samples, const glm::dvec3& color, double opacity)
  {
    this->Volumes.push_back(std::make_unique<Shown>(samples, color, opacity));
    this->Renderer->AddVolume(this->Volumes.back()->Volume);
    return *this->Volumes.back();
  }
  vtkActor* AddActor(vtkAlgorithmOutput* shape, double opacity)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(shape);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetColor(0.9, 0.9, 0.2);
    actor->GetProperty()->SetOpacity(opacity);
    this->Renderer->AddActor(actor);
    this->Actors.push_back(actor.GetPointer());
    return actor;
  }
  void AddSphere(const glm::dvec3& center, double radius)
  {
    vtkNew<vtkSphereSource> sphere;
    sphere->SetCenter(center.x, center.y, center.z);
    sphere->SetRadius(radius);
    this->AddActor(sphere->GetOutputPort(), 1.0);
  }
  void Look(const glm::dvec3& from, const glm::dvec3& at, bool parallel)
  {
    vtkCamera* const camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(from.x, from.y, from.z);
    camera->SetFocalPoint(at.x, at.y, at.z);
    camera->SetViewUp(0.1, 1.0, 0.2);
    camera->SetParallelProjection(parallel);
    camera->SetParallelScale(6.0);
    camera->SetClippingRange(0.01, 60.0);
  }
  Picture Draw()
  {
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Width - 1, Height - 1, 0, pixels);
    return { pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues() };
  }
  /// Only one of the volumes, and all else in one grey.
  Picture DrawAlone(std::size_t volume, double grey)
  {
    double before[6];
    this->Renderer->GetBackground(before);
    for (const auto& actor : this->Actors)
    {
      actor->GetProperty()->SetColor(grey, grey, grey);
    }
    this->Show(static_cast<int>(volume));
    this->Renderer->GradientBackgroundOff();
    this->Renderer->SetBackground(grey, grey, grey);
    const Picture picture = this->Draw();
    this->Renderer->SetBackground(before);
    this->Renderer->GradientBackgroundOn();
    for (const auto& actor : this->Actors)
    {
      actor->GetProperty()->SetColor(0.9, 0.9, 0.2);
    }
    return picture;
  }
  /// One volume; -1 for all, -2 for none.
  void Show(int which)
  {
    for (std::size_t i = 0; i < this->Volumes.size(); ++i)
    {
      this->Volumes[i]->Volume->SetVisibility(which == -1 || which == static_cast<int>(i));
    }
  }
  banyan::RayCamera Camera()
  {
    return banyan::RayCamera(
      FromVtk(this->Renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
        double{ Width } / Height, -1, 1)),
      { Width, Height }, glm::dvec3(0.0));
  }

  vtkNew<vtkRenderer> Renderer;
  vtkRenderWindow* const Window = TheWindow();
  std::vector<std::unique_ptr<Shown>> Volumes;
  std::vector<vtkSmartPointer<vtkActor>> Actors;
};

} // namespace several_volumes

#endif
