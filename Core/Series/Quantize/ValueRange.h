// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_ValueRange_h
#define banyan_Series_Quantize_ValueRange_h

#include <limits>

namespace banyan
{

/// Extremes of the finite values of one component. Empty (Low > High) when there is none.
struct ValueRange
{
  double Low = std::numeric_limits<double>::infinity();
  double High = -std::numeric_limits<double>::infinity();

  bool Empty() const { return !(this->Low <= this->High); }
  double Width() const { return this->Empty() ? 0.0 : this->High - this->Low; }
  void Include(double value)
  {
    this->Low = value < this->Low ? value : this->Low;
    this->High = value > this->High ? value : this->High;
  }
  void Include(const ValueRange& other)
  {
    this->Low = other.Low < this->Low ? other.Low : this->Low;
    this->High = other.High > this->High ? other.High : this->High;
  }
};

} // namespace banyan

#endif
