// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_BrickCodec_h
#define banyan_Series_BrickCodec_h

#include "Series/Bytes.h"
#include "Series/Hash.h"
#include "Series/Quantizer.h"

#include <glm/vec3.hpp>

namespace banyan
{

/// How a payload of version 1 is coded; the numbers are part of the file format.
enum class BrickMode : std::uint8_t
{
  MacroVoxel = 0, ///< no payload
  Lattice = 1,
  Raw = 2
};

/// @param uniformValue of a macro voxel, as the node table keeps it
/// @param out receives samples.x * samples.y * samples.z values of `type`
/// Throws Error when mode, payload or value are not valid. Any input is safe; memory taken depends
/// on `samples` alone.
void DecodeBrick(std::uint8_t mode, const std::uint8_t* payload, std::size_t bytes,
  const Quantizer& quantizer, ScalarType type, const glm::ivec3& samples, double uniformValue,
  void* out);

/// The identity of a payload: see Documentation/format.md. For a macro voxel the payload is the 8
/// bytes of its value.
Hash128 IdentityOf(std::uint8_t mode, const std::uint8_t* payload, std::size_t bytes,
  const Quantizer& quantizer, ScalarType type, const glm::ivec3& samples);

/// Whether a double stands for exactly one value of the type, bit by bit.
bool HoldsExactly(ScalarType type, double value);

} // namespace banyan

#endif
