// SPDX-License-Identifier: BSD-3-Clause
#include "HexMeshRenderer.h"
#include "VtkGridOfMesh.h"
#include "VtkScene.h"

#include "Base/Timer.h"

#include <vtkCamera.h>
#include <vtkDataSetTriangleFilter.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkProjectedTetrahedraMapper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkResampleToImage.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridVolumeRayCastMapper.h>
#include <vtkUnstructuredGridVolumeZSweepMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace banyan::bench
{
namespace
{

/// What a mapper takes the numbers of a scalar opacity function for.
enum class OpacityMeans
{
  Opacity,    ///< after the unit distance: mappers of images
  Attenuation ///< per unit distance, the a of 1 - exp(-a): mappers of unstructured grids
};

/// As nodes have opacities, or as attenuations of which the strongest is 1: projected tetrahedra
/// keep them in 8 bits, cut off. Of those of S1 per voxel, 0.001 to 0.02, five would be left.
vtkSmartPointer<vtkVolumeProperty> PropertyOf(const BenchScene& scene, OpacityMeans means)
{
  auto property = bench::PropertyOf(scene);
  if (means == OpacityMeans::Opacity)
  {
    return property;
  }
  double strongest = 0.0;
  for (const glm::dvec4& node : scene.Nodes)
  {
    strongest = std::max(strongest, -std::log1p(-node.a));
  }
  vtkNew<vtkPiecewiseFunction> attenuations;
  for (std::size_t i = 0; i < scene.Nodes.size(); ++i)
  {
    const double part = static_cast<double>(i) / static_cast<double>(scene.Nodes.size() - 1);
    attenuations->AddPoint(
      scene.Low + part * (scene.High - scene.Low), -std::log1p(-scene.Nodes[i].a) / strongest);
  }
  property->SetScalarOpacity(attenuations);
  property->SetScalarOpacityUnitDistance(scene.UnitDistance / strongest);
  return property;
}

vtkSmartPointer<vtkUnstructuredGrid> InTetrahedra(vtkUnstructuredGrid* grid)
{
  vtkNew<vtkDataSetTriangleFilter> filter;
  filter->SetInputData(grid);
  filter->TetrahedraOnlyOn();
  filter->Update();
  return filter->GetOutput();
}

vtkSmartPointer<vtkAbstractVolumeMapper> ProjectedTetrahedra(vtkUnstructuredGrid* grid, int)
{
  auto mapper = vtkSmartPointer<vtkProjectedTetrahedraMapper>::New();
  mapper->SetInputData(InTetrahedra(grid));
  return mapper;
}

vtkSmartPointer<vtkAbstractVolumeMapper> RayCast(vtkUnstructuredGrid* grid, int threads)
{
  auto mapper = vtkSmartPointer<vtkUnstructuredGridVolumeRayCastMapper>::New();
  mapper->SetInputData(InTetrahedra(grid));
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetImageSampleDistance(1.0f);
  mapper->SetNumberOfThreads(threads);
  return mapper;
}

/// Takes hexahedra as they are.
vtkSmartPointer<vtkAbstractVolumeMapper> ZSweep(vtkUnstructuredGrid* grid, int)
{
  auto mapper = vtkSmartPointer<vtkUnstructuredGridVolumeZSweepMapper>::New();
  mapper->SetInputData(grid);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetImageSampleDistance(1.0f);
  return mapper;
}

/// As many samples along each axis, a sample per edge of the image's cells along rays.
template <int Samples>
vtkSmartPointer<vtkAbstractVolumeMapper> AsImage(vtkUnstructuredGrid* grid, int)
{
  vtkNew<vtkResampleToImage> filter;
  filter->SetInputDataObject(grid);
  filter->SetSamplingDimensions(Samples, Samples, Samples);
  filter->Update();
  vtkImageData* const image = filter->GetOutput();
  image->GetPointData()->SetActiveScalars("value");
  auto mapper = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
  mapper->SetInputData(image);
  mapper->SetBlendModeToComposite();
  mapper->AutoAdjustSampleDistancesOff();
  mapper->LockSampleDistanceToInputSpacingOff();
  mapper->UseJitteringOff();
  mapper->SetImageSampleDistance(1.0f);
  mapper->SetSampleDistance(static_cast<float>(image->GetSpacing()[0]));
  return mapper;
}

struct Way
{
  const char* Name;
  vtkSmartPointer<vtkAbstractVolumeMapper> (*MapperOf)(vtkUnstructuredGrid*, int threads);
  OpacityMeans Means;
};

constexpr Way Ways[] = { { "vtk-projected-tetrahedra", ProjectedTetrahedra,
                           OpacityMeans::Attenuation },
  { "vtk-ray-cast", RayCast, OpacityMeans::Attenuation },
  { "vtk-z-sweep", ZSweep, OpacityMeans::Attenuation },
  { "vtk-image-128", AsImage<128>, OpacityMeans::Opacity },
  { "vtk-image-256", AsImage<256>, OpacityMeans::Opacity } };

class VtkHexMeshRenderer : public HexMeshRenderer
{
public:
  VtkHexMeshRenderer(const Way& way, const HexMeshScene& scene, int threads)
    : How(way)
    , Scene(scene)
    , Threads(threads)
  {
  }

  void Open() override
  {
    this->Grid = VtkGridOf(this->Scene.Mesh);
    const BenchScene& look = this->Scene.Look;
    this->Window->SetMultiSamples(0);
    this->Window->OffScreenRenderingOn();
    this->Window->SwapBuffersOff();
    this->Window->SetSize(look.Picture, look.Picture);
    this->Window->AddRenderer(this->Renderer);
    vtkCamera* const camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(look.Eye.x, look.Eye.y, look.Eye.z);
    camera->SetFocalPoint(look.Center.x, look.Center.y, look.Center.z);
    camera->SetViewUp(look.Up.x, look.Up.y, look.Up.z);
    camera->SetViewAngle(look.ViewAngleDegrees);
    this->Window->Render();
    this->Window->WaitForCompletion();
  }

  HexMeshFrame Draw() override
  {
    HexMeshFrame frame;
    const Timer timer;
    if (!this->Volume)
    {
      this->Volume = vtkSmartPointer<vtkVolume>::New();
      this->Volume->SetMapper(this->How.MapperOf(this->Grid, this->Threads));
      this->Volume->SetProperty(PropertyOf(this->Scene.Look, this->How.Means));
      this->Renderer->AddVolume(this->Volume);
      this->Renderer->ResetCameraClippingRange();
    }
    this->Window->Render();
    this->Window->WaitForCompletion();
    frame.Seconds = timer.Seconds();
    const int size = this->Scene.Look.Picture;
    vtkNew<vtkUnsignedCharArray> pixels;
    constexpr int back = 0;
    this->Window->GetPixelData(0, 0, size - 1, size - 1, back, pixels);
    frame.Shown.Size = size;
    frame.Shown.Rgb.assign(
      pixels->GetPointer(0), pixels->GetPointer(0) + static_cast<std::size_t>(size) * size * 3);
    return frame;
  }

private:
  const Way& How;
  const HexMeshScene& Scene;
  int Threads;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkNew<vtkRenderWindow> Window;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkVolume> Volume;
};

} // namespace

std::unique_ptr<HexMeshRenderer> MakeVtkHexMeshRenderer(
  const std::string& name, const HexMeshScene& scene, int threads)
{
  for (const Way& way : Ways)
  {
    if (name == way.Name)
    {
      // How many threads Mesa's software rasteriser takes; without it the graphics card decides.
      setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
      return std::make_unique<VtkHexMeshRenderer>(way, scene, threads);
    }
  }
  return nullptr;
}

std::vector<std::string> VtkHexMeshRenderers()
{
  std::vector<std::string> names;
  for (const Way& way : Ways)
  {
    names.emplace_back(way.Name);
  }
  return names;
}

} // namespace banyan::bench
