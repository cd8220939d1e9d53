// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_CodecTesting_h
#define banyan_Testing_CodecTesting_h

#include "Base/ThreadPool.h"
#include "Codec/BlockDecoder.h"
#include "Codec/BlockEncoder.h"
#include "Codec/BlockScratch.h"
#include "Codec/Scalar/ScalarBox.h"
#include "Codec/SymbolWriter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <type_traits>
#include <vector>

namespace banyan::testing
{

/// Numbers of a plane from f(x, y, z), padded by repetition.
template <class Function>
PlaneNumbers PlaneOf(const glm::ivec3& samples, int edge, Function&& f, bool narrow = false)
{
  PlaneNumbers plane(samples, edge, narrow);
  plane.With(
    [&](auto* numbers)
    {
      for (int z = 0; z < plane.Padded.z; ++z)
      {
        for (int y = 0; y < plane.Padded.y; ++y)
        {
          for (int x = 0; x < plane.Padded.x; ++x)
          {
            *numbers++ = static_cast<std::remove_pointer_t<decltype(numbers)>>(f(
              std::min(x, samples.x - 1), std::min(y, samples.y - 1), std::min(z, samples.z - 1)));
          }
        }
      }
    });
  return plane;
}

/// Something of everything: smooth, rough, flat and empty places, and some outliers.
inline std::int32_t MixedNumber(int x, int y, int z, unsigned seed)
{
  std::uint32_t noise =
    (static_cast<std::uint32_t>(x) * 73856093u ^ static_cast<std::uint32_t>(y) * 19349663u ^
      static_cast<std::uint32_t>(z) * 83492791u) +
    seed;
  noise = (noise ^ noise >> 15) * 2654435761u;
  noise ^= noise >> 13;
  const double smooth =
    4000.0 * std::sin(0.11 * x + 0.3 * seed) * std::cos(0.07 * y + 0.1) * std::sin(0.05 * z + 0.9);
  const int kind = (x / 11 + y / 13 + z / 7) % 4;
  const int amplitude = kind == 0 ? 2000 : kind == 1 ? 20 : 0;
  const int bump = amplitude > 0 ? static_cast<int>(noise % static_cast<unsigned>(amplitude)) : 0;
  const int outlier = noise % 997 == 0 ? 100000000 : 0;
  return static_cast<std::int32_t>(smooth) + bump + outlier;
}

/// A plane encoded, and all that a decoder needs of it.
struct EncodedPlane
{
  PlaneToEncode Plane;
  PlaneNumbers Decoded;
  std::vector<BlockTokens> Blocks;
  std::vector<std::vector<std::uint8_t>> Payloads;
  std::vector<tans::Frequencies> Frequencies;
  DecodeTables Tables;
};

inline EncodedPlane EncodeWhole(const PlaneToEncode& plane, int threads = 2)
{
  EncodedPlane result;
  result.Plane = plane;
  ThreadPool pool(threads);
  result.Decoded = PlaneNumbers(plane.Target->Samples, plane.Target->Edge, plane.Target->Narrow);
  EncodePlane(plane, result.Decoded, result.Blocks, pool, [](std::int64_t) {});
  ContextCounts counts;
  for (const BlockTokens& block : result.Blocks)
  {
    counts.Add(block.Tokens);
  }
  const SymbolTables tables(counts);
  result.Frequencies = tables.Frequencies();
  result.Tables = DecodeTablesOf(tables.Frequencies());
  for (const BlockTokens& block : result.Blocks)
  {
    result.Payloads.push_back(block.Tokens.empty()
                                ? std::vector<std::uint8_t>{}
                                : tables.Encode(block.Tokens, block.Extra, block.Runs));
  }
  return result;
}

/// A box and the memory that its description points to.
struct Box3
{
  BoxCode Code;
  std::vector<std::int32_t> Coarse, A, B;
};

/// The (edge + 1)^3 numbers of a block and what lies behind it.
inline std::vector<std::int32_t> BoxNumbers(const PlaneNumbers& plane, const glm::ivec3& block)
{
  std::vector<std::int32_t> numbers;
  const glm::ivec3 low = block * plane.Edge;
  for (int z = low.z; z <= low.z + plane.Edge; ++z)
  {
    for (int y = low.y; y <= low.y + plane.Edge; ++y)
    {
      plane.With(
        [&](const auto* all)
        {
          const auto* row = all + plane.IndexOf({ low.x, y, z });
          numbers.insert(numbers.end(), row, row + plane.Edge + 1);
        });
    }
  }
  return numbers;
}

inline glm::ivec3 BlockAt(const PlaneNumbers& plane, std::int64_t index)
{
  return { static_cast<int>(index % plane.Blocks.x),
    static_cast<int>(index / plane.Blocks.x % plane.Blocks.y),
    static_cast<int>(index / plane.Blocks.x / plane.Blocks.y) };
}

inline Box3 MakeBox(const EncodedPlane& encoded, const glm::ivec3& block)
{
  Box3 box;
  const PlaneNumbers& target = *encoded.Plane.Target;
  for (int bits = 0; bits < 8; ++bits)
  {
    const glm::ivec3 at = block + glm::ivec3{ bits & 1, bits >> 1 & 1, bits >> 2 & 1 };
    if (at.x >= target.Blocks.x || at.y >= target.Blocks.y || at.z >= target.Blocks.z)
    {
      continue;
    }
    const std::size_t index =
      static_cast<std::size_t>((at.z * target.Blocks.y + at.y) * target.Blocks.x + at.x);
    BlockCode& code = box.Code.Blocks[bits];
    code.Exists = true;
    code.Uniform = encoded.Blocks[index].Uniform;
    code.Same = encoded.Blocks[index].Same;
    code.Value = encoded.Blocks[index].Value;
    code.Mode = encoded.Blocks[index].Mode;
    code.Data = encoded.Payloads[index].data();
    code.Bytes = encoded.Payloads[index].size();
    code.Limit = target.Samples - 1 - at * target.Edge;
  }
  const PlaneNumbers& coarser = *encoded.Plane.Coarser;
  const int n = target.Edge / 4 + 1;
  const glm::ivec3 first = block * (target.Edge / 4);
  for (int i = 0; i < n * n * n; ++i)
  {
    const glm::ivec3 p = first + glm::ivec3{ i % n, i / n % n, i / n / n };
    box.Coarse.push_back(coarser.At({ std::min(p.x, coarser.Samples.x - 1),
      std::min(p.y, coarser.Samples.y - 1), std::min(p.z, coarser.Samples.z - 1) }));
  }
  box.Code.Coarse = box.Coarse.data();
  if (encoded.Plane.A != nullptr)
  {
    box.A = BoxNumbers(*encoded.Plane.A, block);
    box.B = BoxNumbers(*encoded.Plane.B, block);
    box.Code.A = box.A.data();
    box.Code.B = box.B.data();
  }
  return box;
}

/// Neighbours' boxes, where they are at hand.
using NeighbourBoxes = std::array<std::vector<std::int32_t>, 3>;

/// Decodes in 16 or 32 bits, as the lattice asks for.
template <class Number>
std::vector<std::int32_t> DecodeAs(
  const EncodedPlane& encoded, const Box3& box, const NeighbourBoxes& neighbours)
{
  const PlaneToEncode& plane = encoded.Plane;
  const int edge = plane.Target->Edge;
  const PlaneCode shared{ &encoded.Tables, plane.CoarseBin, plane.FineBin, plane.Least,
    plane.Greatest };
  std::vector<std::vector<Number>> memory;
  memory.reserve(6);
  const auto converted = [&](const std::vector<std::int32_t>& numbers, bool given) -> const Number*
  {
    memory.emplace_back(numbers.begin(), numbers.end());
    return given ? memory.back().data() : nullptr;
  };
  BoxCodeOf<Number> code;
  std::copy(std::begin(box.Code.Blocks), std::end(box.Code.Blocks), std::begin(code.Blocks));
  code.Coarse = converted(box.Coarse, true);
  code.A = converted(box.A, box.Code.A != nullptr);
  code.B = converted(box.B, box.Code.B != nullptr);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    code.Neighbours[axis] = converted(neighbours[axis], !neighbours[axis].empty());
  }
  std::vector<Number> numbers(static_cast<std::size_t>((edge + 1) * (edge + 1) * (edge + 1)));
  DecodeBox(edge, shared, code, numbers.data());
  return { numbers.begin(), numbers.end() };
}

inline std::vector<std::int32_t> DecodeFast(
  const EncodedPlane& encoded, const Box3& box, const NeighbourBoxes& neighbours = {})
{
  return block::Narrow(encoded.Plane.Least, encoded.Plane.Greatest)
           ? DecodeAs<std::int16_t>(encoded, box, neighbours)
           : DecodeAs<std::int32_t>(encoded, box, neighbours);
}

inline std::vector<std::int32_t> DecodeSlow(const EncodedPlane& encoded, const Box3& box)
{
  const PlaneToEncode& plane = encoded.Plane;
  // States by their own rules, not from the tables that the kernels read.
  std::vector<std::vector<scalar::State>> states;
  for (const tans::Frequencies& context : encoded.Frequencies)
  {
    states.push_back(scalar::StatesFrom(context));
  }
  const auto stateOf = [&states](int context, std::uint32_t state)
  { return states[static_cast<std::size_t>(context)][state]; };
  return scalar::Decode(plane.Target->Edge,
    { stateOf, plane.CoarseBin, plane.FineBin, plane.Least, plane.Greatest }, box.Code);
}

/// A plane of mixed numbers with a coarser one and two references, as neighbours in time have them.
struct MixedPlanes
{
  MixedPlanes(const glm::ivec3& samples, int edge, unsigned seed)
    : Target(
        PlaneOf(samples, edge, [seed](int x, int y, int z) { return MixedNumber(x, y, z, seed); }))
    , Coarser(PlaneOf(CoarserSamples(samples), edge,
        [&](int x, int y, int z)
        {
          const glm::ivec3 last = samples - 1;
          return MixedNumber(std::min(4 * x, last.x), std::min(4 * y, last.y),
                   std::min(4 * z, last.z), seed) +
                 (x + y + z) % 5 - 2;
        }))
    , A(PlaneOf(samples, edge,
        [seed, edge](int x, int y, int z)
        {
          // Every third block is as good as the same.
          const bool same = (x / edge + y / edge + z / edge) % 3 == 1;
          return MixedNumber(x, y, z, seed) + (same ? 3 : MixedNumber(y, x, z, 5) / 50);
        }))
    , B(PlaneOf(samples, edge,
        [seed](int x, int y, int z) { return MixedNumber(x, y, z + 1, seed + 1) - 50; }))
  {
  }

  PlaneToEncode With(std::vector<block::Mode> candidates, bool references) const
  {
    PlaneToEncode plane;
    plane.Target = &this->Target;
    plane.Coarser = &this->Coarser;
    plane.A = references ? &this->A : nullptr;
    plane.B = references ? &this->B : nullptr;
    plane.CoarseBin = 23;
    plane.FineBin = 31;
    plane.Least = -6000;
    plane.Greatest = 120000000;
    plane.CandidateModes = std::move(candidates);
    return plane;
  }

  /// The same in a lattice whose predictions are in 16 bits. Numbers go from one end of it to the
  /// other, so that some arithmetic wraps.
  PlaneToEncode NarrowWith(std::vector<block::Mode> candidates, bool references)
  {
    for (PlaneNumbers* plane : { &this->Target, &this->Coarser, &this->A, &this->B })
    {
      *plane = PlaneOf(
        plane->Samples, plane->Edge,
        [old = *plane](int x, int y, int z) {
          return std::clamp(old.At({ x, y, z }), -3500, 4500);
        },
        true);
    }
    PlaneToEncode plane = this->With(std::move(candidates), references);
    plane.Least = -3500;
    plane.Greatest = 4500;
    return plane;
  }

  PlaneNumbers Target, Coarser, A, B;
};

} // namespace banyan::testing

#endif
