// SPDX-License-Identifier: BSD-3-Clause
// Data of VTK as one view of cells: every kind of grid, type and layout of arrays.
#include "MeshVolume.h"

#include "AnyMesh/CellMeshOfData.h"

#include "Base/Error.h"

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkExplicitStructuredGrid.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkWeakPointer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace
{

using banyan::CellMesh;
using banyan::CellMeshOf;
using banyan::MeshOfData;
using banyan::ScalarType;
using banyan::ValuesOn;
using banyan::testing::VolumeByVtk;
using banyan::testing::Volumes;
using banyan::testing::VolumesOf;

/// A box of cells between (n + 1) x 3 x 3 points, sheared so that faces stay flat.
vtkSmartPointer<vtkPoints> SlantedPoints(int size, int type)
{
  const auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(type);
  for (int z = 0; z < 3; ++z)
  {
    for (int y = 0; y < 3; ++y)
    {
      for (int x = 0; x < size; ++x)
      {
        points->InsertNextPoint(x + 0.25 * y + 1.0, 2.0 * y, 0.75 * z + 0.125 * x * x);
      }
    }
  }
  return points;
}

vtkSmartPointer<vtkStructuredGrid> Slanted(int size, int type = VTK_FLOAT)
{
  const auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
  grid->SetDimensions(size, 3, 3);
  grid->SetPoints(SlantedPoints(size, type));
  return grid;
}

/// Each cell of these points has this volume.
constexpr double SlantedCell = 1.0 * 2.0 * 0.75;

/// One cell of each linear type, apart from the others.
vtkSmartPointer<vtkUnstructuredGrid> AllTypes(int pointType = VTK_FLOAT)
{
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(pointType);
  const auto add = [&](int type, const std::vector<std::array<double, 3>>& corners)
  {
    std::vector<vtkIdType> ids;
    const double apart = 4.0 * static_cast<double>(grid->GetNumberOfCells());
    for (const auto& at : corners)
    {
      // VTK takes voxels for boxes along the axes.
      const double slant = type == VTK_VOXEL ? 0.0 : 0.25;
      ids.push_back(points->InsertNextPoint(
        at[0] + slant * at[1] + apart, at[1] - slant * at[2], at[2] + slant * at[0]));
    }
    grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data());
  };
  grid->Allocate(5);
  add(VTK_TETRA, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } });
  add(VTK_VOXEL, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
                   { 0, 1, 1 }, { 1, 1, 1 } });
  add(VTK_HEXAHEDRON, { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 2 },
                        { 1, 0, 2 }, { 1, 1, 2 }, { 0, 1, 2 } });
  add(VTK_WEDGE, { { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 3 }, { 0, 1, 3 }, { 1, 0, 3 } });
  add(VTK_PYRAMID, { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0.5, 4 } });
  grid->SetPoints(points);
  return grid;
}

void SetFlags(vtkDataSetAttributes* attributes, const std::vector<int>& values)
{
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const int value : values)
  {
    flags->InsertNextValue(static_cast<unsigned char>(value));
  }
  attributes->AddArray(flags);
}

std::vector<int> HiddenOf(const CellMesh& mesh)
{
  return mesh.Hidden ? std::vector<int>(mesh.Hidden, mesh.Hidden + mesh.CellCount)
                     : std::vector<int>{};
}

void ExpectProblem(vtkDataSet* data, const std::string& sentence)
{
  try
  {
    (void)CellMeshOf(data);
    ADD_FAILURE() << "nothing is thrown";
  }
  catch (const banyan::Error& error)
  {
    EXPECT_EQ(error.what(), sentence);
  }
}

void ExpectSlanted(const CellMesh& mesh, int size, double tolerance)
{
  const Volumes volumes = VolumesOf(mesh);
  EXPECT_EQ(volumes.Count, 4 * (size - 1));
  EXPECT_NEAR(volumes.Least, SlantedCell, tolerance);
  EXPECT_NEAR(volumes.Sum, volumes.Count * SlantedCell, tolerance);
}

template <class Array>
vtkSmartPointer<vtkDataArray> Axis(const std::vector<double>& places)
{
  const auto axis = vtkSmartPointer<Array>::New();
  for (const double place : places)
  {
    axis->InsertNextValue(static_cast<typename Array::ValueType>(place));
  }
  return axis;
}

} // namespace

TEST(CellMeshOfData, LinearCellsAreTakenWhereTheyAre)
{
  for (const int pointType : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto grid = AllTypes(pointType);
    const MeshOfData taken = CellMeshOf(grid);
    const CellMesh& mesh = taken.Mesh;
    EXPECT_EQ(mesh.Is, CellMesh::Kind::Cells);
    EXPECT_EQ(mesh.CellCount, 5);
    EXPECT_EQ(mesh.PointCount, grid->GetNumberOfPoints());
    EXPECT_EQ(mesh.PointType, pointType == VTK_FLOAT ? ScalarType::Float32 : ScalarType::Float64);
    EXPECT_EQ(mesh.IdType, ScalarType::Int64);
    EXPECT_EQ(mesh.Points, grid->GetPoints()->GetVoidPointer(0));
    EXPECT_EQ(mesh.Connectivity, grid->GetCells()->GetConnectivityArray()->GetVoidPointer(0));
    EXPECT_EQ(mesh.Offsets, grid->GetCells()->GetOffsetsArray()->GetVoidPointer(0));
    EXPECT_EQ(mesh.Hidden, nullptr);
    EXPECT_FALSE(taken.Parts);
    EXPECT_EQ(taken.Others.Count, 0);
    const Volumes volumes = VolumesOf(mesh);
    EXPECT_EQ(volumes.Count, 5);
    EXPECT_GT(volumes.Least, 0.0);
    EXPECT_NEAR(volumes.Sum, VolumeByVtk(grid), 1e-5);
  }
}

TEST(CellMeshOfData, IdsOfEitherSize)
{
  const auto grid = AllTypes();
  const double volume = VolumesOf(CellMeshOf(grid).Mesh).Sum;
  grid->GetCells()->ConvertTo32BitStorage();
  const MeshOfData taken = CellMeshOf(grid);
  EXPECT_EQ(taken.Mesh.IdType, ScalarType::Int32);
  EXPECT_EQ(taken.Mesh.Connectivity, grid->GetCells()->GetConnectivityArray()->GetVoidPointer(0));
  EXPECT_EQ(taken.Mesh.Offsets, grid->GetCells()->GetOffsetsArray()->GetVoidPointer(0));
  EXPECT_EQ(VolumesOf(taken.Mesh).Sum, volume);
}

TEST(CellMeshOfData, OtherPointsAreCopied)
{
  const auto floats = AllTypes();
  const auto places = [](const CellMesh& mesh)
  {
    std::vector<std::array<double, 3>> all;
    for (std::int64_t point = 0; point < mesh.PointCount; ++point)
    {
      const glm::dvec3 at = mesh.Point(point);
      all.push_back({ at.x, at.y, at.z });
    }
    return all;
  };
  const auto expected = places(CellMeshOf(floats).Mesh);
  vtkNew<vtkSOADataArrayTemplate<float>> columns;
  columns->DeepCopy(floats->GetPoints()->GetData());
  const auto apart = AllTypes();
  apart->GetPoints()->SetData(columns);
  const MeshOfData taken = CellMeshOf(apart);
  EXPECT_EQ(taken.Mesh.PointType, ScalarType::Float32);
  EXPECT_EQ(places(taken.Mesh), expected);
  const auto ints = Slanted(3);
  vtkNew<vtkPoints> whole;
  whole->SetDataType(VTK_INT);
  whole->DeepCopy(Slanted(3)->GetPoints());
  ints->SetPoints(whole);
  ASSERT_EQ(ints->GetPoints()->GetDataType(), VTK_INT);
  const MeshOfData rounded = CellMeshOf(ints);
  EXPECT_EQ(rounded.Mesh.PointType, ScalarType::Float64);
  double at[3];
  ints->GetPoint(25, at);
  EXPECT_EQ(rounded.Mesh.Point(25), glm::dvec3(at[0], at[1], at[2]));
}

TEST(CellMeshOfData, CurvilinearGridsNeedNoIds)
{
  for (const int type : { VTK_FLOAT, VTK_DOUBLE })
  {
    const auto grid = Slanted(4, type);
    const MeshOfData taken = CellMeshOf(grid);
    EXPECT_EQ(taken.Mesh.Is, CellMesh::Kind::Curvilinear);
    EXPECT_EQ(taken.Mesh.Size, glm::ivec3(4, 3, 3));
    EXPECT_EQ(taken.Mesh.Points, grid->GetPoints()->GetVoidPointer(0));
    EXPECT_EQ(taken.Mesh.CellCount, grid->GetNumberOfCells());
    EXPECT_EQ(taken.Mesh.PointCount, grid->GetNumberOfPoints());
    ExpectSlanted(taken.Mesh, 4, 1e-9);
    EXPECT_NEAR(VolumesOf(taken.Mesh).Sum, VolumeByVtk(grid), 1e-5);
  }
}

TEST(CellMeshOfData, RectilinearAxesOfAnyTypes)
{
  const std::vector<double> x{ 0.0, 0.5, 2.0, 2.25 };
  const std::vector<double> y{ -1.0, 3.0 };
  const std::vector<double> z{ 10.0, 11.0, 15.0 };
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(4, 2, 3);
  const auto expect = [&](ScalarType type, bool where)
  {
    const MeshOfData taken = CellMeshOf(grid);
    EXPECT_EQ(taken.Mesh.Is, CellMesh::Kind::Rectilinear);
    EXPECT_EQ(taken.Mesh.Size, glm::ivec3(4, 2, 3));
    EXPECT_EQ(taken.Mesh.CellCount, 6);
    EXPECT_EQ(taken.Mesh.PointCount, 24);
    EXPECT_EQ(taken.Mesh.PointType, type);
    EXPECT_EQ(taken.Mesh.Axes[1] == grid->GetYCoordinates()->GetVoidPointer(0), where);
    EXPECT_EQ(VolumesOf(taken.Mesh).Sum, 2.25 * 4.0 * 5.0);
    EXPECT_EQ(VolumesOf(taken.Mesh).Least, 0.25 * 4.0 * 1.0);
    EXPECT_NEAR(VolumeByVtk(grid), 2.25 * 4.0 * 5.0, 1e-9);
    EXPECT_EQ(taken.Mesh.Point(23), glm::dvec3(2.25, 3.0, 15.0));
  };
  grid->SetXCoordinates(Axis<vtkFloatArray>(x));
  grid->SetYCoordinates(Axis<vtkFloatArray>(y));
  grid->SetZCoordinates(Axis<vtkFloatArray>(z));
  expect(ScalarType::Float32, true);
  grid->SetXCoordinates(Axis<vtkDoubleArray>(x));
  expect(ScalarType::Float64, false);
  grid->SetYCoordinates(Axis<vtkIntArray>(y));
  expect(ScalarType::Float64, false);
  grid->SetYCoordinates(Axis<vtkDoubleArray>(y));
  grid->SetZCoordinates(Axis<vtkDoubleArray>(z));
  expect(ScalarType::Float64, true);
}

TEST(CellMeshOfData, ExplicitStructuredGrids)
{
  vtkNew<vtkExplicitStructuredGrid> grid;
  grid->SetDimensions(4, 3, 3);
  grid->SetPoints(SlantedPoints(4, VTK_DOUBLE));
  vtkNew<vtkCellArray> cells;
  const auto curvilinear = Slanted(4, VTK_DOUBLE);
  for (vtkIdType cell = 0; cell < curvilinear->GetNumberOfCells(); ++cell)
  {
    vtkNew<vtkIdList> ids;
    curvilinear->GetCellPoints(cell, ids);
    cells->InsertNextCell(ids);
  }
  grid->SetCells(cells);
  const MeshOfData taken = CellMeshOf(grid);
  EXPECT_EQ(taken.Mesh.Is, CellMesh::Kind::Cells);
  EXPECT_EQ(taken.Mesh.Connectivity, cells->GetConnectivityArray()->GetVoidPointer(0));
  ExpectSlanted(taken.Mesh, 4, 1e-9);
  grid->BlankCell(2);
  EXPECT_EQ(VolumesOf(CellMeshOf(grid).Mesh).Count, 11);
}

TEST(CellMeshOfData, CellsOfOthersAndBlankedOnesAreHidden)
{
  const auto grid = AllTypes();
  SetFlags(grid->GetCellData(),
    { vtkDataSetAttributes::DUPLICATECELL, vtkDataSetAttributes::HIDDENCELL,
      vtkDataSetAttributes::REFINEDCELL, vtkDataSetAttributes::EXTERIORCELL, 0 });
  const MeshOfData taken = CellMeshOf(grid);
  EXPECT_EQ(HiddenOf(taken.Mesh), (std::vector<int>{ 1, 1, 1, 0, 0 }));
  EXPECT_EQ(VolumesOf(taken.Mesh).Count, 2);
  SetFlags(grid->GetCellData(), { 0, 0, 0, vtkDataSetAttributes::EXTERIORCELL, 0 });
  EXPECT_EQ(CellMeshOf(grid).Mesh.Hidden, nullptr);
}

TEST(CellMeshOfData, CellsAtBlankedPointsAreHidden)
{
  const auto cells = AllTypes();
  std::vector<int> flags(static_cast<std::size_t>(cells->GetNumberOfPoints()), 0);
  flags[0] = vtkDataSetAttributes::DUPLICATEPOINT;
  flags[4 + 8 + 7] = vtkDataSetAttributes::HIDDENPOINT; // the last corner of the third cell
  SetFlags(cells->GetPointData(), flags);
  EXPECT_EQ(HiddenOf(CellMeshOf(cells).Mesh), (std::vector<int>{ 0, 0, 1, 0, 0 }));
  const auto curvilinear = Slanted(4);
  curvilinear->BlankPoint(0);
  curvilinear->BlankCell(11);
  const MeshOfData taken = CellMeshOf(curvilinear);
  std::vector<int> expected(12, 0);
  expected.front() = 1;
  expected.back() = 1;
  EXPECT_EQ(HiddenOf(taken.Mesh), expected);
  EXPECT_EQ(VolumesOf(taken.Mesh).Count, 10);
  vtkNew<vtkRectilinearGrid> rectilinear;
  rectilinear->SetDimensions(3, 3, 3);
  const std::vector<double> axis{ 0.0, 1.0, 2.0 };
  rectilinear->SetXCoordinates(Axis<vtkFloatArray>(axis));
  rectilinear->SetYCoordinates(Axis<vtkFloatArray>(axis));
  rectilinear->SetZCoordinates(Axis<vtkFloatArray>(axis));
  flags.assign(27, 0);
  flags[4] = vtkDataSetAttributes::HIDDENPOINT; // in the middle of the lowest face
  SetFlags(rectilinear->GetPointData(), flags);
  EXPECT_EQ(HiddenOf(CellMeshOf(rectilinear).Mesh), (std::vector<int>{ 1, 1, 1, 1, 0, 0, 0, 0 }));
}

TEST(CellMeshOfData, ArraysLiveAsLongAsTheMesh)
{
  vtkWeakPointer<vtkDataArray> points;
  vtkWeakPointer<vtkDataArray> ids;
  vtkWeakPointer<vtkDataArray> axis;
  {
    auto grid = AllTypes();
    vtkNew<vtkRectilinearGrid> rectilinear;
    rectilinear->SetDimensions(2, 2, 2);
    rectilinear->SetXCoordinates(Axis<vtkFloatArray>({ 0.0, 1.0 }));
    rectilinear->SetYCoordinates(Axis<vtkFloatArray>({ 0.0, 1.0 }));
    rectilinear->SetZCoordinates(Axis<vtkFloatArray>({ 0.0, 3.0 }));
    points = grid->GetPoints()->GetData();
    ids = grid->GetCells()->GetConnectivityArray();
    axis = rectilinear->GetZCoordinates();
    const CellMesh cells = CellMeshOf(grid).Mesh;
    const CellMesh boxes = CellMeshOf(rectilinear).Mesh;
    const double volume = VolumesOf(cells).Sum;
    grid = nullptr;
    rectilinear->Initialize();
    ASSERT_TRUE(points && ids && axis);
    EXPECT_EQ(VolumesOf(cells).Sum, volume);
    EXPECT_EQ(VolumesOf(boxes).Sum, 3.0);
  }
  EXPECT_FALSE(points || ids || axis) << "and no longer";
}

TEST(CellMeshOfData, CellsOfFewerDimensionsAreCounted)
{
  const auto grid = AllTypes();
  const vtkIdType corners[4]{ 0, 1, 2, 3 };
  grid->InsertNextCell(VTK_EMPTY_CELL, 0, corners);
  grid->InsertNextCell(VTK_LINE, 2, corners);
  grid->InsertNextCell(VTK_QUADRATIC_TRIANGLE, 6, std::vector<vtkIdType>(6, 0).data());
  grid->InsertNextCell(VTK_LAGRANGE_HEXAHEDRON, 8, std::vector<vtkIdType>(8, 0).data());
  const MeshOfData taken = CellMeshOf(grid);
  EXPECT_EQ(taken.Others.Text(), "3 cells, cell 6 of the type vtkLine the first of them");
  EXPECT_FALSE(taken.Parts);
  EXPECT_EQ(taken.Mesh.CellCount, 9);
  EXPECT_EQ(VolumesOf(taken.Mesh).Count, 5);
  vtkNew<vtkUnstructuredGrid> flat;
  flat->SetPoints(grid->GetPoints());
  flat->Allocate(1);
  flat->InsertNextCell(VTK_QUAD, 4, corners);
  EXPECT_EQ(CellMeshOf(flat).Mesh.CellCount, 0);
  EXPECT_EQ(CellMeshOf(flat).Others.Text(), "1 cell, cell 0 of the type vtkQuad");
  vtkNew<vtkStructuredGrid> sheet;
  sheet->SetDimensions(4, 1, 3);
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(12);
  sheet->SetPoints(points);
  EXPECT_EQ(CellMeshOf(sheet).Mesh.CellCount, 0);
  EXPECT_EQ(
    CellMeshOf(sheet).Others.Text(), "6 cells, cell 0 of the type vtkQuad the first of them");
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(grid->GetPoints());
  surface->Allocate(1);
  surface->InsertNextCell(VTK_TRIANGLE, 3, corners);
  EXPECT_EQ(CellMeshOf(surface).Mesh.CellCount, 0);
  EXPECT_EQ(CellMeshOf(surface).Others.Type, "vtkTriangle");
}

TEST(CellMeshOfData, NothingIsAMeshWithoutCells)
{
  EXPECT_EQ(CellMeshOf(nullptr).Mesh.CellCount, 0);
  EXPECT_EQ(CellMeshOf(vtkNew<vtkUnstructuredGrid>()).Mesh.CellCount, 0);
  EXPECT_EQ(CellMeshOf(vtkNew<vtkStructuredGrid>()).Mesh.CellCount, 0);
  EXPECT_EQ(CellMeshOf(vtkNew<vtkRectilinearGrid>()).Mesh.CellCount, 0);
  EXPECT_EQ(CellMeshOf(vtkNew<vtkExplicitStructuredGrid>()).Mesh.CellCount, 0);
}

TEST(CellMeshOfData, ValuesAreHandedOn)
{
  const auto grid = AllTypes();
  const MeshOfData taken = CellMeshOf(grid);
  vtkDataArray* const points = grid->GetPoints()->GetData();
  EXPECT_EQ(taken.ValuesOf(points, ValuesOn::Points), points);
  EXPECT_EQ(taken.ValuesOf(nullptr, ValuesOn::Cells), nullptr);
}

TEST(CellMeshOfData, ShortArraysAreRefused)
{
  const auto curvilinear = Slanted(4);
  curvilinear->GetPoints()->SetNumberOfPoints(35);
  ExpectProblem(curvilinear, "The grid has 35 points in place of 36.");
  curvilinear->SetPoints(nullptr);
  ExpectProblem(curvilinear, "The grid has 0 points in place of 36.");
  vtkNew<vtkRectilinearGrid> rectilinear;
  rectilinear->SetDimensions(2, 3, 2);
  rectilinear->SetXCoordinates(Axis<vtkFloatArray>({ 0.0, 1.0 }));
  rectilinear->SetYCoordinates(Axis<vtkFloatArray>({ 0.0, 1.0 }));
  ExpectProblem(rectilinear, "The grid has 2 coordinates along y in place of 3.");
  const auto grid = AllTypes();
  SetFlags(grid->GetCellData(), { 0, 0, 1 });
  ExpectProblem(grid, "The cell array vtkGhostType has 3 values for 5 cells.");
  grid->GetCellData()->Initialize();
  SetFlags(grid->GetPointData(), { 2 });
  ExpectProblem(grid, "The point array vtkGhostType has 1 values for 31 points.");
  grid->GetPointData()->Initialize();
  grid->SetPoints(vtkNew<vtkPoints>());
  ExpectProblem(grid, "The mesh has 5 cells, but no points");
}
