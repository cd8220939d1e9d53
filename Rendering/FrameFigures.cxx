// SPDX-License-Identifier: BSD-3-Clause
#include "FrameFigures.h"

#include "vtkBanyanFrameStatistics.h"

#include "Base/ThreadPool.h"
#include "Parallel/Frame/DistributedFrame.h"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace banyan
{
namespace
{

/// What a rank tells the others of a frame: all are sent in one message.
enum Figure
{
  GeometryBytes, ///< sent of what other props have drawn
  BytesRead,
  CacheBytes,
  BytesOfMesh,
  BytesOfMeshShared,
  CacheHits,
  CacheMisses,
  CacheHitsAhead,
  Threads,
  FigureCount
};
using Report = std::array<std::uint64_t, FigureCount>;

/// Collective.
Report SumOf(Communicator& communicator, const Report& mine)
{
  std::vector<Report> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(mine.data(), sizeof(mine), all.data());
  Report sum{};
  for (const Report& report : all)
  {
    std::transform(sum.begin(), sum.end(), report.begin(), sum.begin(), std::plus<>());
  }
  return sum;
}

vtkIdType Id(std::uint64_t number)
{
  return static_cast<vtkIdType>(number);
}

} // namespace

FrameFigures::FrameFigures(DrawnField& field)
  : Caches(field.Caches())
  , BytesBefore(field.BytesRead())
  , AheadBefore(BrickCache::Of(*this->Caches).GetAheadStatistics().Hits)
  , CacheBefore(BrickCache::Of(*this->Caches).GetStatistics())
{
}

void FrameFigures::Add(const DrawnField& field, bool kept)
{
  const DrawnField::Movement last = field.Moved();
  this->Moved.BytesFetched = last.BytesFetched;
  if (!kept)
  {
    this->Moved.Bytes += last.Bytes;
    this->Moved.Hits += last.Hits;
    this->Moved.Misses += last.Misses;
  }
}

void FrameFigures::Publish(Communicator& communicator, const DrawnField& field,
  const FrameStatistics& frame, std::uint64_t geometryBytes, vtkBanyanFrameStatistics* out) const
{
  const BrickCache& bricks = BrickCache::Of(*this->Caches);
  const BrickCache::Statistics cache = bricks.GetStatistics();
  const MeshBytes mesh = field.Bytes();
  const DrawnField::Movement& moved = this->Moved;
  Report mine{};
  mine[GeometryBytes] = geometryBytes;
  mine[BytesRead] = field.BytesRead() - this->BytesBefore;
  mine[CacheBytes] = cache.Bytes + moved.BytesFetched;
  mine[BytesOfMeshShared] = mesh.Leads ? mesh.Together : 0;
  mine[BytesOfMesh] = mesh.Own + mine[BytesOfMeshShared];
  mine[CacheHits] = cache.Hits - this->CacheBefore.Hits;
  mine[CacheMisses] = cache.Misses - this->CacheBefore.Misses;
  mine[CacheHitsAhead] = bricks.GetAheadStatistics().Hits - this->AheadBefore;
  mine[Threads] = static_cast<std::uint64_t>(ThreadPool::Process().Width());
  const Report all = SumOf(communicator, mine);
  out->SetBytesRead(Id(all[BytesRead]));
  out->SetCacheBytes(Id(all[CacheBytes]));
  out->SetMeshBytes(Id(all[BytesOfMesh]));
  out->SetMeshBytesShared(Id(all[BytesOfMeshShared]));
  out->SetCacheHits(Id(all[CacheHits] + moved.Hits));
  out->SetCacheMisses(Id(all[CacheMisses] + moved.Misses));
  out->SetCacheHitsAhead(Id(all[CacheHitsAhead]));
  out->SetThreads(Id(all[Threads]));
  out->SetBytesMoved(Id(moved.Bytes));
  PublishFrame(frame, all[GeometryBytes], out);
}

void FrameFigures::PublishFrame(
  const FrameStatistics& frame, std::uint64_t geometryBytes, vtkBanyanFrameStatistics* out)
{
  out->SetRenderSeconds(frame.RenderSeconds);
  out->SetCompositeSeconds(frame.CompositeSeconds);
  out->SetProbeSeconds(frame.ProbeSeconds);
  out->SetStrideSeconds(frame.StrideSeconds);
  out->SetProbes(frame.Probes);
  out->SetImbalance(frame.Imbalance);
  out->SetSamplesTaken(frame.SamplesTaken);
  out->SetBricksDrawn(frame.BricksDrawn);
  out->SetBricksUniform(frame.BricksUniform);
  out->SetBricksSkipped(frame.BricksSkipped);
  out->SetBytesComposited(Id(frame.BytesComposited + geometryBytes));
  out->SetMessagesComposited(Id(frame.MessagesComposited));
  out->SetFrames(out->GetFrames() + 1);
}

} // namespace banyan
