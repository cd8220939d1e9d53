#include "Parallel/FrameBalancer.h"

#include "Render/RayCaster.h"

namespace banyan
{

void FrameBalancer::Start(LoadBalancing mode, const Field& field, int ranks)
{
  LoadBalancer::Options options;
  options.Mode = mode;
  options.Positions = field.Cells;
  options.Ranks = ranks;
  options.SlicePositions = field.BrickCells;
  options.PlaneStep = 1 << field.CoarsestLevel;
  options.BlockEdge = BlockEdgeFor(field.Cells);
  options.BytesPerPosition = field.BytesPerCell;
  // The values may be others, of another step, say: what was learned is still the best guess.
  this->SeenOf = nullptr;
  if (this->Balancer)
  {
    const LoadBalancer::Options& now = this->Balancer->Given();
    if (now.Mode == options.Mode && now.Positions == options.Positions &&
        now.Ranks == options.Ranks && now.SlicePositions == options.SlicePositions &&
        now.PlaneStep == options.PlaneStep && now.BytesPerPosition == options.BytesPerPosition)
    {
      return;
    }
  }
  this->Balancer.emplace(options);
  this->ZoneCells = ZonesOf(this->Balancer->Tree());
}

/// Which blocks can be seen changes with the values and the transfer function only.
void FrameBalancer::LookAgain(const RayScene& scene, const BrickSource& source)
{
  const TransferFunction& seenBy = this->SeenBy;
  if (this->SeenOf == &source && this->SeenAs == scene.Blend.Mode &&
      seenBy.Low == scene.Transfer.Low && seenBy.High == scene.Transfer.High &&
      seenBy.Entries == scene.Transfer.Entries)
  {
    return;
  }
  const LoadBalancer::Options& options = this->Balancer->Given();
  this->Visible = VisibleParts(scene, source, options.Positions, options.BlockEdge);
  this->SeenOf = &source;
  this->SeenAs = scene.Blend.Mode;
  this->SeenBy = scene.Transfer;
}

void FrameBalancer::BeginFrame(RayScene& scene, const BrickSource& source)
{
  if (this->IsOff())
  {
    return;
  }
  this->LookAgain(scene, source);
  const LoadBalancer::Options& options = this->Balancer->Given();
  this->View = ViewCosts(scene, options.Positions, options.BlockEdge, this->Visible);
  this->Balancer->BeginFrame(this->View);
  this->ZoneCells = ZonesOf(this->Balancer->Tree());
  this->Work = BrickWork();
  scene.Work = &this->Work;
}

void FrameBalancer::EndFrame(Communicator& communicator)
{
  if (this->IsOff())
  {
    return;
  }
  const FrameWork took = GatherWork(communicator, this->Work, this->ZoneCells, this->View);
  this->Balancer->FrameTook(took.Ranks, took.Blocks);
}

} // namespace banyan
