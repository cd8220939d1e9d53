// SPDX-License-Identifier: BSD-3-Clause
// Lengths of rays in meshes of cells.
#include "Cells/RayLengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;
using cellmeshes::Apart;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

TEST(CellCasterEnds, LengthsInATurnedCube)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Voxels, Cut::Tetrahedra, Cut::FiveTetrahedra,
         Cut::Wedges, Cut::Pyramids, Cut::Mixed })
  {
    for (const bool parallel : { false, true })
    {
      OwnedCellMesh mesh = cellmeshes::Cube(4, cut, { 0.04, 0.1, true, 1 });
      cellmeshes::SetValues(mesh, scenes::Linear);
      const glm::dmat4 toBox = cellmeshes::TurnAndFlatten(mesh, glm::dvec3(1.0));
      ShownAs as;
      as.Picture = { 80, 80 };
      as.Parallel = parallel;
      as.Zoom = 2.5;
      as.Edge = 0.125;
      as.Step = 1.6;
      SCOPED_TRACE(testing::Message() << int(cut) << " " << parallel);
      DrawnMesh drawn(mesh, as);
      cellmeshes::ExpectLengths(drawn, toBox);
      drawn.Scene.SampleDistance *= 5.0;
      cellmeshes::ExpectLengths(drawn, toBox);
      drawn.Scene.SampleDistance *= 5.0;
      cellmeshes::ExpectLengths(drawn, toBox);
    }
  }
}

TEST(CellCasterEnds, WithoutThemLengthsAreOff)
{
  OwnedCellMesh mesh = cellmeshes::Cube(4, Cut::Hexahedra, { 0.04, 0.1, true, 1 });
  cellmeshes::SetValues(mesh, scenes::Linear);
  const glm::dmat4 toBox = cellmeshes::TurnAndFlatten(mesh, glm::dvec3(1.0));
  ShownAs as;
  as.Ends = false;
  DrawnMesh drawn(mesh, as);
  const cellmeshes::Lengths lengths = cellmeshes::LengthsOf(drawn, toBox);
  EXPECT_GT(lengths.Off, lengths.Rays * 9 / 10);
  EXPECT_LE(lengths.Worst, 1.01);
}

TEST(CellCasterEnds, ThinShellsKeepTheirThickness)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Tetrahedra, Cut::Wedges, Cut::Pyramids })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(1, cut);
    cellmeshes::SetValues(mesh, scenes::Linear);
    const glm::dmat4 toBox = cellmeshes::TurnAndFlatten(mesh, { 1.0, 1.0, 0.02 });
    ShownAs as;
    as.Picture = { 80, 80 };
    as.Zoom = 2.5;
    as.Edge = 0.125;
    as.Step = 1.6; // ten times as long as it is thick
    DrawnMesh drawn(mesh, as);
    SCOPED_TRACE(int(cut));
    cellmeshes::ExpectLengths(drawn, toBox);
  }
}

TEST(CellCasterEnds, CurvedShells)
{
  OwnedCellMesh mesh = cellmeshes::Sector({ 1, 20, 5 }, 0.98, 4.0);
  cellmeshes::SetValues(mesh, scenes::Linear);
  ShownAs as;
  as.Edge = 0.125;
  as.Step = 1.6;
  as.Zoom = 2.0;
  DrawnMesh drawn(mesh, as);
  drawn.Scene.Transfer.UnitDistance = 0.01;
  const FloatImage image = drawn.Draw();
  const Apart apart = cellmeshes::Between(image, drawn.Reference());
  EXPECT_GE(apart.Decibels, 85.0);
  EXPECT_LE(apart.Worst, 0.2);
  EXPECT_GT(std::count_if(image.Pixels.begin(), image.Pixels.end(),
              [](const glm::vec4& pixel) { return pixel.a > 0.05f; }),
    300);
}

} // namespace
