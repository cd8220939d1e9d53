// SPDX-License-Identifier: BSD-3-Clause
// An octree mesh with hanging points against an integrator that knows nothing of octrees: VTK's
// cell locator finds the original element of each sample, and VTK interpolates in it.
#include "MapperTesting.h"

#include "OctreeMesh.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkCellType.h"
#include "vtkGenericCell.h"
#include "vtkMatrix4x4.h"
#include "vtkPoints.h"
#include "vtkStaticCellLocator.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>

namespace
{

using namespace mapper_testing;

constexpr int Width = 60;
constexpr int Height = 44;
constexpr double UnitDistance = 0.1;
constexpr double FinestEdge = 1.0 / 32.0;

/// Cubes of 1/4 to 1/32, small ones around a sphere: faces and edges have hanging points.
banyan::OctreeMesh Tree()
{
  banyan::OctreeMeshShape shape;
  shape.MaxLevel = 5;
  const auto tooLarge = [](const banyan::MeshOctant& octant)
  {
    const double edge = std::ldexp(1.0, -octant.Level);
    double away = 0.0;
    for (const std::uint32_t low : octant.Corner)
    {
      const double middle = FinestEdge * low + 0.5 * edge - 0.4;
      away += middle * middle;
    }
    return octant.Level < 2 || std::abs(std::sqrt(away) - 0.3) < 0.6 * edge;
  };
  return banyan::OctreeMesh(shape, tooLarge, banyan::ThreadPool::Process());
}

/// Hexahedra and voxels in turns; a scalar and a vector at each point.
vtkSmartPointer<vtkUnstructuredGrid> GridOf(const banyan::OctreeMesh& tree)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkFloatArray> scalars;
  scalars->SetName("scalar");
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("vector");
  vectors->SetNumberOfComponents(3);
  for (std::size_t node = 0; node < tree.NodeCount(); ++node)
  {
    const std::array<double, 3> p = tree.Point(node);
    points->InsertNextPoint(p.data());
    scalars->InsertNextValue(Balls(p[0], p[1], p[2], 0));
    const double swirl = 0.3 * std::sin(9.0 * p[0] + 5.0 * p[2]);
    vectors->InsertNextTuple3(
      Balls(p[2], p[0], p[1], 3), swirl, 0.4 * std::cos(7.0 * p[1]) * (p[0] - 0.5));
  }
  grid->Allocate(static_cast<vtkIdType>(tree.CellCount()));
  for (std::size_t cell = 0; cell < tree.CellCount(); ++cell)
  {
    const auto& corners = tree.Corners(cell);
    std::array<vtkIdType, 8> ids;
    for (std::size_t i = 0; i < 8; ++i)
    {
      // The other way around on every second pair of a hexahedron's corners.
      const std::size_t corner = cell % 2 == 0 && (i & 2) != 0 ? i ^ 1 : i;
      ids[i] = corners[corner];
    }
    grid->InsertNextCell(cell % 2 == 0 ? VTK_HEXAHEDRON : VTK_VOXEL, 8, ids.data());
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(scalars);
  grid->GetPointData()->AddArray(vectors);
  return grid;
}

/// What is drawn at each point: a component, or (-1) the length. Points that hang have the mean of
/// their masters, as documented.
std::vector<double> Drawn(
  const banyan::OctreeMesh& tree, vtkUnstructuredGrid* grid, const char* name, int component)
{
  vtkDataArray* const array = grid->GetPointData()->GetArray(name);
  std::vector<double> drawn;
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    double squares = 0.0;
    for (int i = 0; i < array->GetNumberOfComponents(); ++i)
    {
      squares += array->GetComponent(point, i) * array->GetComponent(point, i);
    }
    drawn.push_back(component < 0 ? std::sqrt(squares) : array->GetComponent(point, component));
  }
  for (const banyan::MeshHangingNode& hanging : tree.Hanging())
  {
    double sum = 0.0;
    for (const std::uint32_t master : hanging.Masters)
    {
      sum += drawn[master];
    }
    drawn[hanging.Node] = 0.25 * sum;
  }
  return drawn;
}

class Reference
{
public:
  Reference(vtkUnstructuredGrid* grid, std::vector<double> values, const Stage& stage)
    : Values(std::move(values))
    , Property(stage.Volume->GetProperty())
  {
    this->Locator->SetDataSet(grid);
    this->Locator->BuildLocator();
    vtkMatrix4x4::Invert(stage.Renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
                           double(Width) / Height, -1.0, 1.0),
      this->ClipToWorld);
  }

  /// Red, green and blue over black, 0 to 255.
  std::array<double, 3> Pixel(int x, int y)
  {
    const glm::dvec3 from = this->World(x, y, -1.0);
    const glm::dvec3 direction = glm::normalize(this->World(x, y, 1.0) - from);
    double enter = 0.0;
    double leave = 1e9;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = -from[axis] / direction[axis];
      const double b = (1.0 - from[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    std::array<double, 3> seen{};
    if (leave <= enter)
    {
      return seen;
    }
    const int steps = static_cast<int>((leave - enter) / (FinestEdge / 12.0)) + 1;
    const double step = (leave - enter) / steps;
    double through = 255.0;
    for (int i = 0; i < steps; ++i)
    {
      const double value = this->ValueAt(from + (enter + (i + 0.5) * step) * direction);
      const double alone = this->Property->GetScalarOpacity()->GetValue(value);
      const double opacity = 1.0 - std::pow(1.0 - alone, step / UnitDistance);
      double color[3];
      this->Property->GetRGBTransferFunction()->GetColor(value, color);
      for (std::size_t c = 0; c < 3; ++c)
      {
        seen[c] += through * opacity * color[c];
      }
      through *= 1.0 - opacity;
    }
    return seen;
  }

private:
  glm::dvec3 World(int x, int y, double depth) const
  {
    const double clip[4] = { 2.0 * (x + 0.5) / Width - 1.0, 2.0 * (y + 0.5) / Height - 1.0, depth,
      1.0 };
    double world[4];
    this->ClipToWorld->MultiplyPoint(clip, world);
    return glm::dvec3(world[0], world[1], world[2]) / world[3];
  }

  double ValueAt(const glm::dvec3& point)
  {
    double place[3] = { point.x, point.y, point.z };
    double parameters[3];
    double weights[8];
    const vtkIdType cell = this->Locator->FindCell(place, 1e-12, this->Cell, parameters, weights);
    if (cell < 0)
    {
      ++this->Missed;
      return 0.0;
    }
    double value = 0.0;
    for (int i = 0; i < 8; ++i)
    {
      value += weights[i] * this->Values[static_cast<std::size_t>(this->Cell->GetPointId(i))];
    }
    return value;
  }

  std::vector<double> Values;
  vtkVolumeProperty* Property;
  vtkNew<vtkMatrix4x4> ClipToWorld;
  vtkNew<vtkStaticCellLocator> Locator;
  vtkNew<vtkGenericCell> Cell;

public:
  int Missed = 0; ///< samples in no cell
};

void LooksAsInOriginalElements(const char* name, int component)
{
  const banyan::OctreeMesh tree = Tree();
  Check(tree.Hanging().size() > 500, "points hang");
  const auto grid = GridOf(tree);
  grid->GetPointData()->SetActiveScalars(name);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputDataObject(grid);
  mapper->SetImageErrorTolerance(0.25);
  Stage stage(mapper);
  stage.Window->SetSize(Width, Height);
  stage.Renderer->SetBackground(0.0, 0.0, 0.0);
  vtkVolumeProperty* const property = stage.Volume->GetProperty();
  property->SetScalarOpacityUnitDistance(UnitDistance);
  property->GetScalarOpacity()->RemoveAllPoints();
  property->GetScalarOpacity()->AddPoint(0.1, 0.0);
  property->GetScalarOpacity()->AddPoint(0.6, 0.5);
  property->GetRGBTransferFunction()->SetVectorComponent(std::max(0, component));
  if (component < 0)
  {
    property->GetRGBTransferFunction()->SetVectorModeToMagnitude();
  }
  else
  {
    property->GetRGBTransferFunction()->SetVectorModeToComponent();
  }
  stage.LookAt(grid->GetBounds());
  const std::vector<unsigned char> picture = stage.Draw();
  Reference reference(grid, Drawn(tree, grid, name, component), stage);
  double largest = 0.0;
  int seen = 0;
  for (int y = 0; y < Height; ++y)
  {
    for (int x = 0; x < Width; ++x)
    {
      const std::array<double, 3> expected = reference.Pixel(x, y);
      seen += *std::max_element(expected.begin(), expected.end()) > 10.0 ? 1 : 0;
      for (std::size_t c = 0; c < 3; ++c)
      {
        const std::size_t at = 3 * (static_cast<std::size_t>(y) * Width + x) + c;
        largest = std::max(largest, std::abs(picture[at] - expected[c]));
      }
    }
  }
  std::cout << name << ", component " << component << ": largest difference " << largest
            << " of 255, " << tree.CellCount() << " cells, " << tree.Hanging().size()
            << " points hang\n";
  Check(reference.Missed == 0, "each sample is in a cell");
  Check(seen > 400, "the mesh is seen");
  Check(largest <= 1.0, std::string(name) + " differs by " + std::to_string(largest));
}

} // namespace

int main()
{
  LooksAsInOriginalElements("scalar", 0);
  LooksAsInOriginalElements("vector", -1);
  LooksAsInOriginalElements("vector", 1);
  return Failures();
}
