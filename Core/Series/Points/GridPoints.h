// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Points_GridPoints_h
#define banyan_Series_Points_GridPoints_h

#include "Base/Box.h"
#include "Series/Format/SeriesIndex.h"

#include <array>
#include <cstddef>
#include <optional>

namespace banyan
{

/// The points of a grid in somebody's memory. Curvilinear: Values[0] has `[z][y][x][3]`, x, y, z of
/// each sample. Rectilinear: Values[a] has the coordinates along axis a.
struct PointsView
{
  PointsForm Form;
  glm::ivec3 Samples{ 0 };
  std::array<const void*, 3> Values{};
};

/// How the points of a grid are cut into chunks, which are coded one by one. Curvilinear: boxes of
/// up to 64 samples per axis, x fastest. Rectilinear: one chunk per axis, in its order.
class PointsLayout
{
public:
  PointsLayout(const PointsForm& form, const glm::ivec3& samples);

  std::int64_t ChunkCount() const;
  /// Samples of a chunk. Of rectilinear grids a row along x, whatever the axis.
  Box SamplesOf(std::int64_t chunk) const;
  ScalarType TypeOf(std::int64_t chunk) const;
  int Components() const { return this->Form.Kind == GridKind::Rectilinear ? 1 : 3; }
  std::size_t TupleBytes(std::int64_t chunk) const;
  std::size_t BytesOf(std::int64_t chunk) const;

private:
  PointsForm Form;
  glm::ivec3 Samples;
  glm::ivec3 Chunks; ///< per axis
};

/// Bytes of all files of points of a series, each counted once; 0 where it has none.
std::uint64_t BytesOfPoints(const SeriesIndex& index);

/// The place of the first coordinate that is NaN or infinite, in the order of the values; nothing
/// where all are finite.
/// @param flags of points: those with one of HiddenPointBits do not count; may be null
std::optional<std::int64_t> FirstNotFinite(ScalarType type, int components, const void* values,
  std::int64_t tuples, const std::uint8_t* flags);

} // namespace banyan

#endif
