// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/InteractiveLevels.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// A step back takes twice the samples, or four times the rays, and where bricks have to be loaded
/// more than that: this was measured where it was tried before.
constexpr double TimesOfStepBack = 3.0;
/// What a step took once is believed less with each frame, since the camera moves on: half of it
/// after 23. Until then pictures do not swing back to a step that has been too slow.
constexpr double Forgetting = 0.97;

} // namespace

RaySampling InteractiveLevels::SamplingOf(int step, double distance, int coarsestLevel)
{
  int level = 0;
  int halvings = 0;
  for (int i = 0; i < std::min(step, Last(coarsestLevel)); ++i)
  {
    const bool levelBefore = halvings == StrideSteps - 1 && level == 0 && coarsestLevel > 0;
    ++(levelBefore || halvings == StrideSteps ? level : halvings);
  }
  return { level, std::ldexp(distance, level), 1 << halvings };
}

void StepControl::FrameTook(double seconds, double promised, int coarsestLevel)
{
  const int last = std::min(InteractiveLevels::Last(coarsestLevel), MostSteps - 1);
  this->Current = std::min(this->Current, last);
  this->HasFrames = true;
  if (!(promised > 0.0))
  {
    this->Current = 0;
    return;
  }
  for (double& taken : this->Taken)
  {
    taken *= Forgetting;
  }
  this->Taken[static_cast<std::size_t>(this->Current)] = seconds;
  // A step has half the samples of the one before, or fewer.
  for (double less = seconds; less > promised && this->Current < last; less *= 0.5)
  {
    ++this->Current;
  }
  const auto before = [this] { return this->Taken[static_cast<std::size_t>(this->Current) - 1]; };
  double more = TimesOfStepBack * seconds;
  while (this->Current > 0 && more < promised && before() <= promised)
  {
    --this->Current;
    more *= TimesOfStepBack;
  }
}

} // namespace banyan
