// SPDX-License-Identifier: BSD-3-Clause
// Meshes of cells of any type as the content of a file, and their order in the image.
#include "Mesh/CellSeries/CellLattices.h"
#include "Mesh/CellSeries/OrderInBox.h"

#include "Base/Error.h"
#include "Base/Hash.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

using namespace banyan;
using cell_lattices::Kind;

namespace
{

const StoredValues Both{ true, true, {}, {} };

void ExpectSame(const StoredCells& a, const StoredCells& b)
{
  EXPECT_EQ(a.PointType, b.PointType);
  EXPECT_TRUE(a.Points == b.Points);
  EXPECT_EQ(a.Types, b.Types);
  EXPECT_EQ(a.Offsets, b.Offsets);
  EXPECT_EQ(a.Connectivity, b.Connectivity);
  EXPECT_EQ(a.Faces, b.Faces);
  EXPECT_EQ(a.PointOrder, b.PointOrder);
  EXPECT_EQ(a.CellOrder, b.CellOrder);
  EXPECT_EQ(a.PointBox, b.PointBox);
  EXPECT_EQ(a.CellBox, b.CellBox);
  EXPECT_EQ(a.SampleOfPoint, b.SampleOfPoint);
  EXPECT_EQ(a.SampleOfCell, b.SampleOfCell);
}

/// Each point and each cell has a sample of its own in the image.
void ExpectOwnSamples(const StoredCells& mesh)
{
  const glm::ivec3 size = mesh.Samples();
  const auto samples = static_cast<std::uint32_t>(size.x * size.y * size.z);
  for (const auto* one : { &mesh.SampleOfPoint, &mesh.SampleOfCell })
  {
    EXPECT_EQ(std::set<std::uint32_t>(one->begin(), one->end()).size(), one->size());
    EXPECT_TRUE(
      std::all_of(one->begin(), one->end(), [=](std::uint32_t s) { return s < samples; }));
  }
}

void ExpectRoundTrip(const StoredCells& mesh)
{
  const auto stored = StoreCells(mesh, Both);
  EXPECT_EQ(stored->SampleOfPoint.size(), static_cast<std::size_t>(mesh.PointCount()));
  EXPECT_EQ(stored->SampleOfCell.size(), static_cast<std::size_t>(mesh.CellCount()));
  ExpectOwnSamples(*stored);
  const Bytes bytes = CellsToBytes(*stored);
  ExpectSame(*stored, *CellsFromBytes(bytes));
  EXPECT_EQ(CellsToBytes(*CellsFromBytes(bytes)), bytes);
}

std::string SentenceOf(const StoredCells& mesh)
{
  try
  {
    (void)StoreCells(mesh, Both);
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "nothing is wrong";
}

class AllKinds : public testing::TestWithParam<Kind>
{
};

INSTANTIATE_TEST_SUITE_P(Kinds, AllKinds,
  testing::Values(
    Kind::Hexahedra, Kind::Voxels, Kind::Tetrahedra, Kind::Wedges, Kind::Polyhedra, Kind::Mixed));

TEST_P(AllKinds, ComeBackBitByBit)
{
  ExpectRoundTrip(cell_lattices::Make<float>(GetParam(), { 7, 5, 6 }));
  ExpectRoundTrip(cell_lattices::Make<double>(GetParam(), { 3, 9, 2 }));
}

TEST_P(AllKinds, OneCubeComesBack)
{
  ExpectRoundTrip(cell_lattices::Make<float>(GetParam(), { 1, 1, 1 }));
}

TEST_P(AllKinds, AnyOrderOfCellsAndPointsComesBack)
{
  StoredCells mesh = cell_lattices::Make<float>(GetParam(), { 5, 4, 3 });
  std::mt19937 random(5);
  std::vector<std::int64_t> to(static_cast<std::size_t>(mesh.PointCount()));
  for (std::size_t i = 0; i < to.size(); ++i)
  {
    to[i] = static_cast<std::int64_t>(i);
  }
  std::shuffle(to.begin(), to.end(), random);
  const Bytes points = mesh.Points;
  for (std::size_t i = 0; i < to.size(); ++i)
  {
    std::copy_n(
      points.begin() + static_cast<std::ptrdiff_t>(12 * i), 12, mesh.Points.begin() + 12 * to[i]);
  }
  for (std::int64_t& id : mesh.Connectivity)
  {
    id = to[static_cast<std::size_t>(id)];
  }
  if (mesh.Faces.empty())
  {
    ExpectRoundTrip(mesh);
    return;
  }
  // Faces may have points that the list of the cell has not.
  const std::size_t last = mesh.Faces.size() - 1;
  mesh.Faces[last] = (mesh.Faces[last] + 17) % mesh.PointCount();
  ExpectRoundTrip(mesh);
}

TEST(StoredCells, SpecialCoordinatesComeBack)
{
  StoredCells mesh = cell_lattices::Make<double>(Kind::Hexahedra, { 3, 3, 3 });
  const double special[] = { std::numeric_limits<double>::quiet_NaN(),
    -std::numeric_limits<double>::infinity(), -0.0, 1e308, -1e308, 5e-324 };
  for (std::size_t i = 0; i < 6; ++i)
  {
    StoreNumber(mesh.Points.data() + 8 * (11 * i + i % 3), special[i]);
  }
  ExpectRoundTrip(mesh);
}

TEST(StoredCells, PointsOfNoCellAndFlatMeshesComeBack)
{
  StoredCells mesh;
  mesh.Offsets = { 0 };
  for (int i = 0; i < 20; ++i)
  {
    for (const float value : { static_cast<float>(i), 3.0F, 0.0F })
    {
      mesh.Points.resize(mesh.Points.size() + 4);
      StoreNumber(mesh.Points.data() + mesh.Points.size() - 4, value);
    }
  }
  cell_lattices::AddCell(mesh, 3, { 2, 9 });
  ExpectRoundTrip(mesh);
  EXPECT_EQ(StoreCells(mesh, Both)->PointBox, glm::ivec3(20, 1, 1));
}

TEST(StoredCells, OnlyValuesThatAreThereHaveSamples)
{
  const StoredCells mesh = cell_lattices::Make<float>(Kind::Tetrahedra, { 4, 4, 4 });
  const auto points = StoreCells(mesh, { true, false, {}, {} });
  EXPECT_EQ(points->CellBox, glm::ivec3(0));
  EXPECT_TRUE(points->SampleOfCell.empty());
  ExpectSame(*points, *CellsFromBytes(CellsToBytes(*points)));
  const auto cells = StoreCells(mesh, { false, true, {}, {} });
  EXPECT_TRUE(cells->SampleOfPoint.empty());
  ExpectSame(*cells, *CellsFromBytes(CellsToBytes(*cells)));
}

TEST(StoredCells, WhatIsWrongIsSaid)
{
  const StoredCells good = cell_lattices::Make<float>(Kind::Polyhedra, { 2, 2, 1 });
  EXPECT_EQ(SentenceOf(good), "nothing is wrong");
  StoredCells bad = good;
  bad.Connectivity[11] = 18;
  EXPECT_NE(SentenceOf(bad).find("Cell 1 refers to point 18, and the mesh has 18 points"),
    std::string::npos);
  bad.Connectivity[11] = -1;
  EXPECT_NE(SentenceOf(bad).find("Cell 1 refers to point -1"), std::string::npos);
  bad = good;
  bad.Faces[2] = 99;
  EXPECT_NE(SentenceOf(bad).find("Cell 0 refers to point 99"), std::string::npos);
  bad = good;
  bad.Faces.pop_back();
  EXPECT_NE(
    SentenceOf(bad).find("Cell 3 is a polyhedron without all of its faces"), std::string::npos);
  bad = good;
  bad.Faces.push_back(1);
  EXPECT_NE(SentenceOf(bad).find("more faces than its polyhedra"), std::string::npos);
  bad = good;
  bad.Offsets[2] = 3;
  EXPECT_NE(SentenceOf(bad).find("impossible number of points"), std::string::npos);
  bad = good;
  bad.Types.pop_back();
  EXPECT_NE(SentenceOf(bad), "nothing is wrong");
  EXPECT_NE(SentenceOf(StoredCells{}).find("no cells"), std::string::npos);
}

/// Bytes that are changed and hashed anew are refused or give some mesh, and nothing else happens.
TEST(StoredCells, NothingInAFileIsTrusted)
{
  const auto stored = StoreCells(cell_lattices::Make<float>(Kind::Mixed, { 3, 3, 2 }), Both);
  const Bytes whole = CellsToBytes(*stored);
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 4000; ++i)
  {
    Bytes bad = whole;
    const std::size_t at = 24 + random() % (bad.size() - 24);
    bad[at] = static_cast<std::uint8_t>(bad[at] ^ (1 << random() % 8));
    if (i % 5 == 0)
    {
      bad.resize(at);
    }
    StoreNumber(bad.data() + 16, ShortHashOf(bad.data() + 24, bad.size() - 24));
    try
    {
      const auto other = CellsFromBytes(bad);
      CheckCells(*other);
      ExpectSame(*other, *CellsFromBytes(CellsToBytes(*other)));
    }
    catch (const Error&)
    {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
  Bytes bad = whole;
  bad.back() ^= 1;
  EXPECT_THROW((void)CellsFromBytes(bad), Error);
  bad = whole;
  bad[8] = 9;
  EXPECT_THROW((void)CellsFromBytes(bad), Error);
  EXPECT_THROW((void)CellsFromBytes({}), Error);
}

template <class Real>
Bytes Moved(const StoredCells& mesh, double far)
{
  Bytes points = mesh.Points;
  for (std::size_t i = 0; i < points.size() / sizeof(Real); ++i)
  {
    std::uint8_t* const at = points.data() + i * sizeof(Real);
    const double value = static_cast<double>(LoadNumber<Real>(at));
    StoreNumber(at, static_cast<Real>(value + far * std::sin(0.1 * value)));
  }
  return points;
}

TEST(StoredCells, MovedPointsComeBack)
{
  for (const double far : { 0.0, 1e-3, 100.0 })
  {
    const auto single = StoreCells(cell_lattices::Make<float>(Kind::Tetrahedra, { 6, 5, 4 }), Both);
    const Bytes moved = Moved<float>(*single, far);
    EXPECT_TRUE(MovedPointsFromBytes(*single, MovedPointsToBytes(*single, moved.data())) == moved);
    const auto dual = StoreCells(cell_lattices::Make<double>(Kind::Hexahedra, { 6, 5, 4 }), Both);
    const Bytes other = Moved<double>(*dual, far);
    EXPECT_TRUE(MovedPointsFromBytes(*dual, MovedPointsToBytes(*dual, other.data())) == other);
    // Points of another mesh are refused.
    EXPECT_THROW(
      (void)MovedPointsFromBytes(*single, MovedPointsToBytes(*dual, other.data())), Error);
  }
}

/// Predicting from where points rest and how others move takes a fraction of the bytes.
TEST(StoredCells, SmallMovementsTakeFewBytes)
{
  const auto mesh = StoreCells(cell_lattices::Make<float>(Kind::Hexahedra, { 20, 20, 20 }), Both);
  const Bytes rest = MovedPointsToBytes(*mesh, mesh->Points.data());
  EXPECT_LT(rest.size(), 200u);
  const Bytes moved = Moved<float>(*mesh, 1e-3);
  EXPECT_LT(MovedPointsToBytes(*mesh, moved.data()).size(), moved.size() / 4);
}

/// Cells and points of a generator in order take few bits: the goal is 20 per hexahedron.
TEST(StoredCells, IdsInOrderTakeFewBits)
{
  for (const Kind kind : { Kind::Hexahedra, Kind::Tetrahedra, Kind::Wedges })
  {
    StoredCells mesh = cell_lattices::Make<float>(kind, { 20, 20, 20 }, 0.0);
    const auto stored = StoreCells(mesh, { false, false, {}, {} });
    EXPECT_LT(8 * CellsToBytes(*stored).size(), 4 * mesh.Types.size()) << static_cast<int>(kind);
  }
}

//--------------------------------------------------------------------------------------------------
// The order in the image

/// A smooth field at the points of a lattice, by the numbers that points have in `order`.
std::vector<float> FieldOf(const glm::ivec3& n, const std::vector<std::size_t>& order)
{
  std::vector<float> values(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    const auto at = static_cast<int>(i);
    values[order[i]] = static_cast<float>(
      std::sin(0.4 * (at % n.x)) + std::cos(0.3 * (at / n.x % n.y)) + 0.1 * (at / n.x / n.y));
  }
  return values;
}

/// Places say nothing about the lattice: the order of the file is taken, in its rows and slabs. In
/// any order of points that of places is.
TEST(ImageOrder, TheOneThatCostsLessIsTaken)
{
  const glm::ivec3 n{ 31, 12, 9 };
  StoredCells mesh = cell_lattices::Make<float>(Kind::Tetrahedra, n - 1);
  std::vector<std::size_t> order(static_cast<std::size_t>(mesh.PointCount()));
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = i;
  }
  const std::vector<float> values = FieldOf(n, order);
  std::vector<float> ofCells(mesh.Types.size());
  for (std::size_t i = 0; i < ofCells.size(); ++i)
  {
    ofCells[i] = static_cast<float>(std::sin(0.01 * static_cast<double>(i)));
  }
  const Bytes points = mesh.Points;
  std::mt19937 random(3);
  for (std::size_t i = 0; i < mesh.Points.size(); i += 4)
  {
    StoreNumber(mesh.Points.data() + i, static_cast<float>(random() % 1000));
  }
  StoredValues kept;
  kept.PointArrays = { { ScalarType::Float32, values.data(), 1, 1.0 / 512.0, false } };
  kept.CellArrays = { { ScalarType::Float32, ofCells.data(), 1, 1.0 / 512.0, false } };
  const auto scattered = StoreCells(mesh, kept);
  EXPECT_EQ(scattered->PointOrder, ImageOrder::OfFile);
  EXPECT_EQ(scattered->PointBox, n);
  EXPECT_EQ(scattered->CellOrder, ImageOrder::OfFile);
  ExpectOwnSamples(*scattered);
  ExpectSame(*scattered, *CellsFromBytes(CellsToBytes(*scattered)));

  std::shuffle(order.begin(), order.end(), random);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(12 * i), 12,
      mesh.Points.begin() + static_cast<std::ptrdiff_t>(12 * order[i]));
  }
  for (std::int64_t& id : mesh.Connectivity)
  {
    id = static_cast<std::int64_t>(order[static_cast<std::size_t>(id)]);
  }
  const std::vector<float> shuffled = FieldOf(n, order);
  kept.PointArrays[0].Values = shuffled.data();
  const auto stored = StoreCells(mesh, kept);
  EXPECT_EQ(stored->PointOrder, ImageOrder::OfPlaces);
  ExpectSame(*stored, *CellsFromBytes(CellsToBytes(*stored)));
}

TEST(ImageOrder, OnePointAndOneCellHaveOne)
{
  StoredCells mesh;
  mesh.Offsets = { 0 };
  mesh.Points.resize(12);
  cell_lattices::AddCell(mesh, 1, { 0 });
  const float value = 3.0F;
  StoredValues kept;
  kept.PointArrays = { { ScalarType::Float32, &value, 1, 0.0, true } };
  kept.CellArrays = kept.PointArrays;
  const auto stored = StoreCells(mesh, kept);
  EXPECT_EQ(stored->Samples(), glm::ivec3(1));
  ExpectSame(*stored, *CellsFromBytes(CellsToBytes(*stored)));
}

TEST(OrderInBox, ALatticeGetsItsOwnOrder)
{
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 7 * 5 * 6; ++i)
  {
    places.emplace_back(i % 7, i / 7 % 5, i / 35);
  }
  EXPECT_EQ(BoxFor(places), glm::ivec3(7, 5, 6));
  std::vector<std::uint32_t> own(places.size());
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    own[i] = static_cast<std::uint32_t>(i);
  }
  EXPECT_EQ(OrderInBox(places, { 7, 5, 6 }, { 7, 5, 6 }), own);
  std::vector<std::size_t> shuffled(own.begin(), own.end());
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  std::vector<glm::dvec3> others(places.size());
  for (std::size_t i = 0; i < shuffled.size(); ++i)
  {
    others[shuffled[i]] = places[i];
  }
  const auto samples = OrderInBox(others, { 7, 5, 6 }, { 7, 5, 6 });
  for (std::size_t i = 0; i < shuffled.size(); ++i)
  {
    EXPECT_EQ(samples[shuffled[i]], i);
  }
}

TEST(OrderInBox, AnyNumberOfPlacesFits)
{
  std::mt19937 random(8);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  for (const std::size_t count : { 1, 2, 3, 7, 64, 65, 1000, 1001 })
  {
    for (const glm::dvec3& size : { glm::dvec3(1.0), glm::dvec3(1.0, 1e-6, 1.0),
           glm::dvec3(1e-300, 0.0, 1e300), glm::dvec3(0.0), glm::dvec3(1.7e308) })
    {
      std::vector<glm::dvec3> places(count);
      for (glm::dvec3& place : places)
      {
        place = size * glm::dvec3(anywhere(random), anywhere(random), anywhere(random));
      }
      const glm::ivec3 box = BoxFor(places);
      const std::int64_t samples = std::int64_t{ box.x } * box.y * box.z;
      EXPECT_GE(samples, static_cast<std::int64_t>(count));
      EXPECT_LE(samples, static_cast<std::int64_t>(2 * count + 1));
      const auto order = OrderInBox(places, box, box);
      EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), count);
      EXPECT_LT(*std::max_element(order.begin(), order.end()), samples);
    }
  }
}

} // namespace
