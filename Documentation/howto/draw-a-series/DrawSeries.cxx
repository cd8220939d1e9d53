// SPDX-License-Identifier: BSD-3-Clause
// Writes a time series, reads it back and draws it, with VTK alone: no ParaView at run time.
//
//   DrawSeries SERIES.banyan PICTURE.png
//
// The series is heat that spreads from two points, by the exact solution of the heat equation.
// Given VTK's test options (-V BASELINE.png -T FOLDER) it compares the picture with a baseline.

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkFloatArray.h"
#include "vtkImageAlgorithm.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPNGWriter.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRegressionTestImage.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSphereSource.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"
#include "vtkWindowToImageFilter.h"

#include <cmath>
#include <cstring>
#include <iostream>
#include <vector>

namespace
{

constexpr int Size = 64;  // samples per axis
constexpr int Steps = 10; // times 0, 1, ...

/// Any vtkImageAlgorithm with time steps can be written; this one computes its data.
class HeatSource : public vtkImageAlgorithm
{
public:
  static HeatSource* New();
  vtkTypeMacro(HeatSource, vtkImageAlgorithm);

protected:
  HeatSource() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const int extent[6] = { 0, Size - 1, 0, Size - 1, 0, Size - 1 };
    info->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
    std::vector<double> times(Steps);
    for (int step = 0; step < Steps; ++step)
    {
      times[static_cast<std::size_t>(step)] = step;
    }
    const double range[2] = { 0.0, Steps - 1.0 };
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), times.data(), Steps);
    info->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range, 2);
    return 1;
  }

  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double time = info->Has(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP())
                          ? info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP())
                          : 0.0;
    vtkImageData* image = vtkImageData::GetData(info);
    image->SetExtent(info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()));
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    vtkNew<vtkFloatArray> heat;
    heat->SetName("temperature");
    heat->SetNumberOfTuples(image->GetNumberOfPoints());
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      double p[3];
      image->GetPoint(i, p);
      heat->SetValue(i, Heat(p, 22.0, 20.0, time) + Heat(p, 40.0, 44.0, time));
    }
    image->GetPointData()->SetScalars(heat);
    return 1;
  }

private:
  /// What an instant source of width 5 at (x, 32, z) has become after some time.
  static float Heat(const double p[3], double x, double z, double time)
  {
    const double width = 25.0 + 20.0 * time;
    const double squared =
      (p[0] - x) * (p[0] - x) + (p[1] - 32.0) * (p[1] - 32.0) + (p[2] - z) * (p[2] - z);
    return static_cast<float>(std::pow(25.0 / width, 1.5) * std::exp(-squared / width));
  }
};
vtkStandardNewMacro(HeatSource);

bool WriteSeries(const char* path)
{
  vtkNew<HeatSource> source;
  vtkNew<vtkBanyanSeriesWriter> writer;
  writer->SetInputConnection(source->GetOutputPort());
  writer->SetFileName(path);
  writer->SetErrorBound(1.0 / 512.0); // of the range of the whole series
  return writer->Write() == 1;
}

/// Colours and opacities over the values; opacity is per unit of length.
vtkSmartPointer<vtkVolume> MakeVolume(vtkAbstractVolumeMapper* mapper)
{
  vtkNew<vtkColorTransferFunction> colors;
  colors->AddRGBPoint(0.0, 0.1, 0.1, 0.6);
  colors->AddRGBPoint(0.06, 0.7, 0.2, 0.4);
  colors->AddRGBPoint(0.15, 1.0, 0.6, 0.2);
  colors->AddRGBPoint(0.25, 1.0, 1.0, 0.8);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(0.004, 0.0);
  opacity->AddPoint(0.25, 0.3);
  auto volume = vtkSmartPointer<vtkVolume>::New();
  volume->SetMapper(mapper);
  volume->GetProperty()->SetColor(colors);
  volume->GetProperty()->SetScalarOpacity(opacity);
  volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
  volume->GetProperty()->SetInterpolationTypeToLinear();
  return volume;
}

/// Opaque geometry is drawn as usual; the volume knows where it lies.
vtkSmartPointer<vtkActor> MakeBall()
{
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(24.0, 34.0, 34.0);
  sphere->SetRadius(5.0);
  sphere->SetThetaResolution(48);
  sphere->SetPhiResolution(48);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(sphere->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.3, 0.8, 0.4);
  return actor;
}

void SavePicture(vtkRenderWindow* window, const char* path)
{
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window);
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> png;
  png->SetFileName(path);
  png->SetInputConnection(image->GetOutputPort());
  png->Write();
}

} // namespace

int main(int argc, char* argv[])
{
  if (argc < 3 || !WriteSeries(argv[1]))
  {
    std::cerr << "usage: DrawSeries SERIES.banyan PICTURE.png\n";
    return EXIT_FAILURE;
  }

  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(argv[1]);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputConnection(reader->GetOutputPort());

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0.15, 0.16, 0.2);
  renderer->AddVolume(MakeVolume(mapper));
  renderer->AddActor(MakeBall());
  vtkNew<vtkRenderWindow> window;
  window->SetSize(400, 300);
  window->AddRenderer(renderer);

  // The step is chosen as for any reader; the volume decodes only bricks that can be seen.
  reader->UpdateTimeStep(2.0);
  renderer->ResetCamera();
  renderer->GetActiveCamera()->Azimuth(30.0);
  renderer->GetActiveCamera()->Elevation(25.0);
  renderer->GetActiveCamera()->Zoom(1.8);
  renderer->ResetCameraClippingRange();
  window->Render();
  SavePicture(window, argv[2]);

  vtkBanyanFrameStatistics* frame = mapper->GetStatistics();
  std::cout << frame->GetBricksDrawn() << " bricks drawn, " << frame->GetBricksSkipped()
            << " skipped, " << frame->GetSamplesTaken() << " samples in "
            << 1000.0 * frame->GetTotalSeconds() << " ms\n";

  for (int i = 3; i < argc; ++i)
  {
    if (std::strcmp(argv[i], "-V") == 0)
    {
      return vtkRegressionTestImage(window) == vtkTesting::FAILED ? EXIT_FAILURE : EXIT_SUCCESS;
    }
  }
  return frame->GetBricksDrawn() > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
