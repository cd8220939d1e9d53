// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/CellSeries/ImageOrder.h"
#include "Mesh/CellSeries/OrderInBox.h"
#include "Mesh/CellSeries/StoredCells.h"

#include "Base/Error.h"

#include <string>

namespace banyan
{
namespace
{

/// Samples have 32 bits.
constexpr std::int64_t MostSamples = (std::int64_t{ 1 } << 32) - 2;

std::string Named(std::size_t cell)
{
  return "Cell " + std::to_string(cell) + " ";
}

void CheckPoint(std::size_t cell, std::int64_t point, std::int64_t points)
{
  if (point < 0 || point >= points)
  {
    throw Error(Named(cell) + "refers to point " + std::to_string(point) + ", and the mesh has " +
                std::to_string(points) + " points");
  }
}

/// Reads over the faces of a polyhedron.
/// @return where the next one begins
std::size_t CheckFaces(const StoredCells& mesh, std::size_t cell, std::size_t at)
{
  const std::vector<std::int64_t>& faces = mesh.Faces;
  const auto next = [&]
  {
    if (at >= faces.size())
    {
      throw Error(Named(cell) + "is a polyhedron without all of its faces");
    }
    return faces[at++];
  };
  const std::int64_t count = next();
  for (std::int64_t face = 0; face < count; ++face)
  {
    const std::int64_t corners = next();
    for (std::int64_t i = 0; i < corners; ++i)
    {
      CheckPoint(cell, next(), mesh.PointCount());
    }
    if (corners < 0)
    {
      throw Error(Named(cell) + "has a face with " + std::to_string(corners) + " points");
    }
  }
  if (count < 0)
  {
    throw Error(Named(cell) + "has " + std::to_string(count) + " faces");
  }
  return at;
}

template <class Real>
std::vector<glm::dvec3> PlacesFrom(const Bytes& points)
{
  std::vector<glm::dvec3> places(points.size() / (3 * sizeof(Real)));
  const std::uint8_t* at = points.data();
  for (glm::dvec3& place : places)
  {
    for (int axis = 0; axis < 3; ++axis, at += sizeof(Real))
    {
      place[axis] = static_cast<double>(LoadNumber<Real>(at));
    }
  }
  return places;
}

std::vector<glm::dvec3> PlacesOf(const StoredCells& mesh)
{
  return mesh.PointType == ScalarType::Float64 ? PlacesFrom<double>(mesh.Points)
                                               : PlacesFrom<float>(mesh.Points);
}

/// The mean of the points of each cell, added up in their order; 0 where a cell has none.
std::vector<glm::dvec3> MiddlesOf(const StoredCells& mesh, const std::vector<glm::dvec3>& places)
{
  std::vector<glm::dvec3> middles(mesh.Types.size(), glm::dvec3(0.0));
  for (std::size_t cell = 0; cell < middles.size(); ++cell)
  {
    for (std::int64_t i = mesh.Offsets[cell]; i < mesh.Offsets[cell + 1]; ++i)
    {
      middles[cell] +=
        places[static_cast<std::size_t>(mesh.Connectivity[static_cast<std::size_t>(i)])];
    }
    middles[cell] /= static_cast<double>(std::max<std::size_t>(mesh.SizeOfCell(cell), 1));
  }
  return middles;
}

/// An image may have so many times the samples of both boxes before others are taken.
constexpr double MostRoom = 2.0;
/// The order of the file must be so much better than that of places, in estimated bits per value:
/// the latter keeps neighbours together at all steps.
constexpr double MarginOfFile = 0.95;

/// The box of points or cells, and their order in it.
struct Chosen
{
  glm::ivec3 Box{ 0 };
  ImageOrder Order = ImageOrder::OfPlaces;
  glm::ivec3 BoxOfPlaces{ 0 };
};

Chosen OrderOfPlaces(const Chosen& chosen)
{
  return { chosen.BoxOfPlaces, ImageOrder::OfPlaces, chosen.BoxOfPlaces };
}

double VolumeOf(const glm::ivec3& box)
{
  return static_cast<double>(box.x) * box.y * box.z;
}

Chosen BestOrder(const StoredCells& mesh, const std::vector<glm::dvec3>& places,
  const std::vector<ValuesToKeep>& arrays)
{
  Chosen best;
  best.BoxOfPlaces = best.Box = BoxFor(places);
  if (arrays.empty())
  {
    return best;
  }
  double least =
    MarginOfFile * BitsInOrder(OrderInBox(places, best.Box, best.Box), best.Box, arrays);
  for (const glm::ivec3& box : BoxesOfFile(mesh, places.size(), best.BoxOfPlaces))
  {
    const double bits = BitsInOrder(OrderOfFile(places.size(), box, box), box, arrays);
    if (bits < least)
    {
      least = bits;
      best.Box = box;
      best.Order = ImageOrder::OfFile;
    }
  }
  return best;
}

} // namespace

void CheckCells(const StoredCells& mesh)
{
  if (mesh.PointType != ScalarType::Float32 && mesh.PointType != ScalarType::Float64)
  {
    throw Error("The points of the mesh are neither float32 nor float64");
  }
  if (mesh.Types.empty())
  {
    throw Error("The mesh has no cells");
  }
  if (mesh.Offsets.size() != mesh.Types.size() + 1 || mesh.Offsets.front() != 0 ||
      mesh.Offsets.back() != static_cast<std::int64_t>(mesh.Connectivity.size()))
  {
    throw Error("The mesh has another number of cells than its list of points is for");
  }
  if (mesh.CellCount() > MostSamples || mesh.PointCount() > MostSamples)
  {
    throw Error("The mesh has more than 2^32 - 2 cells or points, which a series cannot keep");
  }
  std::size_t faces = 0;
  for (std::size_t cell = 0; cell < mesh.Types.size(); ++cell)
  {
    if (mesh.Offsets[cell + 1] < mesh.Offsets[cell] || mesh.Offsets[cell + 1] > mesh.Offsets.back())
    {
      throw Error(Named(cell) + "has an impossible number of points");
    }
    for (std::int64_t i = mesh.Offsets[cell]; i < mesh.Offsets[cell + 1]; ++i)
    {
      CheckPoint(cell, mesh.Connectivity[static_cast<std::size_t>(i)], mesh.PointCount());
    }
    if (mesh.Types[cell] == PolyhedronType)
    {
      faces = CheckFaces(mesh, cell, faces);
    }
  }
  if (faces != mesh.Faces.size())
  {
    throw Error("The mesh has more faces than its polyhedra");
  }
}

void LayOut(StoredCells& mesh)
{
  const std::vector<glm::dvec3> places = PlacesOf(mesh);
  mesh.SampleOfPoint.clear();
  mesh.SampleOfCell.clear();
  if (mesh.PointBox.x > 0)
  {
    mesh.SampleOfPoint = mesh.PointOrder == ImageOrder::OfFile
                           ? OrderOfFile(places.size(), mesh.PointBox, mesh.Samples())
                           : OrderInBox(places, mesh.PointBox, mesh.Samples());
  }
  if (mesh.CellBox.x > 0)
  {
    mesh.SampleOfCell = mesh.CellOrder == ImageOrder::OfFile
                          ? OrderOfFile(mesh.Types.size(), mesh.CellBox, mesh.Samples())
                          : OrderInBox(MiddlesOf(mesh, places), mesh.CellBox, mesh.Samples());
  }
}

std::shared_ptr<const StoredCells> StoreCells(StoredCells mesh, const StoredValues& values)
{
  CheckCells(mesh);
  const std::vector<glm::dvec3> places = PlacesOf(mesh);
  Chosen ofPoints, ofCells;
  if (values.AtPoints && !places.empty())
  {
    ofPoints = BestOrder(mesh, places, values.PointArrays);
  }
  if (values.InCells)
  {
    ofCells = BestOrder(mesh, MiddlesOf(mesh, places), values.CellArrays);
  }
  mesh.PointBox = ofPoints.Box;
  mesh.CellBox = ofCells.Box;
  const double least = VolumeOf(ofPoints.Box) + VolumeOf(ofCells.Box);
  if (VolumeOf(mesh.Samples()) > MostRoom * least)
  {
    // Boxes that are long along different axes do not share an image.
    ofPoints = OrderOfPlaces(ofPoints);
    ofCells = OrderOfPlaces(ofCells);
  }
  mesh.PointBox = ofPoints.Box;
  mesh.CellBox = ofCells.Box;
  mesh.PointOrder = ofPoints.Order;
  mesh.CellOrder = ofCells.Order;
  const glm::ivec3 samples = mesh.Samples();
  // Box by box, so that no product is too large.
  if (std::int64_t{ samples.x } * samples.y > MostSamples ||
      std::int64_t{ samples.x } * samples.y > MostSamples / samples.z)
  {
    throw Error("The mesh is too large for one series: its image would have more than 2^32 - 2 "
                "samples");
  }
  LayOut(mesh);
  return std::make_shared<StoredCells>(std::move(mesh));
}

} // namespace banyan
