// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkBanyanDecodedArray
 * @brief   a plain point array of a Banyan series that still knows where its values come from
 *
 * Everything in VTK takes it for the plain array that it is: it has that one's memory, class name
 * and new instances. A renderer finds the series behind it, as it does behind deferred arrays.
 * GetFiniteRange() is that of the series, see SeriesRangeArray.
 *
 * @par Limits:
 * Who writes values has to call Modified(), as VTK demands; only then do they count as changed.
 */
#ifndef vtkBanyanDecodedArray_h
#define vtkBanyanDecodedArray_h

#include "SeriesRangeArray.h"
#include "vtkBanyanDeferred.h"

/// @tparam Plain the array that vtkDataArray::CreateDataArray() makes of the type
template <class Plain>
class vtkBanyanDecodedArray final
  : public banyan::SeriesRangeArray<Plain>
  , public vtkBanyanDeferred
{
public:
  // No type macro: the name of the class stays that of Plain.
  static vtkBanyanDecodedArray* New() { VTK_STANDARD_NEW_BODY(vtkBanyanDecodedArray); }

  /// To be called when name and values are there.
  void SetSource(const Handle& source)
  {
    this->Source = source;
    this->SetSeriesRange(banyan::RangeOfSeries(*source.Series, source.Array), source.Flags);
  }

protected:
  vtkBanyanDecodedArray() = default;
  ~vtkBanyanDecodedArray() override = default;

  bool IsPristine() const override { return this->Source.Series && this->IsUnchanged(); }
  bool IsPlain() const override { return true; }
  std::uint64_t DecodedBytes() const override
  {
    return static_cast<std::uint64_t>(this->Size) * sizeof(typename Plain::ValueType);
  }
  bool Release() override { return false; }

private:
  vtkBanyanDecodedArray(const vtkBanyanDecodedArray&) = delete;
  void operator=(const vtkBanyanDecodedArray&) = delete;
};

#endif
