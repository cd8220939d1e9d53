// SPDX-License-Identifier: BSD-3-Clause
// Meshes that are no octrees: each is refused with a sentence that names the cell and the reason.
#include "Mesh/Octree/TinyMeshes.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace banyan;
using meshes::Cube;

template <class Mesh>
std::string Refusal(const Mesh& mesh)
{
  std::string sentence;
  for (const int threads : { 1, 3 })
  {
    try
    {
      meshes::Find(mesh.Mesh(), threads);
      return "found";
    }
    catch (const Error& error)
    {
      EXPECT_TRUE(sentence.empty() || sentence == error.what()) << "threads change the sentence";
      sentence = error.what();
    }
  }
  return sentence;
}

void ExpectSays(const std::string& sentence, const std::vector<std::string>& parts)
{
  for (const std::string& part : parts)
  {
    EXPECT_NE(sentence.find(part), std::string::npos) << part << "\nin: " << sentence;
  }
}

class NoOctree : public testing::Test
{
protected:
  meshes::OwnMesh<double, std::int64_t> Mesh =
    meshes::Make(meshes::Ball({ 2, 1, 1 }, 3), glm::dvec3(3.0), glm::dvec3(0.5));
};

TEST_F(NoOctree, TheMeshItselfIsOne)
{
  EXPECT_EQ(Refusal(this->Mesh), "found");
}

TEST_F(NoOctree, NoCells)
{
  this->Mesh.Ids.clear();
  ExpectSays(Refusal(this->Mesh), { "no cells" });
}

TEST_F(NoOctree, PointsThatDoNotExist)
{
  for (const std::int64_t id : { std::int64_t(-1), std::int64_t(1) << 40 })
  {
    this->Mesh.IdAt(7, 3) = id;
    this->Mesh.IdAt(9, 3) = id;
    ExpectSays(Refusal(this->Mesh), { "Cell 7", "point " + std::to_string(id), "points" });
  }
}

TEST_F(NoOctree, CoordinatesThatAreNotFinite)
{
  const auto point = static_cast<std::size_t>(this->Mesh.IdAt(5, 6));
  for (const double bad : { std::nan(""), std::numeric_limits<double>::infinity() })
  {
    this->Mesh.Points[3 * point + 1] = bad;
    ExpectSays(Refusal(this->Mesh), { "point " + std::to_string(point), "not finite" });
  }
}

TEST_F(NoOctree, FlatAndWarpedCells)
{
  auto flat = this->Mesh;
  for (std::size_t corner = 4; corner < 8; ++corner)
  {
    flat.IdAt(11, corner) = flat.IdAt(11, corner - 4);
  }
  ExpectSays(Refusal(flat), { "Cell 11", "flat", " z" });

  for (const double off : { 0.3, 0.02, 0.003 })
  {
    auto warped = this->Mesh;
    warped.Points[3 * static_cast<std::size_t>(warped.IdAt(0, 2))] += off * 0.5;
    const std::string sentence = Refusal(warped);
    ExpectSays(sentence, { "Cell 0", "point ", " x" });
    // What is far from a box is no box; where its corners should be nobody knows.
    EXPECT_EQ(
      sentence.find("point " + std::to_string(warped.IdAt(0, 2)) + " ") == std::string::npos,
      off > 0.1);
  }
  // Less than the tolerance is taken for rounding.
  auto rounded = this->Mesh;
  rounded.Points[3 * static_cast<std::size_t>(rounded.IdAt(0, 2))] += 0.0005 * 0.5;
  EXPECT_EQ(Refusal(rounded), "found");
  // More than that has to be asked for.
  ThreadPool pool(1);
  auto moved = this->Mesh;
  moved.Points[3 * static_cast<std::size_t>(moved.IdAt(0, 2))] += 0.02 * 0.5;
  EXPECT_EQ(ElementOctree::Find(moved.Mesh(), pool, 0.03)->LeafCount(),
    meshes::Find(this->Mesh.Mesh())->LeafCount());
  EXPECT_THROW(ElementOctree::Find(moved.Mesh(), pool, 0.5), Error);
}

TEST_F(NoOctree, TwoPointsAtOneCorner)
{
  auto mesh = this->Mesh;
  mesh.IdAt(3, 6) = mesh.IdAt(3, 5);
  ExpectSays(Refusal(mesh), { "Cell 3", "corner" });
}

TEST_F(NoOctree, CellsOfOtherShapesAndSizes)
{
  std::vector<Cube> cubes{ { { 0, 0, 0 }, 0 }, { { 1, 0, 0 }, 0 } };
  auto mesh = meshes::Make(cubes);
  for (const std::size_t corner : { 1u, 2u, 5u, 6u })
  {
    // The second cell becomes 3 edges long.
    mesh.Points[3 * static_cast<std::size_t>(mesh.IdAt(1, corner))] = 4.0;
  }
  ExpectSays(Refusal(mesh), { "Cell 1", "3 x 1 x 1", "power of two" });
}

TEST_F(NoOctree, CellsThatBeginBetween)
{
  const auto mesh = meshes::Make({ { { 0, 0, 0 }, 1 }, { { 2, 0, 0 }, 0 }, { { 3, 0, 0 }, 1 } });
  ExpectSays(Refusal(mesh), { "Cell 2", "begins at 3 x 0 x 0", "multiples" });
}

TEST_F(NoOctree, CellsThatOverlap)
{
  const auto twice = meshes::Make({ { { 0, 0, 0 }, 0 }, { { 1, 0, 0 }, 0 }, { { 1, 0, 0 }, 0 } });
  ExpectSays(Refusal(twice), { "Cells 1 and 2 overlap" });
  const auto inside = meshes::Make({ { { 2, 2, 2 }, 0 }, { { 0, 0, 0 }, 2 } });
  ExpectSays(Refusal(inside), { "Cells 0 and 1 overlap" });
}

TEST_F(NoOctree, CoordinatesThatAreRoundedTooMuch)
{
  const auto mesh = meshes::Make<float>(meshes::Ball({ 1, 1, 1 }, 2), glm::dvec3(16777000.0));
  ExpectSays(Refusal(mesh), { "rounded", "x" });
}

TEST_F(NoOctree, TooManyCellsAcross)
{
  const auto mesh = meshes::Make({ { { 0, 0, 0 }, 0 }, { { 3000000, 0, 0 }, 0 } });
  ExpectSays(Refusal(mesh), { "along x", "2097152" });
}

TEST_F(NoOctree, NoHexahedronIsLikeAnother)
{
  std::mt19937 random(8);
  std::uniform_real_distribution<double> off(-0.01, 0.01);
  for (double& x : this->Mesh.Points)
  {
    x += off(random);
  }
  ExpectSays(Refusal(this->Mesh), { "Cell 0" });
}

} // namespace
