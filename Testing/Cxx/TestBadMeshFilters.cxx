// SPDX-License-Identifier: BSD-3-Clause
// Meshes, trees and images as a program without ParaView may hand them to filters and the writer,
// broken in one way each: a sentence that says what is wrong and of which array, or a result; never
// a crash, and never values that lie behind the end of an array.
// Testing/PvBatch/test_bad_mesh_filters.py does it in ParaView.
#include "VtkIoTesting.h"

#include "vtkBanyanHexOctree.h"
#include "vtkBanyanSeriesWriter.h"
#include "vtkBanyanTemporalEnhancement.h"

#include "vtkBitArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkOverlappingAMR.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkRandomHyperTreeGridSource.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

namespace
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using Data = vtkSmartPointer<vtkDataObject>;

vtkSmartPointer<vtkDoubleArray> Numbers(vtkIdType count, int components, const char* name)
{
  auto numbers = vtkSmartPointer<vtkDoubleArray>::New();
  numbers->SetNumberOfComponents(components);
  numbers->SetNumberOfTuples(count);
  numbers->SetName(name);
  for (vtkIdType i = 0; i < count * components; ++i)
  {
    numbers->SetValue(i, std::sin(0.1 * static_cast<double>(i)));
  }
  return numbers;
}

/// 3 x 3 x 3 hexahedra at unit places, which are bent where `bend` is not 0.
Grid Mesh(double bend = 0.0, const std::function<void(vtkIdType cell, vtkIdType* ids)>& change = {})
{
  auto grid = Grid::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < 64; ++i)
  {
    const double x = i % 4, y = i / 4 % 4, z = i / 16;
    points->InsertNextPoint(x, y, z + bend * std::sin(x + y));
  }
  grid->SetPoints(points);
  grid->Allocate(27);
  for (int cell = 0; cell < 27; ++cell)
  {
    const vtkIdType low = cell % 3 + 4 * (cell / 3 % 3) + 16 * (cell / 9);
    vtkIdType ids[8] = { low, low + 1, low + 5, low + 4, low + 16, low + 17, low + 21, low + 20 };
    if (change)
    {
      change(cell, ids);
    }
    grid->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  }
  grid->GetPointData()->SetScalars(Numbers(64, 1, "value"));
  return grid;
}

vtkSmartPointer<vtkImageData> Image()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(4, 4, 4);
  image->GetPointData()->SetScalars(Numbers(64, 1, "value"));
  return image;
}

vtkSmartPointer<vtkHyperTreeGrid> Trees()
{
  vtkNew<vtkRandomHyperTreeGridSource> source;
  source->SetDimensions(3, 3, 3);
  source->SetMaxDepth(2);
  source->Update();
  vtkSmartPointer<vtkHyperTreeGrid> trees = source->GetHyperTreeGridOutput();
  const vtkIdType cells = trees->GetNumberOfCells();
  trees->GetCellData()->Initialize();
  trees->GetCellData()->SetScalars(Numbers(cells, 1, "value"));
  return trees;
}

template <class Set>
Set Flagged(Set data, int where, vtkIdType count)
{
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->SetNumberOfValues(count);
  flags->Fill(vtkDataSetAttributes::HIDDENPOINT);
  data->GetAttributes(where)->AddArray(flags);
  return data;
}

template <class Set>
Set With(Set data, vtkAbstractArray* array)
{
  data->GetPointData()->Initialize();
  data->GetPointData()->AddArray(array);
  return data;
}

/// What an algorithm said while it worked, or nothing.
std::string SaidBy(vtkAlgorithm* filter, vtkDataObject* input)
{
  Messages messages(filter);
  filter->SetInputDataObject(input);
  filter->Update();
  return messages.Errors;
}

std::string SaidByBoxes(vtkDataObject* input)
{
  vtkNew<vtkBanyanHexOctree> boxes;
  boxes->SampleGeneralMeshesOn();
  return SaidBy(boxes, input);
}

std::string SaidByWriter(vtkDataObject* input)
{
  TemporaryFolder folder;
  vtkNew<vtkBanyanSeriesWriter> writer;
  Messages messages(writer);
  writer->SetInputDataObject(input);
  writer->SetFileName((folder / "a.banyan").c_str());
  const bool written = writer->Write() == 1;
  EXPECT_EQ(written, messages.Errors.empty());
  EXPECT_EQ(folder.Entries().empty(), !messages.Errors.empty());
  return messages.Errors;
}

void Check(const char* what, const std::string& said, const std::string& expected)
{
  if (expected.empty())
  {
    EXPECT_EQ(said, "") << what;
  }
  else
  {
    EXPECT_NE(said.find(expected), std::string::npos)
      << what << ": '" << said << "' has not '" << expected << "'";
  }
}

/// What each has to say; nothing where there is a result.
struct Answers
{
  std::string Octree, Boxes, Series;
};

void Expect(const Data& data, const Answers& answers)
{
  Check("octree", SaidBy(vtkNew<vtkBanyanHexOctree>(), data), answers.Octree);
  Check("boxes", SaidByBoxes(data), answers.Boxes);
  Check("series", SaidByWriter(data), answers.Series);
}

void ExpectEverywhere(const Data& data, const std::string& sentence)
{
  Expect(data, { sentence, sentence, sentence });
}

TEST(BadMeshFiltersInVtk, CellsThatAreNone)
{
  Expect(Grid::New(), { "", "", "The mesh has no cells" });
  const auto noCells = Mesh();
  noCells->SetCells(VTK_HEXAHEDRON, vtkNew<vtkCellArray>());
  Expect(noCells, { "", "", "The mesh has no cells" });
  const auto noPoints = Mesh();
  noPoints->SetPoints(vtkNew<vtkPoints>());
  ExpectEverywhere(noPoints, "has 27 cells, but no points");
  const auto noTypes = Mesh();
  vtkNew<vtkUnsignedCharArray> types;
  types->InsertNextValue(VTK_HEXAHEDRON);
  vtkNew<vtkCellArray> cells;
  cells->DeepCopy(noTypes->GetCells());
  noTypes->SetCells(types, cells);
  ExpectEverywhere(noTypes, "has 27 cells, but the types of 1");
  const auto others = Mesh();
  const vtkIdType ids[] = { 0, 1, 4, 16 };
  others->InsertNextCell(VTK_TETRA, 4, ids);
  others->InsertNextCell(VTK_EMPTY_CELL, 0, ids);
  Expect(others, { "Cell 27 is of the type vtkTetra", "", "" }); // series keep any cells
}

TEST(BadMeshFiltersInVtk, PointsOfCells)
{
  const auto refer = [](vtkIdType to)
  { return Mesh(0.0, [to](vtkIdType cell, vtkIdType* ids) { ids[3] = cell == 7 ? to : ids[3]; }); };
  ExpectEverywhere(refer(64), "Cell 7 refers to point 64");
  ExpectEverywhere(refer(-1), "Cell 7 refers to point -1");
  ExpectEverywhere(refer(vtkIdType{ 1 } << 62), "Cell 7 refers to point 4611686018427387904");
  const auto place = [](vtkIdType point, double x)
  {
    const auto grid = Mesh();
    grid->GetPoints()->SetPoint(point, x, 0.0, 0.0);
    return grid;
  };
  // Series keep points bit by bit.
  Expect(place(1, std::nan("")), { "not finite", "not finite", "" });
  Expect(place(1, HUGE_VAL), { "not finite", "not finite", "" });
  const auto unused = Mesh();
  unused->GetPoints()->InsertNextPoint(std::nan(""), 0.0, 0.0);
  unused->GetPointData()->SetScalars(Numbers(65, 1, "value"));
  Expect(unused, {});
  const auto one = Mesh();
  for (vtkIdType point = 0; point < 64; ++point)
  {
    one->GetPoints()->SetPoint(point, 1.0, 1.0, 1.0);
  }
  Expect(one, { "Cell 0 is flat", "Cell 0 is flat", "" });
}

TEST(BadMeshFiltersInVtk, ArraysOfAnotherLength)
{
  for (const vtkIdType length : { 0, 5, 5000 })
  {
    const std::string says =
      "The point array value has " + std::to_string(length) + " values for 64 points";
    Expect(With(Mesh(), Numbers(length, 1, "value")), { "", "", says });
    Check("boxes", SaidByBoxes(With(Mesh(0.3), Numbers(length, 1, "value"))), says);
    Check("series", SaidByWriter(With(Image(), Numbers(length, 1, "value"))), says);
    const auto ofCells = Mesh();
    ofCells->GetCellData()->AddArray(Numbers(length, 3, "stress"));
    Check("series", SaidByWriter(ofCells),
      "The cell array stress has " + std::to_string(length) + " values for 27 cells");
  }
  const auto trees = Trees();
  trees->GetCellData()->SetScalars(Numbers(5, 1, "value"));
  ExpectEverywhere(trees, "The cell array value of the hyper tree grid has 5 values");
}

TEST(BadMeshFiltersInVtk, FlagsOfAnotherLength)
{
  const std::string cells = "The cell array vtkGhostType has 3 values for 27 cells";
  ExpectEverywhere(Flagged(Mesh(), vtkDataObject::CELL, 3), cells);
  ExpectEverywhere(Flagged(Mesh(0.3), vtkDataObject::CELL, 3), cells);
  Check("series", SaidByWriter(Flagged(Image(), vtkDataObject::CELL, 3)), cells);
  Check("series", SaidByWriter(Flagged(Image(), vtkDataObject::POINT, 3)),
    "The point array vtkGhostType has 3 values for 64 points");
}

TEST(BadMeshFiltersInVtk, ArraysThatAreNoNumbersOrHaveNoName)
{
  vtkNew<vtkStringArray> words;
  words->SetName("words");
  words->SetNumberOfValues(64);
  Expect(With(Mesh(), words), { "", "", "The point arrays words are not numbers" });
  vtkNew<vtkBitArray> bits;
  bits->SetNumberOfTuples(64);
  Expect(With(Mesh(), bits), { "", "", "The point arrays Unnamed0 are not numbers" });
  Expect(With(Mesh(), Numbers(64, 9, "nine")), {});
  Expect(With(Mesh(), Numbers(64, 1, nullptr)), {});
  Check("image without a name", SaidByWriter(With(Image(), Numbers(64, 1, nullptr))), "");
}

TEST(BadMeshFiltersInVtk, ImagesThatAreNowhere)
{
  const auto spaced = Image();
  spaced->SetSpacing(std::nan(""), 1.0, 1.0);
  Check("series", SaidByWriter(spaced), "The origin or the spacing of the image is not finite");
  const auto huge = Image();
  const int last = 2000000; // newer VTKs hold the coordinates along each axis
  huge->SetExtent(0, last, 0, last, 0, 0);
  const auto points = std::to_string((last + 1LL) * (last + 1LL));
  Check("series", SaidByWriter(huge), "has 64 values for " + points + " points");
}

TEST(BadMeshFiltersInVtk, BlocksThatAreNone)
{
  const auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  blocks->SetNumberOfBlocks(3);
  Expect(blocks, { "", "", "the input is vtkMultiBlockDataSet" });
  blocks->SetBlock(1, Mesh());
  Expect(blocks, {});
  const auto parts = vtkSmartPointer<vtkPartitionedDataSet>::New();
  parts->SetNumberOfPartitions(3);
  parts->SetPartition(2, Mesh());
  Expect(parts, {});
  const auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  collection->SetNumberOfPartitionedDataSets(2);
  collection->SetPartition(1, 1, Mesh());
  Expect(collection, {});
  blocks->SetBlock(0, Image());
  Expect(blocks, { "an unstructured grid cannot hold", "an unstructured grid cannot hold",
                   "the input is vtkMultiBlockDataSet" });
  const auto amr = vtkSmartPointer<vtkOverlappingAMR>::New();
  Expect(amr, { "", "", "The mesh has no cells" });
  const int sizes[] = { 1, 2 };
  amr->Initialize(2, sizes);
  Expect(amr, { "", "", "The mesh has no cells" });
}

/// Values are looked at alone, whatever the mesh is.
TEST(BadMeshFiltersInVtk, Waves)
{
  for (const Data& data : { Data(Trees()), Data(Image()), Data(Grid::New()),
         Data(Flagged(Mesh(), vtkDataObject::CELL, 3)) })
  {
    // Active scalars, which VTK finds in the cells of trees when it is asked for points.
    Check(data->GetClassName(), SaidBy(vtkNew<vtkBanyanTemporalEnhancement>(), data), "");
  }
  const auto trees = Trees();
  vtkNew<vtkBanyanTemporalEnhancement> waves;
  waves->SetInputDataObject(trees);
  waves->Update();
  auto* const enhanced = vtkHyperTreeGrid::SafeDownCast(waves->GetOutputDataObject(0));
  ASSERT_NE(enhanced->GetCellData()->GetArray("value_enhanced"), nullptr);
  EXPECT_EQ(enhanced->GetCellData()->GetArray("value_enhanced")->GetNumberOfTuples(),
    trees->GetNumberOfCells());
}

} // namespace
