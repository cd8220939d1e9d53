// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/ProbeSequence.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Of the largest error anywhere, what a tile without probes of its own is taken to have.
constexpr double ShareOfLargest = 1.0;

} // namespace

void ProbeSequence::Add(ProbeImage picture)
{
  if (this->Drawn.empty())
  {
    this->Errors.emplace_back();
    this->Drawn.push_back(std::move(picture));
    return;
  }
  this->Steps.push_back(this->Pictures.Difference(picture, this->Drawn.back()));
  const ProbeErrors& difference = this->Steps.back();
  const double largest = difference.Largest();
  if (this->Drawn.size() == 1)
  {
    // Of the first one nothing else is known.
    this->Errors.front() = this->Pictures.ErrorsOf(difference, 2.0 * ProbeImages::Safety(), 2.0);
  }
  const bool known = this->Drawn.size() > 1 && largest > 0.0;
  const double ratio = known ? std::clamp(this->LargestBefore / largest, 1.7, 4.0) : 2.0;
  const double part = 1.0 / (ratio - 1.0);
  this->Errors.push_back(
    this->Pictures.ErrorsOf(difference, ProbeImages::Safety() * part, ShareOfLargest * part));
  this->Errors.back().Lower(this->Errors[this->Errors.size() - 2]);
  this->LargestBefore = largest;
  this->Drawn.push_back(std::move(picture));
}

void ProbeSequence::LastIsExact()
{
  TileErrors& last = this->Errors.back();
  std::fill(last.Tiles.begin(), last.Tiles.end(), 0.0);
}

bool ProbeSequence::LastIsWithin(double allowed) const
{
  return this->Drawn.size() > 1 && this->Errors.back().Largest() <= allowed;
}

std::vector<TileErrors> ProbeSequence::AllErrors() const
{
  std::vector<TileErrors> errors = this->Errors;
  const std::size_t last = errors.size() - 1;
  const auto lower = [&](std::size_t i, std::size_t later, const ProbeErrors& difference)
  {
    TileErrors bound = this->Pictures.ErrorsOf(difference, ProbeImages::Safety(), ShareOfLargest);
    bound.Add(errors[later]);
    errors[i].Lower(bound);
  };
  for (std::size_t i = last; i-- > 0;)
  {
    lower(i, i + 1, this->Steps[i]);
    if (i + 1 < last)
    {
      lower(i, last, this->Pictures.Difference(this->Drawn[i], this->Drawn[last]));
    }
  }
  return errors;
}

} // namespace banyan
