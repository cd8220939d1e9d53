// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Points/PointsCode.h"

#include "Base/Error.h"
#include "Base/OrderedBits.h"
#include "Series/Format/Zstd.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr int Level = 3; ///< of zstd: higher ones gain hardly anything on differences

std::size_t CountOf(const glm::ivec3& size)
{
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
         static_cast<std::size_t>(size.z);
}

/// Replaces numbers by differences to the one before along an axis, modulo their size; the first
/// ones stay.
template <class U>
void Differences(const glm::ivec3& size, int axis, U* numbers)
{
  const std::size_t step = axis == 0   ? 1
                           : axis == 1 ? static_cast<std::size_t>(size.x)
                                       : static_cast<std::size_t>(size.x) * size.y;
  const std::size_t block = step * static_cast<std::size_t>(size[axis]);
  for (std::size_t first = 0; first < CountOf(size); first += block)
  {
    for (std::size_t i = block - 1; i >= step; --i)
    {
      numbers[first + i] = static_cast<U>(numbers[first + i] - numbers[first + i - step]);
    }
  }
}

/// Inverse of Differences.
template <class U>
void Sums(const glm::ivec3& size, int axis, U* numbers)
{
  const std::size_t step = axis == 0   ? 1
                           : axis == 1 ? static_cast<std::size_t>(size.x)
                                       : static_cast<std::size_t>(size.x) * size.y;
  const std::size_t block = step * static_cast<std::size_t>(size[axis]);
  for (std::size_t first = 0; first < CountOf(size); first += block)
  {
    for (std::size_t i = step; i < block; ++i)
    {
      numbers[first + i] = static_cast<U>(numbers[first + i] + numbers[first + i - step]);
    }
  }
}

template <class T>
void ToDifferences(int components, const glm::ivec3& size, const std::uint8_t* values, Bytes& out)
{
  using U = BitsOf<T>;
  const std::size_t count = CountOf(size);
  std::vector<U> numbers(count);
  for (int c = 0; c < components; ++c)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      const std::size_t at = i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c);
      numbers[i] = Ordered(LoadNumber<T>(values + at * sizeof(T)));
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      Differences(size, axis, numbers.data());
    }
    std::transform(numbers.begin(), numbers.end(), numbers.begin(), Zigzag<U>);
    ToPlanes(numbers.data(), count, out.data() + static_cast<std::size_t>(c) * count * sizeof(U));
  }
}

template <class T>
void FromDifferences(
  int components, const glm::ivec3& size, const Bytes& planes, std::uint8_t* values)
{
  using U = BitsOf<T>;
  const std::size_t count = CountOf(size);
  std::vector<U> numbers(count);
  for (int c = 0; c < components; ++c)
  {
    FromPlanes(
      planes.data() + static_cast<std::size_t>(c) * count * sizeof(U), count, numbers.data());
    std::transform(numbers.begin(), numbers.end(), numbers.begin(), FromZigzag<U>);
    for (int axis = 2; axis >= 0; --axis)
    {
      Sums(size, axis, numbers.data());
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      const std::size_t at = i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c);
      StoreNumber(values + at * sizeof(T), FromOrdered<T>(numbers[i]));
    }
  }
}

} // namespace

Bytes PackPoints(
  ScalarType type, int components, const glm::ivec3& size, const std::uint8_t* values)
{
  Bytes planes(CountOf(size) * static_cast<std::size_t>(components) * SizeOf(type));
  Dispatch(type, [&](auto tag)
    { ToDifferences<typename decltype(tag)::Type>(components, size, values, planes); });
  Bytes packed;
  AppendCompressed(planes.data(), planes.size(), Level, packed);
  return packed.size() < planes.size() ? packed : planes;
}

void UnpackPoints(ScalarType type, int components, const glm::ivec3& size,
  const std::uint8_t* stored, std::size_t bytes, std::uint8_t* values)
{
  Bytes planes(CountOf(size) * static_cast<std::size_t>(components) * SizeOf(type));
  if (bytes > planes.size())
  {
    throw Error("A chunk of points is longer than what it holds");
  }
  if (bytes < planes.size())
  {
    Decompress(stored, bytes, planes.data(), planes.size());
  }
  else
  {
    std::copy(stored, stored + bytes, planes.begin());
  }
  Dispatch(type, [&](auto tag)
    { FromDifferences<typename decltype(tag)::Type>(components, size, planes, values); });
}

} // namespace banyan
