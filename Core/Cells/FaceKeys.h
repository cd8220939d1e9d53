// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_FaceKeys_h
#define banyan_Cells_FaceKeys_h

#include "Cells/CellShape.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace banyan
{

/// A key of 64 bits names the places of a face's corners, in any order: their hashes, added up. 0
/// is no face.
using FaceKey = std::uint64_t;

/// The hashes of the places of a cell's corners.
using CornerHashes = std::array<std::uint64_t, 8>;

namespace face_keys
{

/// The key of a face whose corners may coincide.
inline FaceKey OfDifferentCorners(const CellFace& face, const CornerHashes& hashes)
{
  std::array<std::uint64_t, 4> different{};
  std::size_t count = 0;
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(face.Count); ++i)
  {
    const std::uint64_t hash = hashes[static_cast<std::size_t>(face.Corners[i])];
    bool known = false;
    for (std::size_t k = 0; k < count; ++k)
    {
      known = known || different[k] == hash;
    }
    if (!known)
    {
      different[count++] = hash;
      sum += hash;
    }
  }
  return count < 3 ? 0 : sum;
}

template <CellShape Shape>
bool Coincide(const CornerHashes& hashes)
{
  bool coincide = false;
  for (std::size_t i = 1; i < CornersOf(Shape); ++i)
  {
    for (std::size_t k = 0; k < i; ++k)
    {
      coincide |= hashes[i] == hashes[k];
    }
  }
  return coincide;
}

/// @tparam Shape known to the compiler, so that it needs no table of corners
template <CellShape Shape>
int OfCell(const CornerHashes& hashes, std::array<FaceKey, 6>& keys)
{
  constexpr CellFaces faces = FacesOf(Shape);
  const bool coincide = Coincide<Shape>(hashes);
  for (std::size_t i = 0; i < faces.Count; ++i)
  {
    constexpr auto number = [](int corner) { return static_cast<std::size_t>(corner); };
    const std::array<int, 4>& corners = faces.Faces[i].Corners;
    const FaceKey three =
      hashes[number(corners[0])] + hashes[number(corners[1])] + hashes[number(corners[2])];
    keys[i] = faces.Faces[i].Count == 3 ? three : three + hashes[number(corners[3])];
  }
  for (std::size_t i = 0; coincide && i < faces.Count; ++i)
  {
    keys[i] = OfDifferentCorners(faces.Faces[i], hashes);
  }
  return faces.Count;
}

} // namespace face_keys

/// The keys of a cell's faces; 0 where corners coincide so that none is left.
/// @return how many faces the shape has
inline int FaceKeysOf(CellShape shape, const CornerHashes& hashes, std::array<FaceKey, 6>& keys)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return face_keys::OfCell<CellShape::Tetrahedron>(hashes, keys);
    case CellShape::Pyramid:
      return face_keys::OfCell<CellShape::Pyramid>(hashes, keys);
    case CellShape::Wedge:
      return face_keys::OfCell<CellShape::Wedge>(hashes, keys);
    case CellShape::Hexahedron:
      return face_keys::OfCell<CellShape::Hexahedron>(hashes, keys);
    default:
      return 0;
  }
}

} // namespace banyan

#endif
