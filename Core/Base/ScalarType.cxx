// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ScalarType.h"

#include <array>

namespace banyan
{
namespace
{

constexpr std::array<const char*, 10> Names = { "int8", "uint8", "int16", "uint16", "int32",
  "uint32", "int64", "uint64", "float32", "float64" };
constexpr std::array<std::size_t, 10> Sizes = { 1, 1, 2, 2, 4, 4, 8, 8, 4, 8 };

} // namespace

std::size_t SizeOf(ScalarType type) noexcept
{
  return Sizes[static_cast<std::size_t>(type)];
}

const char* NameOf(ScalarType type) noexcept
{
  return Names[static_cast<std::size_t>(type)];
}

ScalarType ScalarTypeFromName(const std::string& name)
{
  for (std::size_t i = 0; i < Names.size(); ++i)
  {
    if (name == Names[i])
    {
      return static_cast<ScalarType>(i);
    }
  }
  throw Error("Unknown scalar type name '" + name + "'");
}

} // namespace banyan
