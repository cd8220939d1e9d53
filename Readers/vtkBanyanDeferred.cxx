// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanDeferred.h"

#include "LargeArrays.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkUnsignedCharArray.h"

#include "Cache/BrickCache.h"
#include "Series/Decode/BetweenSteps.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Grid/LevelGrid.h"

#include <algorithm>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <vector>

namespace
{

/// The deferred arrays of this process that hold decoded values, oldest first.
struct Ledger
{
  std::mutex Mutex;
  std::vector<vtkBanyanDeferred*> Arrays;

  static Ledger& Get()
  {
    // Never destroyed: arrays may outlive the static objects of this library.
    static Ledger* ledger = new Ledger;
    return *ledger;
  }
};

vtkBanyanDeferred* Cast(vtkAbstractArray* array)
{
  return dynamic_cast<vtkBanyanDeferred*>(array);
}

} // namespace

vtkBanyanDeferred::vtkBanyanDeferred() = default;
vtkBanyanDeferred::~vtkBanyanDeferred() = default;

const vtkBanyanDeferred::Handle* vtkBanyanDeferred::From(vtkAbstractArray* array)
{
  const vtkBanyanDeferred* deferred = Cast(array);
  return deferred && deferred->IsPristine() ? &deferred->Source : nullptr;
}

bool vtkBanyanDeferred::IsDeferred(vtkAbstractArray* array)
{
  const vtkBanyanDeferred* deferred = Cast(array);
  return deferred && !deferred->IsPlain();
}

bool vtkBanyanDeferred::IsUntouched(vtkAbstractArray* array)
{
  const vtkBanyanDeferred* deferred = Cast(array);
  return deferred && !deferred->IsPlain() && deferred->DecodedBytes() == 0;
}

void vtkBanyanDeferred::Supersede(vtkAbstractArray* array)
{
  if (vtkBanyanDeferred* const deferred = Cast(array))
  {
    deferred->Superseded = true;
  }
}

bool vtkBanyanDeferred::Handle::HasFlags(vtkUnsignedCharArray* flags) const
{
  return flags == this->Flags && (!flags || flags->GetMTime() == this->FlagsTime);
}

bool vtkBanyanDeferred::Handle::HidesAs(vtkImageData* image) const
{
  if (this->Flags ? !this->HasFlags(image->GetPointGhostArray()) : image->HasAnyBlankPoints())
  {
    return false;
  }
  vtkUnsignedCharArray* const cells = image->GetCellGhostArray();
  if (!cells || (cells == this->CellFlags && cells->GetMTime() == this->CellFlagsTime))
  {
    return true;
  }
  const unsigned char* const first = cells->GetPointer(0);
  return std::none_of(first, first + cells->GetNumberOfTuples(),
    [](unsigned char flag) { return (flag & banyan::HiddenCellBits) != 0; });
}

bool vtkBanyanDeferred::LiesOnSeries(vtkImageData* image, const Handle& handle)
{
  const banyan::Grid grid = banyan::GridOfLevel(handle.Series->Index().Domain, handle.Level);
  const int* extent = image->GetExtent();
  const double* origin = image->GetOrigin();
  const double* spacing = image->GetSpacing();
  const vtkMatrix3x3* direction = image->GetDirectionMatrix();
  if (!handle.HidesAs(image))
  {
    return false;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    const int first = handle.Samples.Lo[axis] + grid.Extent.Lo[axis];
    const int last = handle.Samples.Hi[axis] + grid.Extent.Lo[axis] - 1;
    if (extent[2 * axis] != first || extent[2 * axis + 1] != last ||
        origin[axis] != grid.Origin[axis] || spacing[axis] != grid.Spacing[axis])
    {
      return false;
    }
    for (int row = 0; row < 3; ++row)
    {
      if (direction->GetElement(row, axis) != grid.Direction[axis][row])
      {
        return false;
      }
    }
  }
  return true;
}

vtkSmartPointer<vtkDataArray> vtkBanyanDeferred::Plain(vtkDataArray* array)
{
  const vtkBanyanDeferred* deferred = Cast(array);
  if (!deferred)
  {
    return array;
  }
  if (deferred->IsPlain())
  {
    const auto stripped = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    stripped->ShallowCopy(array);
    return stripped;
  }
  try
  {
    vtkSmartPointer<vtkDataArray> plain;
    if (deferred->IsPristine() && IsUntouched(array))
    {
      plain = NewPlain(deferred->Source);
    }
    else
    {
      plain.TakeReference(array->NewInstance());
      plain->SetNumberOfComponents(array->GetNumberOfComponents());
      banyan::SetTuples(plain, array->GetNumberOfTuples());
      array->ExportToVoidPointer(plain->GetVoidPointer(0));
      plain->CopyComponentNames(array);
    }
    plain->SetName(array->GetName());
    plain->CopyInformation(array->GetInformation());
    return plain;
  }
  catch (const std::bad_alloc&)
  {
    vtkErrorWithObjectMacro(array, "There is no memory for the " << array->GetNumberOfValues()
                                                                 << " values of the array "
                                                                 << array->GetName() << ".");
  }
  catch (const banyan::Error& error)
  {
    vtkErrorWithObjectMacro(
      array, "The array " << array->GetName() << " cannot be decoded: " << error.what());
  }
  return nullptr;
}

void vtkBanyanDeferred::ReadInto(const Handle& handle, void* values)
{
  const int components =
    static_cast<int>(handle.Series->Index().Arrays.at(handle.Array).Components.size());
  if (handle.Samples.Empty())
  {
    return;
  }
  for (int component = 0; component < components; ++component)
  {
    banyan::ReadBetween(*handle.Series, { handle.Step, handle.Array, component, handle.Level },
      handle.Fraction, handle.Samples.Count(), values, components, component,
      [&](const banyan::FieldKey& field, void* to, int stride, int at)
      {
        banyan::ReadRegion(banyan::BrickCache::Of(*handle.Series), *handle.Series, field,
          handle.Samples, to, stride, at);
      });
  }
}

void vtkBanyanDeferred::WarnOfFilters(const char* name) const
{
  static std::mutex mutex;
  static auto* const told = new std::set<std::string>; // arrays may outlive static objects
  if (!this->Source.Series || this->Superseded)
  {
    return;
  }
  const std::string& file = this->Source.Series->Path();
  {
    const std::lock_guard<std::mutex> lock(mutex);
    if (!told->insert(file).second)
    {
      return;
    }
  }
  vtkGenericWarningMacro(
    "The values of the array "
    << name << " of " << file
    << " are asked for one by one, by a program or filter that is not connected to the reader. "
       "They "
       "are right, but with such arrays some filters are not: connect the filter to the reader, or "
       "put Banyan Decode between.");
}

void vtkBanyanDeferred::Remember() const
{
  Ledger& ledger = Ledger::Get();
  const std::lock_guard<std::mutex> lock(ledger.Mutex);
  ledger.Arrays.push_back(const_cast<vtkBanyanDeferred*>(this));
}

void vtkBanyanDeferred::Forget()
{
  Ledger& ledger = Ledger::Get();
  const std::lock_guard<std::mutex> lock(ledger.Mutex);
  auto& arrays = ledger.Arrays;
  arrays.erase(std::remove(arrays.begin(), arrays.end(), this), arrays.end());
}

std::uint64_t vtkBanyanDeferred::HeldBytes()
{
  Ledger& ledger = Ledger::Get();
  const std::lock_guard<std::mutex> lock(ledger.Mutex);
  std::uint64_t bytes = 0;
  for (const vtkBanyanDeferred* array : ledger.Arrays)
  {
    bytes += array->DecodedBytes();
  }
  return bytes;
}

banyan::CacheContext* vtkBanyanDeferred::Caches() const
{
  const auto& series = this->Source.Series;
  return (series ? series->Caches() : banyan::CacheContext::Process()).get();
}

void vtkBanyanDeferred::ReleaseBeyondBudgets()
{
  Ledger& ledger = Ledger::Get();
  const std::lock_guard<std::mutex> lock(ledger.Mutex);
  auto& arrays = ledger.Arrays;
  std::map<const banyan::CacheContext*, std::uint64_t> held;
  for (const vtkBanyanDeferred* array : arrays)
  {
    held[array->Caches()] += array->DecodedBytes();
  }
  for (auto array = arrays.begin(); array != arrays.end();)
  {
    const std::uint64_t bytes = (*array)->DecodedBytes();
    const banyan::CacheContext* const caches = (*array)->Caches();
    if (held[caches] > caches->BudgetBytes() && (*array)->Release())
    {
      held[caches] -= bytes;
      array = arrays.erase(array);
    }
    else
    {
      ++array;
    }
  }
}
