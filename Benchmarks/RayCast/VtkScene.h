// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_VtkScene_h
#define banyan_Benchmarks_VtkScene_h

#include <vtkSmartPointer.h>
#include <vtkVolumeProperty.h>

namespace banyan::bench
{

struct BenchScene;

/// A scene's colours, opacities and light as VTK's mappers take them: linear between the scene's
/// nodes.
vtkSmartPointer<vtkVolumeProperty> PropertyOf(const BenchScene& scene);

} // namespace banyan::bench

#endif
