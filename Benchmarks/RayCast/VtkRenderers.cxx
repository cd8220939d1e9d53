// SPDX-License-Identifier: BSD-3-Clause
#include "RayCastRenderer.h"
#include "VtkScene.h"

#include <vtkCamera.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkFloatArray.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkMath.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <cmath>
#include <cstdlib>

namespace banyan::bench
{
namespace
{

/// The scene's values as VTK's image, without a copy.
vtkSmartPointer<vtkImageData> ImageOf(const Volume& volume)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(volume.Samples.x, volume.Samples.y, volume.Samples.z);
  image->SetSpacing(volume.Spacing.x, volume.Spacing.y, volume.Spacing.z);
  const auto count = static_cast<vtkIdType>(volume.Floats.size() + volume.Codes.size());
  constexpr int keep = 1; // the memory is not VTK's
  if (volume.Codes.empty())
  {
    vtkNew<vtkFloatArray> array;
    array->SetArray(const_cast<float*>(volume.Floats.data()), count, keep);
    image->GetPointData()->SetScalars(array);
  }
  else
  {
    vtkNew<vtkUnsignedCharArray> array;
    array->SetArray(const_cast<std::uint8_t*>(volume.Codes.data()), count, keep);
    image->GetPointData()->SetScalars(array);
  }
  return image;
}

/// A mapper of VTK in a window of its own. Every setting has a mapper of its own, so that none has
/// to do again what another one's setting has undone.
class VtkRenderer : public RayCastRenderer
{
public:
  void Prepare(const BenchScene& scene, const std::vector<Setting>& settings) override
  {
    this->Scene = &scene;
    this->Open();
    this->Renderer->RemoveAllViewProps();
    this->Volumes.clear();
    this->Drawn.assign(settings.size(), false);
    const vtkSmartPointer<vtkImageData> image = ImageOf(*scene.Data);
    for (const Setting& setting : settings)
    {
      auto volume = vtkSmartPointer<vtkVolume>::New();
      volume->SetMapper(
        this->MapperWith(image, setting.SampleDistance.value() * scene.Data->VoxelLength()));
      volume->SetProperty(PropertyOf(scene));
      this->Volumes.push_back(volume);
    }
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(scene.Eye.x, scene.Eye.y, scene.Eye.z);
    camera->SetFocalPoint(scene.Center.x, scene.Center.y, scene.Center.z);
    camera->SetViewUp(scene.Up.x, scene.Up.y, scene.Up.z);
    camera->SetViewAngle(this->ViewAngleDegreesFor(scene));
  }

  Frame Draw(std::size_t number) override
  {
    this->Renderer->RemoveAllViewProps();
    this->Renderer->AddVolume(this->Volumes.at(number));
    this->Renderer->ResetCameraClippingRange();
    Frame frame;
    if (!this->Drawn.at(number))
    {
      this->Drawn[number] = true;
      frame.OnceSeconds = this->DrawTiny();
    }
    const FrameClock clock;
    this->Window->Render();
    this->Window->WaitForCompletion();
    clock.StopInto(frame);
    const int size = this->Scene->Picture;
    vtkNew<vtkUnsignedCharArray> pixels;
    constexpr int back = 0;
    this->Window->GetPixelData(0, 0, size - 1, size - 1, back, pixels);
    frame.Shown.Size = size;
    frame.Shown.Rgb.assign(
      pixels->GetPointer(0), pixels->GetPointer(0) + static_cast<std::size_t>(size) * size * 3);
    return frame;
  }

protected:
  virtual double ViewAngleDegreesFor(const BenchScene& scene) const
  {
    return scene.ViewAngleDegrees;
  }

  /// @param sampleDistance in world units
  virtual vtkSmartPointer<vtkVolumeMapper> MapperWith(
    vtkImageData* image, double sampleDistance) const = 0;

  static std::vector<Setting> SampleDistances(std::initializer_list<double> distances)
  {
    std::vector<Setting> settings;
    for (const double distance : distances)
    {
      settings.push_back({ {}, distance });
    }
    return settings;
  }

private:
  /// Uploads and compiles all that the next frame needs, which takes next to nothing itself.
  double DrawTiny()
  {
    const Timer timer;
    this->Window->SetSize(8, 8);
    this->Window->Render();
    this->Window->WaitForCompletion();
    this->Window->SetSize(this->Scene->Picture, this->Scene->Picture);
    return timer.Seconds();
  }

  void Open()
  {
    if (!this->Window)
    {
      this->Renderer = vtkSmartPointer<vtkRenderer>::New();
      this->Window = vtkSmartPointer<vtkRenderWindow>::New();
      this->Window->SetMultiSamples(0);
      this->Window->OffScreenRenderingOn();
      this->Window->SwapBuffersOff();
      this->Window->AddRenderer(this->Renderer);
      // Shaded with the light at the camera, on both sides of a surface.
      this->Renderer->TwoSidedLightingOn();
    }
    this->Window->SetSize(this->Scene->Picture, this->Scene->Picture);
  }

  const BenchScene* Scene = nullptr;
  vtkSmartPointer<vtkRenderer> Renderer;
  vtkSmartPointer<vtkRenderWindow> Window;
  std::vector<vtkSmartPointer<vtkVolume>> Volumes; ///< one per setting
  std::vector<bool> Drawn;                         ///< whether a setting was, before
};

class VtkGpuRenderer : public VtkRenderer
{
public:
  std::string Name() const override { return "vtk-gpu"; }
  std::vector<Setting> SettingsFor(const BenchScene&) const override
  {
    return SampleDistances({ 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0 });
  }

protected:
  vtkSmartPointer<vtkVolumeMapper> MapperWith(
    vtkImageData* image, double sampleDistance) const override
  {
    auto mapper = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
    mapper->SetInputData(image);
    mapper->SetBlendModeToComposite();
    mapper->AutoAdjustSampleDistancesOff();
    mapper->LockSampleDistanceToInputSpacingOff();
    mapper->UseJitteringOff();
    mapper->SetImageSampleDistance(1.0f);
    mapper->SetSampleDistance(static_cast<float>(sampleDistance));
    return mapper;
  }
};

class VtkFixedPointRenderer : public VtkRenderer
{
public:
  explicit VtkFixedPointRenderer(int threads)
    : Threads(threads)
  {
  }

  std::string Name() const override { return "vtk-fixed-point"; }
  /// Its shading is another one, far from all others' pictures.
  std::vector<Setting> SettingsFor(const BenchScene& scene) const override
  {
    if (scene.Shaded)
    {
      return {};
    }
    return SampleDistances({ 0.5, 1.0, 2.0, 4.0 });
  }

protected:
  /// This mapper draws everything larger, by one pixel over the width of the picture. With an angle
  /// that is wider by as much its picture agrees with the others', and its error is the smallest.
  double ViewAngleDegreesFor(const BenchScene& scene) const override
  {
    const double half = 0.5 * vtkMath::RadiansFromDegrees(scene.ViewAngleDegrees);
    const double wider = std::tan(half) * (scene.Picture + 1.0) / scene.Picture;
    return 2.0 * vtkMath::DegreesFromRadians(std::atan(wider));
  }

  vtkSmartPointer<vtkVolumeMapper> MapperWith(
    vtkImageData* image, double sampleDistance) const override
  {
    auto mapper = vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::New();
    mapper->SetInputData(image);
    mapper->SetBlendModeToComposite();
    mapper->AutoAdjustSampleDistancesOff();
    mapper->LockSampleDistanceToInputSpacingOff();
    mapper->SetImageSampleDistance(1.0f);
    mapper->SetSampleDistance(static_cast<float>(sampleDistance));
    mapper->SetInteractiveSampleDistance(static_cast<float>(sampleDistance));
    mapper->SetNumberOfThreads(this->Threads);
    return mapper;
  }

private:
  int Threads;
};

} // namespace

RendererList MakeVtkRenderers(int threads, std::vector<std::string>&)
{
  // How many threads Mesa's software rasteriser takes; without it the graphics card decides.
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  RendererList renderers;
  renderers.push_back(std::make_unique<VtkGpuRenderer>());
  renderers.push_back(std::make_unique<VtkFixedPointRenderer>(threads));
  return renderers;
}

} // namespace banyan::bench
