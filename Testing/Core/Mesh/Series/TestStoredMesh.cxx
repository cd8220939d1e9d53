// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/StoredMeshes.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Mesh/Series/MeshLevel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

using namespace banyan;

namespace
{

/// What comes back from the bytes of a mesh is the grid that went in, and the same places.
void ExpectComesBack(const HexMesh& mesh, const std::vector<std::uint8_t>& types = {})
{
  const auto stored = meshes::Store(mesh, types.empty() ? nullptr : types.data());
  const Bytes bytes = MeshToBytes(*stored);
  const auto back = MeshFromBytes(bytes);
  ASSERT_EQ(back->PointCount(), mesh.PointCount);
  ASSERT_EQ(back->CellCount(), mesh.CellCount);
  EXPECT_EQ(back->PointType, mesh.PointType);
  EXPECT_EQ(std::memcmp(back->Points.data(), mesh.Points, back->Points.size()), 0);
  DispatchMesh(mesh,
    [&](const auto*, const auto* ids)
    {
      for (std::size_t i = 0; i < back->Connectivity.size(); ++i)
      {
        ASSERT_EQ(back->Connectivity[i], ids[i]) << "corner " << i;
      }
    });
  const std::vector<std::uint8_t> all(static_cast<std::size_t>(mesh.CellCount), 12);
  EXPECT_EQ(back->CellTypes, types.empty() ? all : types);
  EXPECT_EQ(back->SampleOfPoint, stored->SampleOfPoint);
  EXPECT_EQ(back->SampleOfCell, stored->SampleOfCell);
  EXPECT_EQ(back->Copies, stored->Copies);
  EXPECT_EQ(MeshToBytes(*back), bytes);

  // Each point and each cell has a sample of its own; copies have none of theirs.
  std::set<std::uint32_t> samples(back->SampleOfPoint.begin(), back->SampleOfPoint.end());
  EXPECT_EQ(samples.size(), static_cast<std::size_t>(mesh.PointCount));
  EXPECT_LT(*samples.rbegin(), back->Atlas->SampleCount());
  for (const auto& copy : back->Copies)
  {
    EXPECT_EQ(samples.count(copy.first), 0u);
    EXPECT_EQ(samples.count(copy.second), 1u);
  }
  const std::set<std::uint32_t> cells(back->SampleOfCell.begin(), back->SampleOfCell.end());
  EXPECT_EQ(cells.size(), static_cast<std::size_t>(mesh.CellCount));
}

TEST(StoredMesh, OneCell)
{
  ExpectComesBack(meshes::Make({ { glm::ivec3(0), 0 } }).Mesh());
}

TEST(StoredMesh, OneSize)
{
  ExpectComesBack(meshes::Make(meshes::Leaves({ 17, 5, 1 }, 0, {})).Mesh());
}

TEST(StoredMesh, MixedSizesInAnyOrder)
{
  for (unsigned shuffle = 0; shuffle < 3; ++shuffle)
  {
    ExpectComesBack(meshes::Make<float, std::int32_t>(
      meshes::Ball({ 2, 3, 1 }, 4), { -1e3, 0.1, 7.0 }, { 0.1, 0.7, 3.0 }, shuffle)
                      .Mesh());
    ExpectComesBack(meshes::Make<double>(meshes::Wild({ 3, 2, 2 }, 4, shuffle),
      { -1.0 / 3.0, 1e5, 0.0 }, glm::dvec3(1.0 / 7.0), shuffle)
                      .Mesh());
  }
}

TEST(StoredMesh, Holes)
{
  ExpectComesBack(meshes::Make(
    meshes::WithHoles(meshes::Wild({ 3, 2, 2 }, 3, 5)), glm::dvec3(0.0), glm::dvec3(1.0), 9)
                    .Mesh());
}

TEST(StoredMesh, PointsOfEachCell)
{
  ExpectComesBack(
    meshes::Separated(meshes::Make(meshes::Ball({ 2, 1, 1 }, 3), {}, glm::dvec3(0.3), 4)).Mesh());
}

TEST(StoredMesh, PointsOfNoCell)
{
  auto mesh = meshes::Make<float>(meshes::Ball({ 1, 1, 2 }, 3), {}, glm::dvec3(0.3), 4);
  meshes::AddLoosePoints(mesh);
  ExpectComesBack(mesh.Mesh());
}

TEST(StoredMesh, VoxelsAndHexahedra)
{
  const auto mesh = meshes::Make(meshes::Ball({ 1, 1, 2 }, 3));
  std::vector<std::uint8_t> types(mesh.Ids.size() / 8, 12);
  types[3] = types[7] = 11;
  ExpectComesBack(mesh.Mesh(), types);
  ExpectComesBack(mesh.Mesh(), std::vector<std::uint8_t>(types.size(), 11));
}

TEST(StoredMesh, PointsBesideTheLattice)
{
  auto mesh = meshes::Make<double>(meshes::Ball({ 2, 2, 1 }, 3));
  for (std::size_t i = 0; i < mesh.Points.size(); i += 3)
  {
    mesh.Points[i] += 1e-4 * std::sin(static_cast<double>(i));
  }
  ExpectComesBack(mesh.Mesh());
}

/// An image around three thin arms of 3000 cells would have 27 billion samples.
TEST(StoredMesh, LongThinMeshesAreCut)
{
  std::vector<meshes::Cube> cubes;
  for (int i = 0; i < 3000; ++i)
  {
    cubes.push_back({ { i, 0, 0 }, 0 });
    cubes.push_back({ { 0, i + 1, 0 }, 0 });
    cubes.push_back({ { 0, 0, i + 1 }, 0 });
  }
  const auto mesh = meshes::Make(cubes);
  ExpectComesBack(mesh.Mesh());
  const auto stored = meshes::Store(mesh.Mesh());
  EXPECT_LT(stored->Atlas->SampleCount(), 600 * stored->PointCount());
}

TEST(StoredMesh, NeighboursStayNeighbours)
{
  const auto mesh = meshes::Make(meshes::Leaves({ 20, 20, 20 }, 0, {}));
  const auto stored = meshes::Store(mesh.Mesh());
  const glm::ivec3 size = stored->Atlas->Samples();
  EXPECT_EQ(stored->Atlas->Boxes().size(), 1u);
  for (std::size_t i = 0; i < mesh.Places.size(); ++i)
  {
    const glm::ivec3 p = mesh.Places[i];
    EXPECT_EQ(stored->SampleOfPoint[i], (p.z * size.y + p.y) * size.x + p.x);
  }
}

/// The image does not grow faster than the mesh: a sphere's shell of fine cells in coarse ones.
TEST(StoredMesh, ImagesAreNotMuchLargerThanMeshes)
{
  const auto mesh = meshes::Make(meshes::Ball({ 3, 3, 3 }, 5));
  const auto stored = meshes::Store(mesh.Mesh());
  EXPECT_LT(stored->Atlas->SampleCount(), 8 * stored->PointCount());
}

//--------------------------------------------------------------------------------------------------
// Damage

/// Bytes whose own checksum fits, whatever else they say.
void Rehash(Bytes& bytes)
{
  StoreNumber(bytes.data() + 16, ShortHashOf(bytes.data() + 24, bytes.size() - 24));
}

TEST(StoredMesh, DamagedBytesAreRefusedOrAreAMesh)
{
  auto mesh =
    meshes::Separated(meshes::Make<float>(meshes::Ball({ 1, 1, 1 }, 3), {}, glm::dvec3(0.3), 4));
  meshes::AddLoosePoints(mesh);
  const Bytes good = MeshToBytes(*meshes::Store(mesh.Mesh()));
  int refused = 0;
  for (std::size_t i = 0; i < good.size(); ++i)
  {
    Bytes bad = good;
    bad[i] = static_cast<std::uint8_t>(bad[i] ^ (1u << i % 8));
    EXPECT_THROW((void)MeshFromBytes(bad), Error) << "byte " << i;
    if (i >= 24)
    {
      Rehash(bad);
      try
      {
        const auto read = MeshFromBytes(bad);
        EXPECT_EQ(read->Connectivity.size(), 8 * static_cast<std::size_t>(read->CellCount()));
      }
      catch (const Error&)
      {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(StoredMesh, CutBytesAreRefused)
{
  const Bytes good = MeshToBytes(*meshes::Store(meshes::Make(meshes::Ball({ 1, 1, 1 }, 3)).Mesh()));
  for (std::size_t size = 0; size < good.size(); ++size)
  {
    Bytes bad(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_THROW((void)MeshFromBytes(bad), Error) << size << " bytes";
    if (size > 24)
    {
      Rehash(bad);
      EXPECT_THROW((void)MeshFromBytes(bad), Error) << size << " bytes";
    }
  }
}

TEST(MeshAtlas, RefusesBoxesThatCannotBe)
{
  const AtlasBox box{ 0, { 0, 0, 0 }, { 4, 4, 4 }, { 0, 0, 0 } };
  const AtlasBox beside{ 0, { 8, 0, 0 }, { 4, 4, 4 }, { 4, 0, 0 } };
  EXPECT_NO_THROW(MeshAtlas({ 8, 4, 4 }, { box, beside }, 0, 0));
  EXPECT_THROW(MeshAtlas({ 7, 4, 4 }, { box, beside }, 0, 0), Error);
  AtlasBox over = beside;
  over.Place.x = 3;
  EXPECT_THROW(MeshAtlas({ 8, 4, 4 }, { box, over }, 0, 0), Error);
  over = beside;
  over.Level = 1;
  EXPECT_THROW(MeshAtlas({ 8, 4, 4 }, { box, over }, 0, 0), Error);
  over.Level = 0;
  over.Low.x = 1 << 21;
  EXPECT_THROW(MeshAtlas({ 8, 4, 4 }, { box, over }, 0, 0), Error);
  EXPECT_THROW(MeshAtlas({ 8, 4, 4 }, { box, beside }, 1, 0), Error);
  EXPECT_NO_THROW(MeshAtlas({ 8, 4, 5 }, { box, beside }, 32, 0));
  EXPECT_THROW(MeshAtlas({ 4096, 4096, 200 }, { box, beside }, 0, 0), Error);
}

//--------------------------------------------------------------------------------------------------
// Levels

/// Cells of a level by a search through all cubes: lower corner, edge.
std::set<std::pair<std::uint64_t, int>> SlowLevel(const std::vector<meshes::Cube>& cubes, int level)
{
  std::set<std::pair<std::uint64_t, int>> cells;
  std::function<void(const meshes::Cube&)> visit = [&](const meshes::Cube& cube)
  {
    std::int64_t filled = 0;
    const meshes::Cube* only = nullptr;
    int count = 0;
    for (const meshes::Cube& leaf : cubes)
    {
      const glm::ivec3 at = leaf.Corner - cube.Corner;
      const int edge = 1 << cube.Level;
      if (at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < edge && at.y < edge && at.z < edge)
      {
        filled += std::int64_t{ 1 } << 3 * leaf.Level;
        only = &leaf;
        ++count;
      }
    }
    if (count == 1)
    {
      cells.emplace(KeyOf(only->Corner), only->Level);
    }
    else if (count > 0 && filled == std::int64_t{ 1 } << 3 * cube.Level)
    {
      cells.emplace(KeyOf(cube.Corner), cube.Level);
    }
    else if (count > 0)
    {
      for (int c = 0; c < 8; ++c)
      {
        visit({ cube.Corner + glm::ivec3(c & 1, c >> 1 & 1, c >> 2) * (1 << (cube.Level - 1)),
          cube.Level - 1 });
      }
    }
  };
  std::set<std::uint64_t> seen;
  for (const meshes::Cube& leaf : cubes)
  {
    if (leaf.Level >= level)
    {
      cells.emplace(KeyOf(leaf.Corner), leaf.Level);
      continue;
    }
    const glm::ivec3 corner = leaf.Corner >> level << level;
    if (seen.insert(KeyOf(corner)).second)
    {
      visit({ corner, level });
    }
  }
  return cells;
}

TEST(MeshLevel, MergesWhatIsFilled)
{
  for (const auto& cubes : { meshes::Ball({ 2, 1, 1 }, 3), meshes::Wild({ 2, 2, 1 }, 3, 3),
         meshes::WithHoles(meshes::Wild({ 2, 1, 2 }, 3, 8)) })
  {
    const auto mesh = meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 5);
    const auto stored = meshes::Store(mesh.Mesh());
    for (int level = 1; level < 5; ++level)
    {
      const MeshCells cells = CoarserCells(*stored, level);
      std::set<std::pair<std::uint64_t, int>> found;
      for (std::size_t cell = 0; cell < static_cast<std::size_t>(cells.Count()); ++cell)
      {
        const auto place = [&](std::size_t corner)
        { return mesh.Places[static_cast<std::size_t>(cells.Connectivity[8 * cell + corner])]; };
        const glm::ivec3 low = place(0);
        const int edge = place(7).x - low.x;
        for (std::size_t corner = 0; corner < 8; ++corner)
        {
          const int c = static_cast<int>(corner);
          EXPECT_EQ(place(corner), low + edge * glm::ivec3(c & 1, c >> 1 & 1, c >> 2));
        }
        found.emplace(KeyOf(low), static_cast<int>(std::lround(std::log2(edge))));
      }
      EXPECT_EQ(found, SlowLevel(cubes, level)) << "level " << level;
      EXPECT_EQ(found.size(), static_cast<std::size_t>(cells.Count()));
    }
  }
}

} // namespace
