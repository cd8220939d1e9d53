// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/DistributedProbe.h"

#include "Parallel/Balance/LevelZones.h"
#include "Parallel/Cells/DrawPieces.h"
#include "Parallel/Communicate/Collective.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

/// Is sent by a rank to the others in front of its pixels. It is plain memory, sent as it is.
struct ProbeReport
{
  double SamplesTaken = 0;
  std::uint64_t Failed = 0;
};

std::size_t PixelsOf(const Footprint& footprint)
{
  std::size_t count = 0;
  for (const Footprint::Interval& row : footprint.Rows)
  {
    count += static_cast<std::size_t>(std::max(0, row.Hi - row.Lo));
  }
  return count;
}

/// Casts this rank's rays; a failure becomes a sentence for the others.
FloatImage CastOwn(const RayScene& scene, const RankShare& share, std::size_t self,
  RayStatistics& statistics, std::string& failure)
{
  const Box& zone = share.Zones.at(self);
  FloatImage mine;
  Attempt(failure,
    [&]
    {
      if (share.Source && !zone.Empty())
      {
        mine = CastRays(scene, *share.Source, zone, share.BudgetBytes, share.Pool, statistics);
      }
    });
  return mine;
}

/// The pixels of a footprint, row by row; 0 where nothing was drawn.
void Pack(const FloatImage& image, const Footprint& footprint, glm::vec4* out)
{
  for (int y = footprint.Rect.Lo.y; y < footprint.Rect.Hi.y; ++y)
  {
    const Footprint::Interval row = footprint.Row(y);
    const bool drawn = y >= image.Rect.Lo.y && y < image.Rect.Hi.y;
    for (int x = row.Lo; x < row.Hi; ++x)
    {
      const bool inside = drawn && x >= image.Rect.Lo.x && x < image.Rect.Hi.x;
      *out++ = inside ? image.At(x, y) : glm::vec4(0.0f);
    }
  }
}

/// Blends what lies behind under what is there already.
void BlendUnder(const glm::vec4* pixels, const Footprint& footprint, FloatImage& picture)
{
  for (int y = footprint.Rect.Lo.y; y < footprint.Rect.Hi.y; ++y)
  {
    const Footprint::Interval row = footprint.Row(y);
    for (int x = row.Lo; x < row.Hi; ++x)
    {
      glm::vec4& front = picture.At(x, y);
      front += (1.0f - front.a) * *pixels++;
    }
  }
}

/// Collective.
FloatImage DrawProbeOfPieces(Communicator& communicator, const RayScene& scene,
  const RankShare& share, FrameStatistics& statistics)
{
  PieceStatistics mine;
  FloatImage picture = DrawPieces(communicator, scene, *share.Piece, share.Pool, EveryRank, mine);
  statistics.SamplesTaken +=
    static_cast<std::int64_t>(AllSum(communicator, static_cast<double>(mine.Rays.SamplesTaken)));
  statistics.BytesComposited +=
    static_cast<std::uint64_t>(AllSum(communicator, static_cast<double>(mine.Sent.Bytes)));
  return picture;
}

} // namespace

FloatImage DrawDistributedProbe(Communicator& communicator, const RayScene& scene,
  const RankShare& share, FrameStatistics& statistics)
{
  if (share.Piece && communicator.Size() > 1)
  {
    return DrawProbeOfPieces(communicator, scene, share, statistics);
  }
  const auto self = static_cast<std::size_t>(communicator.Rank());
  const auto ranks = static_cast<std::size_t>(communicator.Size());
  RayStatistics rays;
  std::string failure;
  const FloatImage mine = CastOwn(scene, share, self, rays, failure);

  // All ranks know these alike.
  const std::vector<int> order = OrderAsDrawn(scene, share.Zones);
  const std::vector<Footprint> footprints = FootprintsOfZones(
    scene.Camera, scene.IndexToWorld, ZonesAsDrawn(scene, share.Zones), scene.Viewport);
  std::size_t most = 0;
  for (const Footprint& footprint : footprints)
  {
    most = std::max(most, PixelsOf(footprint));
  }

  const std::size_t bytes = sizeof(ProbeReport) + most * sizeof(glm::vec4);
  std::vector<char> message(bytes, 0);
  const ProbeReport report{ static_cast<double>(rays.SamplesTaken), failure.empty() ? 0u : 1u };
  std::memcpy(message.data(), &report, sizeof(report));
  std::vector<glm::vec4> pixels(most, glm::vec4(0.0f));
  Pack(mine, footprints[self], pixels.data());
  if (most > 0)
  {
    std::memcpy(message.data() + sizeof(report), pixels.data(), most * sizeof(glm::vec4));
  }
  std::vector<char> all(bytes * ranks);
  communicator.AllGather(message.data(), bytes, all.data());

  FloatImage picture;
  picture.Rect = scene.Viewport;
  picture.Pixels.assign(static_cast<std::size_t>(scene.Viewport.Count()), glm::vec4(0.0f));
  bool failed = false;
  for (const int rank : order)
  {
    const char* const theirs = all.data() + bytes * static_cast<std::size_t>(rank);
    ProbeReport said;
    std::memcpy(&said, theirs, sizeof(said));
    failed = failed || said.Failed != 0;
    statistics.SamplesTaken += static_cast<std::int64_t>(said.SamplesTaken);
    statistics.BytesComposited += ranks > 1 ? bytes : 0;
    if (most > 0)
    {
      std::memcpy(pixels.data(), theirs + sizeof(said), most * sizeof(glm::vec4));
    }
    BlendUnder(pixels.data(), footprints[static_cast<std::size_t>(rank)], picture);
  }
  if (failed)
  {
    ThrowTogether(communicator, failure);
  }
  return picture;
}

} // namespace banyan
