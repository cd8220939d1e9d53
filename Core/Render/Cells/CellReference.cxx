// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellReference.h"

#include "Cells/PlaceInShape.h"
#include "Render/Cells/ReferenceFaces.h"
#include "Render/Scene/RayLattice.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace banyan
{
namespace
{

/// How far outside of a cell its samples may be, in places from -1 to 1: where another cell begins,
/// and at the border of the mesh.
constexpr double OutsideOfCell = 0x1p-13;
constexpr double OutsideOfMesh = 0x1p-20;
/// More than triangles are outside of bilinear faces of cells that are no butterflies.
constexpr double OutsideOfBent = 0.25;
/// How much larger boxes around cells are, in parts of their edges: more than OutsideOfCell makes
/// bent ones.
constexpr double AroundBox = 0.01;

/// A cell that is drawn, in index space.
struct DrawnCell
{
  std::int64_t Number = 0;
  CellShape Shape = CellShape::None;
  CellCorners Corners{};
  std::array<double, 8> Values{};
  glm::dvec3 Middle{ 0.0 };
  glm::dvec3 Low{ 0.0 };
  glm::dvec3 High{ 0.0 };
  FaceTolerances Outside{};
  std::vector<ReferenceFace> Border;
  std::vector<int> Quads; ///< numbers of border faces

  bool Holds(const glm::dvec3& position, glm::dvec3& place) const
  {
    return glm::all(glm::greaterThanEqual(position, this->Low)) &&
           glm::all(glm::lessThanEqual(position, this->High)) &&
           FindPlace(this->Shape, this->Corners, position, this->Outside, place) &&
           std::all_of(this->Quads.begin(), this->Quads.end(),
             [&](int face) { return this->EndsBeyond(face, place); });
  }

private:
  /// Whether a place is on this side of the four triangles of a border face, to first order in how
  /// far they are from the bilinear face.
  bool EndsBeyond(int number, const glm::dvec3& place) const
  {
    const CellFace& face = FacesOf(this->Shape).Faces[static_cast<std::size_t>(number)];
    const std::array<double, 8> weights = WeightsAt(this->Shape, place);
    const int count = CornersOf(this->Shape);
    std::array<glm::dvec3, 4> c;
    std::array<double, 4> w{};
    glm::dvec3 middle(0.0);
    for (std::size_t i = 0; i < 4; ++i)
    {
      c[i] = this->Corners[static_cast<std::size_t>(face.Corners[i])];
      w[i] = weights[static_cast<std::size_t>(face.Corners[i])];
      middle += 0.25 * c[i];
    }
    // The middle of the other corners lies as much deeper as there are places between.
    const glm::dvec3 other =
      (static_cast<double>(count) * this->Middle - 4.0 * middle) / static_cast<double>(count - 4);
    const double places = this->Shape == CellShape::Hexahedron ? 2.0 : 1.0;
    const glm::dvec3 normal = glm::cross(c[2] - c[0], c[3] - c[1]);
    const glm::dvec3 twist = 0.25 * ((c[0] - c[1]) + (c[2] - c[3]));
    const double bulge = places * glm::dot(normal, twist) / glm::dot(normal, middle - other);
    const double sum = w[0] + w[1] + w[2] + w[3];
    const double u = (w[1] + w[2] - w[0] - w[3]) / sum;
    const double v = (w[2] + w[3] - w[0] - w[1]) / sum;
    // In each of the four triangles u v is linear, with the same values at corners and middle.
    const double flat = std::abs(u) > std::abs(v) ? (u > 0.0 ? v : -v) : (v > 0.0 ? u : -u);
    const double beyond = places * (sum - 1.0);
    // A cell that folds ends at the bilinear face. At an apex u and v are no numbers.
    const double away = std::abs(bulge) < 1.0 && sum > 0.0 ? bulge * (flat - u * v) : 0.0;
    return beyond - away <= OutsideOfMesh;
  }
};

/// Sets all but the border of a cell.
DrawnCell MakeCell(const CellMesh& mesh, std::int64_t number, const glm::dmat4& toIndex,
  const std::function<double(std::int64_t)>& valueOfPoint)
{
  const MeshCell cell = mesh.Cell(number);
  DrawnCell drawn;
  drawn.Number = number;
  drawn.Shape = cell.Shape;
  drawn.Outside.fill(OutsideOfCell);
  const int count = CornersOf(cell.Shape);
  drawn.Low = glm::dvec3(std::numeric_limits<double>::infinity());
  drawn.High = -drawn.Low;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
  {
    const glm::dvec3 corner(toIndex * glm::dvec4(mesh.Point(cell.Points[i]), 1.0));
    drawn.Corners[i] = corner;
    drawn.Values[i] = valueOfPoint(cell.Points[i]);
    drawn.Low = glm::min(drawn.Low, corner);
    drawn.High = glm::max(drawn.High, corner);
    drawn.Middle += corner / static_cast<double>(count);
  }
  const glm::dvec3 around = AroundBox * (drawn.High - drawn.Low);
  drawn.Low -= around;
  drawn.High += around;
  return drawn;
}

bool IsVisible(const DrawnCell& cell, const VisibleValues& visible)
{
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t i = 0; i < static_cast<std::size_t>(CornersOf(cell.Shape)); ++i)
  {
    if (!std::isfinite(cell.Values[i]))
    {
      return false;
    }
    low = std::min(low, cell.Values[i]);
    high = std::max(high, cell.Values[i]);
  }
  return visible.Any(low, high);
}

/// What a sample stands for, in sample distances along the line of its ray.
struct Interval
{
  double Begin = 0.0;
  double End = 0.0;
  double Middle = 0.0;

  double Length() const { return this->End - this->Begin; }
};

/// What of an interval is covered.
/// @param crossings those within it
double CoveredPart(const Interval& interval, bool inside,
  const std::vector<FaceCrossing>& crossings, double nearMiddle)
{
  const auto distance = [&](const FaceCrossing& crossing)
  { return std::abs(crossing.At - interval.Middle); };
  const auto nearest = std::min_element(crossings.begin(), crossings.end(),
    [&](const FaceCrossing& a, const FaceCrossing& b) { return distance(a) < distance(b); });
  // How often the ray is in the mesh at the ends of the interval.
  int begins = inside ? 1 : 0;
  int ends = begins;
  for (const FaceCrossing& crossing : crossings)
  {
    crossing.At < interval.Middle ? begins -= crossing.Sign : ends += crossing.Sign;
  }
  const bool odd = std::min(begins, ends) < 0 || std::max(begins, ends) > 1;
  double covered = inside ? interval.Length() : 0.0;
  for (auto crossing = crossings.begin(); crossing != crossings.end(); ++crossing)
  {
    bool before = crossing->At < interval.Middle;
    if (odd && crossing == nearest && distance(*crossing) < nearMiddle)
    {
      before = (crossing->Sign > 0) == inside;
    }
    covered +=
      crossing->Sign * ((interval.End - crossing->At) - (before ? interval.Length() : 0.0));
  }
  return std::clamp(covered, 0.0, interval.Length());
}

} // namespace

/// The cells that are drawn, and rays through them.
class CellReference::Parts
{
public:
  Parts(const RayScene& scene, const CellMesh& mesh, const std::vector<std::uint32_t>& order,
    const glm::dmat4& toIndex, const std::function<double(std::int64_t)>& valueOfPoint, bool ends,
    double nearMiddle)
    : Camera(scene.Camera)
    , Lattice(scene)
    , HasEnds(ends)
    , NearMiddle(nearMiddle)
  {
    const VisibleValues visible(scene.Transfer);
    std::vector<std::vector<int>> border(order.size());
    if (ends)
    {
      border = BorderFacesOf(mesh, order);
    }
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      DrawnCell cell = MakeCell(mesh, order[i], toIndex, valueOfPoint);
      if (!IsVisible(cell, visible))
      {
        continue;
      }
      for (const int number : border[i])
      {
        const CellFace& of = FacesOf(cell.Shape).Faces[static_cast<std::size_t>(number)];
        ReferenceFace face;
        face.Count = of.Count;
        for (std::size_t k = 0; k < static_cast<std::size_t>(of.Count); ++k)
        {
          face.Corners[k] = cell.Corners[static_cast<std::size_t>(of.Corners[k])];
          face.Values[k] = cell.Values[static_cast<std::size_t>(of.Corners[k])];
        }
        cell.Border.push_back(face);
        cell.Outside[static_cast<std::size_t>(number)] = OutsideOfMesh;
        if (of.Count == 4)
        {
          cell.Outside[static_cast<std::size_t>(number)] = OutsideOfBent;
          cell.Quads.push_back(number);
        }
      }
      this->Cells.push_back(std::move(cell));
    }
  }

  std::vector<ReferenceSample> SamplesOf(int x, int y) const
  {
    const ReferenceLine line = this->LineOf(x, y);
    const RaySamples ray = this->Lattice.SamplesOf(x, y);
    std::vector<std::size_t> met;
    std::vector<FaceCrossing> crossings;
    if (!ray.Empty())
    {
      this->Meet(line, met, crossings);
    }
    std::vector<ReferenceSample> samples;
    const auto add = [&](const std::int64_t(&fixed)[3], const Interval& interval)
    {
      const glm::dvec3 position = PositionOf(fixed);
      samples.push_back(this->SampleAt(position, interval, met, crossings));
    };
    const auto whole = [&](std::int32_t sample)
    {
      std::int64_t fixed[3];
      ray.PositionOf(sample, fixed);
      // Rounded, the middle is not at the half.
      const double begin = std::floor(line.NearestTo(PositionOf(fixed)));
      add(fixed, { begin, begin + 1.0, begin + 0.5 });
    };
    if (ray.Head.Fraction > 0.0f)
    {
      add(ray.Head.Position, PartialInterval(ray.Head, line));
    }
    for (std::int32_t i = 0; i < ray.Count; ++i)
    {
      whole(i);
    }
    if (ray.Tail.Fraction > 0.0f)
    {
      add(ray.Tail.Position, PartialInterval(ray.Tail, line));
    }
    return samples;
  }

private:
  static glm::dvec3 PositionOf(const std::int64_t (&fixed)[3])
  {
    return std::ldexp(1.0, -FractionBits) * glm::dvec3(fixed[0], fixed[1], fixed[2]);
  }

  static Interval PartialInterval(const PartialSample& sample, const ReferenceLine& line)
  {
    const double middle = line.NearestTo(PositionOf(sample.Position));
    const double half = 0.5 * static_cast<double>(sample.Fraction);
    return { middle - half, middle + half, middle };
  }

  /// In index space; t are sample distances.
  ReferenceLine LineOf(int x, int y) const
  {
    const Ray ray = this->Camera.RayOf(x, y);
    const LatticeSetup setup = this->Lattice.Setup();
    const glm::dvec4 way = setup.WorldToIndex * glm::dvec4(ray.Direction, 0.0);
    return { glm::dvec3(setup.WorldToIndex * glm::dvec4(ray.Origin, 1.0)),
      setup.Distance * glm::dvec3(way) };
  }

  /// Cells whose boxes a line meets, the last one first, and where it crosses their border faces.
  void Meet(const ReferenceLine& line, std::vector<std::size_t>& met,
    std::vector<FaceCrossing>& crossings) const
  {
    for (std::size_t rank = this->Cells.size(); rank-- > 0;)
    {
      const DrawnCell& cell = this->Cells[rank];
      if (!line.Meets(cell.Low, cell.High))
      {
        continue;
      }
      met.push_back(rank);
      for (const ReferenceFace& face : cell.Border)
      {
        AddCrossings(face, cell.Middle, line, crossings);
      }
    }
  }

  ReferenceSample SampleAt(const glm::dvec3& position, const Interval& interval,
    const std::vector<std::size_t>& met, const std::vector<FaceCrossing>& crossings) const
  {
    ReferenceSample sample;
    sample.Length = interval.Length();
    for (const std::size_t rank : met)
    {
      const DrawnCell& cell = this->Cells[rank];
      glm::dvec3 place;
      if (cell.Holds(position, place))
      {
        const std::array<double, 8> weights = WeightsAt(cell.Shape, place);
        sample.Cell = cell.Number;
        sample.Value = 0.0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(CornersOf(cell.Shape)); ++i)
        {
          sample.Value += weights[i] * cell.Values[i];
        }
        break;
      }
    }
    sample.Covered = sample.Cell >= 0 ? sample.Length : 0.0;
    if (this->HasEnds)
    {
      this->CutToEnds(interval, crossings, sample);
    }
    return sample;
  }

  void CutToEnds(const Interval& interval, const std::vector<FaceCrossing>& crossings,
    ReferenceSample& sample) const
  {
    std::vector<FaceCrossing> within;
    for (const FaceCrossing& crossing : crossings)
    {
      if (crossing.At >= interval.Begin && crossing.At < interval.End)
      {
        within.push_back(crossing);
      }
    }
    const bool inside = sample.Cell >= 0;
    sample.Covered = CoveredPart(interval, inside, within, this->NearMiddle);
    if (!inside && !within.empty())
    {
      sample.Value = 0.0;
      for (const FaceCrossing& crossing : within)
      {
        sample.Value += crossing.Value / static_cast<double>(within.size());
      }
    }
  }

  const RayCamera& Camera;
  RayLattice Lattice;
  bool HasEnds;
  double NearMiddle;
  std::vector<DrawnCell> Cells;
};

CellReference::CellReference(const RayScene& scene, const CellMesh& mesh,
  const std::vector<std::uint32_t>& order, const glm::dmat4& physicalToIndex,
  const std::function<double(std::int64_t)>& valueOfPoint, bool ends, double nearMiddle)
  : Scene(scene)
  , Inside(std::make_unique<const Parts>(
      scene, mesh, order, physicalToIndex, valueOfPoint, ends, nearMiddle))
{
}

CellReference::~CellReference() = default;

std::vector<ReferenceSample> CellReference::SamplesOf(int x, int y) const
{
  return this->Inside->SamplesOf(x, y);
}

FloatImage CellReference::Draw(const std::function<glm::dvec4(double)>& function) const
{
  FloatImage image;
  image.Rect = this->Scene.Viewport;
  image.Pixels.reserve(static_cast<std::size_t>(this->Scene.Viewport.Count()));
  const double perUnit = this->Scene.SampleDistance / this->Scene.Transfer.UnitDistance;
  for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y; ++y)
  {
    for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
    {
      glm::dvec3 colour(0.0);
      double transmittance = 1.0;
      for (const ReferenceSample& sample : this->SamplesOf(x, y))
      {
        if (!(sample.Covered > 0.0) || !std::isfinite(sample.Value))
        {
          continue;
        }
        const glm::dvec4 entry = function(sample.Value);
        const double opacity = 1.0 - std::pow(1.0 - entry.a, sample.Covered * perUnit);
        colour += transmittance * opacity * glm::dvec3(entry);
        transmittance *= 1.0 - opacity;
      }
      image.Pixels.emplace_back(glm::dvec4(colour, 1.0 - transmittance));
    }
  }
  return image;
}

FloatImage CellReferenceImage(const RayScene& scene, const CellMesh& mesh,
  const std::vector<std::uint32_t>& order, const glm::dmat4& physicalToIndex,
  const std::function<double(std::int64_t)>& valueOfPoint,
  const std::function<glm::dvec4(double)>& function, bool ends, double nearMiddle)
{
  return CellReference(scene, mesh, order, physicalToIndex, valueOfPoint, ends, nearMiddle)
    .Draw(function);
}

std::vector<std::vector<ReferenceSample>> CellReferenceSamples(const RayScene& scene,
  const CellMesh& mesh, const std::vector<std::uint32_t>& order, const glm::dmat4& physicalToIndex,
  const std::function<double(std::int64_t)>& valueOfPoint, bool ends, double nearMiddle)
{
  const CellReference reference(
    scene, mesh, order, physicalToIndex, valueOfPoint, ends, nearMiddle);
  std::vector<std::vector<ReferenceSample>> samples;
  samples.reserve(static_cast<std::size_t>(scene.Viewport.Count()));
  for (int y = scene.Viewport.Lo.y; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = scene.Viewport.Lo.x; x < scene.Viewport.Hi.x; ++x)
    {
      samples.push_back(reference.SamplesOf(x, y));
    }
  }
  return samples;
}

} // namespace banyan
