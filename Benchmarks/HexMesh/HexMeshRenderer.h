// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_HexMeshRenderer_h
#define banyan_Benchmarks_HexMeshRenderer_h

#include "BenchMesh.h"
#include "BenchScene.h"
#include "Picture.h"

#include <memory>
#include <string>
#include <vector>

namespace banyan::bench
{

/// What a renderer of meshes is to draw. Of the scene's volume, the size alone counts.
struct HexMeshScene
{
  BenchMesh Mesh;
  BenchScene Look;
};

/// A picture of a mesh and the seconds that it took.
struct HexMeshFrame
{
  double Seconds = 0;
  Picture Shown;
};

/// A way to draw a mesh of hexahedra, under measurement.
class HexMeshRenderer
{
public:
  virtual ~HexMeshRenderer() = default;

  /// What is not the renderer's: the mesh as its library has it, and a window.
  virtual void Open() = 0;

  /// The first time, the seconds include all that has to be done once for the mesh.
  virtual HexMeshFrame Draw() = 0;
};

/// How exact ours is asked to be.
struct HexMeshAccuracy
{
  double Tolerance = 1.0; ///< in 1/255; 0: one sample per finest edge, of the elements as they are
  double MaxElementsPerPixel = 0.0; ///< see FinestLevelsOfTiles
  /// All of the picture from the level that MaxElementsPerPixel gives, one sample per finest edge
  /// of it, whatever the error: as the study of the earthquake does it.
  bool OneLevel = false;
};

std::unique_ptr<HexMeshRenderer> MakeBanyanHexMeshRenderer(
  const HexMeshScene& scene, const HexMeshAccuracy& accuracy, int threads);

/// VTK's ways to draw a mesh; null when there is none of this name.
std::unique_ptr<HexMeshRenderer> MakeVtkHexMeshRenderer(
  const std::string& name, const HexMeshScene& scene, int threads);

/// What the converged picture is checked against: the integral through the original elements that
/// VTK's cell locator finds, in double precision. Null when the program was built without VTK.
std::unique_ptr<HexMeshRenderer> MakeLocatorHexMeshRenderer(const HexMeshScene& scene, int threads);

/// All names that MakeVtkHexMeshRenderer knows; empty when the program was built without VTK.
std::vector<std::string> VtkHexMeshRenderers();

} // namespace banyan::bench

#endif
