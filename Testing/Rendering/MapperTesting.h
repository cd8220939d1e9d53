// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_MapperTesting_h
#define banyan_Testing_MapperTesting_h

#include "Base/ThreadPool.h"
#include "Series/Encode/SeriesEncoder.h"

#include "vtkCamera.h"
#include "vtkCollection.h"
#include "vtkColorTransferFunction.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPiecewiseFunction.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include <stdlib.h>

namespace mapper_testing
{

/// Failed checks so far; main returns it.
inline int& Failures()
{
  static int failures = 0;
  return failures;
}

inline void Check(bool holds, const std::string& what)
{
  if (!holds)
  {
    std::cerr << "FAILED: " << what << "\n";
    ++Failures();
  }
}

/// A folder of its own, removed at the end.
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    this->Name = (std::filesystem::temp_directory_path() / "banyan-XXXXXX").string();
    if (mkdtemp(this->Name.data()) == nullptr)
    {
      throw std::runtime_error("no temporary folder");
    }
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(this->Name, ignored);
  }
  std::string operator/(const std::string& file) const { return this->Name + "/" + file; }

private:
  std::string Name;
};

using Field = std::function<float(double x, double y, double z, int step)>; ///< over [0, 1]^3

/// Two soft balls in a wave, between 0 and 1.
inline float Balls(double x, double y, double z, int step)
{
  const auto ball = [&](double a, double b, double c)
  { return std::exp(-40.0 * ((x - a) * (x - a) + (y - b) * (y - b) + (z - c) * (z - c))); };
  const double wave = 0.1 + 0.1 * std::sin(20.0 * x + 0.3 * step) * std::sin(15.0 * y);
  return static_cast<float>(
    0.8 * (ball(0.35, 0.4, 0.5 + 0.005 * step) + ball(0.65, 0.6, 0.4)) + wave);
}

/// `[z][y][x]`
inline std::vector<float> Sampled(const Field& field, const glm::ivec3& n, int step)
{
  std::vector<float> values;
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        values.push_back(field(x / std::max(1.0, n.x - 1.0), y / std::max(1.0, n.y - 1.0),
          z / std::max(1.0, n.z - 1.0), step));
      }
    }
  }
  return values;
}

inline void WriteSeries(
  const std::string& path, const Field& field, const glm::ivec3& n, int steps, double absoluteBound)
{
  banyan::Grid grid;
  grid.Extent.Hi = n;
  banyan::EncodeOptions options;
  options.ErrorBound = absoluteBound;
  options.Mode = banyan::ErrorBoundMode::Absolute;
  banyan::SeriesEncoder encoder(path, grid,
    { { "field", banyan::ScalarType::Float32, { "" }, {} } }, options,
    banyan::ThreadPool::Process());
  for (int step = 0; step < steps; ++step)
  {
    const std::vector<float> values = Sampled(field, n, step);
    encoder.AddStep(step, { { values.data() } });
  }
  encoder.Finish();
}

inline vtkSmartPointer<vtkImageData> PlainImage(const Field& field, const glm::ivec3& n)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(n.x, n.y, n.z);
  const std::vector<float> values = Sampled(field, n, 0);
  vtkNew<vtkFloatArray> array;
  array->SetName("field");
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  image->GetPointData()->SetScalars(array);
  return image;
}

/// A window with one volume in it.
class Stage
{
public:
  explicit Stage(vtkAbstractVolumeMapper* mapper, int multiSamples = 0)
  {
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(0.0, 0.1, 0.2, 0.8);
    colors->AddRGBPoint(0.5, 0.9, 0.8, 0.2);
    colors->AddRGBPoint(1.0, 0.9, 0.1, 0.1);
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(0.25, 0.0);
    opacity->AddPoint(1.0, 0.5);
    this->Volume->GetProperty()->SetColor(colors);
    this->Volume->GetProperty()->SetScalarOpacity(opacity);
    this->Volume->GetProperty()->SetInterpolationTypeToLinear();
    this->Volume->SetMapper(mapper);
    this->Renderer->AddVolume(this->Volume);
    this->Renderer->SetBackground(0.1, 0.2, 0.3);
    this->Window->SetMultiSamples(multiSamples);
    this->Window->SetSize(240, 180);
    this->Window->AddRenderer(this->Renderer);
  }

  void LookAt(const double bounds[6])
  {
    this->Renderer->GetActiveCamera()->SetPosition(1.0, 2.0, 4.0);
    this->Renderer->GetActiveCamera()->SetFocalPoint(0.0, 0.0, 0.0);
    this->Renderer->GetActiveCamera()->SetViewUp(0.0, 1.0, 0.0);
    this->Renderer->ResetCamera(bounds);
  }

  /// RGB of each pixel.
  std::vector<unsigned char> Draw()
  {
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    const int* size = this->Window->GetSize();
    this->Window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, pixels);
    return { pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues() };
  }

  vtkNew<vtkVolume> Volume;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
};

/// Largest difference of two pictures, in 1/255; 255 when their sizes differ.
inline int Difference(const std::vector<unsigned char>& a, const std::vector<unsigned char>& b)
{
  int largest = a.size() == b.size() ? 0 : 255;
  for (std::size_t i = 0; i < a.size() && largest < 255; ++i)
  {
    largest = std::max(largest, std::abs(int{ a[i] } - int{ b[i] }));
  }
  return largest;
}

/// How many colour values differ from the first pixel's, the background.
inline std::size_t Covered(const std::vector<unsigned char>& picture)
{
  std::size_t count = 0;
  for (std::size_t i = 0; i < picture.size(); ++i)
  {
    count += picture[i] != picture[i % 3] ? 1 : 0;
  }
  return count;
}

} // namespace mapper_testing

#endif
