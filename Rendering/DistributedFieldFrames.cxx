// SPDX-License-Identifier: BSD-3-Clause
// Zones from frame to frame.
#include "DistributedField.h"

#include "MeshField.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Parallel/Fields/PieceField.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Bricks/TimeStepPrefetcher.h"

#include <utility>

namespace banyan
{

void DistributedField::SetLoadBalancing(LoadBalancing mode)
{
  if (mode != this->Balancing)
  {
    this->Balancing = mode;
    this->Reset();
  }
}

const std::vector<Box>& DistributedField::Zones() const
{
  return this->Pieces ? this->Pieces->Zones() : this->ZoneCells;
}

BrickSource* DistributedField::Source()
{
  return this->Pieces ? this->Pieces->Source() : this->Bricks.get();
}

std::uint64_t DistributedField::DrawingBudget()
{
  // Less than the cache has: what one batch holds is then never evicted by that batch itself.
  constexpr std::uint64_t least = std::uint64_t{ 16 } << 20;
  const std::uint64_t all = BrickCache::Process().DrawingBudget();
  return std::max(this->Source() ? this->Source()->Kept().ShareOf(all) : all, least);
}

void DistributedField::BeginFrame(Communicator& communicator, RayScene& scene)
{
  if (this->Pieces)
  {
    this->Pieces->BeginFrame(communicator, scene, BrickCache::Process().DecodedBudget());
  }
  else if (this->Encoded() && this->Bricks)
  {
    if (this->Ahead)
    {
      this->Ahead->Drawing(*this->Series, this->Step);
    }
    this->Balancer.BeginFrame(scene, *this->Bricks);
    this->ZoneCells = this->Balancer.Zones();
  }
  else if (this->IsMesh() && this->Bricks)
  {
    this->Balancer.BeginFrame(scene, *this->Bricks);
    this->PlaceMeshZones();
  }
}

void DistributedField::BringLevels(Communicator& communicator, const RayScene& scene, int coarsest)
{
  if (this->Pieces)
  {
    this->Pieces->BringLevels(communicator, scene, coarsest,
      BrickCache::Process().DecodedBudget() / 8, ThreadPool::Process());
  }
  else if (this->Mesh)
  {
    this->Mesh->BringLevels(communicator, coarsest);
  }
}

void DistributedField::ReadAhead(const RayScene& scene, int rank)
{
  if (!this->Encoded() || !this->Bricks)
  {
    return;
  }
  try
  {
    BrickCache& cache = BrickCache::Process();
    if (!this->Ahead)
    {
      this->Ahead = std::make_unique<TimeStepPrefetcher>(cache, ThreadPool::Process().Width());
      this->Ahead->Drawing(*this->Series, this->Step);
    }
    this->Ahead->Drawn(this->Series, *this->Bricks);
    auto* const source = dynamic_cast<SeriesBrickSource*>(this->Bricks.get());
    std::vector<FieldBricks> coming;
    if (source)
    {
      coming = this->View.Expected(scene, *source, this->Zones()[static_cast<std::size_t>(rank)]);
    }
    if (this->Ahead->Next() < 0 && !coming.empty())
    {
      this->Ahead->Work().Start(this->Series, std::move(coming), cache.DecodedBudget() / 4);
    }
  }
  catch (const std::exception&)
  {
    this->Ahead.reset(); // no threads, no memory: bricks are decoded when they are asked for
  }
}

void DistributedField::EndFrame(Communicator& communicator)
{
  if (this->Pieces)
  {
    this->Pieces->EndFrame(communicator);
  }
  else if (this->Encoded() || this->IsMesh())
  {
    this->Balancer.EndFrame(communicator);
  }
}

double DistributedField::BytesMoved() const
{
  return this->Pieces      ? static_cast<double>(this->Pieces->FrameStatistics().BytesMoved)
         : this->Encoded() ? this->Balancer.BytesMoved()
                           : 0.0; // all ranks have all of a mesh
}

std::uint64_t DistributedField::FetchHits() const
{
  return this->Pieces ? this->Pieces->FrameStatistics().Hits : 0;
}

std::uint64_t DistributedField::FetchMisses() const
{
  return this->Pieces ? this->Pieces->FrameStatistics().Misses : 0;
}

std::uint64_t DistributedField::FetchedBytes() const
{
  return this->Pieces ? this->Pieces->FetchedBytes() : 0;
}

} // namespace banyan
