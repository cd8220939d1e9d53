// SPDX-License-Identifier: BSD-3-Clause
#include "VtkIoTesting.h"

#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTypeTraits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>

using Pipeline = vtkStreamingDemandDrivenPipeline;

TemporaryFolder::TemporaryFolder()
{
  std::string pattern = (std::filesystem::temp_directory_path() / "banyan-XXXXXX").string();
  const char* made = mkdtemp(pattern.data());
  this->Path = made ? made : "";
}

TemporaryFolder::~TemporaryFolder()
{
  std::error_code ignored;
  std::filesystem::remove_all(this->Path, ignored);
}

std::vector<std::string> TemporaryFolder::Entries() const
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(this->Path))
  {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void Messages::Watch(vtkObject* object)
{
  object->AddObserver(vtkCommand::ErrorEvent, this, &Messages::Take);
  object->AddObserver(vtkCommand::WarningEvent, this, &Messages::Take);
  if (auto* algorithm = vtkAlgorithm::SafeDownCast(object))
  {
    algorithm->GetExecutive()->AddObserver(vtkCommand::ErrorEvent, this, &Messages::Take);
  }
}

void Messages::Take(vtkObject*, unsigned long event, void* text)
{
  (event == vtkCommand::ErrorEvent ? this->Errors : this->Warnings) +=
    static_cast<const char*>(text);
}

//--------------------------------------------------------------------------------------------------

vtkStandardNewMacro(TestSource);

TestSource::TestSource()
{
  this->SetNumberOfInputPorts(0);
}

int TestSource::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  vtkInformation* info = outputs->GetInformationObject(0);
  const banyan::Box& e = this->Grid.Extent;
  const int extent[6] = { e.Lo.x, e.Hi.x - 1, e.Lo.y, e.Hi.y - 1, e.Lo.z, e.Hi.z - 1 };
  info->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  info->Set(vtkDataObject::ORIGIN(), &this->Grid.Origin[0], 3);
  info->Set(vtkDataObject::SPACING(), &this->Grid.Spacing[0], 3);
  info->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  if (!this->Times.empty())
  {
    info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    const double range[2] = { this->Times.front(), this->Times.back() };
    info->Set(Pipeline::TIME_RANGE(), range, 2);
  }
  return 1;
}

int TestSource::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  ++this->Executions;
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkImageData* image = vtkImageData::GetData(info);
  double time = 0.0;
  if (info->Has(Pipeline::UPDATE_TIME_STEP()) && !this->Times.empty())
  {
    time = info->Get(Pipeline::UPDATE_TIME_STEP());
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
  }
  const auto step = std::find(this->Times.begin(), this->Times.end(), time) - this->Times.begin();
  if (this->FailAtStep(static_cast<int>(step)))
  {
    return 0;
  }
  image->SetExtent(info->Get(Pipeline::UPDATE_EXTENT()));
  image->SetOrigin(&this->Grid.Origin[0]);
  image->SetSpacing(&this->Grid.Spacing[0]);
  double direction[9];
  for (int i = 0; i < 9; ++i)
  {
    direction[i] = this->Grid.Direction[i % 3][i / 3];
  }
  image->SetDirectionMatrix(direction);
  this->Fill(image, time);
  return 1;
}

//--------------------------------------------------------------------------------------------------

double Wave(const glm::ivec3& sample, double time, int component)
{
  return std::sin(0.11 * sample.x + 0.3 * component + 0.9 * time) * std::cos(0.07 * sample.y) *
         std::cos(0.13 * sample.z - 0.2 * time);
}

vtkSmartPointer<vtkDataArray> WaveArray(banyan::ScalarType type, const std::string& name,
  int components, const int extent[6], double time, double scale, double offset)
{
  return banyan::Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      auto array = vtkSmartPointer<vtkDataArray>::Take(
        vtkDataArray::CreateDataArray(vtkTypeTraits<T>::VTK_TYPE_ID));
      array->SetName(name.c_str());
      array->SetNumberOfComponents(components);
      const vtkIdType tuples = vtkIdType{ extent[1] - extent[0] + 1 } *
                               (extent[3] - extent[2] + 1) * (extent[5] - extent[4] + 1);
      array->SetNumberOfTuples(tuples);
      T* value = static_cast<T*>(array->GetVoidPointer(0));
      for (int z = extent[4]; z <= extent[5]; ++z)
      {
        for (int y = extent[2]; y <= extent[3]; ++y)
        {
          for (int x = extent[0]; x <= extent[1]; ++x)
          {
            for (int c = 0; c < components; ++c)
            {
              const double v = scale * Wave({ x, y, z }, time, c) + offset;
              *value++ = static_cast<T>(std::is_integral_v<T> ? std::floor(v) : v);
            }
          }
        }
      }
      return array;
    });
}

void GoodRange(banyan::ScalarType type, double& scale, double& offset)
{
  scale = 10.0;
  offset = 0.0;
  banyan::Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      if constexpr (std::is_integral_v<T>)
      {
        // Nearly all of the narrow types; of the wide ones as much as a double holds exactly.
        const double top = std::min(static_cast<double>(std::numeric_limits<T>::max()), 4.0e15);
        scale = std::is_signed_v<T> ? 0.95 * top : 0.45 * top;
        offset = std::is_signed_v<T> ? 0.0 : 0.5 * top;
      }
    });
}

banyan::Grid SimpleGrid(const glm::ivec3& samples)
{
  banyan::Grid grid;
  grid.Extent = { glm::ivec3(0), samples };
  return grid;
}

banyan::Grid OddGrid(const glm::ivec3& samples)
{
  banyan::Grid grid;
  grid.Extent = { { -7, 100, 3 }, glm::ivec3(-7, 100, 3) + samples };
  grid.Origin = { 1000.125, -3.0e-7, 5.0 / 3.0 };
  grid.Spacing = { 0.1, 4.0080321286, 1.0e-3 };
  // A rotation of columns (0.6, 0.8, 0), (-0.8, 0.6, 0), (0, 0, 1).
  grid.Direction = glm::dmat3(0.6, 0.8, 0.0, -0.8, 0.6, 0.0, 0.0, 0.0, 1.0);
  return grid;
}

vtkSmartPointer<TestSource> WaveSource(const banyan::Grid& grid, const std::vector<double>& times,
  banyan::ScalarType type, int components, const std::string& name)
{
  auto source = vtkSmartPointer<TestSource>::New();
  source->Grid = grid;
  source->Times = times;
  source->Fill = [=](vtkImageData* image, double time)
  {
    double scale = 1.0;
    double offset = 0.0;
    GoodRange(type, scale, offset);
    const auto array = WaveArray(type, name, components, image->GetExtent(), time, scale, offset);
    image->GetPointData()->SetScalars(array);
  };
  return source;
}

void WriteSeries(vtkAlgorithm* source, const std::string& path,
  const std::function<void(vtkBanyanSeriesWriter*)>& change)
{
  vtkNew<vtkBanyanSeriesWriter> writer;
  Messages messages(writer);
  writer->SetInputConnection(source->GetOutputPort());
  writer->SetFileName(path.c_str());
  if (change)
  {
    change(writer);
  }
  EXPECT_EQ(writer->Write(), 1);
  EXPECT_EQ(messages.Errors, "");
  EXPECT_EQ(writer->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
}

vtkSmartPointer<vtkBanyanSeriesReader> Reader(const std::string& path)
{
  auto reader = vtkSmartPointer<vtkBanyanSeriesReader>::New();
  reader->SetFileName(path.c_str());
  return reader;
}

vtkSmartPointer<vtkImageData> ImageAt(vtkAlgorithm* source, double time)
{
  source->UpdateTimeStep(time);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->DeepCopy(source->GetOutputDataObject(0));
  return image;
}

double LargestDifference(vtkDataArray* a, vtkDataArray* b)
{
  if (!a || !b || a->GetNumberOfValues() != b->GetNumberOfValues())
  {
    return std::numeric_limits<double>::infinity();
  }
  long double largest = 0.0L;
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      const long double difference =
        std::fabs(static_cast<long double>(a->GetComponent(i, c)) - b->GetComponent(i, c));
      largest = difference > largest ? difference : largest;
    }
  }
  return static_cast<double>(largest);
}

bool SameBits(vtkDataArray* a, vtkDataArray* b)
{
  return a && b && a->GetDataType() == b->GetDataType() &&
         a->GetNumberOfValues() == b->GetNumberOfValues() &&
         std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
           a->GetNumberOfValues() * a->GetDataTypeSize()) == 0;
}

std::string DataPath(const std::string& name)
{
  const char* folder = std::getenv("BANYAN_DATA_DIR");
  return folder && *folder ? std::string(folder) + "/" + name : "";
}
