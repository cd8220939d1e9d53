// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_ScalarType_h
#define banyan_Base_ScalarType_h

#include "Base/Error.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

namespace banyan
{

/// The scalar types that a series can hold. The numbers are part of the file format.
enum class ScalarType : std::uint8_t
{
  Int8 = 0,
  UInt8 = 1,
  Int16 = 2,
  UInt16 = 3,
  Int32 = 4,
  UInt32 = 5,
  Int64 = 6,
  UInt64 = 7,
  Float32 = 8,
  Float64 = 9
};

std::size_t SizeOf(ScalarType type) noexcept;

/// "int8", "uint8", ... "float32", "float64": the names used in the index.
const char* NameOf(ScalarType type) noexcept;

/// Inverse of `NameOf`; throws Error for an unknown name.
ScalarType ScalarTypeFromName(const std::string& name);

template <class T>
struct TypeTag
{
  using Type = T;
};

/// Calls `function(TypeTag<T>{})` with the C++ type that stands for `type`.
template <class Function>
decltype(auto) Dispatch(ScalarType type, Function&& function)
{
  switch (type)
  {
    case ScalarType::Int8:
      return function(TypeTag<std::int8_t>{});
    case ScalarType::UInt8:
      return function(TypeTag<std::uint8_t>{});
    case ScalarType::Int16:
      return function(TypeTag<std::int16_t>{});
    case ScalarType::UInt16:
      return function(TypeTag<std::uint16_t>{});
    case ScalarType::Int32:
      return function(TypeTag<std::int32_t>{});
    case ScalarType::UInt32:
      return function(TypeTag<std::uint32_t>{});
    case ScalarType::Int64:
      return function(TypeTag<std::int64_t>{});
    case ScalarType::UInt64:
      return function(TypeTag<std::uint64_t>{});
    case ScalarType::Float32:
      return function(TypeTag<float>{});
    case ScalarType::Float64:
      return function(TypeTag<double>{});
  }
  throw Error("Unknown scalar type", { {}, {}, static_cast<std::uint64_t>(type), 9 });
}

/// The ScalarType of a C++ arithmetic type, by signedness and size (so that `long` and `long long`
/// are both Int64).
template <class T>
constexpr ScalarType ScalarTypeOf()
{
  static_assert(std::is_arithmetic_v<T> && sizeof(T) <= 8);
  if constexpr (std::is_floating_point_v<T>)
  {
    return sizeof(T) == 4 ? ScalarType::Float32 : ScalarType::Float64;
  }
  else
  {
    constexpr int log2size = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
    return static_cast<ScalarType>(2 * log2size + (std::is_signed_v<T> ? 0 : 1));
  }
}

} // namespace banyan

#endif
