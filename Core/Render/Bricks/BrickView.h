// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_BrickView_h
#define banyan_Render_Bricks_BrickView_h

#include "Base/ScalarType.h"

#include <cstddef>
#include <memory>

namespace banyan
{

/// Samples of one brick in memory, ready for the marcher.
struct BrickView
{
  const void* Values = nullptr; ///< the sample at the brick's lowest corner
  ScalarType Type = ScalarType::Float32;
  std::ptrdiff_t Stride[3] = { 1, 0, 0 }; ///< in values, per axis
  std::shared_ptr<const void> Owner;      ///< keeps the values alive; may be empty
};

} // namespace banyan

#endif
