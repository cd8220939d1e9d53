// SPDX-License-Identifier: BSD-3-Clause
#include "MadeUpBricks.h"

#include "Base/Error.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace banyan::bench
{
namespace
{

constexpr double Waves = 4.0;
/// A value changes by at most so much per length of an axis of the volume.
constexpr double Slope = 2.0;
/// Part of the bricks that are of chance and have values above 1/2.
constexpr std::uint64_t HalfOfHashes = std::uint64_t{ 1 } << 63;

/// A gyroid in [0, 1], at 1/2 on its surface.
double Gyroid(const glm::dvec3& p)
{
  const glm::dvec3 at = p * (Waves * glm::two_pi<double>());
  const double sum = std::sin(at.x) * std::cos(at.y) + std::sin(at.y) * std::cos(at.z) +
                     std::sin(at.z) * std::cos(at.x);
  return 0.5 + sum / 3.0;
}

std::uint64_t HashOf(std::uint64_t number)
{
  number = (number ^ (number >> 31)) * 0x7fb5d329728ea185;
  number = (number ^ (number >> 27)) * 0x81dadef4bc2dd44d;
  return number ^ (number >> 33);
}

} // namespace

MadeUpBricks::MadeUpBricks(const glm::ivec3& samples, int brickCells, Kind kind, int level)
  : FineSamples(samples)
  , Layout(samples, brickCells, level)
  , Values(kind)
  , Nodes(static_cast<std::size_t>(this->Layout.BrickCount()))
{
  const MaskRange over = this->MadeUpBricks::MasksAreOver();
  for (std::size_t brick = 0; brick < this->Nodes.size(); ++brick)
  {
    BrickNode& node = this->Nodes[brick];
    node.Range = this->MakeRange(static_cast<std::int64_t>(brick));
    node.Mask = MaskOfBins(over.BinOf(node.Range.Low), over.BinOf(node.Range.High));
    node.PayloadBytes = 1;
  }
}

ValueRange MadeUpBricks::MakeRange(std::int64_t brick) const
{
  if (this->Values == Kind::Scattered)
  {
    const bool high = HashOf(static_cast<std::uint64_t>(brick) + 1) < HalfOfHashes;
    return high ? ValueRange{ 0.6, 0.9 } : ValueRange{ 0.1, 0.4 };
  }
  const Box cells = this->Layout.CellsOf(brick);
  const double longest =
    std::max({ this->Layout.Samples().x, this->Layout.Samples().y, this->Layout.Samples().z });
  const double value = Gyroid(0.5 * glm::dvec3(cells.Lo + cells.Hi) / longest);
  const double change = Slope * this->Layout.BrickCells() / longest * Waves;
  return { std::clamp(value - change, 0.0, 1.0), std::clamp(value + change, 0.0, 1.0) };
}

std::size_t MadeUpBricks::LoadBytes(std::int64_t brick) const
{
  return static_cast<std::size_t>(this->Layout.SamplesOf(brick).Count()) * sizeof(float);
}

BrickView MadeUpBricks::Load(std::int64_t /*brick*/)
{
  throw Error("These bricks have no values");
}

std::unique_ptr<BrickSource> MadeUpBricks::MakeLevel(int level, const Box& /*domain*/)
{
  return std::make_unique<MadeUpBricks>(
    this->FineSamples, this->Layout.BrickCells(), this->Values, level);
}

} // namespace banyan::bench
