// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/DrawnMesh.h"

#include "Cells/CellParts.h"
#include "Render/Cells/CellSource.h"
#include "Render/Cells/ReferenceFaces.h"
#include "Render/Cells/SampleSlab.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace cellmeshes
{

using banyan::CellMesh;
using banyan::DrawnCells;
using banyan::FloatImage;
using banyan::MeshCell;
using banyan::RayScene;

namespace
{

/// Cells of the lattice around the mesh.
constexpr double Around = 2.0;
/// Low enough that floats say what rays have met.
constexpr double TinyOpacity = 1e-2;

struct Bounds
{
  glm::dvec3 Low{ std::numeric_limits<double>::infinity() };
  glm::dvec3 High{ -std::numeric_limits<double>::infinity() };
};

Bounds BoundsOf(const CellMesh& mesh)
{
  Bounds bounds;
  for (std::int64_t i = 0; i < mesh.PointCount; ++i)
  {
    bounds.Low = glm::min(bounds.Low, mesh.Point(i));
    bounds.High = glm::max(bounds.High, mesh.Point(i));
  }
  return bounds;
}

/// The power of two nearest to the median size of cells.
double EdgeFor(const CellMesh& mesh)
{
  std::vector<double> sizes;
  for (std::int64_t i = 0; i < mesh.CellCount; ++i)
  {
    const MeshCell cell = mesh.Cell(i);
    Bounds bounds;
    for (int corner = 0; corner < banyan::CornersOf(cell.Shape); ++corner)
    {
      const glm::dvec3 point = mesh.Point(cell.Points[Index(corner)]);
      bounds.Low = glm::min(bounds.Low, point);
      bounds.High = glm::max(bounds.High, point);
    }
    const glm::dvec3 size = bounds.High - bounds.Low;
    if (cell.Shape != banyan::CellShape::None)
    {
      sizes.push_back(std::cbrt(std::max(size.x * size.y * size.z, 1e-300)));
    }
  }
  std::sort(sizes.begin(), sizes.end());
  return sizes.empty() ? 1.0 : std::exp2(std::round(std::log2(sizes[sizes.size() / 2])));
}

banyan::CellLattice LatticeFor(const CellMesh& mesh, double edge)
{
  Bounds bounds = BoundsOf(mesh);
  if (mesh.PointCount == 0)
  {
    bounds = { glm::dvec3(0.0), glm::dvec3(1.0) };
  }
  banyan::CellLattice lattice;
  lattice.Edge = edge;
  lattice.Origin = (glm::floor(bounds.Low / edge) - Around) * edge;
  lattice.Size = glm::ivec3(glm::ceil((bounds.High - lattice.Origin) / edge) + Around);
  return lattice;
}

std::uint64_t Spread(double coordinate)
{
  const auto whole = static_cast<std::uint64_t>(coordinate);
  std::uint64_t spread = 0;
  for (int bit = 0; bit < 21; ++bit)
  {
    spread |= (whole >> bit & 1) << (3 * bit);
  }
  return spread;
}

} // namespace

glm::dvec4 Dense(double value)
{
  glm::dvec4 entry = scenes::Smooth(value);
  entry.a = 0.01 + 2.0 * entry.a;
  return entry;
}

std::vector<std::uint32_t> GeometricOrder(const CellMesh& mesh)
{
  const Bounds bounds = BoundsOf(mesh);
  const glm::dvec3 scale = 1024.0 / glm::max(bounds.High - bounds.Low, glm::dvec3(1e-300));
  std::vector<std::tuple<std::uint64_t, double, double, double, std::uint32_t>> keys;
  for (std::int64_t i = 0; i < mesh.CellCount; ++i)
  {
    const MeshCell cell = mesh.Cell(i);
    const int corners = banyan::CornersOf(cell.Shape);
    glm::dvec3 middle(0.0);
    for (int corner = 0; corner < corners; ++corner)
    {
      middle += mesh.Point(cell.Points[Index(corner)]) / double(corners);
    }
    if (corners > 0)
    {
      const glm::dvec3 at = (middle - bounds.Low) * scale;
      const std::uint64_t key = Spread(at.x) | Spread(at.y) << 1 | Spread(at.z) << 2;
      keys.emplace_back(key, middle.x, middle.y, middle.z, static_cast<std::uint32_t>(i));
    }
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order;
  for (const auto& key : keys)
  {
    order.push_back(std::get<4>(key));
  }
  return order;
}

DrawnMesh::DrawnMesh(OwnedCellMesh mesh, const ShownAs& as)
  : Mesh(std::make_shared<const OwnedCellMesh>(std::move(mesh)))
  , Scene(scenes::Scene(glm::ivec3(2), { 1, 1 }))
  , Ends(as.Ends)
{
  DrawnCells cells;
  cells.Mesh = this->Mesh->View();
  cells.Lattice = LatticeFor(cells.Mesh, as.Edge > 0.0 ? as.Edge : EdgeFor(cells.Mesh));
  cells.Order = GeometricOrder(cells.Mesh);
  const Bounds bounds = BoundsOf(cells.Mesh);
  cells.Low = bounds.Low;
  cells.High = bounds.High;
  cells.Count = static_cast<std::int64_t>(cells.Order.size());
  this->SetCells(cells);
  this->Field.Values = this->Mesh->Values;
  this->Field.OfCells = as.OfCells;
  const double edge = cells.Lattice.Edge;
  const glm::dmat4 toPhysical = glm::translate(glm::dmat4(1.0), cells.Lattice.Origin) *
                                glm::scale(glm::dmat4(1.0), glm::dvec3(edge));
  this->Scene = scenes::Scene(
    cells.Lattice.Size + 1, as.Picture, as.Actor * toPhysical, as.Distance, as.Parallel);
  this->Scene.Transfer = scenes::Tabulate(Dense);
  this->Scene.Levels = banyan::LevelEdges::Finest();
  const banyan::RayCamera camera = this->Scene.Camera;
  const glm::dmat4 zoom = glm::scale(glm::dmat4(1.0), glm::dvec3(as.Zoom, as.Zoom, 1.0));
  this->Scene.Camera =
    banyan::RayCamera(zoom * camera.WorldToClipMatrix(), as.Picture, camera.AnchorPoint());
  const double unit = edge * std::cbrt(std::abs(glm::determinant(glm::dmat3(as.Actor))));
  this->Scene.SampleDistance = as.Step * unit;
  this->Scene.Transfer.UnitDistance = unit;
}

void DrawnMesh::SetCells(const DrawnCells& cells)
{
  auto mine = std::make_shared<DrawnCells>(cells);
  mine->Border.clear();
  if (this->Ends)
  {
    const std::vector<std::vector<int>> faces = banyan::BorderFacesOf(mine->Mesh, mine->Order);
    for (std::size_t place = 0; place < faces.size(); ++place)
    {
      for (const int face : faces[place])
      {
        mine->Border.push_back(
          { static_cast<std::uint32_t>(place), static_cast<std::uint8_t>(face) });
      }
    }
  }
  mine->BorderBits = banyan::BorderBitsOf(mine->Border, mine->Order.size());
  this->Field.Cells = mine;
}

void DrawnMesh::LookFrom(
  const glm::dvec3& eye, const glm::dvec3& centre, const glm::dmat4& projection)
{
  const glm::dmat4 view = glm::lookAt(eye, centre, glm::dvec3(0.0, 1.0, 0.0));
  this->Scene.Camera = banyan::RayCamera(projection * view, this->Scene.Camera.ImageSize(), centre);
}

glm::dvec3 DrawnMesh::Centre() const
{
  return scenes::CentreOf(this->Scene.DomainCells, this->Scene.IndexToWorld);
}

double DrawnMesh::Diagonal() const
{
  const glm::dvec4 across(this->Scene.DomainCells.Size(), 0.0);
  return glm::length(glm::dvec3(this->Scene.IndexToWorld * across));
}

FloatImage DrawnMesh::Draw(int threads, banyan::RayStatistics* statistics) const
{
  banyan::ThreadPool pool(threads);
  banyan::CellSource source(this->Field, pool);
  banyan::RayStatistics unused;
  FloatImage image = banyan::CastViewport(
    this->Scene, source, this->Scene.DomainCells, 1 << 30, pool, statistics ? *statistics : unused);
  banyan::FinishPicture(this->Scene, image);
  return image;
}

glm::dmat4 DrawnMesh::ToIndex() const
{
  const banyan::CellLattice& lattice = this->Field.Cells->Lattice;
  return glm::translate(
    glm::scale(glm::dmat4(1.0), glm::dvec3(1.0 / lattice.Edge)), -lattice.Origin);
}

std::function<double(std::int64_t)> DrawnMesh::ValueOfPoint() const
{
  return [this](std::int64_t point)
  { return double{ this->Field.Values[Index(point)] } + this->Field.Base; };
}

FloatImage DrawnMesh::Reference(const scenes::Function& function) const
{
  const DrawnCells& cells = *this->Field.Cells;
  return banyan::CellReferenceImage(this->Scene, cells.Mesh, cells.Order, this->ToIndex(),
    this->ValueOfPoint(), function, this->Ends, double{ banyan::SampleSlab::NearSample });
}

std::vector<std::vector<banyan::ReferenceSample>> DrawnMesh::Samples() const
{
  const DrawnCells& cells = *this->Field.Cells;
  return banyan::CellReferenceSamples(this->Scene, cells.Mesh, cells.Order, this->ToIndex(),
    this->ValueOfPoint(), this->Ends, double{ banyan::SampleSlab::NearSample });
}

Apart Between(const FloatImage& a, const FloatImage& b)
{
  double sum = 0.0;
  Apart apart;
  for (std::size_t i = 0; i < a.Pixels.size(); ++i)
  {
    for (int k = 0; k < 4; ++k)
    {
      const double difference = std::abs(double{ a.Pixels[i][k] } - double{ b.Pixels[i][k] });
      sum += difference * difference;
      // Not a number is infinitely far away.
      apart.Worst = difference * 255.0 <= apart.Worst ? apart.Worst : difference * 255.0;
    }
  }
  const double mean = sum / (4.0 * static_cast<double>(a.Pixels.size()));
  apart.Decibels = -10.0 * std::log10(std::max(mean, 1e-30));
  return apart;
}

banyan::TransferFunction Tiny(const RayScene& scene)
{
  banyan::TransferFunction function;
  function.Low = scene.Transfer.Low;
  function.High = scene.Transfer.High;
  function.Entries.assign(2, glm::vec4(1.0f, 1.0f, 1.0f, static_cast<float>(TinyOpacity)));
  function.UnitDistance = scene.SampleDistance;
  return function;
}

double LengthIn(const RayScene& scene, const glm::vec4& pixel)
{
  const double opacity = double{ scene.Transfer.Entries[0].a };
  return std::log1p(-double{ pixel.a }) / std::log1p(-opacity);
}

} // namespace cellmeshes
