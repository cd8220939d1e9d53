// SPDX-License-Identifier: BSD-3-Clause
// Values of meshes on lattices, and pictures of coarser levels, which are drawn from them.
#include "Cells/DrawnMesh.h"
#include "Render/Cells/CellSource.h"
#include "Render/Cells/MeshLattice.h"
#include "Render/Sampling/SamplingPlan.h"
#include "Render/Scene/RayLattice.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

const glm::dvec3 Slope(0.3, -0.2, 0.25);
const cellmeshes::Field Linear = cellmeshes::LinearField(Slope, 0.4);

OwnedCellMesh BentCube(const cellmeshes::Field& field, int cells = 6, Cut cut = Cut::Mixed)
{
  OwnedCellMesh mesh = cellmeshes::Cube(cells, cut, { 0.03, 0.05, false, 1 });
  cellmeshes::SetValues(mesh, field);
  return mesh;
}

DrawnMesh Shown(OwnedCellMesh mesh, int edge = 72)
{
  ShownAs as;
  as.Picture = { edge + 3, edge };
  as.Step = 0.37;
  return DrawnMesh(std::move(mesh), as);
}

/// The picture with one level everywhere.
FloatImage AtLevel(DrawnMesh& drawn, int level, int threads = 1)
{
  drawn.Scene.Samplings = std::make_shared<const TileSamplings>(drawn.Scene.Camera.ImageSize(),
    std::vector{ RaySampling{ level, drawn.Scene.SampleDistance, 1 } });
  FloatImage image = drawn.Draw(threads);
  drawn.Scene.Samplings = nullptr;
  return image;
}

std::vector<float> SampledAt(const DrawnMesh& drawn, const PlacesInRows& places, int threads = 1)
{
  ThreadPool pool(threads);
  std::vector<float> values;
  SampleField(drawn.Field, places, values, pool);
  return values;
}

bool SameBits(const std::vector<float>& a, const std::vector<float>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(SampleField, GivesWhatCellsHave)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::FiveTetrahedra, Cut::Mixed })
  {
    const DrawnMesh drawn(BentCube(Linear, 6, cut));
    const PlacesInRows places = MeshLattice::PlacesFor(*drawn.Field.Cells, 0.125);
    const std::vector<float> values = SampledAt(drawn, places);
    const CellLattice& lattice = drawn.Field.Cells->Lattice;
    std::size_t inside = 0;
    double worst = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const auto place = static_cast<int>(i);
      const glm::ivec3 at(place % places.Count.x, place / places.Count.x % places.Count.y,
        place / places.Count.x / places.Count.y);
      glm::dvec3 point;
      for (int axis = 0; axis < 3; ++axis)
      {
        point[axis] = std::ldexp(
          static_cast<double>(places.First[axis] + at[axis] * places.Step[axis]), -FractionBits);
      }
      point = lattice.ToWorld(point);
      const glm::dvec3 off = glm::abs(point - 0.5);
      const double away = std::max({ off.x, off.y, off.z });
      ASSERT_TRUE(away < 0.6 || std::isnan(values[i])) << "outside";
      ASSERT_TRUE(away > 0.4 || std::isfinite(values[i])) << "inside";
      inside += std::isfinite(values[i]) ? 1 : 0;
      worst =
        std::isfinite(values[i]) ? std::max(worst, std::abs(values[i] - Linear(point))) : worst;
    }
    EXPECT_LE(worst, 2e-5);
    const double each = std::pow(0.125 * lattice.Edge, 3.0);
    EXPECT_NEAR(static_cast<double>(inside) * each, 1.0, 0.05) << "the volume of the mesh";
  }
}

TEST(SampleField, IsTheSameForThreadsInstructionsAndOrders)
{
  OwnedCellMesh mesh = BentCube(scenes::Standard);
  const DrawnMesh drawn(mesh);
  const PlacesInRows places = MeshLattice::PlacesFor(*drawn.Field.Cells, 0.125);
  const std::vector<float> values = SampledAt(drawn, places);
  EXPECT_TRUE(SameBits(SampledAt(drawn, places, 3), values));
  for (const std::int64_t target : targets::OfThisMachine())
  {
    const targets::OnlyTarget only(target);
    EXPECT_TRUE(SameBits(SampledAt(drawn, places), values)) << hwy::TargetName(target);
  }
  cellmeshes::Shuffle(mesh);
  EXPECT_TRUE(SameBits(SampledAt(DrawnMesh(mesh), places), values));
}

TEST(SampleField, LeavesOutCellsWithoutValues)
{
  DrawnMesh drawn(BentCube(Linear));
  drawn.Field.Values.assign(drawn.Field.Values.size(), std::nanf(""));
  const std::vector<float> values =
    SampledAt(drawn, MeshLattice::PlacesFor(*drawn.Field.Cells, 0.5));
  EXPECT_TRUE(
    std::all_of(values.begin(), values.end(), [](float value) { return std::isnan(value); }));
}

std::uint32_t BitsOf(float value)
{
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

TEST(MeshLattice, IsThatOfAFinerOneWhereBothHavePlaces)
{
  const DrawnMesh drawn(BentCube(scenes::Standard));
  ThreadPool pool(2);
  const MeshLattice fine(drawn.Field, 0.25, nullptr, pool);
  const MeshLattice taken(drawn.Field, 0.5, &fine, pool);
  const MeshLattice made(drawn.Field, 0.5, nullptr, pool);
  ASSERT_EQ(taken.Places().Size(), made.Places().Size());
  for (std::size_t i = 0; i < made.Places().Size(); ++i)
  {
    const std::uint32_t bits = BitsOf(made.Values()[i]);
    const std::uint32_t others = BitsOf(taken.Values()[i]);
    ASSERT_EQ(bits & 7u, others & 7u);
    if ((bits & MeshLattice::PlaceBit) != 0)
    {
      ASSERT_EQ(bits, others);
    }
    else if (std::isfinite(made.Values()[i]))
    {
      ASSERT_NEAR(made.Values()[i], taken.Values()[i], 1e-4f);
    }
  }
}

TEST(MeshLattice, SaysWhichOfItsCellsAreInside)
{
  const DrawnMesh drawn(BentCube(Linear));
  ThreadPool pool(1);
  const MeshLattice lattice(drawn.Field, 0.25, nullptr, pool);
  const PlacesInRows& places = lattice.Places();
  int cells[3] = {};
  for (std::size_t i = 0; i < places.Size(); ++i)
  {
    ++cells[BitsOf(lattice.Values()[i]) & MeshLattice::CellBits];
  }
  EXPECT_GT(cells[MeshLattice::Inside], cells[MeshLattice::AtBorder] / 2);
  EXPECT_GT(cells[MeshLattice::AtBorder], 1000);
  const glm::ivec3 middle = places.Count / 2;
  EXPECT_EQ(BitsOf(lattice.Values()[places.IndexOf(middle)]) & 7u,
    MeshLattice::Inside | MeshLattice::PlaceBit);
  EXPECT_EQ(BitsOf(lattice.Values()[0]) & 7u, MeshLattice::Outside);
  EXPECT_TRUE(std::isnan(lattice.Values()[0]));
}

/// Between places of a lattice a linear field is itself, so pictures differ by rounding: they have
/// the same samples and the same ends.
TEST(MeshLevels, ShowLinearFieldsAsCellsDo)
{
  for (const bool shaded : { false, true })
  {
    for (const BlendMode mode : { BlendMode::Composite, BlendMode::Maximum, BlendMode::Average })
    {
      DrawnMesh drawn = Shown(BentCube(Linear));
      drawn.Scene.Shading.On = shaded;
      drawn.Scene.Blend.Mode = mode;
      const cellmeshes::Apart apart = cellmeshes::Between(AtLevel(drawn, 1), drawn.Draw());
      EXPECT_GE(apart.Decibels, 70.0) << shaded << " " << int(mode);
      EXPECT_LE(apart.Worst, 3.0) << shaded << " " << int(mode);
    }
  }
}

TEST(MeshLevels, ShowWhatClipPlanesAndEyesInsideLeave)
{
  DrawnMesh clipped = Shown(BentCube(Linear));
  const glm::dvec3 normal(-0.6, 0.3, -0.7);
  clipped.Scene.ClipPlanes = { { normal, 0.1 - glm::dot(normal, clipped.Centre()) } };
  const FloatImage cells = clipped.Draw();
  EXPECT_GE(cellmeshes::Between(AtLevel(clipped, 1), cells).Decibels, 70.0);
  DrawnMesh within = Shown(BentCube(Linear));
  within.LookFrom(within.Centre(), within.Centre() + glm::dvec3(0.3, 0.1, 0.2),
    glm::perspective(1.0, 1.0, 0.001, 10.0));
  const FloatImage around = within.Draw();
  EXPECT_GT(around.At(36, 36).a, 0.05f);
  EXPECT_GE(cellmeshes::Between(AtLevel(within, 1), around).Decibels, 70.0);
}

TEST(MeshLevels, ComeNearerToCellsTheFinerTheyAre)
{
  DrawnMesh drawn = Shown(BentCube(cellmeshes::StandardField(), 20, Cut::Hexahedra));
  const FloatImage cells = drawn.Draw();
  const double fine = cellmeshes::Between(AtLevel(drawn, 1), cells).Decibels;
  const double coarse = cellmeshes::Between(AtLevel(drawn, 2), cells).Decibels;
  EXPECT_GE(fine, 50.0);
  EXPECT_GE(fine, coarse + 5.0);
}

TEST(MeshLevels, AreTheSameForThreadsInstructionsAndViewports)
{
  DrawnMesh drawn = Shown(BentCube(scenes::Standard));
  for (const bool shaded : { false, true })
  {
    drawn.Scene.Shading.On = shaded;
    const FloatImage image = AtLevel(drawn, 1);
    EXPECT_EQ(MaxDifference(AtLevel(drawn, 1, 3), image), 0.0);
    for (const std::int64_t target : targets::OfThisMachine())
    {
      const targets::OnlyTarget only(target);
      EXPECT_EQ(MaxDifference(AtLevel(drawn, 1), image), 0.0) << hwy::TargetName(target);
    }
    const PixelRect whole = drawn.Scene.Viewport;
    drawn.Scene.Viewport = { { 10, 5 }, { 43, 50 } };
    const FloatImage cutout = AtLevel(drawn, 1);
    for (int y = 5; y < 50; ++y)
    {
      for (int x = 10; x < 43; ++x)
      {
        ASSERT_EQ(cutout.At(x, y), image.At(x, y));
      }
    }
    drawn.Scene.Viewport = whole;
  }
}

TEST(MeshLevels, AreMadeOnceAndCounted)
{
  const DrawnMesh drawn = Shown(BentCube(Linear, 12));
  ThreadPool pool(2);
  CellSource source(drawn.Field, pool);
  EXPECT_EQ(source.LatticeBytes(), 0u);
  EXPECT_NE(source.AtLevel(1, drawn.Scene.DomainCells), nullptr);
  EXPECT_EQ(source.AtLevel(9, drawn.Scene.DomainCells), nullptr) << "of a few places";
  EXPECT_EQ(source.LatticeBytes(), 0u) << "made when a picture asks";
  const auto plain = source.LatticeOf(1, false, pool);
  EXPECT_EQ(source.LatticeOf(1, false, pool), plain);
  EXPECT_GE(source.LatticeBytes(), plain->Places().Size() * sizeof(float));
  const auto shaded = source.LatticeOf(1, true, pool);
  EXPECT_FALSE(plain->HasGradients()) << "a picture may be drawing with it";
  EXPECT_TRUE(shaded->HasGradients());
  EXPECT_GE(source.LatticeBytes(), 4 * plain->Places().Size() * sizeof(float));
}

TEST(MeshLevels, ArePlannedWhereTheyAreGoodEnough)
{
  DrawnMesh drawn = Shown(BentCube(Linear, 20, Cut::Hexahedra), 128);
  ThreadPool pool(2);
  CellSource source(drawn.Field, pool);
  SamplingWish wish;
  wish.Tolerance = 8.0;
  wish.Distance = drawn.Scene.SampleDistance;
  wish.CoarsestLevel = 2;
  wish.LeastCells = 8;
  RayStatistics unused;
  const SamplingPlan plan = PlanSamplings(drawn.Scene, wish,
    [&](const RayScene& probe)
    { return CastRays(probe, source, probe.DomainCells, 1 << 30, pool, unused); });
  ASSERT_NE(plan.Samplings, nullptr);
  EXPECT_GE(*plan.Samplings->UsedLevels().rbegin(), 1);
}

} // namespace
