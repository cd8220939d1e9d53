// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_ForEachScalarType_h
#define banyan_Base_ForEachScalarType_h

#include <cstdint>

/// Calls a macro with each C++ type of ScalarType, for explicit instantiations. The macro ends
/// without a semicolon.
#define BANYAN_FOR_EACH_SCALAR_TYPE(Macro)                                                         \
  Macro(std::int8_t);                                                                              \
  Macro(std::uint8_t);                                                                             \
  Macro(std::int16_t);                                                                             \
  Macro(std::uint16_t);                                                                            \
  Macro(std::int32_t);                                                                             \
  Macro(std::uint32_t);                                                                            \
  Macro(std::int64_t);                                                                             \
  Macro(std::uint64_t);                                                                            \
  Macro(float);                                                                                    \
  Macro(double)

#endif
