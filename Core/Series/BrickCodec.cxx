#include "Series/BrickCodec.h"

#include "Base/Error.h"
#include "Base/ForEachScalarType.h"
#include "Series/Lorenzo.h"
#include "Series/Zstd.h"

#include <algorithm>
#include <array>
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

void AppendNumber(std::int64_t number, Bytes& out)
{
  std::uint64_t rest = ToZigzag(static_cast<std::uint64_t>(number));
  for (; rest >= 128; rest >>= 7)
  {
    out.push_back(static_cast<std::uint8_t>(rest | 128));
  }
  out.push_back(static_cast<std::uint8_t>(rest));
}

/// Reads what `AppendNumber` wrote and moves `position` behind it.
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

/// Appends planes as they are or as a zstd frame, whichever is smaller; says whether compressed.
bool AppendPlanes(const Bytes& planes, int level, Bytes& out)
{
  const std::size_t before = out.size();
  AppendCompressed(planes.data(), planes.size(), level, out);
  if (out.size() - before < planes.size())
  {
    return true;
  }
  out.resize(before);
  out.insert(out.end(), planes.begin(), planes.end());
  return false;
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

/// Bits that an ideal order-0 coder needs for the bytes of some numbers: a quick guess at what zstd
/// will make of them.
template <class C>
double OrderZeroBits(const std::vector<C>& numbers)
{
  std::array<std::array<std::uint32_t, 256>, sizeof(C)> histograms{};
  for (const C number : numbers)
  {
    for (std::size_t p = 0; p < sizeof(C); ++p)
    {
      ++histograms[p][number >> 8 * p & 255];
    }
  }
  const double total = static_cast<double>(numbers.size());
  double bits = 0;
  for (const auto& histogram : histograms)
  {
    for (const std::uint32_t count : histogram)
    {
      bits += count > 0 ? count * std::log2(total / count) : 0;
    }
  }
  return bits;
}

/// Both predictors, the smaller one kept; where a guess already says which, the other is not tried.
/// C is as wide as the codes need.
template <class C>
void AppendCodes(const std::vector<std::uint32_t>& offsets, const glm::ivec3& samples, int level,
  std::uint8_t widthCode, std::int64_t base, Bytes& payload)
{
  const std::size_t count = offsets.size();
  thread_local std::vector<C> codes;
  thread_local std::vector<C> residuals;
  codes.resize(count);
  residuals.resize(count);
  std::transform(offsets.begin(), offsets.end(), codes.begin(),
    [](std::uint32_t offset) { return static_cast<C>(offset); });
  ToLorenzo(codes.data(), samples, residuals.data());
  std::transform(residuals.begin(), residuals.end(), residuals.begin(), ToZigzag<C>);

  thread_local Bytes planes;
  planes.resize(count * sizeof(C));
  const auto code = [&](const std::vector<C>& numbers, std::uint8_t predictor, Bytes& out)
  {
    ToPlanes(numbers.data(), count, planes.data());
    out.assign(1, static_cast<std::uint8_t>(widthCode | predictor));
    AppendNumber(base, out);
    out[0] |= AppendPlanes(planes, level, out) ? ZstdBit : 0;
  };
  constexpr double clear = 0.7;
  const double lorenzoBits = OrderZeroBits(residuals);
  const double plainBits = OrderZeroBits(codes);
  if (plainBits < clear * lorenzoBits)
  {
    code(codes, 0, payload);
    return;
  }
  code(residuals, LorenzoBit, payload);
  if (lorenzoBits < clear * plainBits)
  {
    return;
  }
  thread_local Bytes plain;
  code(codes, 0, plain);
  if (plain.size() < payload.size())
  {
    payload = plain;
  }
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

/// Codes on the lattice; returns false when they lie too far apart.
template <class T>
bool EncodeLattice(
  const LatticeNumber<T>* numbers, const glm::ivec3& samples, int level, Bytes& payload)
{
  const std::size_t count = CountOf(samples);
  const auto extremes = std::minmax_element(numbers, numbers + count);
  const LatticeNumber<T> least = *extremes.first;
  const std::uint64_t width =
    static_cast<std::uint64_t>(*extremes.second) - static_cast<std::uint64_t>(least);
  if (width > (std::is_floating_point_v<T> ? 0x7fffffffu : 0xffffffffu))
  {
    return false;
  }
  const std::int64_t base = static_cast<std::int64_t>(least);
  if (width == 0)
  {
    payload.assign(1, 0);
    AppendNumber(base, payload);
    return true;
  }
  thread_local std::vector<std::uint32_t> offsets;
  offsets.resize(count);
  std::transform(numbers, numbers + count, offsets.begin(),
    [least](LatticeNumber<T> number)
    {
      return static_cast<std::uint32_t>(
        static_cast<std::uint64_t>(number) - static_cast<std::uint64_t>(least));
    });
  if (width <= 0xff)
  {
    AppendCodes<std::uint8_t>(offsets, samples, level, 1, base, payload);
  }
  else if (width <= 0xffff)
  {
    AppendCodes<std::uint16_t>(offsets, samples, level, 2, base, payload);
  }
  else
  {
    AppendCodes<std::uint32_t>(offsets, samples, level, 3, base, payload);
  }
  return true;
}

template <class T>
void EncodeRaw(const T* values, std::size_t count, int level, Bytes& payload)
{
  thread_local Bytes planes;
  planes.resize(count * sizeof(T));
  ToPlanes(values, count, planes.data());
  payload.assign(1, 0);
  payload[0] = AppendPlanes(planes, level, payload) ? 1 : 0;
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

template <class T>
EncodedBrick EncodeBrick(const LatticeNumber<T>* numbers, const T* decoded,
  const glm::ivec3& samples, bool onLattice, bool uniform, int compressionLevel)
{
  EncodedBrick brick;
  if (uniform)
  {
    brick.Mode = BrickMode::MacroVoxel;
    return brick;
  }
  const std::size_t count = CountOf(samples);
  if (onLattice && EncodeLattice<T>(numbers, samples, compressionLevel, brick.Payload))
  {
    brick.Mode = BrickMode::Lattice;
    // Only codes as wide as the values themselves can be worse than these.
    if (brick.Payload.size() <= count * sizeof(T) / 2)
    {
      return brick;
    }
  }
  Bytes raw;
  EncodeRaw(decoded, count, compressionLevel, raw);
  if (brick.Mode == BrickMode::Raw || raw.size() < brick.Payload.size())
  {
    brick.Mode = BrickMode::Raw;
    brick.Payload = std::move(raw);
  }
  return brick;
}

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

#define BANYAN_INSTANTIATE(T)                                                                      \
  template EncodedBrick EncodeBrick<T>(                                                            \
    const LatticeNumber<T>*, const T*, const glm::ivec3&, bool, bool, int)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
