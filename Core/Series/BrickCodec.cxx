// SPDX-License-Identifier: BSD-3-Clause
#include "Series/BrickCodec.h"

#include "Base/Error.h"
#include "Series/Lorenzo.h"
#include "Series/Zstd.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr std::uint8_t WidthBits = 3;
constexpr std::uint8_t LorenzoBit = 4;
constexpr std::uint8_t ZstdBit = 8;
constexpr std::uint8_t Widths[4] = { 0, 1, 2, 4 };

std::size_t CountOf(const glm::ivec3& samples)
{
  return static_cast<std::size_t>(samples.x) * samples.y * samples.z;
}

/// Reads a number and moves `position` behind it.
std::int64_t ReadNumber(const std::uint8_t* data, std::size_t bytes, std::size_t& position)
{
  std::uint64_t number = 0;
  for (int shift = 0; shift < 64; shift += 7)
  {
    if (position >= bytes)
    {
      throw Error("The payload of a brick is cut short");
    }
    const std::uint8_t byte = data[position++];
    number |= static_cast<std::uint64_t>(byte & 127) << shift;
    if (byte < 128)
    {
      return static_cast<std::int64_t>(FromZigzag(number));
    }
  }
  throw Error("The payload of a brick holds a number that is too long");
}

/// Bytes of planes, decompressed into `scratch` where needed.
const std::uint8_t* ReadPlanes(const std::uint8_t* data, std::size_t bytes, bool compressed,
  std::size_t expected, Bytes& scratch)
{
  if (!compressed)
  {
    if (bytes != expected)
    {
      throw Error("The payload of a brick has the wrong size", { {}, {}, bytes, expected });
    }
    return data;
  }
  scratch.resize(expected);
  Decompress(data, bytes, scratch.data(), expected);
  return scratch.data();
}

template <class C>
void ReadCodes(const std::uint8_t* planes, const glm::ivec3& samples, bool lorenzo,
  std::vector<std::uint32_t>& offsets)
{
  thread_local std::vector<C> codes;
  codes.resize(offsets.size());
  FromPlanes(planes, codes.size(), codes.data());
  if (lorenzo)
  {
    std::transform(codes.begin(), codes.end(), codes.begin(), FromZigzag<C>);
    FromLorenzo(codes.data(), samples);
  }
  std::copy(codes.begin(), codes.end(), offsets.begin());
}

template <class T>
void DecodeLattice(const std::uint8_t* payload, std::size_t bytes, const Quantizer& quantizer,
  const glm::ivec3& samples, T* out)
{
  if (bytes == 0 || payload[0] > (WidthBits | LorenzoBit | ZstdBit) ||
      (std::is_floating_point_v<T> && !(quantizer.Step > 0)))
  {
    throw Error("The payload of a brick starts with what no encoder writes");
  }
  const std::uint8_t head = payload[0];
  std::size_t position = 1;
  const std::int64_t base = ReadNumber(payload, bytes, position);
  if (std::is_floating_point_v<T> && std::abs(static_cast<double>(base)) > LatticeLimit)
  {
    throw Error("The payload of a brick starts at a lattice number that is too large");
  }
  const std::size_t width = Widths[head & WidthBits];
  thread_local std::vector<std::uint32_t> offsets;
  thread_local Bytes scratch;
  offsets.resize(CountOf(samples));
  const std::uint8_t* planes = ReadPlanes(
    payload + position, bytes - position, (head & ZstdBit) != 0, offsets.size() * width, scratch);
  const bool lorenzo = (head & LorenzoBit) != 0;
  switch (width)
  {
    case 0:
      std::fill(offsets.begin(), offsets.end(), 0);
      break;
    case 1:
      ReadCodes<std::uint8_t>(planes, samples, lorenzo, offsets);
      break;
    case 2:
      ReadCodes<std::uint16_t>(planes, samples, lorenzo, offsets);
      break;
    default:
      ReadCodes<std::uint32_t>(planes, samples, lorenzo, offsets);
      break;
  }
  Dequantize(quantizer, base, offsets.data(), offsets.size(), out);
}

template <class T>
void DecodeRaw(const std::uint8_t* payload, std::size_t bytes, const glm::ivec3& samples, T* out)
{
  if (bytes == 0 || payload[0] > 1)
  {
    throw Error("The payload of a brick starts with what no encoder writes");
  }
  const std::size_t count = CountOf(samples);
  thread_local Bytes scratch;
  FromPlanes(
    ReadPlanes(payload + 1, bytes - 1, payload[0] == 1, count * sizeof(T), scratch), count, out);
}

template <class T>
bool HoldsExactlyAs(double value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return std::isfinite(value) && std::abs(value) <= std::numeric_limits<T>::max() &&
           static_cast<double>(static_cast<T>(value)) == value;
  }
  else
  {
    // 2^digits is exact as a double, where the type's maximum may not be.
    const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
    const double begin = std::is_signed_v<T> ? -end : 0.0;
    return value >= begin && value < end && std::floor(value) == value;
  }
}

} // namespace

void DecodeBrick(std::uint8_t mode, const std::uint8_t* payload, std::size_t bytes,
  const Quantizer& quantizer, ScalarType type, const glm::ivec3& samples, double uniformValue,
  void* out)
{
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      T* values = static_cast<T*>(out);
      switch (static_cast<BrickMode>(mode))
      {
        case BrickMode::MacroVoxel:
          if (!HoldsExactlyAs<T>(uniformValue))
          {
            throw Error("The value of a macro voxel does not fit its type");
          }
          std::fill(values, values + CountOf(samples), static_cast<T>(uniformValue));
          return;
        case BrickMode::Lattice:
          DecodeLattice(payload, bytes, quantizer, samples, values);
          return;
        case BrickMode::Raw:
          DecodeRaw(payload, bytes, samples, values);
          return;
      }
      throw Error("A brick is coded in a way that this version does not know; a newer Banyan may "
                  "read it",
        { {}, {}, mode, static_cast<std::uint64_t>(BrickMode::Raw) });
    });
}

Hash128 IdentityOf(std::uint8_t mode, const std::uint8_t* payload, std::size_t bytes,
  const Quantizer& quantizer, ScalarType type, const glm::ivec3& samples)
{
  std::uint8_t context[32] = { mode, static_cast<std::uint8_t>(type) };
  StoreNumber(context + 4, std::int32_t{ samples.x });
  StoreNumber(context + 8, std::int32_t{ samples.y });
  StoreNumber(context + 12, std::int32_t{ samples.z });
  if (mode == static_cast<std::uint8_t>(BrickMode::Lattice))
  {
    StoreNumber(context + 16, quantizer.OriginBits(type));
    StoreNumber(context + 24, quantizer.StepBits(type));
  }
  return HashOf(payload, bytes, ShortHashOf(context, sizeof(context)));
}

bool HoldsExactly(ScalarType type, double value)
{
  return Dispatch(
    type, [value](auto tag) { return HoldsExactlyAs<typename decltype(tag)::Type>(value); });
}

} // namespace banyan
