// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_BlockEncoder_h
#define banyan_Codec_BlockEncoder_h

#include "Base/LargePages.h"
#include "Codec/BlockModes.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Lattice numbers of one plane of a field, cut into blocks of Edge^3 samples; Edge is 16 or 32.
///
/// Numbers are padded: there are Blocks * Edge + 1 per axis, x fastest, so that each block has its
/// box of (Edge + 1)^3. Beyond the field's end they are what a decoder predicts there.
class PlaneNumbers
{
public:
  PlaneNumbers() = default;
  /// @param narrow whether numbers are kept in 16 bits: where block::Narrow says so
  PlaneNumbers(const glm::ivec3& samples, int edge, bool narrow);

  int Edge = 16;
  glm::ivec3 Samples{ 1 };
  glm::ivec3 Blocks{ 1 }; ///< ceil(Samples / Edge)
  glm::ivec3 Padded{ 17 };
  bool Narrow = false;

  /// All numbers.
  /// @param Number std::int16_t where they are narrow, else std::int32_t
  template <class Number>
  Number* Data()
  {
    if constexpr (sizeof(Number) == sizeof(std::int16_t))
    {
      return this->Short.data();
    }
    else
    {
      return this->Long.data();
    }
  }
  template <class Number>
  const Number* Data() const
  {
    return const_cast<PlaneNumbers*>(this)->Data<Number>();
  }
  /// Calls body(Data<Number>()).
  template <class Body>
  void With(Body&& body)
  {
    this->Narrow ? body(this->Data<std::int16_t>()) : body(this->Data<std::int32_t>());
  }
  template <class Body>
  void With(Body&& body) const
  {
    this->Narrow ? body(this->Data<std::int16_t>()) : body(this->Data<std::int32_t>());
  }
  std::int32_t At(const glm::ivec3& p) const
  {
    const std::size_t i = static_cast<std::size_t>(this->IndexOf(p));
    return this->Narrow ? this->Short[i] : this->Long[i];
  }

  std::int64_t BlockCount() const
  {
    return std::int64_t{ this->Blocks.x } * this->Blocks.y * this->Blocks.z;
  }
  std::int64_t IndexOf(const glm::ivec3& p) const
  {
    return (std::int64_t{ p.z } * this->Padded.y + p.y) * this->Padded.x + p.x;
  }
  /// The block before another one, x fastest, which one thread encodes after it; the first one is
  /// its own.
  glm::ivec3 BlockBefore(const glm::ivec3& block) const
  {
    const glm::ivec3 last = this->Blocks - 1;
    return block.x > 0   ? glm::ivec3{ block.x - 1, block.y, block.z }
           : block.y > 0 ? glm::ivec3{ last.x, block.y - 1, block.z }
           : block.z > 0 ? glm::ivec3{ last.x, last.y, block.z - 1 }
                         : block;
  }
  friend bool operator==(const PlaneNumbers& a, const PlaneNumbers& b)
  {
    return a.Edge == b.Edge && a.Samples == b.Samples && a.Short == b.Short && a.Long == b.Long;
  }

private:
  std::vector<std::int16_t, InLargePages<std::int16_t>> Short; ///< one of both is empty
  std::vector<std::int32_t, InLargePages<std::int32_t>> Long;
};

/// Samples per axis of the next coarser plane, which keeps every fourth sample; where the last gap
/// is not whole, one more repeats the last sample.
glm::ivec3 CoarserSamples(const glm::ivec3& samples);

/// A block before entropy coding.
struct BlockTokens
{
  std::uint8_t Mode = 0;
  bool Uniform = false;
  bool Same = false; ///< as in reference A, every sample
  std::int32_t Value = 0;
  std::vector<std::uint16_t> Tokens; ///< see residual::TokenOf; empty when all residuals are zero
  std::vector<std::uint32_t> Extra;  ///< of the symbols that have extra bits, in order
  std::vector<std::uint16_t> Runs;   ///< how many tokens each run has
};

struct PlaneToEncode
{
  const PlaneNumbers* Target = nullptr;  ///< what to code, padded by repetition
  const PlaneNumbers* Coarser = nullptr; ///< decoded
  const PlaneNumbers* A = nullptr;       ///< decoded references, or null
  const PlaneNumbers* B = nullptr;
  std::int32_t CoarseBin = 1, FineBin = 1;
  std::int32_t Least = 0, Greatest = 0;
  std::vector<block::Mode> CandidateModes; ///< to choose from; at least one without references
  /// How many of them, those that look best, are encoded to see what they cost; 1: what looks best
  /// is taken.
  int Trials = 1;
};

/// Codes all blocks of a plane.
/// @param decoded a plane like the target (of which nothing is kept); receives exactly what
/// DecodeBox will give
/// @param done called for each block, by any thread, when it is decoded, with the layer behind it:
/// its numbers are still at hand
/// @param begin if not null, called for each block, by any thread, before its numbers to code are
/// asked for: it may make them then
///
/// The result does not depend on the number of threads.
void EncodePlane(const PlaneToEncode& plane, PlaneNumbers& decoded,
  std::vector<BlockTokens>& blocks, ThreadPool& pool,
  const std::function<void(std::int64_t block)>& done,
  const std::function<void(std::int64_t block)>& begin = nullptr);

} // namespace banyan

#endif
