// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_FrameBalancer_h
#define banyan_Parallel_Balance_FrameBalancer_h

#include "Parallel/Balance/FrameCost.h"
#include "Parallel/Balance/LoadBalancer.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Scene/RayBlend.h"
#include "Render/Scene/TransferFunction.h"

#include <optional>
#include <vector>

namespace banyan
{

/// How zones follow what frames cost.
enum class LoadBalancing
{
  Off,         ///< they stay as they are
  MeasuredCost ///< LoadBalancer
};

/// A tree of zones, and the ranks that draw them in the order of its leaves.
struct ZonesOfRanks
{
  ZoneTree Tree;
  std::vector<int> RankOfSeat; ///< empty: rank i draws leaf i

  /// One per rank.
  std::vector<Box> Zones() const;
};

/// Zones of one field from frame to frame: the balancer, and what it has to be told. Used alike on
/// all ranks.
class FrameBalancer
{
public:
  struct Field
  {
    glm::ivec3 Cells{ 0 };
    int BrickCells = 16;
    int CoarsestLevel = 0; ///< that pictures are drawn from: planes stand between cells of it
    double BytesPerCell = 4.0;
    /// Zones to begin with; a tree without nodes: equal ones.
    ZonesOfRanks Start;
  };

  /// Begins with the field's zones, unless ranks, field and mode are those of before.
  void Start(LoadBalancing mode, const Field& field, int ranks);

  /// Moves planes for the next frame, and lets the scene tell what bricks take.
  /// @param scene all of it but its samplings
  /// @param source of the whole field
  void BeginFrame(RayScene& scene, const BrickSource& source);

  /// Goes back from the zones of the frame that was begun towards those at the start.
  /// @param part of the way that is kept, [0, 1]
  void GoBack(double part);
  /// Whether zones can have moved from where they were at the start.
  bool Moves() const { return !this->IsOff(); }

  /// In cells.
  const std::vector<Box>& Zones() const { return this->ZoneCells; }

  /// After a frame was drawn by the scene. Collective.
  void EndFrame(Communicator& communicator);

  /// From rank to rank for the frame that was begun last.
  double BytesMoved() const { return this->Balancer ? this->Balancer->BytesMoved() : 0.0; }

private:
  bool IsOff() const
  {
    return this->Mode == LoadBalancing::Off || !this->Balancer ||
           this->Balancer->GetOptions().Ranks == 1;
  }
  void LookAgain(const RayScene& scene, const BrickSource& source);

  void PlaceZones();

  LoadBalancing Mode = LoadBalancing::Off;
  std::optional<LoadBalancer> Balancer;
  std::vector<int> RankOfSeat; ///< as in ZonesOfRanks
  std::vector<Box> ZoneCells;
  BrickWork Work;  ///< of this rank for the frame
  BrickCosts View; ///< of the frame

  std::vector<float> Visible; ///< for what follows
  const BrickSource* SeenOf = nullptr;
  TransferFunction SeenBy;
  BlendMode SeenAs = BlendMode::Composite;
};

} // namespace banyan

#endif
