// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_VtkIoTesting_h
#define banyan_Testing_VtkIoTesting_h

#include "vtkImageAlgorithm.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include "Base/ScalarType.h"
#include "Series/Grid/Grid.h"

#include <functional>
#include <string>
#include <vector>

class vtkBanyanSeriesReader;
class vtkBanyanSeriesWriter;
class vtkDataArray;
class vtkImageData;

/// A folder of its own that is removed with everything in it.
class TemporaryFolder
{
public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string operator/(const std::string& name) const { return this->Path + "/" + name; }
  /// Names of what is in it, sorted.
  std::vector<std::string> Entries() const;

private:
  std::string Path;
};

/// Collects what an algorithm (and whatever else is given to Watch) says in error and warning
/// messages, instead of printing it.
class Messages
{
public:
  explicit Messages(vtkObject* object) { this->Watch(object); }
  void Watch(vtkObject* object);
  std::string Errors;
  std::string Warnings;

private:
  void Take(vtkObject*, unsigned long event, void* text);
};

/// A source of image data whose every step is made by a function. It knows times, pieces and
/// sub-extents.
class TestSource : public vtkImageAlgorithm
{
public:
  static TestSource* New();
  vtkTypeMacro(TestSource, vtkImageAlgorithm);

  banyan::Grid Grid;
  std::vector<double> Times;
  /// Adds arrays to an image whose extent (a part of Grid) and geometry are set already.
  std::function<void(vtkImageData*, double time)> Fill;
  bool FailAtStep(int step) const { return this->FailingStep == step; }
  int FailingStep = -1;
  int Executions = 0;

protected:
  TestSource();
  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
};

/// A smooth function of position (in samples) and time, different per component, in [-1, 1].
double Wave(const glm::ivec3& sample, double time, int component);

/// An array of a type over an extent with values scale * Wave + offset, rounded for integers.
vtkSmartPointer<vtkDataArray> WaveArray(banyan::ScalarType type, const std::string& name,
  int components, const int extent[6], double time, double scale, double offset);

/// The scale and offset that make good use of a type.
void GoodRange(banyan::ScalarType type, double& scale, double& offset);

/// A grid of so many samples, with an extent that starts at 0 and simple geometry.
banyan::Grid SimpleGrid(const glm::ivec3& samples);
/// One with everything odd: a shifted extent, a far origin, three spacings, a rotation.
banyan::Grid OddGrid(const glm::ivec3& samples);

/// A source with one array of waves.
vtkSmartPointer<TestSource> WaveSource(const banyan::Grid& grid, const std::vector<double>& times,
  banyan::ScalarType type = banyan::ScalarType::Float32, int components = 1,
  const std::string& name = "wave");

/// Writes without ParaView; expects success.
void WriteSeries(vtkAlgorithm* source, const std::string& path,
  const std::function<void(vtkBanyanSeriesWriter*)>& change = nullptr);

/// A reader of that file.
vtkSmartPointer<vtkBanyanSeriesReader> Reader(const std::string& path);

/// The source's own image at a time; a deep copy.
vtkSmartPointer<vtkImageData> ImageAt(vtkAlgorithm* source, double time);

/// The largest |a - b| over all tuples and components, in long double.
double LargestDifference(vtkDataArray* a, vtkDataArray* b);

/// Whether two arrays have the same type, size and bytes.
bool SameBits(vtkDataArray* a, vtkDataArray* b);

/// Path below the folder of real data, or empty if there is none.
std::string DataPath(const std::string& name);

#endif
