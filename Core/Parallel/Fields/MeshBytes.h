// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_MeshBytes_h
#define banyan_Parallel_Fields_MeshBytes_h

#include <cstdint>

namespace banyan
{

/// Memory that a rank holds of a mesh.
struct MeshBytes
{
  std::uint64_t Own = 0;      ///< by this rank alone
  std::uint64_t Together = 0; ///< by all ranks of its machine: it is there once
  bool Leads = true;          ///< whether this rank is the one of its machine that counts it
};

} // namespace banyan

#endif
