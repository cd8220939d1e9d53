// SPDX-License-Identifier: BSD-3-Clause
// What is written comes back: values within the bound, everything else exactly.
#include "VtkIoTesting.h"

#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include "Series/Decode/SeriesFile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace
{

using banyan::ScalarType;

/// Compares a reader's step with what the source makes, to a bound relative to `range`.
void ExpectStep(vtkAlgorithm* source, vtkAlgorithm* reader, double time, double bound)
{
  const auto original = ImageAt(source, time);
  const auto decoded = ImageAt(reader, time);
  vtkPointData* points = original->GetPointData();
  ASSERT_EQ(decoded->GetPointData()->GetNumberOfArrays(), points->GetNumberOfArrays());
  for (int i = 0; i < points->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* a = points->GetArray(i);
    vtkDataArray* b = decoded->GetPointData()->GetArray(a->GetName());
    ASSERT_TRUE(b) << a->GetName();
    EXPECT_EQ(b->GetNumberOfComponents(), a->GetNumberOfComponents());
    EXPECT_EQ(b->GetDataTypeSize(), a->GetDataTypeSize());
    EXPECT_EQ(b->GetDataTypeMin(), a->GetDataTypeMin());
    EXPECT_LE(LargestDifference(a, b), bound) << a->GetName() << " at time " << time;
  }
}

class AllTypes : public testing::TestWithParam<int>
{
};

TEST_P(AllTypes, ComeBackWithinTheBound)
{
  const auto type = static_cast<ScalarType>(GetParam());
  double scale = 0.0;
  double offset = 0.0;
  GoodRange(type, scale, offset);
  TemporaryFolder folder;
  const std::vector<double> times{ 0.0, 0.5, 2.0 };
  const auto source = WaveSource(SimpleGrid({ 19, 17, 13 }), times, type);
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  for (const double time : times)
  {
    // The wave's range is at most 2 * scale.
    ExpectStep(source, reader, time, 2.0 * scale / 512.0);
  }
}

TEST_P(AllTypes, AreBitExactWithoutError)
{
  const auto type = static_cast<ScalarType>(GetParam());
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 18, 5, 16 }), { 0.0, 1.0 }, type, 2);
  WriteSeries(source, folder / "a.banyan", [](vtkBanyanSeriesWriter* w) { w->SetErrorBound(0.0); });
  const auto reader = Reader(folder / "a.banyan");
  for (const double time : { 0.0, 1.0 })
  {
    const auto a = ImageAt(source, time);
    const auto b = ImageAt(reader, time);
    EXPECT_TRUE(SameBits(a->GetPointData()->GetArray(0), b->GetPointData()->GetArray(0)));
  }
}

INSTANTIATE_TEST_SUITE_P(RoundTrip, AllTypes, testing::Range(0, 10),
  [](const auto& info) { return banyan::NameOf(static_cast<ScalarType>(info.param)); });

TEST(RoundTrip, WideIntegersBeyondDoubleAreBitExactWithoutError)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 9, 8, 7 }), {}, ScalarType::Int64);
  source->Fill = [](vtkImageData* image, double)
  {
    auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(VTK_LONG));
    array->SetName("wide");
    array->SetNumberOfTuples(image->GetNumberOfPoints());
    auto* values = static_cast<long*>(array->GetVoidPointer(0));
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      values[i] = std::numeric_limits<long>::max() - i * i * 1000003L;
    }
    image->GetPointData()->SetScalars(array);
  };
  WriteSeries(source, folder / "a.banyan", [](vtkBanyanSeriesWriter* w) { w->SetErrorBound(0.0); });
  const auto a = ImageAt(source, 0.0);
  const auto b = ImageAt(Reader(folder / "a.banyan"), 0.0);
  EXPECT_TRUE(SameBits(a->GetPointData()->GetArray(0), b->GetPointData()->GetArray(0)));
}

TEST(RoundTrip, BricksOfEverySizeComeBackWithinTheBound)
{
  double scale = 0.0;
  double offset = 0.0;
  GoodRange(ScalarType::Float32, scale, offset);
  for (const int cells : { 0, 16, 32 })
  {
    TemporaryFolder folder;
    const std::vector<double> times{ 0.0, 0.5, 2.0 };
    const auto source = WaveSource(SimpleGrid({ 70, 41, 36 }), times, ScalarType::Float32);
    const auto change = [cells](vtkBanyanSeriesWriter* w) { w->SetBrickCells(cells); };
    WriteSeries(source, folder / "a.banyan", change);
    EXPECT_EQ(
      banyan::SeriesFile::Open(folder / "a.banyan")->Index().BrickCells, cells > 0 ? cells : 16);
    const auto reader = Reader(folder / "a.banyan");
    for (const double time : times)
    {
      ExpectStep(source, reader, time, 2.0 * scale / 512.0);
    }
  }
}

class AllSizes : public testing::TestWithParam<std::tuple<int, int, int>>
{
};

TEST_P(AllSizes, ComeBackWithinTheBound)
{
  const auto [nx, ny, nz] = GetParam();
  TemporaryFolder folder;
  const banyan::Grid grid = OddGrid({ nx, ny, nz });
  const auto source = WaveSource(grid, { 1.0, 2.0 });
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  ExpectStep(source, reader, 1.0, 20.0 / 512.0);
  ExpectStep(source, reader, 2.0, 20.0 / 512.0);
  const auto original = ImageAt(source, 1.0);
  const auto decoded = ImageAt(reader, 1.0);
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_EQ(decoded->GetExtent()[i], original->GetExtent()[i]);
  }
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(decoded->GetOrigin()[i], grid.Origin[i]);
    EXPECT_EQ(decoded->GetSpacing()[i], grid.Spacing[i]);
  }
  for (int i = 0; i < 9; ++i)
  {
    EXPECT_EQ(decoded->GetDirectionMatrix()->GetElement(i / 3, i % 3),
      original->GetDirectionMatrix()->GetElement(i / 3, i % 3));
  }
}

INSTANTIATE_TEST_SUITE_P(RoundTrip, AllSizes,
  testing::Values(std::make_tuple(1, 1, 1), std::make_tuple(2, 2, 2), std::make_tuple(1, 5, 7),
    std::make_tuple(7, 1, 1), std::make_tuple(1, 1, 33), std::make_tuple(40, 1, 40),
    std::make_tuple(15, 15, 15), std::make_tuple(16, 16, 16), std::make_tuple(17, 17, 17),
    std::make_tuple(32, 33, 34), std::make_tuple(31, 37, 41), std::make_tuple(64, 3, 2)));

TEST(RoundTrip, SeveralArraysVectorsAndNames)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 20, 20, 20 }), { 0.0, 1.0 });
  source->Fill = [](vtkImageData* image, double time)
  {
    const int* e = image->GetExtent();
    vtkPointData* points = image->GetPointData();
    const auto velocity = WaveArray(ScalarType::Float64, "velocity", 3, e, time, 5.0, 1.0);
    velocity->SetComponentName(0, "u");
    velocity->SetComponentName(2, "w");
    points->AddArray(velocity);
    points->AddArray(WaveArray(ScalarType::UInt16, "p r/e,s \"ü", 1, e, time, 1000.0, 2000.0));
    points->SetScalars(WaveArray(ScalarType::Float32, "density", 1, e, time, 0.01, 0.1));
    auto ghosts = WaveArray(ScalarType::UInt8, "vtkGhostType", 1, e, time, 0.0, 0.0);
    points->AddArray(ghosts);
  };
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  const auto image = ImageAt(reader, 1.0);
  vtkPointData* points = image->GetPointData();
  ASSERT_EQ(points->GetNumberOfArrays(), 3);
  EXPECT_STREQ(points->GetArrayName(0), "velocity");
  EXPECT_STREQ(points->GetArrayName(1), "p r/e,s \"ü");
  EXPECT_STREQ(points->GetScalars()->GetName(), "density");
  vtkDataArray* velocity = points->GetArray("velocity");
  EXPECT_STREQ(velocity->GetComponentName(0), "u");
  EXPECT_EQ(velocity->GetComponentName(1), nullptr);
  EXPECT_STREQ(velocity->GetComponentName(2), "w");
  const auto original = ImageAt(source, 1.0);
  // The bound is per component and array, each with its own range.
  EXPECT_LE(
    LargestDifference(velocity, original->GetPointData()->GetArray("velocity")), 10.0 / 512.0);
  EXPECT_LE(LargestDifference(points->GetScalars(), original->GetPointData()->GetArray("density")),
    0.02 / 512.0);
}

TEST(RoundTrip, OnlyTheChosenArrays)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 6, 6, 6 }), {});
  source->Fill = [](vtkImageData* image, double time)
  {
    for (const char* name : { "a", "b", "c" })
    {
      image->GetPointData()->AddArray(
        WaveArray(ScalarType::Float32, name, 1, image->GetExtent(), time, 1.0, 0.0));
    }
  };
  WriteSeries(source, folder / "a.banyan",
    [](vtkBanyanSeriesWriter* w) { w->GetPointArraySelection()->EnableArray("b"); });
  const auto reader = Reader(folder / "a.banyan");
  reader->Update();
  EXPECT_EQ(reader->GetNumberOfPointArrays(), 1);
  EXPECT_STREQ(reader->GetPointArrayName(0), "b");
}

TEST(RoundTrip, AbsoluteBoundPullsEachStepOnce)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 16, 16, 16 }), { 0.0, 1.0, 2.0 });
  WriteSeries(source, folder / "a.banyan",
    [](vtkBanyanSeriesWriter* w)
    {
      w->SetErrorBoundMode(vtkBanyanSeriesWriter::ABSOLUTE);
      w->SetErrorBound(0.01);
    });
  EXPECT_EQ(source->Executions, 3);
  const auto reader = Reader(folder / "a.banyan");
  ExpectStep(source, reader, 1.0, 0.01);
}

TEST(RoundTrip, NaNAndInfinityKeepTheirBits)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 20, 20, 20 }), { 0.0, 1.0 });
  const auto fill = source->Fill;
  source->Fill = [fill](vtkImageData* image, double time)
  {
    fill(image, time);
    auto* values = static_cast<float*>(image->GetPointData()->GetScalars()->GetVoidPointer(0));
    values[5] = std::numeric_limits<float>::infinity();
    values[6] = -std::numeric_limits<float>::infinity();
    for (int i = 1000; i < 1500; ++i)
    {
      values[i] = std::numeric_limits<float>::quiet_NaN();
    }
  };
  WriteSeries(source, folder / "a.banyan");
  const auto a = ImageAt(source, 1.0);
  const auto b = ImageAt(Reader(folder / "a.banyan"), 1.0);
  auto* original = static_cast<float*>(a->GetPointData()->GetScalars()->GetVoidPointer(0));
  auto* decoded = static_cast<float*>(b->GetPointData()->GetScalars()->GetVoidPointer(0));
  for (vtkIdType i = 0; i < a->GetNumberOfPoints(); ++i)
  {
    if (std::isfinite(original[i]))
    {
      ASSERT_LE(std::fabs(original[i] - decoded[i]), 20.0 / 512.0);
    }
    else
    {
      ASSERT_EQ(std::memcmp(&original[i], &decoded[i], sizeof(float)), 0);
    }
  }
}

TEST(RoundTrip, OnlyThePresentStep)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 9, 9, 9 }), { 0.0, 1.0, 2.0 });
  source->UpdateTimeStep(2.0);
  WriteSeries(
    source, folder / "a.banyan", [](vtkBanyanSeriesWriter* w) { w->WriteTimeStepsOff(); });
  const auto reader = Reader(folder / "a.banyan");
  reader->UpdateInformation();
  vtkInformation* info = reader->GetOutputInformation(0);
  ASSERT_EQ(info->Length(vtkStreamingDemandDrivenPipeline::TIME_STEPS()), 1);
  EXPECT_EQ(info->Get(vtkStreamingDemandDrivenPipeline::TIME_STEPS())[0], 2.0);
  ExpectStep(source, reader, 2.0, 20.0 / 512.0);
}

TEST(RoundTrip, UpdateOfTheWriterWritesToo)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 9, 9, 9 }), { 0.0, 1.0 });
  vtkNew<vtkBanyanSeriesWriter> writer;
  writer->SetInputConnection(source->GetOutputPort());
  writer->SetFileName((folder / "a.banyan").c_str());
  writer->Update();
  ExpectStep(source, Reader(folder / "a.banyan"), 1.0, 20.0 / 512.0);
}

TEST(RoundTrip, ASeriesOfASeries)
{
  TemporaryFolder folder;
  const auto source = WaveSource(OddGrid({ 20, 17, 9 }), { 0.0, 1.0, 5.0 });
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  WriteSeries(reader, folder / "b.banyan", [](vtkBanyanSeriesWriter* w) { w->SetErrorBound(0.0); });
  const auto again = Reader(folder / "b.banyan");
  const auto a = ImageAt(reader, 5.0);
  const auto b = ImageAt(again, 5.0);
  EXPECT_TRUE(SameBits(a->GetPointData()->GetScalars(), b->GetPointData()->GetScalars()));
}

} // namespace
