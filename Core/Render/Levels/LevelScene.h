// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_LevelScene_h
#define banyan_Render_Levels_LevelScene_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Levels/RayCaster.h"
#include "Render/Scene/ProjectionTable.h"
#include "Render/Scene/RayLattice.h"
#include "Render/Scene/ShadingTable.h"

#include <memory>
#include <vector>

namespace banyan
{

/// One way to sample rays at a level: where samples lie, and what colours they get.
struct LevelSampling
{
  double Distance;    ///< world length between samples
  RayLattice Lattice; ///< made for the largest cells of the source
  std::shared_ptr<const StepTable> Steps;
  const StepTable& Table;                            ///< *Steps
  std::unique_ptr<const ProjectionTable> Projection; ///< null when samples are composited

  LevelSampling(const RayScene& scene, double distance, const BrickSource& source);
};

/// A scene in the index space of one level of a source, with the tables that drawing it needs. It
/// does not change while the level is drawn: planner, loader and drawer share it.
class LevelScene
{
public:
  /// Both must stay.
  /// @param source of the level; some sampling of the scene must have that level
  LevelScene(const RayScene& scene, BrickSource& source);
  LevelScene(const LevelScene&) = delete;
  LevelScene& operator=(const LevelScene&) = delete;

  /// Pixels of the whole picture that a box of cells may touch.
  PixelRect FootprintOf(const Box& cells) const
  {
    return this->IndexCamera.Footprint(glm::dvec3(cells.Lo), glm::dvec3(cells.Hi));
  }
  /// Whether the level is much larger than the processor's caches: samples wait for memory then,
  /// and rays meet many bricks.
  bool IsLarge() const;
  bool IsShaded() const { return this->Shading != nullptr; }
  /// The table of a projection; null when samples are composited. All samplings of a level have
  /// equal ones, as far as the ranks of values go.
  const ProjectionTable* Projection() const { return this->AnySampling->Projection.get(); }
  /// The low end of the transfer function's range, the same for all samplings.
  double Low() const { return this->AnySampling->Table.Low(); }
  /// A ray ends when its transmittance is not above this. Rays of projections never end.
  float TransmittanceLimit() const
  {
    return this->Projection() ? 0.0f : 1.0f - this->Scene.OpacityLimit;
  }

  const RayScene& Scene;
  BrickSource& Source;
  const std::shared_ptr<const VisibleValues> Visible;
  const glm::dmat4 IndexToWorld;
  const RayCamera IndexCamera;                       ///< of index space
  const std::vector<glm::dvec4> ClipPlanes;          ///< in index space
  const std::unique_ptr<const ShadingTable> Shading; ///< null for none
  /// By number of the scene's samplings; null for those of other levels, and that no tile has.
  std::vector<std::unique_ptr<const LevelSampling>> Samplings;
  const LevelSampling* AnySampling = nullptr; ///< for what is the same for all
};

} // namespace banyan

#endif
