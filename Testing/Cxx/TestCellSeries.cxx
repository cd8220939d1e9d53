// SPDX-License-Identifier: BSD-3-Clause
// Unstructured grids of any cells come back from a series: points, cells and faces bit by bit,
// values within the bound.
#include "VtkIoTesting.h"

#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkUnstructuredGridAlgorithm.h"

#include "Series/Decode/SeriesFile.h"
#include "Series/Format/IndexText.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

using Pipeline = vtkStreamingDemandDrivenPipeline;

namespace
{

constexpr double Bound = 2.0 / 512.0; ///< of waves in [-1, 1]

/// A source of grids that a function makes, and that says that it knows pieces.
class CellSource : public vtkUnstructuredGridAlgorithm
{
public:
  static CellSource* New();
  vtkTypeMacro(CellSource, vtkUnstructuredGridAlgorithm);

  std::vector<double> Times{ 0.0, 1.0, 2.5, 3.0 };
  std::function<void(vtkUnstructuredGrid*, double time)> Fill;

protected:
  CellSource() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* const info = outputs->GetInformationObject(0);
    info->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
    info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    const double range[2] = { this->Times.front(), this->Times.back() };
    info->Set(Pipeline::TIME_RANGE(), range, 2);
    return 1;
  }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkInformation* const info = outputs->GetInformationObject(0);
    const double time =
      info->Has(Pipeline::UPDATE_TIME_STEP()) ? info->Get(Pipeline::UPDATE_TIME_STEP()) : 0.0;
    auto* const grid = vtkUnstructuredGrid::SafeDownCast(info->Get(vtkDataObject::DATA_OBJECT()));
    grid->Initialize();
    grid->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    this->Fill(grid, time);
    return 1;
  }
};
vtkStandardNewMacro(CellSource);

constexpr int Side = 6; ///< points per axis of the lattice

vtkIdType PointAt(int x, int y, int z)
{
  return (vtkIdType{ z } * Side + y) * Side + x;
}

/// @param type of coordinates
void AddPoints(vtkUnstructuredGrid* grid, int type, double moved)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(type);
  for (int i = 0; i < Side * Side * Side; ++i)
  {
    const int x = i % Side, y = i / Side % Side, z = i / (Side * Side);
    points->InsertNextPoint(
      x + 0.1 * std::sin(y) + moved * std::cos(z), y + 0.1 * std::cos(z), z + 0.05 * x * y);
  }
  grid->SetPoints(points);
}

void AddPolyhedron(vtkUnstructuredGrid* grid, const std::vector<vtkIdType>& c)
{
  std::vector<vtkIdType> stream{ 6 };
  for (const std::vector<int>& face : { std::vector<int>{ 0, 2, 3, 1 }, { 4, 5, 7, 6 },
         { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
  {
    stream.push_back(4);
    for (const int corner : face)
    {
      stream.push_back(c[static_cast<std::size_t>(corner)]);
    }
  }
  vtkNew<vtkIdList> ids;
  for (const vtkIdType id : stream)
  {
    ids->InsertNextId(id);
  }
  grid->InsertNextCell(VTK_POLYHEDRON, ids);
}

/// Cells of all shapes, one after the other.
void AddCells(vtkUnstructuredGrid* grid, bool polyhedra)
{
  grid->Allocate(500);
  const auto add = [grid](int type, const std::vector<vtkIdType>& ids)
  { grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data()); };
  for (int i = 0; i < (Side - 1) * (Side - 1) * (Side - 1); ++i)
  {
    std::vector<vtkIdType> c;
    for (int n = 0; n < 8; ++n)
    {
      c.push_back(PointAt(i % (Side - 1) + (n & 1), i / (Side - 1) % (Side - 1) + (n >> 1 & 1),
        i / ((Side - 1) * (Side - 1)) + (n >> 2)));
    }
    switch (i % 5)
    {
      case 0:
        add(VTK_HEXAHEDRON, { c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6] });
        break;
      case 1:
        add(VTK_WEDGE, { c[0], c[1], c[2], c[4], c[5], c[6] });
        add(VTK_WEDGE, { c[1], c[3], c[2], c[5], c[7], c[6] });
        break;
      case 2:
        for (const std::vector<int>& t : { std::vector<int>{ 0, 1, 3, 5 }, { 0, 3, 2, 6 },
               { 0, 5, 6, 4 }, { 3, 6, 5, 7 }, { 0, 3, 5, 6 } })
        {
          add(VTK_TETRA, { c[t[0]], c[t[1]], c[t[2]], c[t[3]] });
        }
        break;
      case 3:
        if (polyhedra)
        {
          AddPolyhedron(grid, c);
          break;
        }
        add(VTK_QUADRATIC_TETRA, { c[0], c[1], c[2], c[4], c[3], c[5], c[6], c[7], c[0], c[1] });
        break;
      default:
        add(VTK_PYRAMID, { c[0], c[1], c[3], c[2], c[7] });
        add(VTK_TRIANGLE, { c[4], c[5], c[7] });
        break;
    }
  }
}

template <class Array>
void AddArray(
  vtkDataSetAttributes* attributes, const char* name, int components, vtkIdType count, double time)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(count);
  for (vtkIdType i = 0; i < count; ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      array->SetComponent(i, c, std::sin(0.05 * static_cast<double>(i) + time + c));
    }
  }
  attributes->AddArray(array);
}

void AddValues(vtkUnstructuredGrid* grid, double time)
{
  AddArray<vtkFloatArray>(grid->GetPointData(), "wave", 1, grid->GetNumberOfPoints(), time);
  AddArray<vtkDoubleArray>(grid->GetPointData(), "velocity", 3, grid->GetNumberOfPoints(), time);
  AddArray<vtkFloatArray>(grid->GetCellData(), "wave", 1, grid->GetNumberOfCells(), time);
}

vtkSmartPointer<vtkUnstructuredGrid> CellsAt(vtkAlgorithm* source, double time)
{
  source->UpdateTimeStep(time);
  auto copy = vtkSmartPointer<vtkUnstructuredGrid>::New();
  copy->DeepCopy(source->GetOutputDataObject(0));
  return copy;
}

void ExpectSameCells(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b)
{
  ASSERT_EQ(a->GetNumberOfPoints(), b->GetNumberOfPoints());
  ASSERT_EQ(a->GetNumberOfCells(), b->GetNumberOfCells());
  EXPECT_TRUE(SameBits(a->GetPoints()->GetData(), b->GetPoints()->GetData()));
  vtkNew<vtkIdList> mine, theirs;
  for (vtkIdType cell = 0; cell < a->GetNumberOfCells(); ++cell)
  {
    ASSERT_EQ(a->GetCellType(cell), b->GetCellType(cell)) << cell;
    for (const bool faces : { false, true })
    {
      if (faces)
      {
        a->GetFaceStream(cell, mine);
        b->GetFaceStream(cell, theirs);
      }
      else
      {
        a->GetCellPoints(cell, mine);
        b->GetCellPoints(cell, theirs);
      }
      ASSERT_EQ(mine->GetNumberOfIds(), theirs->GetNumberOfIds()) << cell;
      for (vtkIdType i = 0; i < mine->GetNumberOfIds(); ++i)
      {
        ASSERT_EQ(mine->GetId(i), theirs->GetId(i)) << cell;
      }
    }
  }
}

void ExpectSteps(CellSource* source, vtkAlgorithm* reader)
{
  for (const double time : source->Times)
  {
    const auto original = CellsAt(source, time);
    const auto decoded = CellsAt(reader, time);
    ExpectSameCells(original, decoded);
    for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
    {
      vtkDataSetAttributes* const mine = original->GetAttributes(where);
      for (int i = 0; i < mine->GetNumberOfArrays(); ++i)
      {
        vtkDataArray* const array = mine->GetArray(i);
        vtkDataArray* const other = decoded->GetAttributes(where)->GetArray(array->GetName());
        ASSERT_TRUE(other) << array->GetName();
        EXPECT_EQ(other->GetDataType(), array->GetDataType());
        EXPECT_LE(LargestDifference(array, other), Bound) << array->GetName() << " at " << time;
      }
    }
  }
}

class CellSeries : public testing::TestWithParam<std::tuple<bool, int>>
{
protected:
  CellSeries()
    : Source(vtkSmartPointer<CellSource>::New())
  {
    this->Source->Fill = [this](vtkUnstructuredGrid* grid, double time) { this->Make(grid, time); };
  }

  void Make(vtkUnstructuredGrid* grid, double time) const
  {
    AddPoints(grid, std::get<1>(GetParam()), this->Moving ? this->Moving(time) : 0.0);
    AddCells(grid, std::get<0>(GetParam()));
    AddValues(grid, time);
  }

  banyan::SeriesIndex Index() const { return banyan::SeriesFile::Open(this->Path)->Index(); }

  /// Writes, and expects an error that mentions something.
  void ExpectRefusal(const std::string& mention)
  {
    vtkNew<vtkBanyanSeriesWriter> writer;
    Messages messages(writer);
    writer->SetInputConnection(this->Source->GetOutputPort());
    writer->SetFileName(this->Path.c_str());
    EXPECT_EQ(writer->Write(), 0);
    EXPECT_NE(messages.Errors.find(mention), std::string::npos) << messages.Errors;
    EXPECT_FALSE(std::filesystem::exists(this->Path));
  }

  vtkSmartPointer<CellSource> Source;
  std::function<double(double time)> Moving;
  TemporaryFolder Folder;
  std::string Path = Folder / "cells.banyan";
};

INSTANTIATE_TEST_SUITE_P(Kinds, CellSeries,
  testing::Combine(testing::Bool(), testing::Values(VTK_FLOAT, VTK_DOUBLE)),
  [](const auto& info)
  {
    return std::string(std::get<0>(info.param) ? "Polyhedra" : "Quadratic") +
           (std::get<1>(info.param) == VTK_FLOAT ? "Float32" : "Float64");
  });

TEST_P(CellSeries, CellsOfAllShapesComeBack)
{
  WriteSeries(this->Source, this->Path);
  ExpectSteps(this->Source, Reader(this->Path));
  EXPECT_EQ(banyan::FeaturesOf(this->Index()),
    (std::vector<std::string>{ "mesh", "cell arrays", "any cells" }));
  EXPECT_TRUE(this->Index().Mesh->Moved.empty());
}

TEST_P(CellSeries, PointsThatMoveAreStoredWhenTheyDo)
{
  this->Moving = [](double time) { return time > 0.5 && time < 2.9 ? 0.25 : 0.0; };
  WriteSeries(
    this->Source, this->Path, [](vtkBanyanSeriesWriter* w) { w->SetKeyframeInterval(2); });
  ExpectSteps(this->Source, Reader(this->Path));
  const auto moved = this->Index().Mesh->Moved;
  ASSERT_EQ(moved.size(), 2u); // away, and back
  EXPECT_EQ(moved[0].FirstStep, 1);
  EXPECT_EQ(moved[1].FirstStep, 3);
  // Seeking gives what playing does.
  const auto reader = Reader(this->Path);
  for (const double time : { 3.0, 1.0, 0.0, 2.5 })
  {
    ExpectSameCells(CellsAt(this->Source, time), CellsAt(reader, time));
  }
}

TEST_P(CellSeries, PointsBetweenStepsLieBetween)
{
  this->Moving = [](double time) { return time; };
  WriteSeries(this->Source, this->Path);
  const auto reader = Reader(this->Path);
  reader->SetInterpolateInTime(true);
  const auto middle = CellsAt(reader, 0.5);
  const auto first = CellsAt(reader, 0.0);
  const auto second = CellsAt(reader, 1.0);
  for (vtkIdType i = 0; i < first->GetNumberOfPoints(); ++i)
  {
    double a[3], b[3], m[3];
    first->GetPoint(i, a);
    second->GetPoint(i, b);
    middle->GetPoint(i, m);
    EXPECT_NEAR(m[0], (a[0] + b[0]) / 2.0, 1e-5);
  }
}

TEST_P(CellSeries, PiecesAreRunsOfCells)
{
  WriteSeries(this->Source, this->Path);
  const auto whole = CellsAt(this->Source, 1.0);
  vtkIdType cells = 0;
  for (int piece = 0; piece < 3; ++piece)
  {
    const auto reader = Reader(this->Path);
    reader->UpdateTimeStep(1.0, piece, 3);
    auto* const part = vtkUnstructuredGrid::SafeDownCast(reader->GetOutputDataObject(0));
    ASSERT_GT(part->GetNumberOfCells(), 0);
    EXPECT_LT(part->GetNumberOfPoints(), whole->GetNumberOfPoints());
    vtkNew<vtkIdList> mine, theirs;
    for (vtkIdType cell = 0; cell < part->GetNumberOfCells(); ++cell, ++cells)
    {
      ASSERT_EQ(part->GetCellType(cell), whole->GetCellType(cells));
      EXPECT_NEAR(part->GetCellData()->GetArray("wave")->GetTuple1(cell),
        whole->GetCellData()->GetArray("wave")->GetTuple1(cells), Bound);
      part->GetFaceStream(cell, mine);
      whole->GetFaceStream(cells, theirs);
      ASSERT_EQ(mine->GetNumberOfIds(), theirs->GetNumberOfIds());
      part->GetCellPoints(cell, mine);
      whole->GetCellPoints(cells, theirs);
      for (vtkIdType i = 0; i < mine->GetNumberOfIds(); ++i)
      {
        double a[3], b[3];
        part->GetPoint(mine->GetId(i), a);
        whole->GetPoint(theirs->GetId(i), b);
        EXPECT_EQ(std::vector<double>(a, a + 3), std::vector<double>(b, b + 3));
      }
    }
  }
  EXPECT_EQ(cells, whole->GetNumberOfCells());
}

TEST_P(CellSeries, BoundZeroKeepsEveryBit)
{
  const auto fill = this->Source->Fill;
  this->Source->Fill = [fill](vtkUnstructuredGrid* grid, double time)
  {
    fill(grid, time);
    vtkDataArray* const wave = grid->GetPointData()->GetArray("wave");
    wave->SetTuple1(3, std::numeric_limits<double>::quiet_NaN());
    wave->SetTuple1(5, -std::numeric_limits<double>::infinity());
  };
  WriteSeries(this->Source, this->Path, [](vtkBanyanSeriesWriter* w) { w->SetErrorBound(0.0); });
  const auto original = CellsAt(this->Source, 2.5);
  const auto decoded = CellsAt(Reader(this->Path), 2.5);
  for (const char* name : { "wave", "velocity" })
  {
    EXPECT_TRUE(
      SameBits(original->GetPointData()->GetArray(name), decoded->GetPointData()->GetArray(name)));
  }
  EXPECT_TRUE(
    SameBits(original->GetCellData()->GetArray("wave"), decoded->GetCellData()->GetArray("wave")));
}

TEST_P(CellSeries, ArraysOfOneKindAreEnough)
{
  const auto fill = this->Source->Fill;
  for (const bool ofPoints : { true, false })
  {
    this->Source->Fill = [=](vtkUnstructuredGrid* grid, double time)
    {
      fill(grid, time);
      (ofPoints ? grid->GetAttributes(vtkDataObject::CELL)
                : grid->GetAttributes(vtkDataObject::POINT))
        ->Initialize();
    };
    this->Source->Modified();
    WriteSeries(this->Source, this->Path);
    ExpectSteps(this->Source, Reader(this->Path));
  }
}

TEST_P(CellSeries, CellsWith32BitIdsComeBack)
{
  const auto fill = this->Source->Fill;
  this->Source->Fill = [fill](vtkUnstructuredGrid* grid, double time)
  {
    fill(grid, time);
    grid->GetCells()->ConvertTo32BitStorage();
  };
  WriteSeries(this->Source, this->Path);
  ExpectSteps(this->Source, Reader(this->Path));
}

TEST_P(CellSeries, AnotherTopologyIsRefusedWithItsStep)
{
  const auto fill = this->Source->Fill;
  this->Source->Fill = [fill](vtkUnstructuredGrid* grid, double time)
  {
    fill(grid, time);
    if (time == 2.5)
    {
      grid->GetCells()->ReplaceCellAtId(0, { 0, 1, 7, 6, 36, 37, 42, 43 });
    }
  };
  this->ExpectRefusal("At step 2 (time 2.5): The mesh of a series must not change, and cells have "
                      "other points or types");
}

TEST_P(CellSeries, AnIdThatIsNotThereIsRefused)
{
  const auto fill = this->Source->Fill;
  this->Source->Fill = [fill](vtkUnstructuredGrid* grid, double time)
  {
    fill(grid, time);
    grid->GetCells()->ReplaceCellAtId(0, { 0, 1, 7, 6, 36, 37, 9999, 43 });
  };
  this->ExpectRefusal("Cell 0 refers to point 9999, and the mesh has 216 points");
}

TEST_P(CellSeries, WhatIsNotKeptIsNamed)
{
  const auto fill = this->Source->Fill;
  this->Source->Fill = [fill](vtkUnstructuredGrid* grid, double time)
  {
    fill(grid, time);
    vtkNew<vtkStringArray> names;
    names->SetName("names");
    names->SetNumberOfValues(grid->GetNumberOfPoints());
    grid->GetPointData()->AddArray(names);
  };
  vtkNew<vtkBanyanSeriesWriter> writer;
  Messages messages(writer);
  writer->SetInputConnection(this->Source->GetOutputPort());
  writer->SetFileName(this->Path.c_str());
  EXPECT_EQ(writer->Write(), 1);
  EXPECT_NE(messages.Warnings.find("names are not numbers"), std::string::npos)
    << messages.Warnings;
}

/// Bytes of the mesh, and of moved points, that are changed.
TEST_P(CellSeries, DamagedFilesAreRefusedInASentence)
{
  this->Moving = [](double time) { return time; };
  WriteSeries(this->Source, this->Path);
  const auto mesh = this->Index().Mesh;
  for (const std::string& name : { mesh->File, mesh->Moved[0].File })
  {
    const std::string file = this->Path + ".d/" + name;
    const auto size = std::filesystem::file_size(file);
    char byte = 0;
    {
      std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
      stream.seekg(static_cast<std::streamoff>(size / 2));
      stream.get(byte);
      stream.seekp(static_cast<std::streamoff>(size / 2));
      stream.put(static_cast<char>(byte ^ 16));
    }
    const auto reader = Reader(this->Path);
    const Messages messages(reader);
    reader->UpdateTimeStep(1.0);
    EXPECT_NE(messages.Errors.find("damaged"), std::string::npos) << messages.Errors;
    EXPECT_NE(messages.Errors.find(name), std::string::npos) << messages.Errors;
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(size / 2));
    stream.put(byte);
  }
  ExpectSteps(this->Source, Reader(this->Path));
}

TEST_P(CellSeries, NoHyperTreeGridIsMadeOfThem)
{
  WriteSeries(this->Source, this->Path);
  const auto reader = Reader(this->Path);
  const Messages messages(reader);
  reader->SetMeshAsHyperTreeGrid(true);
  reader->Update();
  EXPECT_NE(messages.Errors.find("is no octree"), std::string::npos) << messages.Errors;
  EXPECT_EQ(reader->GetNumberOfLevels(), 1);
}

} // namespace
