// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/RefinementPasses.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// How much closer a pass is than the one before: it takes about twice as many samples.
constexpr double Step = 0.25;

} // namespace

double RefinementPasses::ToleranceOf(const Hash128& scene, const Wish& wish)
{
  this->Fresh = true;
  if (!wish.Passes)
  {
    this->IsLast = true;
    this->Reached = wish.Still;
    this->AfterInteraction = false;
    return wish.Still;
  }
  const bool changed = scene != this->Drawn;
  this->Drawn = scene;
  if (changed)
  {
    this->Reached = this->AfterInteraction ? wish.Interactive : wish.Still;
  }
  else if (this->Asked)
  {
    this->Reached *= Step;
  }
  this->Asked = false;
  this->AfterInteraction = false;
  this->Reached = std::max(this->Reached, wish.Still);
  this->IsLast = this->Reached <= wish.Still;
  return this->Reached;
}

void RefinementPasses::Showed(double tolerance, const Wish& wish)
{
  this->Reached = std::max(std::min(this->Reached, tolerance), wish.Still);
  this->IsLast = this->Reached <= wish.Still;
}

bool RefinementPasses::Next()
{
  this->Asked = this->Fresh && !this->IsLast;
  this->Fresh = false;
  return this->Asked;
}

} // namespace banyan
