// SPDX-License-Identifier: BSD-3-Clause
// Meshes whose parts do not join as they should: cracks, hanging nodes on bent faces, triangles
// against bilinear faces, and parts that are there twice.
#include "Cells/CellParts.h"
#include "Cells/RayLengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::Index;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;
using cellmeshes::Warp;

/// Differences in the lengths of rays, in intervals, of those that are longer than half a one.
struct Differences
{
  int Rays = 0;
  int Off = 0; ///< by more than a tenth
  double Mean = 0.0;
  double Worst = 0.0;
};

Differences Compare(const std::vector<double>& lengths, const std::vector<double>& expected)
{
  Differences result;
  for (std::size_t i = 0; i < lengths.size(); ++i)
  {
    const double off = std::abs(lengths[i] - expected[i]);
    if (std::max(lengths[i], expected[i]) > 0.5)
    {
      ++result.Rays;
      result.Off += off > 0.1 ? 1 : 0;
      result.Mean += off;
      result.Worst = std::max(result.Worst, off);
    }
  }
  result.Mean /= std::max(result.Rays, 1);
  return result;
}

ShownAs Close(double step)
{
  ShownAs as;
  as.Picture = { 200, 200 };
  as.Zoom = 2.0;
  as.Edge = 0.125;
  as.Step = step;
  return as;
}

/// @param scene that the mesh is seen in; null for its own
std::vector<double> LengthsIn(
  const OwnedCellMesh& mesh, const ShownAs& as, const RayScene* scene = nullptr)
{
  DrawnMesh drawn(mesh, as);
  if (scene)
  {
    drawn.Scene.Camera = scene->Camera;
  }
  drawn.Scene.Transfer = cellmeshes::Tiny(drawn.Scene);
  std::vector<double> lengths;
  for (const glm::vec4& pixel : drawn.Draw().Pixels)
  {
    lengths.push_back(cellmeshes::LengthIn(drawn.Scene, pixel));
  }
  return lengths;
}

/// The cells of a cut cube on one side of its middle.
OwnedCellMesh HalfOf(int n, Cut cut, const Warp& warp, bool upper)
{
  const OwnedCellMesh straight = cellmeshes::Cube(n, cut);
  const OwnedCellMesh mesh = cellmeshes::Cube(n, cut, warp);
  OwnedCellMesh half = mesh;
  half.Ids.clear();
  half.Offsets.clear();
  half.Types.clear();
  for (std::int64_t cell = 0; cell < mesh.CellCount(); ++cell)
  {
    const std::vector<std::int64_t> corners(mesh.Ids.begin() + mesh.Offsets[Index(cell)],
      mesh.Ids.begin() + mesh.Offsets[Index(cell + 1)]);
    double middle = 0.0;
    for (const std::int64_t corner : corners)
    {
      middle += cellmeshes::PointOf(straight, corner).x / static_cast<double>(corners.size());
    }
    if ((middle > 0.5) == upper)
    {
      half.AddCell(mesh.Types[Index(cell)], corners);
    }
  }
  return half;
}

/// Two triangles of tetrahedra are no bilinear face of a hexahedron: there are gaps, and places
/// that two cells have. A gap is empty, and as thin as it is. A sample in two cells may count for
/// nothing.
TEST(CellCasterJoins, TrianglesAgainstBilinearFaces)
{
  const Warp warp{ 0.0, 0.05, true, 1 };
  for (const double step : { 0.3, 1.0, 3.0 })
  {
    OwnedCellMesh mesh = HalfOf(8, Cut::Hexahedra, warp, false);
    cellmeshes::Append(mesh, HalfOf(8, Cut::FiveTetrahedra, warp, true));
    OwnedCellMesh whole = cellmeshes::Cube(8, Cut::Hexahedra, warp);
    for (OwnedCellMesh* each : { &mesh, &whole })
    {
      cellmeshes::SetValues(*each, scenes::Linear);
    }
    const Differences off = Compare(LengthsIn(mesh, Close(step)), LengthsIn(whole, Close(step)));
    EXPECT_GT(off.Rays, 20000);
    EXPECT_LE(off.Off * step, off.Rays / (step < 1.0 ? 250 : 600)) << step;
    EXPECT_LE(off.Mean, 0.012) << step;
    EXPECT_GT(off.Mean, 0.0) << "they join after all";
    EXPECT_LE(off.Worst, 1.001) << step;
  }
}

/// A coarse block and a fine one, with a wave between them that each follows with its own points.
OwnedCellMesh Waves(double height)
{
  const double pi = std::acos(-1.0);
  OwnedCellMesh mesh;
  mesh.Offsets = { 0 };
  for (const int n : { 4, 6 })
  {
    OwnedCellMesh block = cellmeshes::Cube(n, Cut::Hexahedra);
    for (std::int64_t i = 0; i < block.PointCount(); ++i)
    {
      const glm::dvec3 p = cellmeshes::PointOf(block, i);
      const double middle = 0.5 + height * std::sin(pi * p.y) * std::sin(2.0 * pi * p.z);
      block.Points[Index(3 * i)] = n == 4 ? middle * p.x : middle + (1.0 - middle) * p.x;
    }
    mesh.Offsets.resize(Index(mesh.CellCount() + 1));
    cellmeshes::Append(mesh, block);
  }
  cellmeshes::SetValues(mesh, scenes::Linear);
  return mesh;
}

TEST(CellCasterJoins, HangingNodesOnBentFaces)
{
  OwnedCellMesh box = cellmeshes::Cube(1, Cut::Hexahedra);
  cellmeshes::SetValues(box, scenes::Linear);
  for (const double step : { 0.3, 1.0, 3.0 })
  {
    const std::vector<double> expected = LengthsIn(box, Close(step));
    const Differences straight = Compare(LengthsIn(Waves(0.0), Close(step)), expected);
    EXPECT_GT(straight.Rays, 20000);
    EXPECT_LE(straight.Off, 5) << step;
    const Differences bent = Compare(LengthsIn(Waves(0.05), Close(step)), expected);
    EXPECT_LE(bent.Off, bent.Rays / 8) << step;
    EXPECT_LE(bent.Mean * step, 0.03) << step;
    EXPECT_GT(bent.Mean, straight.Mean) << "they join after all";
    EXPECT_LE(bent.Worst, 1.001) << step;
    ShownAs small;
    small.Edge = 0.125;
    small.Step = step;
    const DrawnMesh drawn(Waves(0.05), small);
    const cellmeshes::Apart apart = cellmeshes::Between(drawn.Draw(), drawn.Reference());
    EXPECT_GE(apart.Decibels, 85.0) << step;
    EXPECT_LE(apart.Worst, 0.2) << step;
  }
}

/// A crack that is thinner than an interval is missing from the lengths of rays by what it is.
TEST(CellCasterJoins, CracksStayOpen)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Tetrahedra, Cut::Pyramids })
  {
    OwnedCellMesh mesh;
    mesh.Offsets = { 0 };
    for (const bool upper : { false, true })
    {
      OwnedCellMesh half = cellmeshes::Cube(3, cut, { 0.03, 0.05, true, 1 });
      cellmeshes::Place(half, { 0.495, 1.0, 1.0 }, { upper ? 0.505 : 0.0, 0.0, 0.0 });
      cellmeshes::Append(mesh, half);
    }
    OwnedCellMesh box = cellmeshes::Cube(1, Cut::Hexahedra);
    OwnedCellMesh crack = box;
    cellmeshes::Place(crack, { 0.01, 1.0, 1.0 }, { 0.495, 0.0, 0.0 });
    for (OwnedCellMesh* each : { &mesh, &box, &crack })
    {
      cellmeshes::SetValues(*each, scenes::Linear);
      cellmeshes::Turn(*each, { 1.0, 2.0, 3.0 }, 0.7);
    }
    for (const double step : { 0.3, 2.0 })
    {
      const DrawnMesh drawn(mesh, Close(step));
      std::vector<double> expected = LengthsIn(box, Close(step), &drawn.Scene);
      const std::vector<double> missing = LengthsIn(crack, Close(step), &drawn.Scene);
      std::transform(
        expected.begin(), expected.end(), missing.begin(), expected.begin(), std::minus<>());
      const Differences off = Compare(LengthsIn(mesh, Close(step)), expected);
      EXPECT_GT(off.Rays, 10000);
      EXPECT_LE(off.Off, off.Rays / 2000) << int(cut) << " " << step;
      EXPECT_LE(off.Mean, 1e-4) << int(cut) << " " << step;
      EXPECT_GT(*std::max_element(missing.begin(), missing.end()), 0.04);
    }
  }
}

/// Faces that two cells have are no border, also where the mesh ends: its ends are those of
/// samples.
TEST(CellCasterJoins, MeshesThatAreThereTwice)
{
  OwnedCellMesh mesh = cellmeshes::Cube(4, Cut::Mixed, { 0.03, 0.05, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Linear);
  const std::vector<double> once = LengthsIn(mesh, Close(1.0));
  ShownAs without = Close(1.0);
  without.Ends = false;
  const std::vector<double> samples = LengthsIn(mesh, without);
  OwnedCellMesh twice = mesh;
  cellmeshes::Append(twice, mesh);
  const std::vector<double> lengths = LengthsIn(twice, Close(1.0));
  EXPECT_EQ(Compare(lengths, samples).Worst, 0.0);
  EXPECT_LE(Compare(lengths, once).Worst, 1.001);
}

} // namespace
