// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanDecodedArray
 * @brief   a plain point array of a Banyan series that still knows where its values come from
 *
 * Everything in VTK takes it for the plain array that it is: it has that one's memory, class name
 * and new instances. A renderer finds the series behind it, as it does behind deferred arrays.
 * GetFiniteRange() is that of the series, as that of vtkBanyanArray.
 *
 * @par Limits:
 * Who writes values has to call Modified(), as VTK demands; only then do they count as changed.
 */
#ifndef vtkBanyanDecodedArray_h
#define vtkBanyanDecodedArray_h

#include "vtkBanyanDeferred.h"
#include "vtkObjectFactory.h"

#include "Series/Decode/PieceRange.h"

#include <vector>

/// @tparam Plain the array that vtkDataArray::CreateDataArray() makes of the type
template <class Plain>
class vtkBanyanDecodedArray final
  : public Plain
  , public vtkBanyanDeferred
{
public:
  // No type macro: the name of the class stays that of Plain.
  static vtkBanyanDecodedArray* New() { VTK_STANDARD_NEW_BODY(vtkBanyanDecodedArray); }

  /// To be called when name and values are there.
  void SetSource(const Handle& source)
  {
    this->Source = source;
    this->OfSeries = banyan::RangeOfSeries(*source.Series, source.Array);
    this->UnchangedSince = this->GetMTime();
  }

protected:
  vtkBanyanDecodedArray() = default;
  ~vtkBanyanDecodedArray() override = default;

  using Plain::ComputeFiniteRange;
  void ComputeFiniteRange(double range[2], int component) override
  {
    const int components = static_cast<int>(this->OfSeries.Components.size());
    if (!this->IsPristine() || component >= components)
    {
      this->Plain::ComputeFiniteRange(range, component);
      return;
    }
    const banyan::ValueRange& of = component < 0 && components > 1
                                     ? this->OfSeries.Magnitude
                                     : this->OfSeries.Components[std::max(component, 0)];
    range[0] = of.Empty() ? VTK_DOUBLE_MAX : of.Low;
    range[1] = of.Empty() ? VTK_DOUBLE_MIN : of.High;
  }

  bool IsPristine() const override
  {
    auto* self = const_cast<vtkBanyanDecodedArray*>(this);
    return this->Source.Series && self->GetMTime() == this->UnchangedSince;
  }
  bool IsPlain() const override { return true; }
  std::uint64_t DecodedBytes() const override
  {
    return static_cast<std::uint64_t>(this->Size) * sizeof(typename Plain::ValueType);
  }
  bool Release() override { return false; }

private:
  vtkBanyanDecodedArray(const vtkBanyanDecodedArray&) = delete;
  void operator=(const vtkBanyanDecodedArray&) = delete;

  banyan::PieceRange OfSeries;
  vtkMTimeType UnchangedSince = 0;
};

#endif
