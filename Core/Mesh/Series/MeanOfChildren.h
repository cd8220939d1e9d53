// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeanOfChildren_h
#define banyan_Mesh_Series_MeanOfChildren_h

#include "Mesh/Series/Rounded.h"

namespace banyan
{

/// The value of a cell of a tree that has up to eight cells below it: their mean, or a fill value
/// where one of them is one, and then that which was added last. Sums are kept an eighth as large:
/// those of the largest doubles are finite, too.
class MeanOfChildren
{
public:
  void Add(double value, bool fill)
  {
    if (fill)
    {
      this->Sum = value;
      this->Fill = true;
    }
    else if (!this->Fill)
    {
      this->Sum += value / 8.0;
      ++this->Count;
    }
  }

  /// 0 where there is nothing below.
  double Value() const
  {
    return this->Fill        ? this->Sum
           : this->Count > 0 ? MeanOfPart(this->Sum, this->Count / 8.0)
                             : 0.0;
  }
  bool IsFill() const { return this->Fill; }

private:
  double Sum = 0.0;
  int Count = 0;
  bool Fill = false;
};

} // namespace banyan

#endif
