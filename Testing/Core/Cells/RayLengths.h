// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Cells_RayLengths_h
#define banyan_Testing_Core_Cells_RayLengths_h

#include "Cells/DrawnMesh.h"

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace cellmeshes
{

/// How long the rays of a picture are in a mesh, against those in a box.
struct Lengths
{
  int Rays = 0; ///< that meet the box
  int Off = 0;  ///< by more than 1e-3 intervals
  double Worst = 0.0;
};

/// @param toBox takes the world to a space where the box is [0, 1]^3
inline Lengths LengthsOf(DrawnMesh& drawn, const glm::dmat4& toBox)
{
  drawn.Scene.Transfer = Tiny(drawn.Scene);
  const banyan::FloatImage image = drawn.Draw();
  Lengths lengths;
  for (int y = 0; y < image.Rect.Hi.y; ++y)
  {
    for (int x = 0; x < image.Rect.Hi.x; ++x)
    {
      const banyan::Ray ray = drawn.Scene.Camera.RayOf(x, y);
      const glm::dvec3 origin(toBox * glm::dvec4(ray.Origin, 1.0));
      const glm::dvec3 way(toBox * glm::dvec4(ray.Direction, 0.0));
      glm::dvec2 chord(-1e300, 1e300);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double a = -origin[axis] / way[axis];
        const double b = (1.0 - origin[axis]) / way[axis];
        chord = { std::max(chord.x, std::min(a, b)), std::min(chord.y, std::max(a, b)) };
      }
      const double length = std::max(0.0, chord.y - chord.x) / drawn.Scene.SampleDistance;
      const double off = std::abs(LengthIn(drawn.Scene, image.At(x, y)) - length);
      lengths.Rays += length > 0.0 ? 1 : 0;
      lengths.Off += off > 1e-3 ? 1 : 0;
      lengths.Worst = std::max(lengths.Worst, off);
    }
  }
  return lengths;
}

inline void ExpectLengths(DrawnMesh& drawn, const glm::dmat4& toBox)
{
  const Lengths lengths = LengthsOf(drawn, toBox);
  EXPECT_GT(lengths.Rays, 1000);
  EXPECT_LE(lengths.Off, lengths.Rays / 1000);
  EXPECT_LE(lengths.Worst, 1.0);
}

/// Turned in the lattice.
inline glm::dmat4 TurnAndFlatten(OwnedCellMesh& mesh, const glm::dvec3& size)
{
  const glm::dvec3 axis(1.0, 2.0, 3.0);
  Place(mesh, size, glm::dvec3(0.0));
  Turn(mesh, axis, 0.7);
  return glm::scale(glm::dmat4(1.0), 1.0 / size) * glm::rotate(glm::dmat4(1.0), -0.7, axis);
}

} // namespace cellmeshes

#endif
