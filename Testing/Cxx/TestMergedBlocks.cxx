// SPDX-License-Identifier: BSD-3-Clause
// Blocks that are drawn as one mesh: what VTK's own filter makes of them, but cells are merged
// once.
#include "CellArrays.h"
#include "MergedBlocks.h"

#include "vtkAppendFilter.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkRectilinearGrid.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using Blocks = std::vector<vtkSmartPointer<vtkDataSet>>;

template <class Array>
void Add(vtkDataSetAttributes* to, const char* name, int components, vtkIdType count, double first)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  for (vtkIdType i = 0; i < count * components; ++i)
  {
    array->InsertNextValue(static_cast<typename Array::ValueType>(first + static_cast<double>(i)));
  }
  to->AddArray(array);
}

/// A row of cubes.
vtkSmartPointer<vtkUnstructuredGrid> Row(int cubes, double at, int step, double moved = 0.0)
{
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  for (int x = 0; x <= cubes; ++x)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      points->InsertNextPoint(at + x, corner & 1, (corner >> 1) + moved);
    }
  }
  grid->SetPoints(points);
  grid->Allocate(cubes);
  for (vtkIdType x = 0; x < cubes; ++x)
  {
    const vtkIdType low = 4 * x;
    const vtkIdType ids[8] = { low, low + 4, low + 5, low + 1, low + 2, low + 6, low + 7, low + 3 };
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  }
  Add<vtkFloatArray>(grid->GetPointData(), "velocity", 3, points->GetNumberOfPoints(), 10.0 * step);
  Add<vtkDoubleArray>(grid->GetPointData(), "pressure", 1, points->GetNumberOfPoints(), -step);
  Add<vtkIntArray>(grid->GetCellData(), "block", 1, cubes, at);
  grid->GetPointData()->SetActiveScalars("pressure");
  grid->GetPointData()->SetActiveVectors("velocity");
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> Appended(const Blocks& blocks)
{
  vtkNew<vtkAppendFilter> append;
  for (const auto& block : blocks)
  {
    append->AddInputData(block);
  }
  append->Update();
  return append->GetOutput();
}

void ExpectSame(vtkDataArray* a, vtkDataArray* b)
{
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->GetDataType(), b->GetDataType());
  ASSERT_EQ(a->GetNumberOfComponents(), b->GetNumberOfComponents());
  ASSERT_EQ(a->GetNumberOfTuples(), b->GetNumberOfTuples());
  for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      ASSERT_EQ(a->GetComponent(i, c), b->GetComponent(i, c)) << a->GetName() << " at " << i;
    }
  }
}

void ExpectSame(vtkDataSetAttributes* a, vtkDataSetAttributes* b)
{
  ASSERT_EQ(a->GetNumberOfArrays(), b->GetNumberOfArrays());
  for (int i = 0; i < a->GetNumberOfArrays(); ++i)
  {
    ExpectSame(a->GetArray(i), b->GetArray(a->GetArray(i)->GetName()));
  }
  for (int kind = 0; kind < vtkDataSetAttributes::NUM_ATTRIBUTES; ++kind)
  {
    vtkAbstractArray* const one = a->GetAbstractAttribute(kind);
    vtkAbstractArray* const other = b->GetAbstractAttribute(kind);
    ASSERT_EQ(!one, !other) << kind;
    EXPECT_TRUE(!one || std::string(one->GetName()) == other->GetName());
  }
}

void ExpectAppended(vtkUnstructuredGrid* merged, const Blocks& blocks)
{
  const auto expected = Appended(blocks);
  ASSERT_EQ(expected->GetNumberOfCells(), merged->GetNumberOfCells());
  ExpectSame(expected->GetPoints()->GetData(), merged->GetPoints()->GetData());
  ExpectSame(
    expected->GetCells()->GetConnectivityArray(), merged->GetCells()->GetConnectivityArray());
  ExpectSame(expected->GetCells()->GetOffsetsArray(), merged->GetCells()->GetOffsetsArray());
  ExpectSame(banyan::CellTypesOf(expected), banyan::CellTypesOf(merged));
  ExpectSame(expected->GetPointData(), merged->GetPointData());
  ExpectSame(expected->GetCellData(), merged->GetCellData());
}

} // namespace

TEST(MergedBlocks, CellsAreMergedOnce)
{
  banyan::MergedBlocks merged;
  for (int step = 0; step < 4; ++step)
  {
    const Blocks blocks{ Row(3, 0.0, step), Row(1, 5.0, step + 1), Row(2, 9.0, step + 2) };
    ExpectAppended(merged.Of(blocks), blocks);
  }
  EXPECT_EQ(merged.CellsMerged(), 1);
  // Points may move.
  const Blocks moved{ Row(3, 0.0, 1, 0.5), Row(1, 5.0, 2), Row(2, 9.0, 3) };
  ExpectAppended(merged.Of(moved), moved);
  EXPECT_EQ(merged.CellsMerged(), 1);
}

TEST(MergedBlocks, OtherCellsOrArraysAreNoticed)
{
  banyan::MergedBlocks merged;
  int count = 0;
  const auto expect = [&](const Blocks& blocks)
  {
    ExpectAppended(merged.Of(blocks), blocks);
    EXPECT_EQ(merged.CellsMerged(), ++count);
  };
  expect({ Row(3, 0.0, 0), Row(1, 5.0, 0) });
  expect({ Row(2, 0.0, 0), Row(2, 5.0, 0) }); // as many cells
  const auto turned = Row(2, 0.0, 0);
  turned->GetCells()->GetConnectivityArray()->SetComponent(0, 0, 1.0);
  expect({ turned, Row(2, 5.0, 0) });
  const auto more = Row(2, 0.0, 0);
  Add<vtkFloatArray>(more->GetPointData(), "more", 1, more->GetNumberOfPoints(), 0.0);
  expect({ more, Row(2, 5.0, 0) }); // which only one block has
  const auto also = Row(2, 5.0, 0);
  Add<vtkFloatArray>(also->GetPointData(), "more", 1, also->GetNumberOfPoints(), 7.0);
  expect({ more, also });
  more->GetPointData()->SetActiveScalars("more");
  expect({ more, also });
  const auto other = Row(2, 5.0, 0);
  Add<vtkIntArray>(other->GetPointData(), "more", 1, other->GetNumberOfPoints(), 7.0);
  expect({ more, other });
  const auto fewer = Row(2, 0.0, 0);
  fewer->GetPointData()->RemoveArray("pressure");
  expect({ fewer, Row(2, 5.0, 0) });
}

TEST(MergedBlocks, OneBlockIsHandedOn)
{
  banyan::MergedBlocks merged;
  const Blocks one{ Row(3, 0.0, 0) };
  const auto grid = merged.Of(one);
  ExpectAppended(grid, one);
  EXPECT_EQ(grid->GetCells()->GetConnectivityArray(),
    vtkUnstructuredGrid::SafeDownCast(one[0])->GetCells()->GetConnectivityArray());
}

TEST(MergedBlocks, OneBlockOfAnyTypeStaysAsItIs)
{
  banyan::MergedBlocks merged;
  vtkNew<vtkRectilinearGrid> boxes;
  boxes->SetDimensions(2, 3, 4);
  const vtkSmartPointer<vtkDataSet> one = boxes.GetPointer();
  EXPECT_EQ(merged.AsOne({ one }), one);
  EXPECT_EQ(merged.CellsMerged(), 0);
  // Blocks of several kinds become cells.
  const auto both = merged.AsOne({ one, Row(3, 0.0, 0) });
  ASSERT_TRUE(vtkUnstructuredGrid::SafeDownCast(both));
  EXPECT_EQ(both->GetNumberOfCells(), 6 + 3);
}

TEST(MergedBlocks, FacesOfPolyhedraAreTakenAnew)
{
  // A cube whose last side is one square, or two triangles.
  const auto cube = [](bool cut)
  {
    const auto grid = Row(1, 0.0, 0);
    vtkNew<vtkUnstructuredGrid> polyhedron;
    polyhedron->SetPoints(grid->GetPoints());
    vtkNew<vtkIdList> faces;
    faces->InsertNextId(cut ? 7 : 6);
    for (const std::vector<vtkIdType>& face : { std::vector<vtkIdType>{ 0, 1, 3, 2 },
           { 4, 6, 7, 5 }, { 0, 4, 5, 1 }, { 2, 3, 7, 6 }, { 0, 2, 6, 4 } })
    {
      faces->InsertNextId(4);
      std::for_each(face.begin(), face.end(), [&](vtkIdType id) { faces->InsertNextId(id); });
    }
    const std::vector<vtkIdType> side = cut ? std::vector<vtkIdType>{ 3, 1, 5, 7, 3, 1, 7, 3 }
                                            : std::vector<vtkIdType>{ 4, 1, 5, 7, 3 };
    std::for_each(side.begin(), side.end(), [&](vtkIdType id) { faces->InsertNextId(id); });
    polyhedron->Allocate(1);
    polyhedron->InsertNextCell(VTK_POLYHEDRON, faces);
    return vtkSmartPointer<vtkDataSet>(polyhedron.GetPointer());
  };
  banyan::MergedBlocks merged;
  for (const bool cut : { false, true })
  {
    const auto grid = merged.Of({ cube(cut), cube(cut) });
    vtkNew<vtkIdList> faces;
    grid->GetFaceStream(1, faces);
    EXPECT_EQ(faces->GetId(0), cut ? 7 : 6);
  }
}
