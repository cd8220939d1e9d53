// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_MeshOptions_h
#define banyan_Mesh_Sampling_MeshOptions_h

#include "Mesh/Sampling/CubeRefiner.h"

namespace banyan
{

/// How the hexahedra of a mesh become an octree.
struct MeshOptions
{
  double Tolerance = 0.0; ///< see ElementOctree::Find
  MeshSampling Sampling;  ///< of meshes that are no octrees

  bool operator==(const MeshOptions& other) const
  {
    return this->Tolerance == other.Tolerance && this->Sampling == other.Sampling;
  }
};

} // namespace banyan

#endif
