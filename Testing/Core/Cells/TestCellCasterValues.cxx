// SPDX-License-Identifier: BSD-3-Clause
// Projections, light, gradients and means of cells, and what cannot be seen.
#include "Cells/DrawnMesh.h"
#include "Render/Cells/PointMeans.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using namespace banyan;
using cellmeshes::Apart;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

const std::vector<Cut> AllCuts{ Cut::Hexahedra, Cut::Voxels, Cut::Tetrahedra, Cut::FiveTetrahedra,
  Cut::Wedges, Cut::Pyramids, Cut::Mixed };

OwnedCellMesh BentCube(Cut cut = Cut::Mixed, const cellmeshes::Field& field = scenes::Standard)
{
  OwnedCellMesh mesh = cellmeshes::Cube(5, cut, { 0.03, 0.05, false, 1 });
  cellmeshes::SetValues(mesh, field);
  return mesh;
}

/// A projection, sample by sample.
glm::vec4 Projected(const DrawnMesh& drawn, const std::vector<ReferenceSample>& samples)
{
  const RayBlend& blend = drawn.Scene.Blend;
  double best = std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  double weight = 0.0;
  for (const ReferenceSample& sample : samples)
  {
    if (!(sample.Covered > 0.0) || !std::isfinite(sample.Value))
    {
      continue;
    }
    const bool better =
      blend.Mode == BlendMode::Minimum ? sample.Value < best : sample.Value > best;
    best = better || std::isnan(best) ? sample.Value : best;
    if (sample.Value >= blend.AveragedLow && sample.Value <= blend.AveragedHigh)
    {
      const double grey = (sample.Value - blend.Black) / (blend.White - blend.Black);
      sum += sample.Covered * std::clamp(grey, 0.0, 1.0) * cellmeshes::Dense(sample.Value).a;
      weight += sample.Covered;
    }
  }
  if (blend.Mode == BlendMode::Average)
  {
    const double grey = std::clamp(sum / weight, 0.0, 1.0);
    return weight > 0.0 ? glm::vec4(glm::vec3(static_cast<float>(grey)), 1.0f) : glm::vec4(0.0f);
  }
  if (std::isnan(best))
  {
    return glm::vec4(0.0f);
  }
  const glm::dvec4 entry = cellmeshes::Dense(best);
  return glm::vec4(glm::dvec4(glm::dvec3(entry) * entry.a, entry.a));
}

void ExpectProjection(const DrawnMesh& drawn)
{
  const FloatImage image = drawn.Draw();
  FloatImage expected = image;
  const auto samples = drawn.Samples();
  double most = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    expected.Pixels[i] = Projected(drawn, samples[i]);
    most = std::max(most, double{ expected.Pixels[i].a });
  }
  EXPECT_GT(most, 0.01);
  const Apart apart = cellmeshes::Between(image, expected);
  // Entries are 1/4096 of the function apart.
  EXPECT_GE(apart.Decibels, 75.0);
  EXPECT_LE(apart.Worst, 0.3);
}

TEST(CellCasterValues, Projections)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Mixed })
  {
    for (const bool ends : { false, true })
    {
      for (const BlendMode mode : { BlendMode::Maximum, BlendMode::Minimum, BlendMode::Average })
      {
        SCOPED_TRACE(testing::Message() << int(cut) << " " << ends << " " << int(mode));
        ShownAs as;
        as.Ends = ends;
        DrawnMesh drawn(BentCube(cut), as);
        drawn.Scene.Blend.Mode = mode;
        drawn.Scene.Blend.White = 0.5;
        ExpectProjection(drawn);
        const glm::dvec3 normal(-0.6, 0.3, -0.7);
        drawn.Scene.ClipPlanes = { { normal, 0.3 - glm::dot(normal, drawn.Centre()) } };
        ExpectProjection(drawn);
      }
    }
  }
}

TEST(CellCasterValues, AveragesOfSomeValues)
{
  // Constant in cells: neither these values nor means of two are near the ends of the range.
  OwnedCellMesh mesh = BentCube();
  cellmeshes::SeparatePoints(mesh);
  for (std::size_t i = 0; i < mesh.Values.size(); ++i)
  {
    const auto cell =
      std::upper_bound(mesh.Offsets.begin(), mesh.Offsets.end(), static_cast<std::int64_t>(i)) -
      mesh.Offsets.begin();
    mesh.Values[i] = 0.05f + 0.1f * static_cast<float>(cell % 9);
  }
  DrawnMesh drawn(mesh);
  drawn.Scene.Blend = { BlendMode::Average, 0.22, 0.62, 0.1, 0.4 };
  ExpectProjection(drawn);
  drawn.Field.Base = 0.125;
  drawn.Scene.Blend = { BlendMode::Average, 0.36, 0.73, 0.1, 0.4 };
  ExpectProjection(drawn);
}

TEST(CellCasterValues, ALinearFieldIsLitAsAnImageIs)
{
  const glm::ivec3 n(9);
  const glm::dvec3 slope(0.3, 0.25, 0.3);
  std::vector<float> values = scenes::Sampled(cellmeshes::LinearField(slope, 0.05), n);
  glm::dmat4 toWorld = glm::rotate(glm::dmat4(1.0), 0.6, glm::dvec3(1.0, 2.0, -0.5));
  toWorld = glm::scale(toWorld, glm::dvec3(1.0, 2.0, 0.7));
  for (const Cut cut : AllCuts)
  {
    cellmeshes::Warp warp{ 0.03, 0.05, true, 1 };
    OwnedCellMesh mesh = cellmeshes::Cube(8, cut, warp);
    cellmeshes::SetValues(mesh, cellmeshes::LinearField(slope, 0.05));
    ShownAs as;
    as.Ends = false;
    as.Actor = glm::scale(toWorld, glm::dvec3(8.0));
    as.Edge = 1.0 / 8;
    DrawnMesh drawn(mesh, as);
    // The lattice is that of the image.
    DrawnCells cells = *drawn.Field.Cells;
    cells.Lattice = { glm::dvec3(0.0), 1.0 / 8, glm::ivec3(8) };
    drawn.SetCells(cells);
    drawn.Scene = scenes::Scene(n, { 48, 48 }, toWorld);
    drawn.Scene.SampleDistance = 0.6;
    drawn.Scene.Shading.On = true;
    drawn.Scene.Shading.Specular = 0.4f;
    const FloatImage lit = drawn.Draw();
    FloatImage image = lit;
    image.Pixels.assign(lit.Pixels.size(), glm::vec4(0.0f));
    const FloatImage drawnImage = scenes::Draw(drawn.Scene, scenes::ArrayOf(values, n)).Image;
    for (int y = drawnImage.Rect.Lo.y; y < drawnImage.Rect.Hi.y; ++y)
    {
      for (int x = drawnImage.Rect.Lo.x; x < drawnImage.Rect.Hi.x; ++x)
      {
        image.At(x, y) = drawnImage.At(x, y);
      }
    }
    const Apart apart = cellmeshes::Between(lit, image);
    EXPECT_LE(apart.Worst, 0.1) << int(cut);
    EXPECT_GT(lit.At(24, 24).a, 0.1f);
    drawn.Scene.Shading.On = false;
    EXPECT_GT(cellmeshes::Between(lit, drawn.Draw()).Worst, 1.0);
  }
}

/// Samples outside of cells, at ends, are lit as those inside.
TEST(CellCasterValues, EndsAreLit)
{
  ShownAs as;
  as.Parallel = true;
  as.Step = 2.5;
  DrawnMesh drawn(BentCube(Cut::Mixed, cellmeshes::LinearField({ 0.3, 0.2, 0.25 }, 0.1)), as);
  const FloatImage plain = drawn.Draw();
  drawn.Scene.Shading.On = true;
  drawn.Scene.Shading.Diffuse = 1.0f;
  drawn.Scene.Shading.Ambient = 0.0f;
  const FloatImage lit = drawn.Draw();
  const glm::dvec3 gradient = glm::normalize(glm::dvec3(0.3, 0.2, 0.25));
  const double cosine = std::abs(glm::dot(gradient, drawn.Scene.Camera.ViewDirection()));
  for (std::size_t i = 0; i < lit.Pixels.size(); ++i)
  {
    EXPECT_EQ(lit.Pixels[i].a, plain.Pixels[i].a);
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(lit.Pixels[i][k], cosine * plain.Pixels[i][k], 1e-5);
    }
  }
}

TEST(CellCasterValues, ValuesOfCellsAreLitByTheirMeans)
{
  // A linear field of cells: their means are linear inside, and so is the light there.
  OwnedCellMesh mesh = cellmeshes::Cube(8, Cut::Hexahedra);
  const glm::dvec3 slope(0.3, 0.2, 0.25);
  mesh.Values.clear();
  const CellMesh view = mesh.View();
  for (std::int64_t cell = 0; cell < view.CellCount; ++cell)
  {
    const MeshCell corners = view.Cell(cell);
    const glm::dvec3 middle = 0.5 * (view.Point(corners.Points[0]) + view.Point(corners.Points[7]));
    mesh.Values.push_back(static_cast<float>(glm::dot(slope, middle) + 0.1));
  }
  ShownAs as;
  as.OfCells = true;
  DrawnMesh drawn(mesh, as);
  ThreadPool pool(2);
  const std::vector<float> means = PointMeans(*drawn.Field.Cells, drawn.Field.Values, pool);
  const std::vector<float> gradients = PointGradients(*drawn.Field.Cells, means, pool);
  int inner = 0;
  for (std::int64_t i = 0; i < view.PointCount; ++i)
  {
    const glm::dvec3 p = view.Point(i);
    const auto beyond = [&](double edge) {
      return std::min({ p.x, p.y, p.z }) < edge || std::max({ p.x, p.y, p.z }) > 1.0 - edge;
    };
    const auto at = static_cast<std::size_t>(i);
    if (!beyond(0.1))
    {
      EXPECT_NEAR(means[at], glm::dot(slope, p) + 0.1, 1e-6);
    }
    for (int axis = 0; axis < 3 && !beyond(0.2); ++axis)
    {
      const std::size_t number = 3 * at + static_cast<std::size_t>(axis);
      EXPECT_NEAR(gradients[number], slope[axis] / 8.0, 1e-6);
      ++inner;
    }
  }
  EXPECT_EQ(inner, 3 * 125);
  const FloatImage plain = drawn.Draw();
  drawn.Scene.Shading.On = true;
  const FloatImage lit = drawn.Draw();
  EXPECT_GT(cellmeshes::Between(lit, plain).Worst, 1.0);
  for (std::size_t i = 0; i < lit.Pixels.size(); ++i)
  {
    EXPECT_EQ(lit.Pixels[i].a, plain.Pixels[i].a);
  }
}

TEST(CellCasterValues, GradientsOfLinearFieldsAreExact)
{
  const glm::dvec3 slope(0.3, -0.7, 1.1);
  for (const Cut cut : AllCuts)
  {
    for (const double bend : { 0.0, 0.1 })
    {
      OwnedCellMesh mesh = cellmeshes::Cube(4, cut, { bend, bend, false, 1 });
      const glm::dvec3 size(1.0, 0.1, 10.0);
      cellmeshes::Place(mesh, size, glm::dvec3(0.0));
      cellmeshes::SetValues(mesh, cellmeshes::LinearField(slope, 0.5));
      ShownAs as;
      as.Edge = 0.25;
      const DrawnMesh drawn(mesh, as);
      ThreadPool pool(3);
      const std::vector<float> gradients =
        PointGradients(*drawn.Field.Cells, drawn.Field.Values, pool);
      ASSERT_EQ(gradients.size(), 3 * static_cast<std::size_t>(mesh.PointCount()));
      ThreadPool alone(1);
      EXPECT_EQ(PointGradients(*drawn.Field.Cells, drawn.Field.Values, alone), gradients);
      for (std::size_t i = 0; i < gradients.size(); ++i)
      {
        // Values are floats below 16, and edges about a quarter of the cube.
        const int axis = static_cast<int>(i % 3);
        const double slack = 12.0 * 0x1p-21 / (0.25 * size[axis]);
        EXPECT_NEAR(gradients[i] / 0.25, slope[axis], slack)
          << int(cut) << " " << bend << " " << axis;
      }
    }
  }
}

TEST(CellCasterValues, MeansOfConstantsAreConstant)
{
  for (const Cut cut : AllCuts)
  {
    OwnedCellMesh mesh = cellmeshes::Cube(4, cut, { 0.05, 0.1, false, 1 });
    mesh.Points.insert(mesh.Points.end(), { 0.5, 0.5, 0.5 });
    mesh.Values.assign(static_cast<std::size_t>(mesh.CellCount()), 0.7f);
    const DrawnMesh drawn(mesh);
    ThreadPool pool(2);
    std::vector<float> means = PointMeans(*drawn.Field.Cells, drawn.Field.Values, pool);
    ASSERT_EQ(means.size(), static_cast<std::size_t>(mesh.PointCount()));
    EXPECT_TRUE(std::isnan(means.back()));
    means.pop_back();
    for (const float mean : means)
    {
      EXPECT_NEAR(mean, 0.7f, 1e-7);
    }
  }
}

/// A hexahedron of volume 1 beside each corner of a cell, with other values.
TEST(CellCasterValues, MeansAreWeightedByVolumes)
{
  struct Volume
  {
    CellShape Shape;
    double Of;
  };
  for (const Volume& volume :
    { Volume{ CellShape::Tetrahedron, 1.0 / 6 }, Volume{ CellShape::Pyramid, 1.0 / 3 },
      Volume{ CellShape::Wedge, 0.5 }, Volume{ CellShape::Hexahedron, 1.0 } })
  {
    const OwnedCellMesh alone = cellmeshes::OneCell(volume.Shape);
    for (const std::int64_t corner : alone.Ids)
    {
      OwnedCellMesh mesh = alone;
      std::vector<std::int64_t> corners;
      for (const int i : { 0, 1, 3, 2, 4, 5, 7, 6 })
      {
        const glm::dvec3 p = alone.View().Point(corner) + glm::dvec3(i & 1, i >> 1 & 1, i >> 2);
        mesh.Points.insert(mesh.Points.end(), { p.x, p.y, p.z });
        corners.push_back(i == 0 ? corner : mesh.PointCount() - 1);
      }
      mesh.AddCell(12, corners);
      mesh.Values = { 3.0f, 5.0f };
      const DrawnMesh drawn(mesh);
      ThreadPool pool(1);
      const float mean =
        PointMeans(*drawn.Field.Cells, mesh.Values, pool)[static_cast<std::size_t>(corner)];
      EXPECT_NEAR(mean, (3.0 * volume.Of + 5.0) / (volume.Of + 1.0), 1e-6)
        << int(volume.Shape) << " " << corner;
    }
  }
}

TEST(CellCasterValues, CellsThatCannotBeSeenAreSkipped)
{
  DrawnMesh drawn(BentCube());
  RayStatistics all;
  (void)drawn.Draw(1, &all);
  EXPECT_EQ(all.BricksSkipped, 0);
  EXPECT_GE(all.BricksDrawn, drawn.Mesh->CellCount());
  // Nothing below 0.45.
  const auto sparse = [](double value)
  {
    glm::dvec4 entry = cellmeshes::Dense(value);
    entry.a = value < 0.45 ? 0.0 : entry.a * (value - 0.45);
    return entry;
  };
  drawn.Scene.Transfer.Entries = scenes::Tabulate(sparse).Entries;
  RayStatistics few;
  const FloatImage image = drawn.Draw(1, &few);
  EXPECT_LE(cellmeshes::Between(image, drawn.Reference(sparse)).Worst, 0.2);
  EXPECT_GT(few.BricksSkipped, drawn.Mesh->CellCount() * 3 / 4);
  EXPECT_LT(few.BricksSkipped, drawn.Mesh->CellCount());
  EXPECT_LT(few.SamplesTaken, all.SamplesTaken / 3);
  EXPECT_GT(few.SamplesTaken, 0);
}

TEST(CellCasterValues, ValuesThatCannotBeSeenDrawNothing)
{
  DrawnMesh drawn(BentCube());
  drawn.Scene.Transfer.Low = 2.0;
  drawn.Scene.Transfer.High = 3.0;
  drawn.Scene.Transfer.Entries.front().a = 0.0f;
  drawn.Scene.Transfer.Entries[1].a = 0.0f;
  drawn.Scene.Transfer.Entries[2].a = 0.0f;
  RayStatistics statistics;
  const FloatImage image = drawn.Draw(1, &statistics);
  for (const glm::vec4& pixel : image.Pixels)
  {
    ASSERT_EQ(pixel, glm::vec4(0.0f));
  }
  EXPECT_EQ(statistics.BricksSkipped, drawn.Mesh->CellCount());
  EXPECT_EQ(statistics.SamplesTaken, 0);
}

TEST(CellCasterValues, CellsBesideThePictureAreSkipped)
{
  DrawnMesh drawn(BentCube());
  const glm::dvec3 centre = drawn.Centre();
  const glm::dvec3 eye = centre + drawn.Diagonal() * glm::dvec3(0.0, 0.0, 2.0);
  drawn.LookFrom(eye, centre + glm::dvec3(0.3, 0.0, 0.0), glm::perspective(0.1, 1.0, 0.1, 10.0));
  RayStatistics statistics;
  const FloatImage image = drawn.Draw(1, &statistics);
  EXPECT_LE(cellmeshes::Between(image, drawn.Reference()).Worst, 0.2);
  EXPECT_GT(statistics.BricksSkipped, drawn.Mesh->CellCount() / 2);
  EXPECT_LT(statistics.BricksSkipped, drawn.Mesh->CellCount());
}

} // namespace
