// SPDX-License-Identifier: BSD-3-Clause
// Hexahedra in a real window: the picture of image data, from new values without a new octree, and
// sentences for what cannot be drawn.
#include "MapperTesting.h"

#include "Mesh/Octree/ElementOctree.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSetAttributes.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <map>
#include <tuple>

namespace
{

using namespace mapper_testing;

constexpr int Edge = 16; // cells of the domain per axis

float Linear(double x, double y, double z, int step)
{
  return static_cast<float>(0.1 + (0.3 * x + 0.2 * y + 0.3 * z) * (step == 0 ? 1.0 : 0.5));
}

/// Cells of 4, 2 and 1 edges, the smaller ones at low x; every second one a voxel.
vtkSmartPointer<vtkUnstructuredGrid> Mesh(int step, double shift = 0.0, bool ghosts = false)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> values;
  values->SetName("field");
  vtkNew<vtkUnsignedCharArray> types;
  types->SetName(vtkDataSetAttributes::GhostArrayName());
  std::map<std::tuple<int, int, int>, vtkIdType> numbers;
  const auto number = [&](const glm::ivec3& p)
  {
    const auto found =
      numbers.emplace(std::make_tuple(p.x, p.y, p.z), static_cast<vtkIdType>(numbers.size()));
    if (found.second)
    {
      points->InsertNextPoint(p.x + shift, p.y, p.z);
      values->InsertNextValue(
        Linear(p.x / double(Edge), p.y / double(Edge), p.z / double(Edge), step));
    }
    return found.first->second;
  };
  int cells = 0;
  const auto add = [&](const glm::ivec3& low, int size)
  {
    vtkIdType ids[8];
    const bool voxel = cells++ % 2 == 1;
    for (int i = 0; i < 8; ++i)
    {
      const int x = voxel ? i & 1 : (i & 3) == 1 || (i & 3) == 2 ? 1 : 0;
      const int y = voxel ? i >> 1 & 1 : (i & 3) >= 2 ? 1 : 0;
      ids[i] = number(low + size * glm::ivec3(x, y, i >> 2));
    }
    grid->InsertNextCell(voxel ? VTK_VOXEL : VTK_HEXAHEDRON, 8, ids);
    types->InsertNextValue(0);
  };
  grid->Allocate(4096);
  for (int x = 0; x < Edge;)
  {
    const int size = x < 4 ? 1 : x < 8 ? 2 : 4;
    for (int z = 0; z < Edge; z += size)
    {
      for (int y = 0; y < Edge; y += size)
      {
        add({ x, y, z }, size);
      }
    }
    x += size;
  }
  if (ghosts)
  {
    // Another piece has this cell too, so it comes twice in all: here, and as a ghost.
    add({ 0, 0, 0 }, 1);
    types->SetValue(types->GetNumberOfTuples() - 1, vtkDataSetAttributes::DUPLICATECELL);
    grid->GetCellData()->AddArray(types);
  }
  grid->SetPoints(points);
  grid->GetPointData()->SetScalars(values);
  return grid;
}

vtkSmartPointer<vtkImageData> Image(int step)
{
  return PlainImage(
    [=](double x, double y, double z, int) { return Linear(x, y, z, step); }, glm::ivec3(Edge + 1));
}

std::vector<unsigned char> PictureOf(vtkDataSet* data, bool shaded = false)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputDataObject(data);
  mapper->SetSampleDistanceVoxels(0.5);
  Stage stage(mapper);
  stage.Volume->GetProperty()->SetShade(shaded ? 1 : 0);
  stage.LookAt(data->GetBounds());
  return stage.Draw();
}

void DrawsAsImageData()
{
  for (const bool shaded : { false, true })
  {
    const auto expected = PictureOf(Image(0), shaded);
    Check(Covered(expected) > 10000, "the image is seen");
    Check(Difference(expected, PictureOf(Mesh(0), shaded)) <= 1, "a mesh is drawn as image data");
    Check(Difference(expected, PictureOf(Mesh(0, 0.0, true), shaded)) <= 1, "without ghost cells");
  }
}

void NewValuesFindNoOctree()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputDataObject(Mesh(0));
  mapper->SetImageErrorTolerance(0.5);
  Stage stage(mapper);
  stage.LookAt(Image(0)->GetBounds());
  stage.Draw();
  const std::int64_t found = banyan::ElementOctree::FoundSoFar();
  // A reader makes new objects of the same points and cells at each step.
  mapper->SetInputDataObject(Mesh(1));
  const auto drawn = stage.Draw();
  Check(banyan::ElementOctree::FoundSoFar() == found, "new values find no octree");
  vtkNew<vtkBanyanVolumeMapper> other;
  other->SetInputDataObject(Image(1));
  other->SetImageErrorTolerance(0.5);
  Stage expected(other);
  expected.LookAt(Image(0)->GetBounds());
  Check(Difference(drawn, expected.Draw()) <= 1, "new values are drawn");
  mapper->SetInputDataObject(Mesh(1, 3.0));
  stage.Draw();
  Check(banyan::ElementOctree::FoundSoFar() == found + 1, "another mesh has another octree");
  // While somebody moves the camera, and from a mesh to image data and back.
  stage.Window->SetDesiredUpdateRate(10.0);
  stage.Draw();
  mapper->SetInputDataObject(Image(1));
  stage.Draw();
  stage.Window->SetDesiredUpdateRate(0.0001);
  mapper->SetInputDataObject(Mesh(1));
  Check(Difference(stage.Draw(), drawn) <= 1, "the same mesh once more");
}

/// A rod of 256 x 4 x 4 cells.
vtkSmartPointer<vtkUnstructuredGrid> Rod(const std::function<float(int x)>& value)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> values;
  const glm::ivec3 n(257, 5, 5);
  for (int i = 0; i < n.x * n.y * n.z; ++i)
  {
    points->InsertNextPoint(i % n.x, i / n.x % n.y, i / n.x / n.y);
    values->InsertNextValue(value(i % n.x));
  }
  grid->Allocate(4096);
  for (int i = 0; i < 256 * 4 * 4; ++i)
  {
    const vtkIdType first = i % 256 + n.x * (i / 256 % 4 + n.y * (i / 1024));
    vtkIdType ids[8];
    for (int corner = 0; corner < 8; ++corner)
    {
      ids[corner] = first + (corner & 1) + n.x * ((corner >> 1 & 1) + n.y * (corner >> 2));
    }
    grid->InsertNextCell(VTK_VOXEL, 8, ids);
  }
  grid->SetPoints(points);
  grid->GetPointData()->SetScalars(values);
  return grid;
}

void ElementsPerPixelAreLimited()
{
  const auto rough = [](int x)
  { return 0.3f + 0.6f * static_cast<float>((x * 37 + x * x * 11) % 64) / 64.0f; };
  const auto finest = Rod(rough);
  // What level 1 has of it: every second point.
  const auto coarser = Rod([&](int x) { return 0.5f * (rough(x - x % 2) + rough(x + x % 2)); });
  const auto draw = [](vtkUnstructuredGrid* grid, double most, double& estimate)
  {
    vtkNew<vtkBanyanVolumeMapper> mapper;
    mapper->SetInputDataObject(grid);
    mapper->SetMaxElementsPerPixel(most);
    Stage stage(mapper);
    stage.LookAt(grid->GetBounds());
    const auto picture = stage.Draw();
    estimate = mapper->GetStatistics()->GetEstimatedImageError();
    return picture;
  };
  double error = 0.0;
  const auto expected = draw(coarser, 0.0, error);
  Check(Covered(expected) > 100, "the rod is seen");
  const auto fine = draw(finest, 0.0, error);
  Check(Difference(fine, expected) > 3, "the tolerance asks for the finest elements");
  Check(error <= 1.0, "and keeps it");
  Check(Difference(draw(finest, 1e-3, error), expected) <= 2, "few elements in a pixel");
  Check(error > 0.0, "and their error is told");
  Check(Difference(draw(finest, 1e6, error), fine) == 0, "as many as there are");
}

/// What a mapper says about data.
std::string Said(vtkDataSet* data)
{
  std::string said;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&said);
  listener->SetCallback([](vtkObject*, unsigned long, void* to, void* text)
    { *static_cast<std::string*>(to) += static_cast<const char*>(text); });
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->AddObserver(vtkCommand::ErrorEvent, listener);
  mapper->SetInputDataObject(data);
  Stage stage(mapper);
  stage.LookAt(Image(0)->GetBounds());
  Check(Covered(stage.Draw()) == 0, "nothing is drawn of what is refused");
  return said;
}

void ExpectSays(vtkDataSet* data, const std::string& part)
{
  const std::string said = Said(data);
  Check(said.find(part) != std::string::npos, "'" + part + "' in '" + said + "'");
}

/// The picture of a mesh with a moved point, a cell that comes twice, or a tetrahedron in others:
/// nearly that of the mesh without them.
void DrawsWhatIsNoOctree()
{
  const auto expected = PictureOf(Mesh(0));
  const auto mixed = Mesh(0);
  const vtkIdType ids[4] = { 0, 1, 2, 5 };
  mixed->InsertNextCell(VTK_TETRA, 4, ids);
  mixed->InsertNextCell(VTK_VERTEX, 1, ids);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputDataObject(mixed);
  mapper->SetSampleDistanceVoxels(0.5);
  std::string said;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&said);
  listener->SetCallback([](vtkObject*, unsigned long, void* to, void* text)
    { *static_cast<std::string*>(to) += static_cast<const char*>(text); });
  mapper->AddObserver(vtkCommand::WarningEvent, listener);
  Stage stage(mapper);
  stage.LookAt(mixed->GetBounds());
  Check(Difference(expected, stage.Draw()) <= 4, "mixed cells are drawn");
  Check(said.find("Not drawn: 1 cell, cell 1185 of the type vtkVertex") != std::string::npos, said);
  Check(std::isnan(mapper->GetStatistics()->GetEncodingErrorOfValues()),
    "an error that is not known is not told to be none");
  stage.Draw();
  Check(said.find("vtkVertex") == said.rfind("vtkVertex"), "it is said once");

  const auto twice = Mesh(0, 0.0, true);
  twice->GetCellData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  Check(Difference(expected, PictureOf(twice)) <= 4, "cells that overlap are drawn");

  const auto warped = Mesh(0);
  double point[3];
  warped->GetPoint(5, point);
  warped->GetPoints()->SetPoint(5, point[0] + 0.01, point[1], point[2]);
  mapper->SetInputDataObject(warped);
  Check(Difference(expected, stage.Draw()) <= 4, "a point beside the lattice");
}

/// With nothing chosen, and nothing active.
void DrawsTheFirstArray()
{
  const auto mesh = Mesh(0);
  mesh->GetPointData()->SetActiveScalars(nullptr);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetScalarModeToDefault();
  mapper->SetInputDataObject(mesh);
  Stage stage(mapper);
  stage.LookAt(mesh->GetBounds());
  Check(Covered(stage.Draw()) > 100, "the first array of points is drawn");
}

void Refuses()
{
  vtkNew<vtkUnstructuredGrid> triangle;
  triangle->ShallowCopy(Mesh(0));
  const vtkIdType ids[3] = { 0, 1, 2 };
  triangle->Allocate(1);
  triangle->InsertNextCell(VTK_TRIANGLE, 3, ids);
  ExpectSays(triangle, "no cells in three dimensions, but 1 cell, cell 0 of the type vtkTriangle");

  const auto stray = Mesh(0);
  const vtkIdType far[8] = { 0, 1, 2, 3, 4, 5, 6, 99999999 };
  stray->InsertNextCell(VTK_HEXAHEDRON, 8, far);
  ExpectSays(stray, "refers to point 99999999");

  const auto bare = Mesh(0);
  bare->GetPointData()->Initialize();
  ExpectSays(bare, "no array to draw");
}

} // namespace

int main()
{
  DrawsAsImageData();
  NewValuesFindNoOctree();
  DrawsWhatIsNoOctree();
  ElementsPerPixelAreLimited();
  DrawsTheFirstArray();
  Refuses();
  return Failures();
}
