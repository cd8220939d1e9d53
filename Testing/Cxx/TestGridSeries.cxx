// SPDX-License-Identifier: BSD-3-Clause
// Curvilinear and rectilinear grids come back from a series: points bit by bit, values within the
// bound.
#include "GridSource.h"

#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkRectilinearGrid.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"

#include "Series/Decode/SeriesFile.h"
#include "Series/Format/IndexText.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

namespace
{

constexpr double Bound = 2.0 / 512.0; ///< of waves in [-1, 1]

void ExpectSteps(GridSource* source, vtkAlgorithm* reader)
{
  for (const double time : source->Times)
  {
    const auto original = GridAt(source, time);
    const auto decoded = GridAt(reader, time);
    ExpectSamePoints(original, decoded);
    EXPECT_LE(LargestDifference(original->GetPointData()->GetArray("wave"),
                decoded->GetPointData()->GetArray("wave")),
      Bound)
      << time;
  }
}

/// Both kinds of grids, with coordinates of float32 or float64.
class GridSeries : public testing::TestWithParam<std::tuple<bool, int>>
{
protected:
  GridSeries()
    : Source(GridsAtRest(std::get<0>(GetParam())))
  {
    this->Source->TypeOfPoints = std::get<1>(GetParam());
  }

  std::size_t FilesOfPoints() const
  {
    return banyan::SeriesFile::Open(this->Path)->Index().Points->Files.size();
  }

  vtkSmartPointer<GridSource> Source;
  TemporaryFolder Folder;
  std::string Path = Folder / "grid.banyan";
};

INSTANTIATE_TEST_SUITE_P(Kinds, GridSeries,
  testing::Combine(testing::Bool(), testing::Values(VTK_FLOAT, VTK_DOUBLE)),
  [](const auto& info)
  {
    return std::string(std::get<0>(info.param) ? "Rectilinear" : "Curvilinear") +
           (std::get<1>(info.param) == VTK_FLOAT ? "Float32" : "Float64");
  });

TEST_P(GridSeries, PointsAtRestAreStoredOnce)
{
  WriteSeries(this->Source, this->Path);
  ExpectSteps(this->Source, Reader(this->Path));
  EXPECT_EQ(this->FilesOfPoints(), 1u);
  const banyan::SeriesIndex index = banyan::SeriesFile::Open(this->Path)->Index();
  EXPECT_EQ(banyan::FeaturesOf(index), std::vector<std::string>{ "grid points" });
}

TEST_P(GridSeries, PointsThatMoveAreStoredWhenTheyDo)
{
  const auto rest = this->Source->Place;
  this->Source->Times = { 0.0, 1.0, 2.0, 3.0, 4.0 };
  // Steps 2 and 3 have the points of one place, and the last one those of the first.
  this->Source->Place = [rest](const glm::ivec3& sample, double time)
  {
    const bool away = time > 0.5 && time < 3.5;
    return rest(sample, time) +
           (away ? glm::dvec3(0.125 * std::floor(time / 2.0) + 1.0) : glm::dvec3(0.0));
  };
  WriteSeries(
    this->Source, this->Path, [](vtkBanyanSeriesWriter* w) { w->SetKeyframeInterval(2); });
  ExpectSteps(this->Source, Reader(this->Path));
  EXPECT_EQ(this->FilesOfPoints(), 4u);
  // The same content is the same file.
  const auto files = banyan::SeriesFile::Open(this->Path)->Index().Points->Files;
  EXPECT_EQ(files.front().File, files.back().File);
}

TEST_P(GridSeries, ShiftedExtentsAndPiecesComeBack)
{
  this->Source->Extent = { { -7, 100, 3 }, { 13, 117, 12 } };
  this->Source->Place = [](const glm::ivec3& s, double)
  { return glm::dvec3(s.x, s.y, s.z) * 0.1 + 1e-3 * glm::dvec3(s * s); };
  WriteSeries(this->Source, this->Path);
  ExpectSteps(this->Source, Reader(this->Path));
  const int part[6] = { -3, 12, 105, 105, 3, 10 };
  const auto reader = Reader(this->Path); // one that has not the whole already
  reader->UpdateTimeStep(1.0, -1, 1, 0, part);
  this->Source->Modified();
  this->Source->UpdateTimeStep(1.0, -1, 1, 0, part);
  auto* const read = vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
  auto* const made = vtkDataSet::SafeDownCast(this->Source->GetOutputDataObject(0));
  EXPECT_EQ(read->GetNumberOfPoints(), 16 * 8);
  ExpectSamePoints(made, read);
  EXPECT_LE(LargestDifference(
              made->GetPointData()->GetArray("wave"), read->GetPointData()->GetArray("wave")),
    Bound);
}

/// A coarser level has every second sample, and the last one.
TEST_P(GridSeries, LevelsHaveThePointsOfTheirSamples)
{
  WriteSeries(this->Source, this->Path, [](vtkBanyanSeriesWriter* w) { w->SetErrorBound(0.0); });
  const auto reader = Reader(this->Path);
  reader->UpdateInformation();
  ASSERT_EQ(reader->GetNumberOfLevels(), 2);
  reader->SetLevel(1);
  const auto fine = GridAt(this->Source, 1.0);
  const auto coarse = GridAt(reader, 1.0);
  const glm::ivec3 samples{ 11, 10, 5 };
  ASSERT_EQ(coarse->GetNumberOfPoints(), 11 * 10 * 5);
  banyan::ForPositions({ glm::ivec3(0), samples },
    [&](const glm::ivec3& at)
    {
      const glm::ivec3 from = glm::min(2 * at, glm::ivec3(19, 17, 8));
      const vtkIdType a = (vtkIdType{ at.z } * samples.y + at.y) * samples.x + at.x;
      const vtkIdType b = (vtkIdType{ from.z } * 18 + from.y) * 20 + from.x;
      for (int axis = 0; axis < 3; ++axis)
      {
        EXPECT_EQ(coarse->GetPoint(a)[axis], fine->GetPoint(b)[axis]);
      }
      EXPECT_EQ(coarse->GetPointData()->GetArray("wave")->GetTuple1(a),
        fine->GetPointData()->GetArray("wave")->GetTuple1(b));
    });
}

TEST_P(GridSeries, PointsBetweenStepsLieBetween)
{
  const auto rest = this->Source->Place;
  this->Source->Times = { 0.0, 1.0 };
  this->Source->Place = [rest](const glm::ivec3& s, double time)
  { return rest(s, time) + 4.0 * time; };
  WriteSeries(this->Source, this->Path);
  const auto reader = Reader(this->Path);
  reader->InterpolateInTimeOn();
  const auto before = GridAt(this->Source, 0.0);
  const auto between = GridAt(reader, 0.25);
  for (vtkIdType i = 0; i < before->GetNumberOfPoints(); ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      EXPECT_NEAR(between->GetPoint(i)[axis], before->GetPoint(i)[axis] + 1.0, 1e-5);
    }
  }
}

TEST_P(GridSeries, HiddenPointsAndCellsComeBack)
{
  this->Source->Change = [](vtkDataSet* grid, double time)
  {
    vtkUnsignedCharArray* const points = grid->AllocatePointGhostArray();
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
    {
      points->SetValue(i, i % 7 == static_cast<int>(time) ? vtkDataSetAttributes::HIDDENPOINT : 0);
    }
    vtkUnsignedCharArray* const cells = grid->AllocateCellGhostArray();
    for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i)
    {
      cells->SetValue(i, i % 5 == 0 ? vtkDataSetAttributes::HIDDENCELL : 0);
    }
  };
  WriteSeries(this->Source, this->Path);
  const auto reader = Reader(this->Path);
  ExpectSteps(this->Source, reader);
  for (const double time : this->Source->Times)
  {
    const auto original = GridAt(this->Source, time);
    const auto decoded = GridAt(reader, time);
    EXPECT_TRUE(SameBits(original->GetPointGhostArray(), decoded->GetPointGhostArray()));
    EXPECT_TRUE(SameBits(original->GetCellGhostArray(), decoded->GetCellGhostArray()));
  }
}

TEST_P(GridSeries, ASaveThatStartsAnewHasItsPoints)
{
  // Points that are hidden late with an absolute bound make the writer start anew.
  this->Source->Change = [](vtkDataSet* grid, double time)
  {
    if (time > 2.0)
    {
      grid->AllocatePointGhostArray()->SetValue(3, vtkDataSetAttributes::HIDDENPOINT);
    }
  };
  WriteSeries(this->Source, this->Path,
    [](vtkBanyanSeriesWriter* w)
    {
      w->SetErrorBoundMode(vtkBanyanSeriesWriter::ABSOLUTE);
      w->SetErrorBound(Bound);
    });
  ExpectSteps(this->Source, Reader(this->Path));
}

/// Groups that were finished open with their points, and no others stay.
TEST_P(GridSeries, AnInterruptedSaveKeepsThePointsOfItsSteps)
{
  const auto rest = this->Source->Place;
  this->Source->Times = { 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0 };
  this->Source->Place = [rest](const glm::ivec3& s, double time) { return rest(s, time) + time; };
  vtkNew<vtkBanyanSeriesWriter> writer;
  Messages messages(writer);
  writer->SetInputConnection(this->Source->GetOutputPort());
  writer->SetFileName(this->Path.c_str());
  writer->SetErrorBoundMode(vtkBanyanSeriesWriter::ABSOLUTE);
  writer->SetKeyframeInterval(1);
  this->Source->Change = [&](vtkDataSet*, double)
  { writer->SetAbortExecute(writer->GetAbortExecute() || std::filesystem::exists(this->Path)); };
  EXPECT_EQ(writer->Write(), 0);
  EXPECT_NE(messages.Errors.find("holds the first"), std::string::npos) << messages.Errors;
  this->Source->Change = {};
  const auto file = banyan::SeriesFile::Open(this->Path);
  const auto steps = static_cast<std::size_t>(file->Index().Steps());
  EXPECT_LT(steps, 8u);
  EXPECT_EQ(file->Index().Points->Files.size(), steps);
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(this->Path + ".d"))
  {
    files += entry.is_regular_file() ? 1 : 0;
  }
  EXPECT_EQ(files, 2 * steps);
  this->Source->Times.resize(steps);
  ExpectSteps(this->Source, Reader(this->Path));
}

/// Each byte of the file of points counts.
TEST_P(GridSeries, DamagedPointsAreASentence)
{
  WriteSeries(this->Source, this->Path);
  const std::string file =
    this->Path + ".d/" + banyan::SeriesFile::Open(this->Path)->Index().Points->Files[0].File;
  std::string content;
  {
    std::ifstream stream(file, std::ios::binary);
    content.assign(std::istreambuf_iterator<char>(stream), {});
  }
  const auto refused = [&](const std::string& bad)
  {
    std::ofstream(file, std::ios::binary | std::ios::trunc) << bad;
    const auto reader = Reader(this->Path);
    Messages messages(reader);
    reader->Update();
    EXPECT_NE(reader->GetErrorCode(), 0u);
    EXPECT_NE(messages.Errors.find(file), std::string::npos) << messages.Errors;
    return messages.Errors;
  };
  for (std::size_t at = 0; at < content.size(); at += content.size() / 40 + 1)
  {
    std::string bad = content;
    bad[at] = static_cast<char>(bad[at] ^ 16);
    EXPECT_NE(refused(bad).find("points of the grid cannot be read"), std::string::npos) << at;
  }
  (void)refused(content.substr(0, content.size() / 2));
  (void)refused(content + "x");
  (void)refused("");
  std::filesystem::remove(file);
  const auto reader = Reader(this->Path);
  Messages messages(reader);
  reader->Update();
  EXPECT_NE(messages.Errors.find("1 of the"), std::string::npos) << messages.Errors;
}

//--------------------------------------------------------------------------------------------------
// What cannot be written

std::string Refusal(GridSource* source, const std::string& path)
{
  vtkNew<vtkBanyanSeriesWriter> writer;
  Messages messages(writer);
  writer->SetInputConnection(source->GetOutputPort());
  writer->SetFileName(path.c_str());
  EXPECT_EQ(writer->Write(), 0);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_FALSE(std::filesystem::exists(path + ".d"));
  return writer->GetErrorMessage();
}

TEST_P(GridSeries, PointsThatAreNowhereAreRefused)
{
  const bool rectilinear = std::get<0>(GetParam());
  const auto rest = this->Source->Place;
  this->Source->Place = [rest](const glm::ivec3& s, double time)
  {
    const bool bad = time == 1.0 && s == glm::ivec3(s.x, 4, 3);
    return bad || (time == 1.0 && s == glm::ivec3(2))
             ? glm::dvec3(std::numeric_limits<double>::quiet_NaN())
             : rest(s, time);
  };
  const std::string sentence = Refusal(this->Source, this->Path);
  EXPECT_NE(sentence.find("step 1"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("not finite"), std::string::npos) << sentence;
  EXPECT_NE(sentence.find(rectilinear ? "along x" : "i = 2, j = 2, k = 2"), std::string::npos)
    << sentence;
}

TEST_P(GridSeries, AnotherNumberOfPointsIsRefused)
{
  this->Source->Change = [](vtkDataSet* data, double)
  {
    if (auto* const grid = vtkRectilinearGrid::SafeDownCast(data))
    {
      grid->GetYCoordinates()->SetNumberOfTuples(3);
    }
    else
    {
      vtkStructuredGrid::SafeDownCast(data)->GetPoints()->SetNumberOfPoints(3);
    }
  };
  const std::string sentence = Refusal(this->Source, this->Path);
  EXPECT_NE(sentence.find("has 3 "), std::string::npos) << sentence;
  EXPECT_NE(sentence.find("its extent needs"), std::string::npos) << sentence;
}

TEST_P(GridSeries, OtherTypesLaterAreRefused)
{
  this->Source->Change = [this](vtkDataSet*, double time)
  { this->Source->TypeOfPoints = time >= 1.0 ? VTK_FLOAT : VTK_DOUBLE; };
  this->Source->Times = { 0.0, 1.0, 2.0, 3.0 };
  const std::string sentence = Refusal(this->Source, this->Path);
  EXPECT_NE(sentence.find("All steps of a series need the same kind of grid"), std::string::npos)
    << sentence;
}

TEST(GridSeriesOfHidden, HiddenPointsNeedNoPlace)
{
  const auto source = GridsAtRest(false);
  const auto rest = source->Place;
  source->Place = [rest](const glm::ivec3& s, double time)
  {
    return s == glm::ivec3(3, 0, 0) ? glm::dvec3(std::numeric_limits<double>::quiet_NaN())
                                    : rest(s, time);
  };
  source->Change = [](vtkDataSet* grid, double)
  { grid->AllocatePointGhostArray()->SetValue(3, vtkDataSetAttributes::HIDDENPOINT); };
  TemporaryFolder folder;
  WriteSeries(source, folder / "a.banyan");
  ExpectSteps(source, Reader(folder / "a.banyan"));
}

} // namespace
