// SPDX-License-Identifier: BSD-3-Clause
// Times, pieces, sub-extents, levels and array selection of the reader, and what they decode.
#include "VtkIoTesting.h"

#include "vtkBanyanDecode.h"
#include "vtkBanyanDeferred.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"

#include "vtkDataArray.h"
#include "vtkExtractVOI.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include "Cache/BrickCache.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/PieceRange.h"
#include "Series/Decode/SeriesFile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace
{

using Pipeline = vtkStreamingDemandDrivenPipeline;

/// A series of waves with the given samples, and its reader.
class Series
{
public:
  explicit Series(const banyan::Grid& grid, const std::vector<double>& times = { 0.0, 0.5, 2.0 })
    : Source(WaveSource(grid, times))
  {
    WriteSeries(this->Source, this->Path());
    this->Read = Reader(this->Path());
  }
  std::string Path() const { return this->Folder / "a.banyan"; }

  TemporaryFolder Folder;
  vtkSmartPointer<TestSource> Source;
  vtkSmartPointer<vtkBanyanSeriesReader> Read;
};

double TimeOf(vtkAlgorithm* algorithm)
{
  return algorithm->GetOutputDataObject(0)->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
}

const vtkBanyanDeferred::Handle* HandleOf(vtkAlgorithm* algorithm)
{
  auto* image = vtkImageData::SafeDownCast(algorithm->GetOutputDataObject(0));
  return vtkBanyanDeferred::From(image->GetPointData()->GetScalars());
}

/// What lies in `part` of an image, value by value.
void ExpectPart(vtkImageData* whole, vtkImageData* part)
{
  const int* e = part->GetExtent();
  for (int z = e[4]; z <= e[5]; ++z)
  {
    for (int y = e[2]; y <= e[3]; ++y)
    {
      for (int x = e[0]; x <= e[1]; ++x)
      {
        ASSERT_EQ(part->GetScalarComponentAsDouble(x, y, z, 0),
          whole->GetScalarComponentAsDouble(x, y, z, 0));
      }
    }
  }
}

TEST(Reader, SnapsToTheStepAtOrBefore)
{
  Series series(SimpleGrid({ 5, 5, 5 }));
  const std::vector<std::pair<double, double>> asked{ { -1.0, 0.0 }, { 0.0, 0.0 }, { 0.4, 0.0 },
    { 0.5, 0.5 }, { 1.999, 0.5 }, { 2.0, 2.0 }, { 99.0, 2.0 } };
  for (const auto& [time, step] : asked)
  {
    series.Read->UpdateTimeStep(time);
    EXPECT_EQ(TimeOf(series.Read), step) << "asked for " << time;
  }
  vtkInformation* info = series.Read->GetOutputInformation(0);
  ASSERT_EQ(info->Length(Pipeline::TIME_STEPS()), 3);
  EXPECT_EQ(info->Get(Pipeline::TIME_RANGE())[1], 2.0);
}

/// The last budget counts, also between updates, and arrays that were read before stay as they are.
TEST(Reader, ASeriesMayHaveCachesOfItsOwn)
{
  Series series(OddGrid({ 70, 70, 70 }));
  const auto whole = ImageAt(series.Read, 0.5);
  const auto reader = Reader(series.Path());
  vtkNew<vtkBanyanDecode> readsDeferred; // connected, so that nothing is decoded yet
  readsDeferred->SetInputConnection(reader->GetOutputPort());
  const auto process = banyan::CacheContext::Process();
  std::vector<vtkSmartPointer<vtkImageData>> images;
  for (const int mebibytes : { -1, 0, 1, 500, -1 })
  {
    reader->SetCacheBudget(mebibytes);
    reader->UpdateTimeStep(0.5);
    const vtkBanyanDeferred::Handle handle = *HandleOf(reader);
    const auto& caches = handle.Series->Caches();
    EXPECT_EQ(caches == process, mebibytes < 0);
    EXPECT_EQ(caches->OwnBudgetBytes(), mebibytes < 0 ? -1 : std::int64_t{ mebibytes } << 20);
    const std::uint64_t before = process->Blocks().Bytes();
    EXPECT_EQ(handle.Series->BricksDecoded(), 0u) << "opened again";
    const auto copy = vtkSmartPointer<vtkImageData>::New();
    copy->ShallowCopy(reader->GetOutputDataObject(0));
    images.push_back(copy);
    if (mebibytes != 1) // that one is read when its reader has others
    {
      ExpectPart(whole, copy);
      EXPECT_GT(handle.Series->BricksDecoded(), 0u);
      EXPECT_EQ(caches->Blocks().Bytes() > 0, mebibytes != 0);
    }
    EXPECT_EQ(process->Blocks().Bytes() != before, mebibytes < 0);
    const vtkMTimeType executed = HandleOf(reader) ? reader->GetMTime() : 0;
    reader->SetCacheBudget(mebibytes);
    EXPECT_EQ(reader->GetMTime(), executed) << "nothing to do";
  }
  for (const auto& image : images)
  {
    ExpectPart(whole, image);
  }
  Messages messages(reader);
  reader->SetCacheBudget(-2);
  EXPECT_NE(messages.Errors.find("'Cache Budget' (CacheBudget) must be"), std::string::npos);
  EXPECT_EQ(reader->GetCacheBudget(), -1);
}

TEST(Reader, SubExtentsDecodeOnlyTheBricksTheyTouch)
{
  Series series(OddGrid({ 70, 70, 70 }));
  const auto whole = ImageAt(series.Read, 0.5);
  const auto reader = Reader(series.Path());
  reader->UpdateInformation();
  const std::vector<std::array<int, 6>> extents{ { -7, -7, 100, 100, 3, 3 },
    { 0, 20, 110, 140, 40, 72 }, { 62, 62, 100, 169, 3, 72 }, { -7, 62, 100, 169, 3, 72 } };
  for (const auto& extent : extents)
  {
    banyan::BrickCache::Of(*banyan::CacheContext::Process()).Clear();
    const auto fresh = Reader(series.Path());
    fresh->UpdateInformation();
    vtkNew<vtkBanyanDecode> readsDeferred; // connected, so that nothing is decoded yet
    readsDeferred->SetInputConnection(fresh->GetOutputPort());
    fresh->UpdateTimeStep(0.5, -1, 1, 0, extent.data());
    const vtkBanyanDeferred::Handle handle = *HandleOf(fresh);
    EXPECT_EQ(handle.Series->BricksDecoded(), 0u);
    auto* part = vtkImageData::SafeDownCast(fresh->GetOutputDataObject(0));
    for (int i = 0; i < 6; ++i)
    {
      ASSERT_EQ(part->GetExtent()[i], extent[i]);
    }
    ExpectPart(whole, part);
    std::uint64_t coded = 0;
    const auto nodes = handle.Series->Nodes({ 1, 0, 0, 0 });
    for (const std::int64_t brick :
      banyan::BricksTouching(handle.Series->Layout(0), handle.Samples))
    {
      coded += (*nodes)[brick].Uniform ? 0 : 1;
    }
    // Macro voxels may or may not count as decoded.
    EXPECT_GE(handle.Series->BricksDecoded(), coded);
    EXPECT_LE(handle.Series->BricksDecoded(),
      banyan::BricksTouching(handle.Series->Layout(0), handle.Samples).size());
  }
}

TEST(Reader, PiecesTogetherAreTheWhole)
{
  Series series(SimpleGrid({ 33, 20, 17 }));
  const auto whole = ImageAt(series.Read, 2.0);
  for (const int pieces : { 2, 3, 7 })
  {
    std::vector<char> seen(whole->GetNumberOfPoints(), 0);
    for (int piece = 0; piece < pieces; ++piece)
    {
      const auto reader = Reader(series.Path());
      reader->UpdateTimeStep(2.0, piece, pieces, 0);
      auto* part = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
      ExpectPart(whole, part);
      const int* e = part->GetExtent();
      for (int z = e[4]; z <= e[5]; ++z)
      {
        for (int y = e[2]; y <= e[3]; ++y)
        {
          for (int x = e[0]; x <= e[1]; ++x)
          {
            int ijk[3] = { x, y, z };
            seen[whole->ComputePointId(ijk)] = 1;
          }
        }
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 0), 0) << pieces << " pieces";
  }
}

TEST(Reader, MorePiecesThanSamplesLeaveSomeEmpty)
{
  Series series(SimpleGrid({ 2, 2, 1 }));
  vtkIdType points = 0;
  for (int piece = 0; piece < 8; ++piece)
  {
    const auto reader = Reader(series.Path());
    Messages messages(reader);
    reader->UpdateTimeStep(0.0, piece, 8, 0);
    auto* part = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
    points += part->GetNumberOfPoints();
    EXPECT_EQ(messages.Errors, "");
    double range[2];
    if (vtkDataArray* array = part->GetPointData()->GetArray("wave"))
    {
      array->GetRange(range);
      EXPECT_EQ(array->GetNumberOfTuples(), part->GetNumberOfPoints());
    }
  }
  EXPECT_GE(points, 4);
}

TEST(Reader, LevelsAreEveryOtherSample)
{
  const banyan::Grid odd = OddGrid({ 70, 33, 18 });
  Series series(odd);
  const auto fine = ImageAt(series.Source, 0.5);
  const int levels = [&]
  {
    series.Read->UpdateInformation();
    return series.Read->GetNumberOfLevels();
  }();
  ASSERT_GE(levels, 2);
  for (int level = 1; level < levels + 2; ++level)
  {
    const int used = std::min(level, levels - 1);
    const int factor = 1 << used;
    series.Read->SetLevel(level);
    const auto coarse = ImageAt(series.Read, 0.5);
    const int* e = coarse->GetExtent();
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_EQ(e[2 * axis], 0);
      EXPECT_EQ(e[2 * axis + 1], (odd.Samples()[axis] - 1) / factor);
      EXPECT_EQ(coarse->GetSpacing()[axis], odd.Spacing[axis] * factor);
    }
    for (int z = 0; z <= e[5]; ++z)
    {
      for (int y = 0; y <= e[3]; ++y)
      {
        for (int x = 0; x <= e[1]; ++x)
        {
          const double value = coarse->GetScalarComponentAsDouble(x, y, z, 0);
          const int i = -7 + factor * x;
          const int j = 100 + factor * y;
          const int k = 3 + factor * z;
          ASSERT_LE(std::abs(value - fine->GetScalarComponentAsDouble(i, j, k, 0)), 20.0 / 512.0);
          int here[3] = { x, y, z };
          int there[3] = { i, j, k };
          double p[3];
          double q[3];
          coarse->GetPoint(coarse->ComputePointId(here), p);
          fine->GetPoint(fine->ComputePointId(there), q);
          for (int axis = 0; axis < 3; ++axis)
          {
            ASSERT_NEAR(p[axis], q[axis], 1e-9 * (1.0 + std::abs(q[axis])));
          }
        }
      }
    }
  }
}

TEST(Reader, ContentsSayStepsBytesAndBounds)
{
  Series series(SimpleGrid({ 5, 6, 7 }));
  EXPECT_STREQ(series.Read->GetContents(), "");
  series.Read->UpdateInformation();
  const std::string contents = series.Read->GetContents();
  EXPECT_EQ(contents.rfind("3 steps of 5 x 6 x 7 points\n", 0), 0u) << contents;
  EXPECT_NE(contents.find(" of the values' "), std::string::npos) << contents;

  const auto file = banyan::SeriesFile::Open(series.Path());
  const int wave = file->Index().FindArray("wave");
  ASSERT_GE(wave, 0);
  std::ostringstream bound;
  bound << std::setprecision(4) << "  bound "
        << file->Index().Arrays[static_cast<std::size_t>(wave)].Components[0].ErrorBoundAbsolute;
  EXPECT_NE(contents.find("\nwave: error at most "), std::string::npos) << contents;
  EXPECT_NE(contents.find(bound.str()), std::string::npos) << contents;
}

/// Where values were lost, the text says so, whatever the error of the others.
TEST(Reader, ContentsSayHowManyValuesAreLost)
{
  TemporaryFolder folder;
  const std::string path = folder / "clamped.banyan";
  WriteSeries(WaveSource(SimpleGrid({ 5, 6, 7 }), { 0.0 }), path,
    [](vtkBanyanSeriesWriter* writer)
    {
      writer->SetErrorBound(0.0);
      writer->SetRangeMode(vtkBanyanSeriesWriter::GIVEN);
      writer->SetRange(-0.5, 0.5);
      writer->SetClampOutside(true);
    });
  const auto reader = Reader(path);
  reader->UpdateInformation();
  const auto file = banyan::SeriesFile::Open(path);
  const int wave = file->Index().FindArray("wave");
  ASSERT_GE(wave, 0);
  const std::int64_t lost =
    file->Index().Arrays[static_cast<std::size_t>(wave)].Components[0].ClampedCount;
  ASSERT_GT(lost, 0);
  const std::string contents = reader->GetContents();
  EXPECT_NE(contents.find("but for " + std::to_string(lost) + " values"), std::string::npos)
    << contents;
}

TEST(Reader, ReadsOnlyTheChosenArrays)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 6, 6, 6 }), {});
  source->Fill = [](vtkImageData* image, double time)
  {
    for (const char* name : { "a", "b", "c" })
    {
      image->GetPointData()->AddArray(
        WaveArray(banyan::ScalarType::Float32, name, 1, image->GetExtent(), time, 1.0, 0.0));
    }
    image->GetPointData()->SetActiveScalars("c");
  };
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  reader->UpdateInformation();
  ASSERT_EQ(reader->GetNumberOfPointArrays(), 3);
  reader->SetPointArrayStatus("b", 0);
  reader->Update();
  vtkPointData* points = reader->GetOutput()->GetPointData();
  ASSERT_EQ(points->GetNumberOfArrays(), 2);
  EXPECT_FALSE(points->HasArray("b"));
  EXPECT_STREQ(points->GetScalars()->GetName(), "c");
  reader->SetPointArrayStatus("b", 1);
  reader->SetPointArrayStatus("c", 0);
  reader->Update();
  EXPECT_TRUE(points->HasArray("b"));
  EXPECT_FALSE(points->HasArray("c"));
}

TEST(Reader, WithoutDeferringGivesPlainArrays)
{
  Series series(SimpleGrid({ 20, 20, 20 }));
  const auto deferred = ImageAt(series.Read, 0.5);
  series.Read->DeferDecodingOff();
  series.Read->UpdateTimeStep(0.5);
  vtkDataArray* array = series.Read->GetOutput()->GetPointData()->GetScalars();
  EXPECT_EQ(vtkBanyanDeferred::From(array), nullptr);
  EXPECT_TRUE(array->IsA("vtkFloatArray"));
  EXPECT_TRUE(SameBits(array, deferred->GetPointData()->GetScalars()));
}

TEST(Reader, FollowsAFileThatChangesWhenRefreshed)
{
  Series series(SimpleGrid({ 5, 5, 5 }), { 0.0, 1.0 });
  series.Read->UpdateInformation();
  WriteSeries(WaveSource(SimpleGrid({ 6, 6, 6 }), { 0.0, 1.0, 2.0 }), series.Path());
  series.Read->Refresh();
  series.Read->UpdateTimeStep(2.0);
  EXPECT_EQ(series.Read->GetOutput()->GetNumberOfPoints(), 216);
  EXPECT_EQ(TimeOf(series.Read), 2.0);
}

TEST(Reader, ExtractVoiOfAPiece)
{
  Series series(SimpleGrid({ 40, 40, 40 }));
  const auto whole = ImageAt(series.Read, 0.0);
  vtkNew<vtkExtractVOI> extract;
  extract->SetInputConnection(Reader(series.Path())->GetOutputPort());
  extract->SetVOI(10, 20, 11, 11, 12, 30);
  extract->Update();
  ExpectPart(whole, extract->GetOutput());
}

} // namespace
