// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_VtkGridOfMesh_h
#define banyan_Benchmarks_VtkGridOfMesh_h

#include "BenchMesh.h"

#include <vtkSmartPointer.h>

class vtkUnstructuredGrid;

namespace banyan::bench
{

/// The mesh as VTK's, sharing its memory.
vtkSmartPointer<vtkUnstructuredGrid> VtkGridOf(const BenchMesh& mesh);

} // namespace banyan::bench

#endif
