// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/PointNumbers.h"

#include "Base/OrderedBits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

using Corners = std::array<std::uint8_t, 4>;

/// What predictions know of a type of cells: faces with four corners, and whether the first eight
/// points are the corners of a hexahedron. Corners of a face go round.
struct Shape
{
  std::vector<Corners> Faces;
  bool Hexahedron = false;
  std::array<std::uint8_t, 8> Order{}; ///< of its corners: x first, then y, then z
};

Shape ShapeOf(std::uint8_t type)
{
  Shape shape;
  switch (type)
  {
    case 8: // VTK's numbers: pixel
      shape.Faces = { { 0, 1, 3, 2 } };
      break;
    case 9:  // quadrilateral
    case 23: // the same, quadratic: corners come first
    case 14: // pyramid
    case 27: // quadratic pyramid
      shape.Faces = { { 0, 1, 2, 3 } };
      break;
    case 11: // voxel
      shape.Hexahedron = true;
      shape.Order = { 0, 1, 2, 3, 4, 5, 6, 7 };
      break;
    case 12: // hexahedron
    case 25: // with points on its edges
    case 29: // and on its faces
      shape.Hexahedron = true;
      shape.Order = { 0, 1, 3, 2, 4, 5, 7, 6 };
      break;
    case 13: // wedge
    case 26: // quadratic wedge
      shape.Faces = { { 0, 3, 4, 1 }, { 1, 4, 5, 2 }, { 2, 5, 3, 0 } };
      break;
    default:
      break;
  }
  if (shape.Hexahedron)
  {
    const auto& o = shape.Order;
    for (const Corners& face :
      { Corners{ 0, 1, 3, 2 }, Corners{ 4, 5, 7, 6 }, Corners{ 0, 1, 5, 4 }, Corners{ 2, 3, 7, 6 },
        Corners{ 0, 2, 6, 4 }, Corners{ 1, 3, 7, 5 } })
    {
      shape.Faces.push_back({ o[face[0]], o[face[1]], o[face[2]], o[face[3]] });
    }
  }
  return shape;
}

/// Says which points a point is predicted from: the seven others of a hexahedron, three of a face,
/// or the one before it.
struct Recipe
{
  std::int64_t First = -1; ///< of the cell in the connectivity; -1: the point before
  std::int8_t Face = -1;   ///< of the cell's shape; -1: the hexahedron
  std::int8_t Corner = 0;  ///< the place of the point in face or hexahedron
  std::uint8_t Type = 0;
};

class Recipes
{
public:
  explicit Recipes(const StoredCells& cells)
    : Cells(cells)
    , Shapes(256)
    , Of(static_cast<std::size_t>(cells.PointCount()))
  {
    for (int type = 0; type < 256; ++type)
    {
      this->Shapes[static_cast<std::size_t>(type)] = ShapeOf(static_cast<std::uint8_t>(type));
    }
    for (std::size_t cell = 0; cell < cells.Types.size(); ++cell)
    {
      this->Look(cell);
    }
  }

  /// Calls add(point, whether it counts negatively) for each point that a point is predicted from.
  template <class Add>
  void ForEach(std::size_t point, const Add& add) const
  {
    const Recipe& recipe = this->Of[point];
    if (recipe.First < 0)
    {
      if (point > 0)
      {
        add(point - 1, false);
      }
      return;
    }
    const Shape& shape = this->Shapes[recipe.Type];
    const auto at = [&](std::uint8_t corner)
    {
      return static_cast<std::size_t>(
        this->Cells.Connectivity[static_cast<std::size_t>(recipe.First) + corner]);
    };
    if (recipe.Face >= 0)
    {
      const Corners& face = shape.Faces[static_cast<std::size_t>(recipe.Face)];
      for (int i = 1; i < 4; ++i)
      {
        add(at(face[static_cast<std::size_t>((recipe.Corner + i) % 4)]), i == 2);
      }
      return;
    }
    for (int i = 0; i < 8; ++i)
    {
      const int apart = i ^ recipe.Corner;
      if (apart != 0)
      {
        const int axes = (apart & 1) + (apart >> 1 & 1) + (apart >> 2);
        add(at(shape.Order[static_cast<std::size_t>(i)]), axes == 2);
      }
    }
  }

private:
  /// A cell says how the last of its points is predicted, and the last one of each of its faces.
  /// The first cell that says so counts, and cells before faces.
  void Look(std::size_t cell)
  {
    const std::uint8_t type = this->Cells.Types[cell];
    const Shape& shape = this->Shapes[type];
    const std::int64_t first = this->Cells.Offsets[cell];
    const std::int64_t* const points = this->Cells.Connectivity.data() + first;
    const std::size_t corners = shape.Hexahedron ? 8 : type == 13 || type == 26 ? 6 : 4;
    if (shape.Faces.empty() || this->Cells.SizeOfCell(cell) < corners)
    {
      return;
    }
    for (std::size_t f = 0; f < shape.Faces.size(); ++f)
    {
      const int last = LastOf(points, shape.Faces[f]);
      Recipe* const recipe = last < 0 ? nullptr : &this->At(points, shape.Faces[f], last);
      if (recipe && recipe->First < 0)
      {
        *recipe = { first, static_cast<std::int8_t>(f), static_cast<std::int8_t>(last), type };
      }
    }
    const int last = shape.Hexahedron ? LastOf(points, shape.Order) : -1;
    Recipe* const recipe = last < 0 ? nullptr : &this->At(points, shape.Order, last);
    if (recipe && (recipe->First < 0 || recipe->Face >= 0))
    {
      *recipe = { first, -1, static_cast<std::int8_t>(last), type };
    }
  }

  template <class Places>
  Recipe& At(const std::int64_t* points, const Places& places, int place)
  {
    return this->Of[static_cast<std::size_t>(points[places[static_cast<std::size_t>(place)]])];
  }

  /// The place of the point with the greatest number; -1 where it is there twice.
  template <class Places>
  static int LastOf(const std::int64_t* points, const Places& places)
  {
    int last = 0;
    bool twice = false;
    for (std::size_t i = 1; i < places.size(); ++i)
    {
      const std::int64_t now = points[places[i]];
      const std::int64_t greatest = points[places[static_cast<std::size_t>(last)]];
      twice = now == greatest || (twice && now < greatest);
      last = now > greatest ? static_cast<int>(i) : last;
    }
    return twice ? -1 : last;
  }

  const StoredCells& Cells;
  std::vector<Shape> Shapes; ///< by type
  std::vector<Recipe> Of;    ///< by point
};

/// One axis of points, and of where they rest.
template <class Real>
class Axis
{
public:
  Axis(const Recipes* recipes, const std::uint8_t* points, const std::uint8_t* rest, int axis)
    : Cells(recipes)
    , Points(points)
    , Rest(rest)
    , Number(static_cast<std::size_t>(axis))
  {
  }

  /// Where a point is expected, from points before it.
  BitsOf<Real> Expected(std::size_t point) const
  {
    Real sum = 0;
    const auto add = [&](std::size_t other, bool negative)
    {
      const Real moved = this->Moved(other);
      sum = negative ? sum - moved : sum + moved;
    };
    if (this->Cells)
    {
      this->Cells->ForEach(point, add);
    }
    else if (point > 0)
    {
      add(point - 1, false);
    }
    sum += this->Rest ? At(this->Rest, point) : Real{ 0 };
    // The bits of what is no number differ from machine to machine.
    return Ordered(std::isfinite(sum) ? sum : Real{ 0 });
  }

  Real At(const std::uint8_t* points, std::size_t point) const
  {
    return LoadNumber<Real>(points + (3 * point + this->Number) * sizeof(Real));
  }

private:
  Real Moved(std::size_t point) const
  {
    const Real at = this->At(this->Points, point);
    return this->Rest ? at - this->At(this->Rest, point) : at;
  }

  const Recipes* Cells;
  const std::uint8_t* Points;
  const std::uint8_t* Rest;
  std::size_t Number;
};

template <class Real>
Bytes NumbersOf(
  std::size_t count, const Recipes* recipes, const std::uint8_t* points, const std::uint8_t* rest)
{
  using U = BitsOf<Real>;
  Bytes out(3 * sizeof(Real) * count);
  std::vector<U> numbers(count);
  for (int a = 0; a < 3; ++a)
  {
    const Axis<Real> axis(recipes, points, rest, a);
    for (std::size_t i = 0; i < count; ++i)
    {
      numbers[i] = Zigzag(static_cast<U>(Ordered(axis.At(points, i)) - axis.Expected(i)));
    }
    ToPlanes(numbers.data(), count, out.data() + static_cast<std::size_t>(a) * count * sizeof(U));
  }
  return out;
}

template <class Real>
Bytes PointsOf(
  std::size_t count, const Recipes* recipes, const Bytes& numbers, const std::uint8_t* rest)
{
  using U = BitsOf<Real>;
  Bytes points(3 * sizeof(Real) * count);
  std::vector<U> own(count);
  for (std::size_t a = 0; a < 3; ++a)
  {
    FromPlanes(numbers.data() + a * count * sizeof(U), count, own.data());
    const Axis<Real> axis(recipes, points.data(), rest, static_cast<int>(a));
    for (std::size_t i = 0; i < count; ++i)
    {
      const U bits = static_cast<U>(FromZigzag(own[i]) + axis.Expected(i));
      StoreNumber(points.data() + (3 * i + a) * sizeof(Real), FromOrdered<Real>(bits));
    }
  }
  return points;
}

std::unique_ptr<const Recipes> RecipesFor(const StoredCells& cells, PointPrediction prediction)
{
  return prediction == PointPrediction::Cells ? std::make_unique<const Recipes>(cells) : nullptr;
}

} // namespace

Bytes NumbersOfPoints(const StoredCells& cells, PointPrediction prediction,
  const std::uint8_t* points, const std::uint8_t* rest)
{
  const auto recipes = RecipesFor(cells, prediction);
  const auto count = static_cast<std::size_t>(cells.PointCount());
  return cells.PointType == ScalarType::Float64
           ? NumbersOf<double>(count, recipes.get(), points, rest)
           : NumbersOf<float>(count, recipes.get(), points, rest);
}

Bytes PointsOfNumbers(const StoredCells& cells, PointPrediction prediction, const Bytes& numbers,
  const std::uint8_t* rest)
{
  const auto recipes = RecipesFor(cells, prediction);
  const auto count = static_cast<std::size_t>(cells.PointCount());
  return cells.PointType == ScalarType::Float64
           ? PointsOf<double>(count, recipes.get(), numbers, rest)
           : PointsOf<float>(count, recipes.get(), numbers, rest);
}

} // namespace banyan
