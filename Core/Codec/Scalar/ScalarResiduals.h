// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_ScalarResiduals_h
#define banyan_Codec_ScalarResiduals_h

#include "Codec/Scalar/ScalarSymbols.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan::scalar
{

using Position = std::array<int, 3>;

/// Axes of the units of a block in the order of its payload.
inline const std::vector<std::vector<int>> Units = { { 0 }, { 1 }, { 2 }, { 0, 1 }, { 0, 2 },
  { 1, 2 }, { 0, 1, 2 } };

/// The passes of a unit, and the rows of each: what a payload is read in, and samples predicted in.
/// @param body called as body(stride, axis, y, z, first, step): the samples x = first, first +
/// step,
/// ... of the row
template <class Body>
void ForEachRow(int edge, int dimensions, Body&& body)
{
  for (int stride = 2; stride >= 1; --stride)
  {
    for (int axis = 0; axis < dimensions; ++axis)
    {
      // Finished axes have all multiples of the stride, those to come only every second one.
      Position first{ 0, 0, 0 };
      Position step{ edge, edge, edge };
      for (int a = 0; a < dimensions; ++a)
      {
        const std::size_t i = static_cast<std::size_t>(a);
        first[i] = a <= axis ? stride : 2 * stride;
        step[i] = a < axis ? stride : 2 * stride;
      }
      for (int z = first[2]; z < edge; z += step[2])
      {
        for (int y = first[1]; y < edge; y += step[1])
        {
          body(stride, axis, y, z, first[0], step[0]);
        }
      }
    }
  }
}

/// A row of a unit that is being read.
struct RowToRead
{
  std::vector<int> Axes; ///< of the unit
  Position First;        ///< of its samples, in the unit
};

/// The order in which a payload is read: the passes of all edges, of all faces and of the interior,
/// each slice by slice.
/// @param body called as body(stride, axis, rows, step) for each slice
template <class Body>
void ForEachSlice(int edge, Body&& body)
{
  for (int dimensions = 1; dimensions <= 3; ++dimensions)
  {
    std::vector<std::vector<int>> units;
    for (const std::vector<int>& axes : Units)
    {
      if (static_cast<int>(axes.size()) == dimensions)
      {
        units.push_back(axes);
      }
    }
    // Rows that follow each other with the same last coordinate are a slice.
    struct Slice
    {
      int Stride, Axis, Last, Step;
      std::vector<Position> Rows;
    };
    std::vector<Slice> slices;
    ForEachRow(edge, dimensions,
      [&](int stride, int axis, int y, int z, int first, int step)
      {
        const int last = dimensions == 3 ? z : y;
        if (slices.empty() || slices.back().Stride != stride || slices.back().Axis != axis ||
            slices.back().Last != last)
        {
          slices.push_back({ stride, axis, last, step, {} });
        }
        slices.back().Rows.push_back({ first, y, z });
      });
    for (const Slice& slice : slices)
    {
      std::vector<RowToRead> rows;
      for (const Position& first : slice.Rows)
      {
        for (const std::vector<int>& axes : units)
        {
          rows.push_back({ axes, first });
        }
      }
      body(slice.Stride, slice.Axis, rows, slice.Step);
    }
  }
}

/// The residuals of a block, all units, `[z][y][x]`; see Decode.
/// @param limit the field's last sample, seen from the block's first one
/// @param narrow residuals are reduced to 16 bits
std::vector<std::int32_t> ReadResiduals(int edge, const StateOf& stateOf, const glm::ivec3& limit,
  bool narrow, const std::uint8_t* data, std::size_t bytes);

} // namespace banyan::scalar

#endif
