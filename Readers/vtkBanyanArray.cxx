// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanArray.txx"

#include "LargeArrays.h"
#include "vtkBanyanDecodedArray.h"

#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkIntArray.h"
#include "vtkLongArray.h"
#include "vtkShortArray.h"
#include "vtkSignedCharArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnsignedIntArray.h"
#include "vtkUnsignedLongArray.h"
#include "vtkUnsignedShortArray.h"

#include <tuple>
#include <type_traits>

namespace
{

/// VTK's general path through unknown arrays goes by double; larger integers would change there.
constexpr double LargestExactInteger = 9007199254740992.0; // 2^53

/// Ranges do not tell of hidden values.
bool FitsDouble(const banyan::ArrayIndex& index, bool hidden)
{
  const bool wide =
    index.Type == banyan::ScalarType::Int64 || index.Type == banyan::ScalarType::UInt64;
  for (const banyan::ComponentIndex& component : index.Components)
  {
    const banyan::ValueRange& range = component.Range;
    if (wide && hidden)
    {
      return false;
    }
    if (wide && !range.Empty() &&
        (range.Low < -LargestExactInteger || range.High > LargestExactInteger))
    {
      return false;
    }
  }
  return true;
}

/// VTK's class of plain arrays of T, in the order of banyan::ScalarType.
using PlainArrays = std::tuple<vtkSignedCharArray, vtkUnsignedCharArray, vtkShortArray,
  vtkUnsignedShortArray, vtkIntArray, vtkUnsignedIntArray, vtkLongArray, vtkUnsignedLongArray,
  vtkFloatArray, vtkDoubleArray>;
template <class T>
using PlainArray =
  std::tuple_element_t<static_cast<std::size_t>(banyan::ScalarTypeOf<T>()), PlainArrays>;

} // namespace

vtkSmartPointer<vtkDataArray> vtkBanyanDeferred::New(const Handle& handle)
{
  const banyan::ArrayIndex& index = handle.Series->Index().Arrays.at(handle.Array);
  if (!FitsDouble(index, handle.Flags != nullptr))
  {
    return NewPlain(handle);
  }
  return banyan::Dispatch(index.Type,
    [&](auto tag) -> vtkSmartPointer<vtkDataArray>
    {
      auto array = vtkSmartPointer<vtkBanyanArray<typename decltype(tag)::Type>>::New();
      array->SetSource(handle);
      return array;
    });
}

vtkSmartPointer<vtkDataArray> vtkBanyanDeferred::NewEmpty(const Handle& handle)
{
  const banyan::ArrayIndex& index = handle.Series->Index().Arrays.at(handle.Array);
  return banyan::Dispatch(index.Type,
    [&](auto tag) -> vtkSmartPointer<vtkDataArray>
    {
      using T = typename decltype(tag)::Type;
      const auto array = vtkSmartPointer<banyan::SeriesRangeArray<PlainArray<T>>>::New();
      Label(*array, index);
      return array;
    });
}

vtkSmartPointer<vtkDataArray> vtkBanyanDeferred::NewPlain(const Handle& handle)
{
  const vtkSmartPointer<vtkDataArray> array = NewEmpty(handle);
  banyan::SetTuples(array, handle.Samples.Count());
  ReadInto(handle, array->GetVoidPointer(0));
  return array;
}

vtkSmartPointer<vtkDataArray> vtkBanyanDeferred::NewDecoded(const Handle& handle)
{
  const banyan::ArrayIndex& index = handle.Series->Index().Arrays.at(handle.Array);
  return banyan::Dispatch(index.Type,
    [&](auto tag) -> vtkSmartPointer<vtkDataArray>
    {
      using T = typename decltype(tag)::Type;
      static_assert(std::is_same_v<typename PlainArray<T>::ValueType, T>);
      const auto array = vtkSmartPointer<vtkBanyanDecodedArray<PlainArray<T>>>::New();
      Label(*array, index);
      banyan::SetTuples(array, handle.Samples.Count());
      ReadInto(handle, array->GetVoidPointer(0));
      array->SetSource(handle);
      return array;
    });
}

void vtkBanyanDeferred::Label(vtkDataArray& array, const banyan::ArrayIndex& index)
{
  array.SetName(index.Name.c_str());
  array.SetNumberOfComponents(static_cast<int>(index.Components.size()));
  for (std::size_t c = 0; c < index.Components.size(); ++c)
  {
    if (!index.Components[c].Name.empty())
    {
      array.SetComponentName(static_cast<vtkIdType>(c), index.Components[c].Name.c_str());
    }
  }
}
