// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_MeshOfKind_h
#define banyan_Benchmarks_MeshOfKind_h

#include "BenchMesh.h"

#include <string>

namespace banyan::bench
{

/// Which mesh a benchmark is of.
struct MeshKind
{
  /// `uniform`, `graded`, `earthquake`, or the name of a file of Exodus
  std::string Name = "uniform";
  int Cells = 100;       ///< across; of an earthquake, about so many in all
  double Seconds = 12.0; ///< of an earthquake
};

/// Throws Error when there is no such mesh.
/// @param folder keeps meshes that take long to make; may be empty: none is kept
BenchMesh MeshOfKind(const MeshKind& kind, const std::string& folder, ThreadPool& pool);

} // namespace banyan::bench

#endif
