// SPDX-License-Identifier: BSD-3-Clause
// The reference for pictures of cells, against that for images and against lengths in closed form.
#include "Cells/CellMeshes.h"
#include "Render/Cells/CellReference.h"
#include "Render/Scene/RayLattice.h"
#include "Render/Scenes.h"

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::OwnedCellMesh;
using Samples = std::vector<std::vector<ReferenceSample>>;

const std::vector<Cut> AllCuts{ Cut::Hexahedra, Cut::Voxels, Cut::Tetrahedra, Cut::FiveTetrahedra,
  Cut::Wedges, Cut::Pyramids, Cut::Mixed };

/// Crossings this near to a sample count as its owner says, in sample distances.
constexpr double NearMiddle = 1e-2;

FloatImage Draw(const RayScene& scene, const OwnedCellMesh& mesh, bool ends,
  const glm::dmat4& toIndex = glm::dmat4(1.0), const scenes::Function& function = scenes::Smooth)
{
  return CellReferenceImage(
    scene, mesh.View(), mesh.Order(), toIndex, mesh.ValueOfPoint(), function, ends, NearMiddle);
}

Samples SamplesIn(const RayScene& scene, const OwnedCellMesh& mesh,
  const std::vector<std::uint32_t>& order, bool ends, double nearMiddle = NearMiddle)
{
  return CellReferenceSamples(
    scene, mesh.View(), order, glm::dmat4(1.0), mesh.ValueOfPoint(), ends, nearMiddle);
}

/// A cube with an edge of 5, turned, with its middle in that of a domain of 12^3.
struct TurnedCube
{
  explicit TurnedCube(Cut cut, bool parallel = false, double distance = 0.7)
    : Scene(scenes::Scene(glm::ivec3(13), { 41, 41 }, glm::dmat4(1.0), 1.4, parallel))
    , Mesh(cellmeshes::Cube(4, cut, { 0.04, 0.1, true }))
  {
    this->Scene.SampleDistance = distance;
    cellmeshes::SetValues(this->Mesh, cellmeshes::LinearField({ 0.2, 0.3, 0.4 }, 0.05));
    cellmeshes::Place(this->Mesh, glm::dvec3(5.0), glm::dvec3(-2.5));
    cellmeshes::Turn(this->Mesh, { 1.0, 2.0, 3.0 }, 0.7);
    cellmeshes::Place(this->Mesh, glm::dvec3(1.0), glm::dvec3(6.0));
    this->ToCube = glm::rotate(glm::dmat4(1.0), -0.7, glm::dvec3(1.0, 2.0, 3.0));
    this->ToCube = glm::translate(this->ToCube, glm::dvec3(-6.0));
  }

  /// Where a pixel's ray is in the cube: from x to y, in world lengths.
  glm::dvec2 ChordOf(int x, int y) const
  {
    const Ray ray = this->Scene.Camera.RayOf(x, y);
    const glm::dvec3 origin(this->ToCube * glm::dvec4(ray.Origin, 1.0));
    const glm::dvec3 way(this->ToCube * glm::dvec4(ray.Direction, 0.0));
    glm::dvec2 chord(-1e300, 1e300);
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = (-2.5 - origin[axis]) / way[axis];
      const double b = (2.5 - origin[axis]) / way[axis];
      chord = { std::max(chord.x, std::min(a, b)), std::min(chord.y, std::max(a, b)) };
    }
    return chord;
  }

  RayScene Scene;
  OwnedCellMesh Mesh;
  glm::dmat4 ToCube{ 1.0 };
};

/// The lengths that rays have in the mesh against those of a turned cube.
struct Lengths
{
  int Rays = 0;        ///< that meet the cube
  double Worst = 0.0;  ///< difference, in sample distances
  int Off = 0;         ///< rays with a difference of more than 1e-9
  double Partly = 0.0; ///< of all rays, what samples cover that cover a part of their interval
};

Lengths Compare(const TurnedCube& cube, bool ends, double nearMiddle)
{
  const RayScene& scene = cube.Scene;
  const Samples samples = SamplesIn(scene, cube.Mesh, cube.Mesh.Order(), ends, nearMiddle);
  Lengths lengths;
  for (int y = 0; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = 0; x < scene.Viewport.Hi.x; ++x)
    {
      double sum = 0.0;
      for (const ReferenceSample& sample :
        samples[static_cast<std::size_t>(y * scene.Viewport.Hi.x + x)])
      {
        sum += sample.Covered;
        lengths.Partly += sample.Covered < sample.Length ? sample.Covered : 0.0;
      }
      const glm::dvec2 chord = cube.ChordOf(x, y);
      const double length = std::max(0.0, chord.y - chord.x) / scene.SampleDistance;
      const double difference = std::abs(sum - length);
      lengths.Rays += length > 0.0 ? 1 : 0;
      lengths.Off += difference > 1e-9 ? 1 : 0;
      lengths.Worst = std::max(lengths.Worst, difference);
    }
  }
  return lengths;
}

TEST(CellReference, HexahedraAreAnImage)
{
  const glm::ivec3 n(9);
  RayScene scene = scenes::Scene(n, { 33, 24 });
  scene.SampleDistance = 0.83;
  const glm::dmat4 toIndex = glm::scale(glm::dmat4(1.0), glm::dvec3(8.0));
  for (const scenes::Field& field :
    { scenes::Field(scenes::Linear), scenes::Field(scenes::Standard) })
  {
    const std::vector<float> values = scenes::Sampled(field, n);
    const FloatImage image = ReferenceImage(scene, scenes::ValueOf(values, n), scenes::Smooth);
    EXPECT_GT(image.At(16, 12).a, 0.05f);
    for (const Cut cut : { Cut::Hexahedra, Cut::Voxels })
    {
      OwnedCellMesh mesh = cellmeshes::Cube(8, cut);
      cellmeshes::SetValues(mesh, field);
      EXPECT_LE(MaxDifference(Draw(scene, mesh, false, toIndex), image), 2e-6);
      EXPECT_LE(MaxDifference(Draw(scene, mesh, true, toIndex), image), 2e-6);
    }
    OwnedCellMesh grid = cellmeshes::Rectilinear(glm::ivec3(8), 1.0);
    cellmeshes::SetValues(grid, field);
    EXPECT_LE(MaxDifference(Draw(scene, grid, false, toIndex), image), 2e-6);
  }
}

TEST(CellReference, EveryShapeDrawsALinearFieldAlike)
{
  RayScene scene = scenes::Scene(glm::ivec3(5), { 33, 24 });
  scene.SampleDistance = 0.37;
  const glm::dmat4 toIndex = glm::scale(glm::dmat4(1.0), glm::dvec3(4.0));
  for (const bool ends : { false, true })
  {
    FloatImage first;
    for (const Cut cut : AllCuts)
    {
      OwnedCellMesh mesh = cellmeshes::Cube(4, cut);
      cellmeshes::SetValues(mesh, cellmeshes::LinearField({ 0.5, 0.25, 0.125 }, 0.0625));
      const FloatImage image = Draw(scene, mesh, ends, toIndex);
      first = cut == AllCuts.front() ? image : first;
      EXPECT_LE(MaxDifference(image, first), 1e-7) << int(cut);
    }
    EXPECT_GT(first.At(16, 12).a, 0.05f);
  }
}

TEST(CellReference, WithEndsLengthsAreExact)
{
  for (const Cut cut : AllCuts)
  {
    for (const bool parallel : { false, true })
    {
      const Lengths lengths = Compare(TurnedCube(cut, parallel), true, NearMiddle);
      EXPECT_GT(lengths.Rays, 100);
      EXPECT_LE(lengths.Worst, 1e-9) << int(cut) << " " << parallel;
    }
  }
}

TEST(CellReference, SamplesLongerThanTheMeshHaveExactLengthsToo)
{
  for (const double distance : { 3.0, 20.0 })
  {
    const Lengths lengths = Compare(TurnedCube(Cut::Hexahedra, false, distance), true, NearMiddle);
    EXPECT_LE(lengths.Worst, 1e-9) << distance;
    EXPECT_GT(lengths.Partly, 1.0) << distance;
  }
}

TEST(CellReference, WithoutEndsLengthsAreOffByUpToAnInterval)
{
  const Lengths lengths = Compare(TurnedCube(Cut::Hexahedra), false, NearMiddle);
  EXPECT_LE(lengths.Worst, 1.0 + 1e-2);
  EXPECT_GT(lengths.Worst, 0.5);
  EXPECT_EQ(lengths.Partly, 0.0);
}

/// Rays through edges of triangles, their middles and corners: each side is crossed once.
TEST(CellReference, RaysThroughEdgesOfFacesCrossThemOnce)
{
  const glm::dvec3 centre(4.0);
  // Pixel centres are at multiples of 1/4 in the domain of 8^3.
  const glm::dmat4 view = glm::lookAt(centre + glm::dvec3(0, 0, 20), centre, glm::dvec3(0, 1, 0));
  const double half = 4.125;
  RayScene scene = scenes::Scene(glm::ivec3(9), { 33, 33 });
  scene.Camera =
    RayCamera(glm::ortho(-half, half, -half, half, 1.0, 40.0) * view, { 33, 33 }, centre);
  scene.SampleDistance = 0.7;
  for (const Cut cut : AllCuts)
  {
    OwnedCellMesh mesh = cellmeshes::Cube(2, cut);
    cellmeshes::SetValues(mesh, scenes::Linear);
    cellmeshes::Place(mesh, glm::dvec3(5.0, 5.0, 5.0), glm::dvec3(1.5));
    const Samples samples = SamplesIn(scene, mesh, mesh.Order(), true);
    for (int y = 7; y < 26; ++y)
    {
      for (int x = 7; x < 26; ++x)
      {
        double sum = 0.0;
        for (const ReferenceSample& sample : samples[static_cast<std::size_t>(33 * y + x)])
        {
          sum += sample.Covered;
        }
        EXPECT_NEAR(sum * scene.SampleDistance, 5.0, 1e-9) << int(cut) << " " << x << " " << y;
      }
    }
  }
}

/// The formula alone takes a sample that is slightly outside of its cell for one inside.
TEST(CellReference, SamplesBesideTheBorderAreOffInTheFormulaAlone)
{
  RayScene scene = scenes::Scene(glm::ivec3(9), { 9, 9 }, glm::dmat4(1.0), 1.4, true);
  const glm::dvec3 centre(4.0);
  const glm::dmat4 view = glm::lookAt(centre + glm::dvec3(0, 0, 20), centre, glm::dvec3(0, 1, 0));
  scene.Camera = RayCamera(glm::ortho(-1.0, 1.0, -1.0, 1.0, 1.0, 40.0) * view, { 9, 9 }, centre);
  scene.SampleDistance = 0.75;
  std::int64_t position[3];
  RayLattice(scene).SamplesOf(4, 4).PositionOf(3, position);
  const double sample = std::ldexp(static_cast<double>(position[2]), -FractionBits);
  // Above the upper face by 0.3 of what counts.
  OwnedCellMesh mesh = cellmeshes::Cube(1, Cut::Hexahedra);
  cellmeshes::SetValues(mesh, scenes::Linear);
  const double top = sample - 0.3 * 0x1p-20 * 1.25;
  cellmeshes::Place(mesh, glm::dvec3(2.5), { 2.5, 2.5, top - 2.5 });
  for (const double nearMiddle : { 0.0, NearMiddle })
  {
    for (const std::vector<ReferenceSample>& samples :
      SamplesIn(scene, mesh, mesh.Order(), true, nearMiddle))
    {
      double sum = 0.0;
      for (const ReferenceSample& each : samples)
      {
        sum += each.Covered * scene.SampleDistance;
      }
      const double off = nearMiddle == 0.0 ? 0.5 * scene.SampleDistance : 0.0;
      EXPECT_NEAR(sum, 2.5 + off, 1e-6) << nearMiddle;
    }
  }
}

TEST(CellReference, SamplesOutsideTakeTheValueOfTheBorder)
{
  const TurnedCube cube(Cut::Mixed);
  const auto field = [&](double along, int x, int y)
  {
    const Ray ray = cube.Scene.Camera.RayOf(x, y);
    const glm::dvec4 at(ray.Origin + along * ray.Direction, 1.0);
    const glm::dvec3 unit = (glm::dvec3(cube.ToCube * at) + 2.5) / 5.0;
    return glm::dot(glm::dvec3(0.2, 0.3, 0.4), unit) + 0.05;
  };
  const CellReference reference(cube.Scene, cube.Mesh.View(), cube.Mesh.Order(), glm::dmat4(1.0),
    cube.Mesh.ValueOfPoint(), true, NearMiddle);
  int outside = 0;
  for (int y = 0; y < 41; ++y)
  {
    for (int x = 0; x < 41; ++x)
    {
      const std::vector<ReferenceSample> samples = reference.SamplesOf(x, y);
      const auto covered = [](const ReferenceSample& sample) { return sample.Covered > 0.0; };
      const auto first = std::find_if(samples.begin(), samples.end(), covered);
      if (first != samples.end() && first->Cell < 0)
      {
        ++outside;
        // Where the ray leaves in the same interval, too, it is the mean: the field is linear.
        const glm::dvec2 chord = cube.ChordOf(x, y);
        const double length = first->Covered * cube.Scene.SampleDistance;
        const bool leaves = std::abs(length - (chord.y - chord.x)) < 1e-9;
        EXPECT_NEAR(first->Value, field(leaves ? 0.5 * (chord.x + chord.y) : chord.x, x, y), 1e-6);
      }
      for (const ReferenceSample& sample : samples)
      {
        EXPECT_TRUE(sample.Covered == 0.0 || std::isfinite(sample.Value));
      }
    }
  }
  EXPECT_GT(outside, 40);
}

/// Two cubes that overlap in half of each.
OwnedCellMesh TwoCubes(double first, double second)
{
  OwnedCellMesh mesh;
  for (int cube = 0; cube < 2; ++cube)
  {
    std::vector<std::int64_t> corners;
    for (const int corner : { 0, 1, 3, 2, 4, 5, 7, 6 })
    {
      const glm::dvec3 p(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 at = 4.0 * p + glm::dvec3(1.0 + 2.0 * cube, 2.0, 2.0);
      mesh.Points.insert(mesh.Points.end(), { at.x, at.y, at.z });
      corners.push_back(mesh.PointCount() - 1);
    }
    mesh.AddCell(12, corners);
    mesh.Values.insert(mesh.Values.end(), 8, static_cast<float>(cube == 0 ? first : second));
  }
  return mesh;
}

/// How many samples each cell owns, and none; and what is covered in all.
struct Owners
{
  std::array<int, 3> Samples{};
  double Covered = 0.0;
};

Owners OwnersOf(const OwnedCellMesh& mesh, const std::vector<std::uint32_t>& order,
  const scenes::Function& function, bool ends)
{
  RayScene scene = scenes::Scene(glm::ivec3(9), { 24, 24 });
  scene.SampleDistance = 0.5;
  scene.Transfer = scenes::Tabulate(function);
  Owners owners;
  for (const auto& samples : SamplesIn(scene, mesh, order, ends))
  {
    for (const ReferenceSample& sample : samples)
    {
      ++owners.Samples[static_cast<std::size_t>(sample.Cell + 1)];
      owners.Covered += sample.Covered;
      if (sample.Cell >= 0)
      {
        EXPECT_NEAR(sample.Value, mesh.Values[static_cast<std::size_t>(8 * sample.Cell)], 1e-12);
      }
    }
  }
  return owners;
}

TEST(CellReference, TheLastCellOfTheOrderOwnsASample)
{
  const OwnedCellMesh mesh = TwoCubes(0.25, 0.75);
  const Owners alone = OwnersOf(mesh, { 0 }, scenes::Smooth, false);
  const Owners other = OwnersOf(mesh, { 1 }, scenes::Smooth, false);
  const Owners upward = OwnersOf(mesh, { 0, 1 }, scenes::Smooth, false);
  const Owners downward = OwnersOf(mesh, { 1, 0 }, scenes::Smooth, false);
  EXPECT_GT(alone.Samples[1], 100);
  EXPECT_EQ(downward.Samples[1], alone.Samples[1]);
  EXPECT_EQ(upward.Samples[2], other.Samples[2]);
  EXPECT_LT(upward.Samples[1], 0.7 * alone.Samples[1]);
  EXPECT_EQ(upward.Samples[0], downward.Samples[0]);
}

TEST(CellReference, CellsThatCannotBeSeenAreNotThere)
{
  // Sparse shows nothing below 0.25.
  const OwnedCellMesh mesh = TwoCubes(0.75, 0.1);
  for (const bool ends : { false, true })
  {
    const Owners alone = OwnersOf(mesh, { 0 }, scenes::Sparse, ends);
    const Owners both = OwnersOf(mesh, { 0, 1 }, scenes::Sparse, ends);
    EXPECT_EQ(both.Samples, alone.Samples);
    EXPECT_EQ(both.Covered, alone.Covered);
    EXPECT_GT(alone.Covered, 100.0);
  }
  OwnedCellMesh broken = TwoCubes(0.75, 0.75);
  broken.Values[10] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(OwnersOf(broken, { 0, 1 }, scenes::Smooth, true).Samples[2], 0);
}

TEST(CellReference, NeighboursOfCellsThatCannotBeSeenHaveNoBorder)
{
  // Side by side, in domain and index space as they stand.
  OwnedCellMesh mesh = cellmeshes::Cube(2, Cut::Hexahedra);
  cellmeshes::Place(mesh, glm::dvec3(8.0), glm::dvec3(0.0));
  cellmeshes::SetValues(mesh, [](const glm::dvec3& p) { return p.x < 6.0 ? 0.1 : 0.9; });
  RayScene scene = scenes::Scene(glm::ivec3(9), { 24, 24 });
  scene.SampleDistance = 0.5;
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  double covered = 0.0;
  for (const auto& samples : SamplesIn(scene, mesh, mesh.Order(), true))
  {
    for (const ReferenceSample& sample : samples)
    {
      // But for rounding, rays begin and end at the border of the mesh.
      EXPECT_NEAR(sample.Covered, sample.Cell >= 0 ? sample.Length : 0.0, 1e-5);
      EXPECT_TRUE(sample.Cell < 0 || sample.Cell % 2 == 1);
      covered += sample.Covered;
    }
  }
  EXPECT_GT(covered, 100.0);
}

TEST(CellReference, HiddenCellsLeaveABorder)
{
  const TurnedCube cube(Cut::Hexahedra);
  std::vector<std::uint8_t> hidden(64, 0);
  std::vector<std::uint32_t> shown;
  for (std::uint32_t cell = 0; cell < 64; ++cell)
  {
    hidden[cell] = cell % 4 < 2 ? 1 : 0;
    if (hidden[cell] == 0)
    {
      shown.push_back(cell);
    }
  }
  CellMesh view = cube.Mesh.View();
  const auto draw = [&](const std::vector<std::uint32_t>& order)
  {
    return CellReferenceImage(cube.Scene, view, order, glm::dmat4(1.0), cube.Mesh.ValueOfPoint(),
      scenes::Smooth, true, NearMiddle);
  };
  const FloatImage rest = draw(shown);
  EXPECT_GT(MaxDifference(draw(cube.Mesh.Order()), rest), 0.01);
  view.Hidden = hidden.data();
  EXPECT_EQ(MaxDifference(draw(cube.Mesh.Order()), rest), 0.0);
}

TEST(CellReference, OrdersOfCellsAndPointsAndTheirSidesChangeNothing)
{
  const TurnedCube cube(Cut::Mixed);
  const FloatImage first = Draw(cube.Scene, cube.Mesh, true);
  EXPECT_GT(first.At(20, 20).a, 0.05f);
  OwnedCellMesh other = cube.Mesh;
  cellmeshes::Shuffle(other);
  EXPECT_LE(MaxDifference(Draw(cube.Scene, other, true), first), 1e-6);
  cellmeshes::SeparatePoints(other);
  EXPECT_LE(MaxDifference(Draw(cube.Scene, other, true), first), 1e-6);
  cellmeshes::MirrorCells(other);
  EXPECT_LE(MaxDifference(Draw(cube.Scene, other, true), first), 1e-6);
}

TEST(CellReference, GridsAreDrawnAsTheirCells)
{
  RayScene scene = scenes::Scene(glm::ivec3(9), { 33, 33 });
  scene.SampleDistance = 0.6;
  const glm::dmat4 toIndex = glm::scale(glm::dmat4(1.0), glm::dvec3(8.0));
  for (OwnedCellMesh grid :
    { cellmeshes::Sector({ 3, 7, 2 }, 0.4, 1.5), cellmeshes::Rectilinear({ 5, 3, 4 }) })
  {
    cellmeshes::SetValues(grid, scenes::Standard);
    const FloatImage image = Draw(scene, grid, true, toIndex);
    EXPECT_GT(image.At(16, 16).a, 0.05f);
    EXPECT_EQ(MaxDifference(Draw(scene, cellmeshes::AsCells(grid), true, toIndex), image), 0.0);
  }
}

} // namespace
