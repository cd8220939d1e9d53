// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_BrickWork_h
#define banyan_Render_Raycast_BrickWork_h

#include "Base/Box.h"

#include <chrono>
#include <cstdint>
#include <vector>

namespace banyan
{

/// What drawing a brick, or the part of it that lies in a zone, took.
struct DrawnWork
{
  std::int64_t Samples = 0; ///< that were interpolated
  std::int64_t Pixels = 0;  ///< under its footprint, in tiles that were drawn through it
  /// Rays that had to be made: those of each tile are divided among its bricks by their pixels.
  double Rays = 0;
  double Seconds = 0; ///< of all threads together, without loading
};

/// What drawing took, brick by brick: what zones are balanced by. Written by the ray caster, which
/// looks at the clock once per brick and tile.
struct BrickWork
{
  struct Part
  {
    Box Cells; ///< of the finest level
    DrawnWork Took;
  };
  std::vector<Part> Parts; ///< in any order; a brick that was drawn more than once has several
  double DrawSeconds = 0;  ///< in which rays were cast, without loading
  /// What DrawSeconds are taken from: wall-clock seconds, from any moment on.
  double (*Clock)() = WallClock;

  static double WallClock();

  DrawnWork Total() const;
};

/// One worker's part of the work of a batch of bricks.
class BatchMeter
{
public:
  /// @param bricks of the batch; 0 measures nothing
  void Reset(std::size_t bricks) { this->Took.assign(bricks, {}); }
  bool IsOn() const { return !this->Took.empty(); }

  /// Before the first brick of a tile.
  void Start()
  {
    this->Since = Clock::now();
    this->Samples = 0;
    this->Laps.clear();
  }
  /// After each brick of it.
  /// @param samples taken in the tile so far
  void Lap(int brick, std::int64_t samples, std::int64_t pixels)
  {
    const Clock::time_point now = Clock::now();
    DrawnWork& took = this->Took[static_cast<std::size_t>(brick)];
    took.Samples += samples - this->Samples;
    took.Pixels += pixels;
    took.Seconds += std::chrono::duration<double>(now - this->Since).count();
    this->Since = now;
    this->Samples = samples;
    this->Laps.push_back({ static_cast<std::size_t>(brick), static_cast<double>(pixels) });
  }
  /// After the last one.
  void Finish(std::int64_t rays);

  const DrawnWork& Of(std::size_t brick) const { return this->Took[brick]; }

private:
  using Clock = std::chrono::steady_clock;
  struct OneLap
  {
    std::size_t Brick;
    double Pixels;
  };
  std::vector<DrawnWork> Took;
  std::vector<OneLap> Laps; ///< of the tile
  Clock::time_point Since;
  std::int64_t Samples = 0;
};

/// A part of what drawing a brick of a batch took: from one fraction of it to another.
struct WorkShare
{
  std::size_t Brick; ///< position in the batch
  Box Cells;         ///< of the level
  double From = 0.0;
  double To = 1.0;
};

/// Adds what all workers measured of a batch.
/// @param edges of cells of the level, in cells of the finest one
/// @param domain all cells of the finest level
void AddBatch(BrickWork& work, const std::vector<BatchMeter>& meters,
  const std::vector<WorkShare>& shares, const glm::ivec3& edges, const Box& domain);

} // namespace banyan

#endif
