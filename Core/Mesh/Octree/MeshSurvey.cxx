// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/MeshSurvey.h"

#include "Base/FirstFailure.h"

#include <glm/common.hpp>

#include <cmath>
#include <cstring>
#include <type_traits>

namespace banyan
{
namespace
{

constexpr std::int64_t MostCells = (std::int64_t{ 1 } << 32) - 2;
/// Along an axis: twice what Morton keys can tell apart, for rounding.
constexpr std::size_t MostPlanes = std::size_t{ 1 } << 22;

/// A set of finite numbers, by their bits.
class NumberSet
{
public:
  NumberSet()
    : Slots(1024, Empty)
  {
  }

  void Insert(double value)
  {
    // -0 is 0.
    const double plain = value + 0.0;
    if (plain == this->Last[0] || plain == this->Last[1])
    {
      return;
    }
    this->Last[1] = this->Last[0];
    this->Last[0] = plain;
    std::uint64_t bits;
    std::memcpy(&bits, &plain, sizeof(bits));
    if (this->Place(bits) && 2 * ++this->Count > this->Slots.size())
    {
      this->Grow();
    }
  }

  std::size_t Size() const { return this->Count; }

  template <class Function>
  void ForEach(Function&& function) const
  {
    for (const std::uint64_t bits : this->Slots)
    {
      if (bits != Empty)
      {
        double value;
        std::memcpy(&value, &bits, sizeof(value));
        function(value);
      }
    }
  }

private:
  static constexpr std::uint64_t Empty = ~std::uint64_t{ 0 }; ///< not a number

  bool Place(std::uint64_t bits)
  {
    // Whole numbers have only their upper bits set.
    std::size_t slot = ((bits ^ bits >> 32) * 0x9e3779b97f4a7c15u >> 32) & (this->Slots.size() - 1);
    while (this->Slots[slot] != Empty && this->Slots[slot] != bits)
    {
      slot = (slot + 1) & (this->Slots.size() - 1);
    }
    const bool isNew = this->Slots[slot] == Empty;
    this->Slots[slot] = bits;
    return isNew;
  }

  void Grow()
  {
    std::vector<std::uint64_t> old(2 * this->Slots.size(), Empty);
    old.swap(this->Slots);
    for (const std::uint64_t bits : old)
    {
      if (bits != Empty)
      {
        this->Place(bits);
      }
    }
  }

  std::vector<std::uint64_t> Slots;
  std::size_t Count = 0;
  double Last[2] = { std::nan(""), std::nan("") };
};

/// Holds what one thread has found.
struct Part
{
  glm::dvec3 Shortest{ std::numeric_limits<double>::infinity() };
  std::int64_t LongestCell = 0;
  double LongestEdge = 0.0;
  glm::dvec3 Largest{ 0.0 };
  bool AllFloat = true;
  NumberSet Planes[3];
};

std::string Numbered(const char* what, std::int64_t number)
{
  return what + std::to_string(number);
}

template <class Real, class Id>
class Surveyor
{
public:
  Surveyor(const HexMesh& mesh, const Real* points, const Id* ids)
    : Points(points)
    , Ids(ids)
    , PointCount(mesh.PointCount)
  {
  }

  /// @return what is wrong with the cell; empty if nothing is
  std::string Look(std::int64_t cell, Part& part) const
  {
    return this->TakeBox(cell, part) ? std::string() : this->LookClosely(cell, part);
  }

private:
  /// Takes up a cell that is plainly a box. @return false when it may be none
  bool TakeBox(std::int64_t cell, Part& part) const
  {
    Real corners[3][8];
    bool plain = true;
    for (int i = 0; i < 8; ++i)
    {
      const auto id = static_cast<std::int64_t>(this->Ids[8 * cell + i]);
      if (static_cast<std::uint64_t>(id) >= static_cast<std::uint64_t>(this->PointCount))
      {
        return false;
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        corners[axis][i] = this->Points[3 * id + axis];
      }
    }
    Real low[3];
    Real high[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real* const x = corners[axis];
      // Opposite corners first: one of these pairs has both faces.
      low[axis] = std::min(std::min(std::min(x[0], x[6]), std::min(x[1], x[7])),
        std::min(std::min(x[2], x[4]), std::min(x[3], x[5])));
      high[axis] = std::max(std::max(std::max(x[0], x[6]), std::max(x[1], x[7])),
        std::max(std::max(x[2], x[4]), std::max(x[3], x[5])));
      for (int i = 0; i < 8; ++i)
      {
        // Nothing equals NaN.
        plain &= (x[i] == low[axis]) | (x[i] == high[axis]);
      }
      const double edge = static_cast<double>(high[axis]) - low[axis];
      plain &= edge > 0.0 && std::isfinite(edge);
    }
    if (!plain)
    {
      return false;
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Take(axis, low[axis], high[axis], part);
    }
    this->TakeEdge(cell, static_cast<double>(high[0]) - low[0], part);
    return true;
  }

  static void TakeEdge(std::int64_t cell, double edge, Part& part)
  {
    if (edge > part.LongestEdge)
    {
      part.LongestEdge = edge;
      part.LongestCell = cell;
    }
  }

  std::string LookClosely(std::int64_t cell, Part& part) const
  {
    double low[3];
    double high[3];
    double corners[8][3];
    for (int i = 0; i < 8; ++i)
    {
      const auto id = static_cast<std::int64_t>(this->Ids[8 * cell + i]);
      if (id < 0 || id >= this->PointCount)
      {
        return Numbered("Cell ", cell) + Numbered(" refers to point ", id) +
               Numbered(", and the mesh has ", this->PointCount) + " points";
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        const double x = this->Points[3 * id + axis];
        if (!std::isfinite(x))
        {
          return Numbered("A coordinate of point ", id) + Numbered(" of cell ", cell) +
                 " is not finite";
        }
        corners[i][axis] = x;
        low[axis] = i == 0 ? x : std::min(low[axis], x);
        high[axis] = i == 0 ? x : std::max(high[axis], x);
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      const double edge = high[axis] - low[axis];
      if (!(edge > 0.0) || !std::isfinite(edge))
      {
        return Numbered("Cell ", cell) + " is flat: all of its points have the same " + "xyz"[axis];
      }
      for (int i = 0; i < 8; ++i)
      {
        const double off = std::min(corners[i][axis] - low[axis], high[axis] - corners[i][axis]);
        if (off > edge / 16)
        {
          return Numbered("Cell ", cell) + " is not an axis-aligned box: its point " +
                 std::to_string(static_cast<std::int64_t>(this->Ids[8 * cell + i])) + " lies " +
                 std::to_string(off / edge) + " of an edge inside along " + "xyz"[axis];
        }
      }
      this->Take(axis, low[axis], high[axis], part);
    }
    this->TakeEdge(cell, high[0] - low[0], part);
    return {};
  }

  static void Take(int axis, double low, double high, Part& part)
  {
    part.Shortest[axis] = std::min(part.Shortest[axis], high - low);
    part.Largest[axis] = std::max({ part.Largest[axis], std::abs(low), std::abs(high) });
    const auto isFloat = [](double x)
    { return std::is_same_v<Real, float> || static_cast<double>(static_cast<float>(x)) == x; };
    part.AllFloat = part.AllFloat && isFloat(low) && isFloat(high);
    part.Planes[axis].Insert(low);
    part.Planes[axis].Insert(high);
  }

  const Real* Points;
  const Id* Ids;
  std::int64_t PointCount;
};

void CheckCounts(const HexMesh& mesh)
{
  if (mesh.CellCount < 1)
  {
    throw Error("The mesh has no cells");
  }
  if (mesh.CellCount > MostCells)
  {
    throw Error("The mesh has too many cells for one process",
      { {}, {}, static_cast<std::uint64_t>(mesh.CellCount),
        static_cast<std::uint64_t>(MostCells) });
  }
}

MeshSurvey Joined(const std::vector<Part>& parts)
{
  MeshSurvey survey;
  survey.Shortest = parts.front().Shortest;
  survey.LongestCell = std::numeric_limits<std::int64_t>::max();
  for (const Part& part : parts)
  {
    survey.Shortest = glm::min(survey.Shortest, part.Shortest);
    survey.Largest = glm::max(survey.Largest, part.Largest);
    survey.AllFloat = survey.AllFloat && part.AllFloat;
    const bool same = part.LongestEdge == survey.LongestEdge;
    if (part.LongestEdge > survey.LongestEdge || (same && part.LongestCell < survey.LongestCell))
    {
      survey.LongestEdge = part.LongestEdge;
      survey.LongestCell = part.LongestCell;
    }
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    std::vector<double>& planes = survey.Planes[axis];
    for (const Part& part : parts)
    {
      part.Planes[axis].ForEach([&](double plane) { planes.push_back(plane); });
    }
    std::sort(planes.begin(), planes.end());
    planes.erase(std::unique(planes.begin(), planes.end()), planes.end());
  }
  return survey;
}

} // namespace

MeshSurvey SurveyMesh(const HexMesh& mesh, ThreadPool& pool)
{
  CheckCounts(mesh);
  std::vector<Part> parts(static_cast<std::size_t>(pool.Width()));
  DispatchMesh(mesh,
    [&](const auto* points, const auto* ids)
    {
      const Surveyor surveyor(mesh, points, ids);
      FirstFailure failure;
      ForRuns(mesh.CellCount, pool, failure,
        [&](std::int64_t begin, std::int64_t end, int worker)
        {
          Part& part = parts[static_cast<std::size_t>(worker)];
          for (std::int64_t cell = begin; cell < end; ++cell)
          {
            const std::string problem = surveyor.Look(cell, part);
            if (!problem.empty())
            {
              failure.Report(cell, problem);
              return;
            }
          }
          for (int axis = 0; axis < 3; ++axis)
          {
            if (part.Planes[axis].Size() > MostPlanes)
            {
              failure.Report(begin,
                std::string("The faces of the cells have more than 4 million coordinates along ") +
                  "xyz"[axis] + ": this is no octree");
            }
          }
        });
    });
  MeshSurvey survey = Joined(parts);
  survey.StoredAsFloat = mesh.PointType == ScalarType::Float32;
  return survey;
}

LatticeAxis FindLattice(const MeshSurvey& survey, int axis, double tolerance)
{
  const double shortest = survey.Shortest[axis];
  // Between neighbouring numbers of the type, where they are largest.
  const int octave = std::ilogb(survey.Largest[axis]);
  double spacing = std::ldexp(1.0, octave - (survey.AllFloat ? 23 : 52));
  const auto isTooCoarse = [&]() { return 2.0 * spacing > shortest / 8; };
  if (isTooCoarse() && !survey.StoredAsFloat)
  {
    // Whole numbers, say, which only look as if they had been float32.
    spacing = std::ldexp(1.0, octave - 52);
  }
  if (isTooCoarse())
  {
    throw Error(std::string("The coordinates along ") + "xyz"[axis] +
                " are rounded too coarsely for the mesh: the shortest edge is " +
                std::to_string(shortest) + ", and neighbouring numbers are " +
                std::to_string(spacing) + " apart; move the mesh to the origin or write float64");
  }
  // Planes that are nearer to each other than cells can be are one plane.
  std::vector<double> planes;
  double begin = 0.0;
  for (const double plane : survey.Planes[axis])
  {
    if (planes.empty() || plane - begin > shortest / 4)
    {
      planes.push_back(plane);
      begin = plane;
    }
    else
    {
      planes.back() = 0.5 * (begin + plane);
    }
  }
  std::vector<double> steps;
  for (std::size_t i = 1; i < planes.size(); ++i)
  {
    steps.push_back(planes[i] - planes[i - 1]);
  }
  std::sort(steps.begin(), steps.end());
  double length = 0.0;
  double count = 0.0;
  for (const double step : steps)
  {
    const double edge = count > 0.0 ? length / count : std::min(step, shortest);
    const double edges = std::max(1.0, std::floor(step / edge + 0.5));
    length += step;
    count += edges;
  }
  LatticeAxis lattice;
  lattice.Origin = planes.front();
  lattice.Edge = length / count;
  lattice.Tolerance = std::max(lattice.Edge * tolerance, 2.0 * spacing);
  return lattice;
}

} // namespace banyan
