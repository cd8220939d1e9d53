// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_KeptMesh_h
#define banyan_Benchmarks_KeptMesh_h

#include "BenchMesh.h"

#include <functional>
#include <string>

namespace banyan::bench
{

/// A mesh that was made once and is read from then on: runs that draw the same mesh share the time
/// that it takes to simulate it. A file that is damaged or of another build counts as none.
/// @param path of the file; its folder is there. Empty: the mesh is made, and not kept
/// Throws Error when the mesh cannot be kept, and what `make` throws.
BenchMesh KeptMesh(const std::string& path, const std::function<BenchMesh()>& make);

} // namespace banyan::bench

#endif
