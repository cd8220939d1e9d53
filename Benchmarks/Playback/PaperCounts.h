// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PaperCounts_h
#define banyan_Benchmarks_PaperCounts_h

#include "Base/Box.h"
#include "Render/Scene/RayScene.h"

#include <array>
#include <utility>
#include <vector>

namespace banyan::bench
{

/// Counts what a frame could take from the one before it by the study's own way, an image for each
/// brick, and by that of today, blocks of 4 x 4 rays. Samples are one voxel apart along each ray;
/// rays do not end early, and empty space inside a brick is not left out.
/// @par Source: "A study of time-varying octree and difference encoding", section 4. Its subtrees
/// are bricks of one size here: a larger subtree that is as before consists of such bricks.
class PaperCounts
{
public:
  /// In 1/255.
  static constexpr std::array<double, 2> Tolerances{ { 1.0, 8.0 } };

  /// Parts from 0 to 1.
  struct Shares
  {
    double Bricks = 0.0;      ///< of all bricks, those as before
    double Shown = 0.0;       ///< of all samples, those in bricks in which something can be seen
    double EveryBrick = 0.0;  ///< of all samples, those in bricks as before
    double ShownBricks = 0.0; ///< of the samples that are shown, those in bricks as before
    double Blocks = 0.0;      ///< the same, of blocks of rays that meet no brick that has changed
    /// The same, of blocks whose rays cannot have changed by more than each of Tolerances.
    std::array<double, 2> Within{};
  };

  /// @param scene gives the camera; its function does not matter
  /// @param samples of the grid per axis, at least 2
  /// @param brickCells edge of a brick, at least 1
  PaperCounts(const RayScene& scene, const glm::ivec3& samples, int brickCells);

  /// Takes the values of the next step: `[z][y][x]`, x fastest, finite. A brick is as before if all
  /// samples of its cells are.
  void Take(std::vector<float> values);

  /// Counts for the step that was taken last; nothing is as before in the first one. How far a ray
  /// may change is bounded by the samples in each brick, times the largest difference of two
  /// entries of its values that are as far apart as any of its samples are from before.
  /// @param function an entry's opacity is that of a sample
  Shares Of(const TransferFunction& function) const;

private:
  struct Brick
  {
    float Low = 0.0f;
    float High = 0.0f;
    float Apart = 0.0f; ///< largest difference of a sample to the one before
    bool Same = false;
  };

  Box SamplesOf(std::int64_t brick) const;
  void MeetBricks(const RayScene& scene);

  glm::ivec3 Samples;
  int BrickCells;
  glm::ivec3 Counts; ///< of bricks
  /// Of each block of rays, the bricks that it meets, and how many samples lie in each.
  std::vector<std::vector<std::pair<std::size_t, int>>> Blocks;
  std::vector<float> Values;
  std::vector<Brick> Now;
  std::vector<Brick> Before;
};

} // namespace banyan::bench

#endif
