// SPDX-License-Identifier: BSD-3-Clause
// Values at points of linear parts, whatever the cells and the values are.
#include "LinearPartsTesting.h"

namespace
{

using namespace linear_parts;

TEST(LinearParts, CollapsedCellsCountTheirPointsOnce)
{
  // A hexahedron whose upper face is one edge: its middle face points are means of fewer.
  Places places = PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8));
  const auto grid = Empty();
  AddPoints(grid, places);
  std::vector<vtkIdType> ids(20);
  std::iota(ids.begin(), ids.end(), vtkIdType{ 0 });
  ids[7] = 4; // corners 4 and 7, 5 and 6 are one, and so are the middles between
  ids[6] = 5;
  ids[15] = 4;
  ids[13] = 5;
  ids[14] = 12;
  grid->InsertNextCell(VTK_QUADRATIC_HEXAHEDRON, 20, ids.data());
  const LinearParts parts = *LinearPartsOf(grid);
  std::size_t source = 0;
  for (const std::size_t end : parts.NewPoints.Ends)
  {
    std::set<vtkIdType> seen;
    double sum = 0.0;
    for (; source < end; ++source)
    {
      EXPECT_TRUE(seen.insert(parts.NewPoints.Sources[source]).second);
      sum += parts.NewPoints.Weights[source];
    }
    EXPECT_NEAR(sum, 1.0, 1e-15);
  }
}

TEST(LinearParts, PointsWhoseWeightsCancelDoNotCount)
{
  // Two corners and the middle between them are one point. In faces along this edge its weights are
  // twice -1/4, and 1/2.
  const auto grid = Empty();
  AddPoints(grid, PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8)));
  std::vector<vtkIdType> ids(20);
  std::iota(ids.begin(), ids.end(), vtkIdType{ 0 });
  ids[1] = 0;
  ids[8] = 0;
  grid->InsertNextCell(VTK_QUADRATIC_HEXAHEDRON, 20, ids.data());
  const LinearParts parts = *LinearPartsOf(grid);
  EXPECT_TRUE(std::none_of(parts.NewPoints.Weights.begin(), parts.NewPoints.Weights.end(),
    [](double weight) { return weight == 0.0; }));
  const auto values = ValuesAt<vtkFloatArray>(grid, [](const Place&) { return 1.0; });
  values->SetTuple1(0, std::nan(""));
  const auto taken = parts.PointValues(values);
  int missing = 0;
  for (vtkIdType point = 20; point < taken->GetNumberOfTuples(); ++point)
  {
    missing += std::isnan(taken->GetTuple1(point)) ? 1 : 0;
  }
  // The faces at both ends of the edge, and the middle of all: there they are twice -1/4, and 1/4.
  EXPECT_EQ(missing, 3);
}

TEST(LinearParts, PlacesThatAreNoNumbersHarmNoOthers)
{
  const auto grid = Empty();
  Places places = PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8));
  for (std::size_t point = 0; point < 20; point += 2)
  {
    places[point].x = std::nan("");
  }
  AddCell(grid, VTK_QUADRATIC_HEXAHEDRON, places);
  AddCell(grid, VTK_QUADRATIC_WEDGE, PlacesOf(VTK_QUADRATIC_WEDGE, CornersOf(6)));
  AddCell(grid, VTK_CONVEX_POINT_SET, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
  const MeshOfData taken = CellMeshOf(grid);
  ASSERT_EQ(taken.Mesh.CellCount, 16);
  double sum = 0.0;
  for (std::int64_t cell = 8; cell < 16; ++cell)
  {
    sum += banyan::testing::VolumeOf(taken.Mesh, taken.Mesh.Cell(cell));
  }
  EXPECT_NEAR(sum, 0.5, 1e-12);
}

TEST(LinearParts, ValuesAreFloatWhereTheirTypeFits)
{
  const auto grid = Empty(VTK_FLOAT);
  AddCell(grid, VTK_QUADRATIC_PYRAMID, PlacesOf(VTK_QUADRATIC_PYRAMID, CornersOf(5)));
  const LinearParts parts = *LinearPartsOf(grid);
  EXPECT_EQ(parts.Grid->GetPoints()->GetDataType(), VTK_FLOAT);
  const auto linear = [](const Place& at) { return 100.0 * at.x + 20.0 * at.y; };
  const auto shorts = ValuesAt<vtkShortArray>(grid, linear);
  EXPECT_EQ(parts.PointValues(shorts)->GetDataType(), VTK_FLOAT);
  ExpectValues(parts.Grid, parts.PointValues(shorts), linear);
  EXPECT_EQ(parts.PointValues(ValuesAt<vtkFloatArray>(grid, linear))->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(parts.PointValues(ValuesAt<vtkIntArray>(grid, linear))->GetDataType(), VTK_DOUBLE);
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("velocity");
  vectors->SetNumberOfComponents(3);
  for (int point = 0; point < 13; ++point)
  {
    double at[3];
    grid->GetPoint(point, at);
    vectors->InsertNextTuple3(at[0], 2.0 * at[1], -at[2]);
  }
  const auto taken = parts.PointValues(vectors);
  ASSERT_EQ(taken->GetNumberOfTuples(), 14);
  EXPECT_STREQ(taken->GetName(), "velocity");
  EXPECT_EQ(taken->GetComponent(13, 0), 0.5);
  EXPECT_EQ(taken->GetComponent(13, 1), 1.0);
  EXPECT_EQ(taken->GetComponent(13, 2), 0.0);
  EXPECT_EQ(taken->GetComponent(4, 2), -1.0);
}

TEST(LinearParts, MissingValuesStayWhereTheyCount)
{
  const auto grid = Empty();
  AddCell(grid, VTK_QUADRATIC_HEXAHEDRON, PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8)));
  const LinearParts parts = *LinearPartsOf(grid);
  const auto values = ValuesAt<vtkFloatArray>(grid, [](const Place&) { return 1.0; });
  values->SetTuple1(0, std::nan("")); // the corner of three faces
  const auto taken = parts.PointValues(values);
  int missing = 0;
  for (vtkIdType point = 20; point < 27; ++point)
  {
    missing += std::isnan(taken->GetTuple1(point)) ? 1 : 0;
  }
  EXPECT_EQ(missing, 4) << "three faces, and the middle";
  EXPECT_TRUE(std::isnan(taken->GetTuple1(0)));
  EXPECT_EQ(taken->GetTuple1(1), 1.0);
}

TEST(LinearParts, MixedGridsKeepTheOrderOfTheirCells)
{
  const auto grid = Empty();
  const auto moved = [](double x) { return [x](const Place& at) { return at + Place(x, 0, 0); }; };
  const Places cube = CornersOf(8);
  AddCell(grid, VTK_HEXAHEDRON, cube);
  AddCell(grid, VTK_QUAD, Mapped({ cube.begin(), cube.begin() + 4 }, moved(9)));
  AddCell(grid, VTK_QUADRATIC_TETRA, Mapped(PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)), moved(2)));
  AddCell(grid, VTK_VERTEX, { { 3, 3, 3 } });
  AddCell(grid, VTK_WEDGE, Mapped(CornersOf(6), moved(5)));
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const int flag : { 0, 0, 1, 0, 0 })
  {
    flags->InsertNextValue(static_cast<unsigned char>(flag));
  }
  const MeshOfData whole = CellMeshOf(grid);
  ASSERT_TRUE(whole.Parts);
  EXPECT_EQ(whole.Parts->CellOf, (std::vector<vtkIdType>{ 0, 2, 2, 2, 2, 2, 2, 2, 2, 4 }));
  EXPECT_EQ(whole.Others.Count, 2);
  EXPECT_EQ(whole.Others.First, 1);
  EXPECT_EQ(whole.Others.Type, "vtkQuad");
  EXPECT_NEAR(VolumesOf(whole.Mesh).Sum, 1.0 + 1.0 / 6.0 + 0.5, 1e-12);
  vtkNew<vtkIntArray> numbers;
  for (const int number : { 10, 11, 12, 13, 14 })
  {
    numbers->InsertNextValue(number);
  }
  const auto values = whole.ValuesOf(numbers, ValuesOn::Cells);
  ASSERT_EQ(values->GetNumberOfTuples(), whole.Mesh.CellCount);
  EXPECT_EQ(values->GetTuple1(0), 10.0);
  EXPECT_EQ(values->GetTuple1(8), 12.0);
  EXPECT_EQ(values->GetTuple1(9), 14.0);
  EXPECT_EQ(whole.ValuesOf(grid->GetPoints()->GetData(), ValuesOn::Points)->GetNumberOfTuples(),
    whole.Mesh.PointCount);
  grid->GetCellData()->AddArray(flags);
  EXPECT_NEAR(VolumeOf(grid), 1.5, 1e-12) << "the tetrahedron is another piece's";
}

TEST(LinearParts, OtherStepsTakeThePartsOfTheSameMesh)
{
  const auto step = [](double moved, bool cut)
  {
    const auto grid = Empty();
    AddCell(grid, VTK_QUADRATIC_TETRA, PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)));
    Places prism = PrismOf(4);
    prism.back().z += moved;
    AddPoints(grid, prism);
    Faces faces = FacesOfPrism(4);
    if (cut)
    {
      // The first side is two triangles.
      faces[2] = { 0, 1, 5 };
      faces.push_back({ 0, 5, 4 });
    }
    for (auto& face : faces)
    {
      std::for_each(face.begin(), face.end(), [](vtkIdType& point) { point += 10; });
    }
    AddPolyhedron(grid, faces);
    return grid;
  };
  const MeshOfData first = CellMeshOf(step(0.0, false));
  EXPECT_EQ(CellMeshOf(step(0.0, false), first).Parts, first.Parts);
  EXPECT_NE(CellMeshOf(step(0.1, false), first).Parts, first.Parts) << "a point has moved";
  EXPECT_NE(CellMeshOf(step(0.0, true), first).Parts, first.Parts) << "faces are others";
  const auto retyped = step(0.0, false);
  retyped->GetCells()->GetConnectivityArray()->SetComponent(0, 0, 1.0);
  EXPECT_NE(CellMeshOf(retyped, first).Parts, first.Parts) << "a cell has another point";
  // Flags are those of the step.
  const auto hidden = step(0.0, false);
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->InsertNextValue(0);
  flags->InsertNextValue(1);
  hidden->GetCellData()->AddArray(flags);
  const MeshOfData later = CellMeshOf(hidden, first);
  EXPECT_EQ(later.Parts, first.Parts);
  EXPECT_EQ(VolumesOf(first.Mesh).Count, later.Mesh.CellCount);
  EXPECT_EQ(VolumesOf(later.Mesh).Count, 8);
}

TEST(LinearParts, WrongCellsAreNamed)
{
  const auto expect = [](vtkUnstructuredGrid* grid, const char* sentence)
  {
    try
    {
      (void)CellMeshOf(grid);
      ADD_FAILURE() << "nothing is thrown";
    }
    catch (const banyan::Error& error)
    {
      EXPECT_STREQ(error.what(), sentence);
    }
  };
  const auto grid = Empty();
  AddCell(grid, VTK_TETRA, CornersOf(4));
  AddCell(grid, VTK_QUADRATIC_TETRA, PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)));
  grid->GetCells()->GetConnectivityArray()->SetComponent(7, 0, 14.0);
  expect(grid, "Cell 1 refers to point 14, and the mesh has 14 points.");
  const auto fewer = Empty();
  AddCell(fewer, VTK_QUADRATIC_TETRA, CornersOf(8));
  expect(fewer, "Cell 0 of the type vtkQuadraticTetra has 8 points in place of 10.");
  const auto good = Empty();
  AddCell(good, VTK_QUADRATIC_TETRA, PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)));
  vtkNew<vtkFloatArray> one;
  one->InsertNextValue(1.0f);
  one->InsertNextValue(1.0f);
  EXPECT_THROW(LinearPartsOf(good)->PointValues(one), banyan::Error);
  EXPECT_THROW(LinearPartsOf(good)->CellValues(one), banyan::Error);
}

} // namespace
