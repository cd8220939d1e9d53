// SPDX-License-Identifier: BSD-3-Clause
// Blocks of 64^3 cells of volumes of 2^25 cells and more.
#include "Render/Bricks/BrickGroups.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace
{

using namespace banyan;

constexpr int Edge = 16;
constexpr int Counts = 21; // 336^3 cells
constexpr int Drawn = 8;   // bricks per axis

/// Bricks of 16^3 cells that are made when they are loaded. Notes how many are loaded together.
class Waves : public BrickSource
{
public:
  Waves()
    : Ranges(Drawn * Drawn * Drawn)
  {
    for (std::size_t i = 0; i < this->Ranges.size(); ++i)
    {
      const auto number = static_cast<int>(i);
      const glm::ivec3 p(number % Drawn, number / Drawn % Drawn, number / Drawn / Drawn);
      for (const float value : ValuesFrom(p * Edge))
      {
        this->Ranges[i].Include(value);
      }
    }
  }
  glm::ivec3 Bricks() const override { return glm::ivec3(Counts); }
  Box CellsOf(std::int64_t brick) const override
  {
    const glm::ivec3 low = PositionOf(brick) * Edge;
    return { low, low + Edge };
  }
  /// Those that are not drawn have none that can be seen.
  ValueRange RangeOf(std::int64_t brick) const override
  {
    const glm::ivec3 p = PositionOf(brick);
    const bool drawn = p.x < Drawn && p.y < Drawn && p.z < Drawn;
    return drawn ? this->Ranges[static_cast<std::size_t>((p.z * Drawn + p.y) * Drawn + p.x)]
                 : ValueRange{ 0.0, 0.0 };
  }
  ValueMask MaskOf(std::int64_t) const override { return ~ValueMask{ 0 }; }
  MaskRange MasksAreOver() const override { return { 0.0, 1.0 }; }
  std::size_t LoadBytes(std::int64_t) const override { return 0; }
  BrickView Load(std::int64_t brick) override
  {
    const auto values =
      std::make_shared<const std::vector<float>>(ValuesFrom(PositionOf(brick) * Edge));
    return { values->data(), ScalarType::Float32, { 1, Edge + 1, (Edge + 1) * (Edge + 1) },
      values };
  }
  BrickView LoadTogether(const Box& bricks, bool around, Box& samples) override
  {
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      ++this->Blocks[static_cast<int>(bricks.Count())];
    }
    return BrickSource::LoadTogether(bricks, around, samples);
  }

  std::map<int, int> Blocks; ///< by number of bricks

private:
  static glm::ivec3 PositionOf(std::int64_t brick)
  {
    const auto number = static_cast<int>(brick);
    return { number % Counts, number / Counts % Counts, number / Counts / Counts };
  }
  static std::vector<float> ValuesFrom(const glm::ivec3& low)
  {
    std::vector<float> values;
    for (int z = 0; z <= Edge; ++z)
    {
      for (int y = 0; y <= Edge; ++y)
      {
        for (int x = 0; x <= Edge; ++x)
        {
          // Ever shorter waves: where they are short, some of each brick can be seen.
          const glm::vec3 p(low + glm::ivec3(x, y, z));
          values.push_back(
            0.5f + 0.25f * (std::sin(p.x * p.x / 900.0f) + std::sin((p.y + p.z) / 50.0f)));
        }
      }
    }
    return values;
  }

  std::vector<ValueRange> Ranges;
  std::mutex Mutex;
};

FloatImage Draw(Waves& source, double lowest, bool shaded, bool inside, std::uint64_t budget)
{
  RayScene scene =
    scenes::Scene(glm::ivec3(Drawn * Edge + 1), { 90, 70 }, glm::dmat4(1.0), inside ? 0.2 : 1.4);
  // Opaque where it can be seen: the order of blocks counts.
  scene.Transfer = scenes::Tabulate(
    [lowest](double v) { return glm::dvec4(v, 1.0 - v, 0.5, v > lowest ? 0.6 : 0.0); });
  scene.Shading.On = shaded;
  scene.DomainCells = { glm::ivec3(0), glm::ivec3(Counts * Edge) };
  ThreadPool pool(2);
  RayStatistics statistics;
  const FloatImage image =
    CastRays(scene, source, { glm::ivec3(0), glm::ivec3(Drawn * Edge) }, budget, pool, statistics);
  EXPECT_GT(statistics.SamplesTaken, 1000);
  return image;
}

TEST(LargeBlocks, ChangeNoBitAmongSmallerOnesAndSingleBricks)
{
  for (const bool shaded : { false, true })
  {
    for (const bool inside : { false, true })
    {
      Waves large;
      const FloatImage image = Draw(large, 0.35, shaded, inside, std::uint64_t{ 1 } << 30);
      if (!inside)
      {
        EXPECT_GT(large.Blocks[64], 0);
        EXPECT_GT(large.Blocks[8], 0);
      }
      Waves single;
      const FloatImage same = Draw(single, 0.35, shaded, inside, 4096);
      EXPECT_EQ(single.Blocks.size(), 0u);
      EXPECT_EQ(MaxDifference(image, same), 0.0) << shaded << inside;
    }
  }
}

TEST(LargeBlocks, AreTakenWhereAllBricksCanBeSeen)
{
  Waves all;
  (void)Draw(all, 0.0, false, false, std::uint64_t{ 1 } << 30);
  EXPECT_EQ(all.Blocks, (std::map<int, int>{ { 64, 8 } }));
}

} // namespace
