// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellSetup_h
#define banyan_Render_Cells_CellSetup_h

#include "Cells/CellShape.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace banyan
{

/// A field in a cell: a sum over its places, as CellSetup says.
struct CellTerms
{
  float Base = 0.0f;
  float Linear[3] = {};
  float Bent[4] = {};

  /// @param values of the corners
  void Set(CellShape shape, const float (&values)[8]);
};

/// A bilinear face at the border of a mesh. Rays cross it as four triangles around its middle, so
/// samples of the cell end there, too: where
///
///     (Out . x) - Bulge * w(u, v) <= Most, with u = U . x, v = V . x
///
/// Here w is how far the triangles are from u v, and v from -1 to 1 over the face.
struct FanBound
{
  float Out[3] = {};
  float U[4] = {}; ///< and a constant
  float V[3] = {};
  float Bulge = 0.0f;
  float Most = 0.0f;
};

/// What a kernel needs of a cell: its shape as polynomials about a point in its middle.
///
/// A point of the cell is Base + sum of Linear[i] * x_i + the bent terms, in cells of the index
/// space from Middle on. Places x are
///   - hexahedra: r, s, t from -1 to 1; bent terms r s, s t, t r, r s t;
///   - tetrahedra: r, s, t from 0 on, with a sum of at most 1; none;
///   - wedges: r, s from 0 on, with a sum of at most 1, and t from -1 to 1; r t, s t;
///   - pyramids: u, v from -h to h, and h from 0 (apex) to 1 (base); u v / h. So the apex is a
///     place like others.
/// Fields are the same sums.
struct CellSetup
{
  /// Of places beyond a face that count as those of the cell, so that no sample between two cells
  /// is missed.
  static constexpr float Margin = 1.0f / (1 << 13);
  /// A step of Newton's method that is smaller is the last one: the next would be about its square.
  static constexpr float LastStep = 4e-3f;

  CellShape Shape = CellShape::None;
  bool IsBent = false;   ///< whether the bent terms count
  bool IsWide = false;   ///< whether positions in the cell do not fit into 256 cells
  double Middle[3] = {}; ///< fixed-point, whole
  double Reach[3] = {};  ///< fixed-point: no point of the cell is further from the middle
  float Base[3] = {};
  float Linear[3][3] = {}; ///< `[place][axis]`
  float Bent[4][3] = {};   ///< `[term][axis]`
  CellTerms Value;
  CellTerms Gradient[3]; ///< where it is wanted

  // Inverse * (position - Base) is the place, but for the bent terms. What this is for the points
  // of the cell, and their sums, lies between these bounds.
  float Inverse[3][3] = {}; ///< `[place][axis]`
  float Lean[4][3] = {};    ///< Inverse * Bent, `[term][place]`; 0 if large
  float Low[3] = {};
  float High[3] = {};
  bool HasSum = false; ///< whether x_0 + x_1 (+ x_2 of tetrahedra) is at most HighSum
  float HighSum = 0.0f;

  // Places within these bounds are those of the cell: x from Least to Most, and x_0 + x_1 (+ x_2 of
  // tetrahedra) up to MostSum. For pyramids u and v are from Least - h to Most + h.
  float Least[3] = {};
  float Most[3] = {};
  float MostSum = 0.0f;
  FanBound Fans[6]; ///< of bent faces at the border: further bounds
  int FanCount = 0;

  /// Sets all but fields.
  /// @param corners in index space
  /// @param border bits of faces at the border of the mesh, beyond which nothing is the cell's but
  /// what cannot be told from the face
  /// @return false when nothing of the cell can be drawn
  bool Set(CellShape shape, const glm::dvec3 (&corners)[8], unsigned border);

private:
  void SetBounds(const glm::dvec3 (&offsets)[8], const glm::dmat3& inverse);
  void SetBorder(const glm::dvec3 (&corners)[8], unsigned border, float margin);
  void SetFaces(const float (&beyond)[6]);
  void SetFans(const glm::dvec3 (&corners)[8], unsigned border, float (&beyond)[6]);
};

} // namespace banyan

#endif
