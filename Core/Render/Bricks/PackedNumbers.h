// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_PackedNumbers_h
#define banyan_Render_Bricks_PackedNumbers_h

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// How 16-bit numbers stand for float32 values: number n stands for n * High + n * Low, where the
/// latter product is rounded, and the former and the sum are rounded once (a fused multiplication
/// and addition).
struct NumberScale
{
  float High = 0.0f; ///< the step, rounded
  float Low = 0.0f;  ///< what that leaves of it
};

/// Numbers for values that are whole multiples of a step, each rounded to float32.
///
/// Exactness: bit-exact, zeros of either sign apart. Every value is compared with what its number
/// stands for.
/// @param step > 0
/// @return false when some value is no such multiple, or its number is not in [-32768, 32767]; and
/// on processors without fused operations, which draw from values
bool NumbersOfValues(
  const float* values, std::size_t count, double step, NumberScale& scale, std::int16_t* numbers);

/// What a number stands for, slowly.
float ValueOfNumber(std::int16_t number, const NumberScale& scale);

} // namespace banyan

#endif
