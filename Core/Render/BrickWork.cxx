#include "Render/BrickWork.h"

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

void AddBatch(BrickWork& work, const std::vector<BatchMeter>& meters, const std::vector<Box>& cells,
  int level, const Box& domain)
{
  const int edge = 1 << level;
  for (std::size_t brick = 0; brick < cells.size(); ++brick)
  {
    BrickWork::Part part;
    part.Cells = Intersection({ cells[brick].Lo * edge, cells[brick].Hi * edge }, domain);
    for (const BatchMeter& meter : meters)
    {
      Add(part.Took, meter.Of(brick));
    }
    work.Parts.push_back(part);
  }
}

} // namespace banyan
