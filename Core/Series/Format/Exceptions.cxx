// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/Exceptions.h"

#include "Base/Error.h"
#include "Base/ForEachScalarType.h"
#include "Base/OrderedBits.h"
#include "Base/Varint.h"
#include "Series/Format/Zstd.h"

namespace banyan
{
namespace
{

enum Positions : std::uint8_t
{
  List = 0, ///< varints: distance from the last position, less one
  Mask = 1, ///< one bit per sample
  All = 2
};

/// Differences between successive values, zigzag coded, as planes of bytes.
template <class T>
void AppendValues(const std::vector<T>& values, Bytes& out)
{
  using U = BitsOf<T>;
  std::vector<U> codes(values.size());
  U last = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const U bits = Ordered(values[i]);
    codes[i] = Zigzag(static_cast<U>(bits - last));
    last = bits;
  }
  const std::size_t at = out.size();
  out.resize(at + codes.size() * sizeof(U));
  ToPlanes(codes.data(), codes.size(), out.data() + at);
}

template <class T>
std::vector<T> ReadValues(const std::uint8_t* planes, std::size_t count)
{
  using U = BitsOf<T>;
  std::vector<U> codes(count);
  FromPlanes(planes, count, codes.data());
  std::vector<T> values(count);
  U last = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    last = static_cast<U>(last + FromZigzag(codes[i]));
    values[i] = FromOrdered<T>(last);
  }
  return values;
}

void AppendPositions(const std::vector<std::uint32_t>& positions, std::uint32_t samples, Bytes& out)
{
  if (positions.size() == samples)
  {
    out.push_back(All);
    return;
  }
  if (positions.size() * 8 < samples)
  {
    out.push_back(List);
    std::uint32_t next = 0;
    for (const std::uint32_t position : positions)
    {
      PutVarint(out, position - next);
      next = position + 1;
    }
    return;
  }
  out.push_back(Mask);
  const std::size_t at = out.size();
  out.resize(at + (samples + 7) / 8);
  for (const std::uint32_t position : positions)
  {
    out[at + position / 8] = static_cast<std::uint8_t>(out[at + position / 8] | 1u << position % 8);
  }
}

std::vector<std::uint32_t> ReadPositions(ByteReader& in, std::uint64_t count, std::uint32_t samples)
{
  std::vector<std::uint32_t> positions;
  const std::uint8_t kind = in.Byte();
  if (kind == List)
  {
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < count; ++i)
    {
      const std::uint64_t distance = in.Varint();
      if (distance >= samples - next) // a sum may wrap around
      {
        throw Error("An exception does not lie inside its block");
      }
      next += distance;
      positions.push_back(static_cast<std::uint32_t>(next++));
    }
  }
  else if (kind == Mask || kind == All)
  {
    const std::uint8_t* mask = kind == Mask ? in.Skip((samples + 7) / 8) : nullptr;
    for (std::uint32_t i = 0; i < samples; ++i)
    {
      if (mask == nullptr || (mask[i / 8] >> i % 8 & 1) != 0)
      {
        positions.push_back(i);
      }
    }
  }
  if (positions.size() != count)
  {
    throw Error("The exceptions of a block are not as many as they should be");
  }
  return positions;
}

} // namespace

template <class T>
Bytes PackExceptions(const ExceptionList<T>& list, std::uint32_t samples, int compressionLevel)
{
  Bytes raw;
  AppendPositions(list.Positions, samples, raw);
  AppendValues(list.Values, raw);
  Bytes out;
  PutVarint(out, list.Positions.size());
  PutVarint(out, raw.size());
  const std::size_t head = out.size();
  out.push_back(1);
  AppendCompressed(raw.data(), raw.size(), compressionLevel, out);
  if (out.size() - head - 1 >= raw.size())
  {
    out.resize(head);
    out.push_back(0);
    out.insert(out.end(), raw.begin(), raw.end());
  }
  return out;
}

template <class T>
ExceptionList<T> UnpackExceptions(
  const std::uint8_t* payload, std::size_t bytes, std::uint32_t samples)
{
  ByteReader in(payload, bytes);
  const std::uint64_t count = in.Varint();
  const std::uint64_t rawBytes = in.Varint();
  const std::uint8_t compressed = in.Byte();
  // 6 bytes are more than any position takes.
  if (count > samples || compressed > 1 ||
      rawBytes > std::uint64_t{ samples } * (6 + sizeof(T)) + 16)
  {
    throw Error("The exceptions of a block are not valid");
  }
  Bytes raw;
  const std::uint8_t* data = payload + (bytes - in.Left());
  std::size_t size = in.Left();
  if (compressed == 1)
  {
    raw.resize(static_cast<std::size_t>(rawBytes));
    Decompress(data, size, raw.data(), raw.size());
    data = raw.data();
    size = raw.size();
  }
  ByteReader values(data, size);
  ExceptionList<T> list;
  list.Positions = ReadPositions(values, count, samples);
  list.Values =
    ReadValues<T>(values.Skip(list.Positions.size() * sizeof(T)), list.Positions.size());
  values.MustBeDone();
  return list;
}

template <class T>
void PlaceExceptions(const PlaneRegion& region, int edge, const glm::ivec3& block,
  const ExceptionList<T>& list, T* values)
{
  for (std::size_t i = 0; i < list.Positions.size(); ++i)
  {
    const int at = static_cast<int>(list.Positions[i]);
    const glm::ivec3 sample =
      block * edge + glm::ivec3{ at % edge, at / edge % edge, at / edge / edge };
    // Where the sample shows along each axis: at its own place, and, if it is the field's last one,
    // in the place beyond.
    int places[3][2];
    int counts[3] = {};
    for (int a = 0; a < 3; ++a)
    {
      const int from = sample[a] - region.Low[a];
      const int lastPlace = region.Count[a] - 1;
      if (from >= 0 && from % region.Stride == 0 && from / region.Stride <= lastPlace)
      {
        places[a][counts[a]++] = from / region.Stride;
      }
      if (sample[a] == region.Last[a] && lastPlace * region.Stride > from)
      {
        places[a][counts[a]++] = lastPlace;
      }
    }
    for (int z = 0; z < counts[2]; ++z)
    {
      for (int y = 0; y < counts[1]; ++y)
      {
        for (int x = 0; x < counts[0]; ++x)
        {
          values[(static_cast<std::size_t>(places[2][z]) * region.Count.y + places[1][y]) *
                   region.Count.x +
                 places[0][x]] = list.Values[i];
        }
      }
    }
  }
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template void PlaceExceptions<T>(                                                                \
    const PlaneRegion&, int, const glm::ivec3&, const ExceptionList<T>&, T*);                      \
  template Bytes PackExceptions(const ExceptionList<T>&, std::uint32_t, int);                      \
  template ExceptionList<T> UnpackExceptions<T>(const std::uint8_t*, std::size_t, std::uint32_t)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
