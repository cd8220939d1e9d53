// SPDX-License-Identifier: BSD-3-Clause
#include "HexMeshRenderer.h"
#include "VtkGridOfMesh.h"

#include "Base/ThreadPool.h"
#include "Base/Timer.h"

#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace banyan::bench
{
namespace
{

constexpr double Near = 1e-4; // of the finest edge
constexpr int SamplesPerEdge = 12;

/// The integral along each pixel's ray through the original elements, without any octree: VTK's
/// locator finds the element of each sample, and VTK interpolates in it. Slow.
class LocatorHexMeshRenderer : public HexMeshRenderer
{
public:
  LocatorHexMeshRenderer(const HexMeshScene& scene, int threads)
    : Scene(scene)
    , Pool(threads)
  {
  }

  void Open() override {}

  HexMeshFrame Draw() override
  {
    const Timer timer;
    if (!this->Grid)
    {
      this->SetUp();
    }
    const BenchScene& look = this->Scene.Look;
    const RayCamera camera = ToRayScene(look, 1.0, 2.0f).Camera;
    FloatImage picture;
    picture.Rect = { glm::ivec2(0), glm::ivec2(look.Picture) };
    picture.Pixels.resize(static_cast<std::size_t>(picture.Rect.Count()));
    this->Pool.ParallelFor(look.Picture,
      [&](std::int64_t y)
      {
        vtkNew<vtkGenericCell> cell;
        for (int x = 0; x < look.Picture; ++x)
        {
          picture.At(x, static_cast<int>(y)) =
            this->Integrate(camera.RayOf(x, static_cast<int>(y)), cell);
        }
      });
    HexMeshFrame frame;
    frame.Seconds = timer.Seconds();
    frame.Shown = Rounded(picture, look.Picture);
    return frame;
  }

private:
  void SetUp()
  {
    this->Grid = VtkGridOf(this->Scene.Mesh);
    this->Locator->SetDataSet(this->Grid);
    this->Locator->BuildLocator();
    this->Values.assign(this->Scene.Mesh.Values.begin(), this->Scene.Mesh.Values.end());
    this->ConstrainHangingPoints();
  }

  double EdgeOf(vtkIdType cell) const
  {
    double bounds[6];
    this->Grid->GetCellBounds(cell, bounds);
    return bounds[1] - bounds[0];
  }

  bool Touches(vtkIdType cell, const double* point) const
  {
    double bounds[6];
    this->Grid->GetCellBounds(cell, bounds);
    bool touches = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      touches = touches && point[axis] >= bounds[2 * axis] - Near &&
                point[axis] <= bounds[2 * axis + 1] + Near;
    }
    return touches;
  }

  /// The largest cell that a point touches.
  vtkIdType LargestAt(const double* point) const
  {
    double box[6];
    for (int axis = 0; axis < 3; ++axis)
    {
      box[2 * axis] = point[axis] - Near;
      box[2 * axis + 1] = point[axis] + Near;
    }
    vtkNew<vtkIdList> cells;
    this->Locator->FindCellsWithinBounds(box, cells);
    vtkIdType largest = -1;
    for (vtkIdType i = 0; i < cells->GetNumberOfIds(); ++i)
    {
      // The locator also gives cells that are near.
      const vtkIdType cell = cells->GetId(i);
      if (this->Touches(cell, point) && (largest < 0 || this->EdgeOf(cell) > this->EdgeOf(largest)))
      {
        largest = cell;
      }
    }
    return largest;
  }

  /// A point inside of a face or an edge of a larger cell takes the value that this one has there.
  void ConstrainHangingPoints()
  {
    const auto count = static_cast<std::size_t>(this->Grid->GetNumberOfPoints());
    std::vector<vtkIdType> largest(count);
    std::vector<double> edges(count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    for (const std::size_t point : order)
    {
      largest[point] = this->LargestAt(this->Grid->GetPoint(static_cast<vtkIdType>(point)));
      edges[point] = this->EdgeOf(largest[point]);
    }
    // Corners of large cells come first: others may hang on them.
    std::stable_sort(order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return edges[a] > edges[b]; });
    vtkNew<vtkGenericCell> cell;
    for (const std::size_t point : order)
    {
      this->Grid->GetCell(largest[point], cell);
      if (cell->GetPointIds()->IsId(static_cast<vtkIdType>(point)) < 0)
      {
        double place[3];
        this->Grid->GetPoint(static_cast<vtkIdType>(point), place);
        int part;
        double parameters[3];
        double away;
        double weights[8];
        cell->EvaluatePosition(place, nullptr, part, parameters, away, weights);
        this->Values[point] = this->Mean(cell, weights);
      }
    }
  }

  double Mean(vtkGenericCell* cell, const double* weights) const
  {
    double value = 0.0;
    for (int i = 0; i < 8; ++i)
    {
      value += weights[i] * this->Values[static_cast<std::size_t>(cell->GetPointId(i))];
    }
    return value;
  }

  glm::dvec4 Integrate(const Ray& ray, vtkGenericCell* cell)
  {
    const BenchScene& look = this->Scene.Look;
    double enter = ray.Near;
    double leave = ray.Far;
    const double* const bounds = this->Grid->GetBounds();
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = (bounds[2 * axis] - ray.Origin[axis]) / ray.Direction[axis];
      const double b = (bounds[2 * axis + 1] - ray.Origin[axis]) / ray.Direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    glm::dvec3 color(0.0);
    double through = 1.0;
    const int steps = leave > enter ? static_cast<int>((leave - enter) * SamplesPerEdge) + 1 : 0;
    const double step = (leave - enter) / std::max(1, steps);
    for (int i = 0; i < steps; ++i)
    {
      glm::dvec3 place = ray.Origin + (enter + (i + 0.5) * step) * ray.Direction;
      double parameters[3];
      double weights[8];
      if (this->Locator->FindCell(&place.x, Near * Near, cell, parameters, weights) >= 0)
      {
        const glm::dvec4 entry = look.At(this->Mean(cell, weights));
        const double opacity = 1.0 - std::pow(1.0 - entry.a, step / look.UnitDistance);
        color += through * opacity * glm::dvec3(entry);
        through *= 1.0 - opacity;
      }
    }
    return { color, 1.0 - through };
  }

  const HexMeshScene& Scene;
  ThreadPool Pool;
  vtkSmartPointer<vtkUnstructuredGrid> Grid;
  vtkNew<vtkStaticCellLocator> Locator;
  std::vector<double> Values;
};

} // namespace

std::unique_ptr<HexMeshRenderer> MakeLocatorHexMeshRenderer(const HexMeshScene& scene, int threads)
{
  return std::make_unique<LocatorHexMeshRenderer>(scene, threads);
}

} // namespace banyan::bench
