// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/BrickWork.h"

#include <cmath>

namespace banyan
{
namespace
{

void Add(DrawnWork& sum, const DrawnWork& took)
{
  sum.Samples += took.Samples;
  sum.Pixels += took.Pixels;
  sum.Rays += took.Rays;
  sum.Seconds += took.Seconds;
}

/// Of whole numbers, so that all shares add up to them.
std::int64_t PartOf(std::int64_t whole, const WorkShare& share)
{
  const auto number = static_cast<double>(whole);
  return std::llround(share.To * number) - std::llround(share.From * number);
}

DrawnWork PartOf(const DrawnWork& work, const WorkShare& share)
{
  const double part = share.To - share.From;
  return { PartOf(work.Samples, share), PartOf(work.Pixels, share), part * work.Rays,
    part * work.Seconds };
}

} // namespace

double BrickWork::WallClock()
{
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

DrawnWork BrickWork::Total() const
{
  DrawnWork total;
  for (const Part& part : this->Parts)
  {
    Add(total, part.Took);
  }
  return total;
}

void BatchMeter::Finish(std::int64_t rays)
{
  double pixels = 0.0;
  for (const OneLap& lap : this->Laps)
  {
    pixels += lap.Pixels;
  }
  for (const OneLap& lap : this->Laps)
  {
    const double part =
      pixels > 0.0 ? lap.Pixels / pixels : 1.0 / static_cast<double>(this->Laps.size());
    this->Took[lap.Brick].Rays += part * static_cast<double>(rays);
  }
}

void AddBatch(BrickWork& work, const std::vector<BatchMeter>& meters,
  const std::vector<WorkShare>& shares, const glm::ivec3& edges, const Box& domain)
{
  for (const WorkShare& share : shares)
  {
    BrickWork::Part part;
    part.Cells = Intersection({ share.Cells.Lo * edges, share.Cells.Hi * edges }, domain);
    for (const BatchMeter& meter : meters)
    {
      Add(part.Took, meter.Of(share.Brick));
    }
    part.Took = PartOf(part.Took, share);
    work.Parts.push_back(part);
  }
}

} // namespace banyan
