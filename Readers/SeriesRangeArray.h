// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_SeriesRangeArray_h
#define banyan_Readers_SeriesRangeArray_h

#include "Series/Decode/PieceRange.h"

#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <utility>

namespace banyan
{

/// An array that can be told the range of its series, see SeriesRangeArray.
class HasSeriesRange
{
public:
  virtual ~HasSeriesRange() = default;

  /// To be called when the values are there.
  /// @param range with a range for each component; empty ones are told as VTK tells empty ranges
  /// @param ghosts the ghost array of the same output; may be null
  virtual void SetSeriesRange(PieceRange range, vtkUnsignedCharArray* ghosts) = 0;
};

/**
 * A plain array whose GetFiniteRange() is that of the whole series, until it is modified. ParaView
 * takes colours from there: so they do not depend on the step that is shown first, and do not
 * drift while a series plays. With ghosts of others it is that of the values.
 *
 * Everything in VTK takes it for the plain array that it is: no type macro, so the name of the
 * class stays that of Plain. ParaView 5.11 asks the array; newer ones ask its vtkFieldData, which
 * asks for all components or for the magnitude.
 */
template <class Plain>
class SeriesRangeArray
  : public Plain
  , public HasSeriesRange
{
public:
  static SeriesRangeArray* New() { VTK_STANDARD_NEW_BODY(SeriesRangeArray); }

  void SetSeriesRange(PieceRange range, vtkUnsignedCharArray* ghosts) override
  {
    this->OfSeries = std::move(range);
    this->Ghosts = ghosts;
    this->UnchangedSince = this->GetMTime();
  }

protected:
  SeriesRangeArray() = default;
  ~SeriesRangeArray() override = default;

  bool IsUnchanged() const
  {
    auto* self = const_cast<SeriesRangeArray*>(this);
    return self->GetMTime() == this->UnchangedSince;
  }

  using Plain::ComputeFiniteRange;
  void ComputeFiniteRange(double range[2], int component) override
  {
    if (!this->IsKnown(nullptr) || component >= this->Components())
    {
      this->Plain::ComputeFiniteRange(range, component);
      return;
    }
    this->Write(component, range);
  }

  using Plain::ComputeFiniteScalarRange;
  bool ComputeFiniteScalarRange(
    double* ranges, const unsigned char* ghosts, unsigned char skip) override
  {
    if (!this->IsKnown(ghosts))
    {
      return this->Plain::ComputeFiniteScalarRange(ranges, ghosts, skip);
    }
    for (int c = 0; c < this->Components(); ++c)
    {
      this->Write(c, ranges + 2 * c);
    }
    return true;
  }

  using Plain::ComputeFiniteVectorRange;
  bool ComputeFiniteVectorRange(
    double range[2], const unsigned char* ghosts, unsigned char skip) override
  {
    if (!this->IsKnown(ghosts))
    {
      return this->Plain::ComputeFiniteVectorRange(range, ghosts, skip);
    }
    this->Write(-1, range);
    return true;
  }

private:
  SeriesRangeArray(const SeriesRangeArray&) = delete;
  void operator=(const SeriesRangeArray&) = delete;

  int Components() const { return static_cast<int>(this->OfSeries.Components.size()); }

  bool IsKnown(const unsigned char* ghosts) const
  {
    return this->Components() > 0 && this->IsUnchanged() &&
           (!ghosts || (this->Ghosts && ghosts == this->Ghosts->GetPointer(0)));
  }

  /// @param component -1 for the magnitude
  void Write(int component, double range[2]) const
  {
    const ValueRange& of = component < 0 && this->Components() > 1
                             ? this->OfSeries.Magnitude
                             : this->OfSeries.Components[std::max(component, 0)];
    range[0] = of.Empty() ? VTK_DOUBLE_MAX : of.Low;
    range[1] = of.Empty() ? VTK_DOUBLE_MIN : of.High;
  }

  PieceRange OfSeries;
  vtkSmartPointer<vtkUnsignedCharArray> Ghosts;
  vtkMTimeType UnchangedSince = 0;
};

} // namespace banyan

#endif
