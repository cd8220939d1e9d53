// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellParts.h"

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace cellmeshes
{

using banyan::CellShape;

namespace
{

double HalfWave(double x)
{
  return std::sin(std::acos(-1.0) * x);
}

/// Waves of half a period and of a whole one: smooth, and cells keep their sides.
glm::dvec3 Bend(const glm::dvec3& p)
{
  const double pi = std::acos(-1.0);
  const auto wave = [&](double a, double b, double c)
  { return HalfWave(a + 0.3) * std::cos(pi * (b - c)) * std::cos(2.0 * pi * c); };
  return { wave(p.y, p.z, p.x), wave(p.z, p.x, p.y), wave(p.x, p.y, p.z) };
}

glm::dvec3 Moved(const glm::dvec3& p, const Warp& warp, const glm::dvec3& offset)
{
  if (!warp.KeepBorder)
  {
    return p + warp.Bend * Bend(p) + offset;
  }
  const bool inner =
    glm::all(glm::greaterThan(p, glm::dvec3(0.0))) && glm::all(glm::lessThan(p, glm::dvec3(1.0)));
  const double part = HalfWave(p.x) * HalfWave(p.y) * HalfWave(p.z);
  return inner ? p + warp.Bend * part * Bend(p) + offset : p;
}

/// The boxes of the cube, and what each is cut into.
class CubeMaker
{
public:
  CubeMaker(int n, Cut cut, const Warp& warp)
    : N(n)
    , As(cut)
  {
    Numbers numbers(warp.Seed);
    for (int z = 0; z <= n; ++z)
    {
      for (int y = 0; y <= n; ++y)
      {
        for (int x = 0; x <= n; ++x)
        {
          // One after the other: arguments have no order.
          const double reach = warp.Offset / n;
          glm::dvec3 offset;
          for (int axis = 0; axis < 3; ++axis)
          {
            offset[axis] = numbers.Between(-reach, reach);
          }
          AddPoint(this->Mesh, Moved(glm::dvec3(x, y, z) / double(n), warp, offset));
        }
      }
    }
  }

  OwnedCellMesh Make()
  {
    this->Mesh.Offsets.push_back(0);
    for (int z = 0; z < this->N; ++z)
    {
      for (int y = 0; y < this->N; ++y)
      {
        for (int x = 0; x < this->N; ++x)
        {
          this->AddBox({ x, y, z });
        }
      }
    }
    return std::move(this->Mesh);
  }

private:
  Cut CutOf(const glm::ivec3& box) const
  {
    if (this->As != Cut::Mixed)
    {
      return this->As;
    }
    static constexpr std::array<Cut, 4> all{ Cut::Hexahedra, Cut::Tetrahedra, Cut::Wedges,
      Cut::Pyramids };
    // Any two of them are neighbours somewhere.
    const glm::ivec3 block = box / 2;
    return all[Index((block.x + 2 * block.y + 3 * block.z + block.x * block.y) % 4)];
  }

  /// Whether a box, if there is one, wants its faces across an axis cut into two triangles. The cut
  /// is from the corner with the lowest coordinates to that with the highest.
  bool WantsCut(const glm::ivec3& box, int axis) const
  {
    for (int i = 0; i < 3; ++i)
    {
      if (box[i] < 0 || box[i] >= this->N)
      {
        return false;
      }
    }
    const Cut cut = this->CutOf(box);
    return cut == Cut::Tetrahedra || (cut == Cut::Wedges && axis == 2);
  }

  /// @param high 1 for the face at the upper end of the axis
  bool IsCut(const glm::ivec3& box, int axis, int high) const
  {
    glm::ivec3 other = box;
    other[axis] += high ? 1 : -1;
    return this->WantsCut(box, axis) || this->WantsCut(other, axis);
  }

  std::array<std::int64_t, 8> CornersOf(const glm::ivec3& box) const
  {
    const std::int64_t row = this->N + 1;
    std::array<std::int64_t, 8> corners;
    for (int i = 0; i < 8; ++i)
    {
      const glm::ivec3 p = box + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
      corners[Index(i)] = p.x + row * (p.y + row * p.z);
    }
    return corners;
  }

  void AddBox(const glm::ivec3& box)
  {
    const std::array<std::int64_t, 8> c = this->CornersOf(box);
    const Cut cut = this->CutOf(box);
    bool sides = false;
    for (int side = 0; side < 4; ++side)
    {
      sides = sides || this->IsCut(box, side / 2, side % 2);
    }
    const bool ends = this->IsCut(box, 2, 0) || this->IsCut(box, 2, 1);
    if (cut == Cut::Tetrahedra)
    {
      this->AddSix(c);
    }
    else if (cut == Cut::FiveTetrahedra)
    {
      this->AddFive(c, (box.x + box.y + box.z) % 2);
    }
    else if (cut == Cut::Wedges && !sides)
    {
      this->Mesh.AddCell(Wedge, { c[0], c[3], c[1], c[4], c[7], c[5] });
      this->Mesh.AddCell(Wedge, { c[0], c[2], c[3], c[4], c[6], c[7] });
    }
    else if (cut == Cut::Hexahedra && !sides && !ends)
    {
      this->Mesh.AddCell(Hexahedron, AsVtkHexahedron(c));
    }
    else if (cut == Cut::Voxels)
    {
      this->Mesh.AddCell(Voxel, { c.begin(), c.end() });
    }
    else
    {
      this->AddStar(box, c);
    }
  }

  void AddSix(const std::array<std::int64_t, 8>& c)
  {
    // From corner to corner along the three axes, in each order of them.
    static constexpr int ways[6][2] = { { 1, 3 }, { 3, 2 }, { 2, 6 }, { 6, 4 }, { 4, 5 },
      { 5, 1 } };
    for (const auto& way : ways)
    {
      this->Mesh.AddCell(Tetrahedron, { c[0], c[Index(way[0])], c[Index(way[1])], c[7] });
    }
  }

  void AddFive(const std::array<std::int64_t, 8>& c, int odd)
  {
    static constexpr int all[2][5][4] = { { { 0, 1, 3, 5 }, { 0, 3, 2, 6 }, { 0, 6, 4, 5 },
                                            { 3, 6, 5, 7 }, { 0, 3, 6, 5 } },
      { { 1, 0, 4, 2 }, { 1, 2, 7, 3 }, { 1, 4, 5, 7 }, { 4, 2, 6, 7 }, { 1, 2, 4, 7 } } };
    for (const auto& t : all[odd])
    {
      this->Mesh.AddCell(
        Tetrahedron, { c[Index(t[0])], c[Index(t[1])], c[Index(t[2])], c[Index(t[3])] });
    }
  }

  /// Pyramids and tetrahedra from the faces to the middle.
  void AddStar(const glm::ivec3& box, const std::array<std::int64_t, 8>& c)
  {
    glm::dvec3 middle(0.0);
    for (const std::int64_t corner : c)
    {
      middle += 0.125 * PointOf(this->Mesh, corner);
    }
    const std::int64_t apex = this->Mesh.PointCount();
    AddPoint(this->Mesh, middle);
    const banyan::CellFaces& faces = banyan::FacesOf(CellShape::Hexahedron);
    for (int face = 0; face < 6; ++face)
    {
      // Seen from the middle.
      std::array<std::int64_t, 4> base;
      for (int i = 0; i < 4; ++i)
      {
        base[Index(i)] = c[Index(faces.Faces[Index(face)].Corners[Index(3 - i)])];
      }
      if (!this->IsCut(box, face / 2, face % 2))
      {
        this->Mesh.AddCell(Pyramid, { base[0], base[1], base[2], base[3], apex });
        continue;
      }
      std::rotate(base.begin(), std::min_element(base.begin(), base.end()), base.end());
      this->Mesh.AddCell(Tetrahedron, { base[0], base[1], base[2], apex });
      this->Mesh.AddCell(Tetrahedron, { base[0], base[2], base[3], apex });
    }
  }

  int N;
  Cut As;
  OwnedCellMesh Mesh;
};

} // namespace

OwnedCellMesh Cube(int n, Cut cut, const Warp& warp)
{
  return CubeMaker(n, cut, warp).Make();
}

} // namespace cellmeshes
