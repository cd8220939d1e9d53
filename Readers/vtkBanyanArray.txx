// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanArray_txx
#define vtkBanyanArray_txx

#include "vtkBanyanArray.h"

#include "vtkArrayIteratorTemplate.h"

#include "Cache/BrickCache.h"

#include <cstring>
#include <limits>

template <class T>
vtkBanyanArray<T>::vtkBanyanArray() = default;

template <class T>
vtkBanyanArray<T>::~vtkBanyanArray()
{
  this->Forget();
}

template <class T>
void vtkBanyanArray<T>::SetSource(const Handle& source)
{
  this->Source = source;
  const banyan::SeriesFile& series = *source.Series;
  this->OfPiece =
    banyan::RangeOfPiece(series, source.Step, source.Array, source.Level, source.Samples);
  if (source.Fraction > 0.0)
  {
    this->OfPiece = banyan::RangeBetween(this->OfPiece,
      banyan::RangeOfPiece(series, source.Step + 1, source.Array, source.Level, source.Samples));
  }
  this->OfSeries = banyan::RangeOfSeries(series, source.Array);

  const banyan::ArrayIndex& index = series.Index().Arrays[source.Array];
  Label(*this, index);
  this->Size = source.Samples.Count() * this->NumberOfComponents;
  this->MaxId = this->Size - 1;
  this->UnchangedSince = this->GetMTime();
}

template <class T>
T* vtkBanyanArray<T>::Decode() const
{
  const std::lock_guard<std::mutex> lock(this->Decoding);
  if (T* values = this->Data.load(std::memory_order_acquire))
  {
    return values; // another thread was faster
  }
  // An array is never without values, so that 0 is free to say "not decoded".
  const std::size_t count = this->Size > 0 ? static_cast<std::size_t>(this->Size) : 1;
  this->Storage = banyan::NewInLargePages<T>(count);
  try
  {
    if (this->Source.Series)
    {
      ReadInto(this->Source, this->Storage.get());
    }
  }
  catch (const std::exception& error)
  {
    auto* self = const_cast<SelfType*>(this);
    vtkErrorWithObjectMacro(self, "The values of the array "
                                    << self->GetName()
                                    << " could not be decoded and are now missing (NaN, or 0 for "
                                       "integers): "
                                    << error.what());
    const T missing =
      std::numeric_limits<T>::has_quiet_NaN ? std::numeric_limits<T>::quiet_NaN() : T(0);
    std::fill_n(this->Storage.get(), count, missing);
  }
  this->Data.store(this->Storage.get(), std::memory_order_release);
  this->Remember();
  return this->Storage.get();
}

template <class T>
const T* vtkBanyanArray<T>::FirstOneByOne() const
{
  if (!this->Written)
  {
    this->WarnOfFilters(const_cast<SelfType*>(this)->GetName());
  }
  const T* const values = this->Values();
  this->OneByOne.store(values, std::memory_order_release);
  return values;
}

template <class T>
T* vtkBanyanArray<T>::Writable()
{
  T* values = const_cast<T*>(this->Values());
  this->Written = true;
  return values;
}

template <class T>
bool vtkBanyanArray<T>::Own(vtkIdType tuples, bool keep)
{
  const std::size_t count = static_cast<std::size_t>(tuples) * this->NumberOfComponents;
  banyan::ArrayInLargePages<T> storage;
  try
  {
    storage = banyan::NewInLargePages<T>(std::max<std::size_t>(count, 1));
  }
  catch (const std::bad_alloc&)
  {
    return false;
  }
  if (keep && this->Size > 0)
  {
    std::copy_n(this->Values(), std::min<std::size_t>(count, this->Size), storage.get());
  }
  const std::lock_guard<std::mutex> lock(this->Decoding);
  this->OneByOne.store(nullptr);
  this->Storage = std::move(storage);
  this->Data.store(this->Storage.get(), std::memory_order_release);
  this->Written = true;
  return true;
}

template <class T>
bool vtkBanyanArray<T>::AllocateTuples(vtkIdType tuples)
{
  return this->Own(tuples, false);
}

template <class T>
bool vtkBanyanArray<T>::ReallocateTuples(vtkIdType tuples)
{
  return this->Own(tuples, true);
}

template <class T>
void* vtkBanyanArray<T>::GetVoidPointer(vtkIdType index)
{
  this->GivenAway = true;
  return const_cast<T*>(this->Values()) + index;
}

template <class T>
void* vtkBanyanArray<T>::WriteVoidPointer(vtkIdType index, vtkIdType count)
{
  const vtkIdType end = index + count;
  if (end > this->Size)
  {
    const vtkIdType tuples = (end + this->NumberOfComponents - 1) / this->NumberOfComponents;
    if (!this->Resize(tuples))
    {
      return nullptr;
    }
  }
  this->MaxId = std::max(this->MaxId, end - 1);
  this->GivenAway = true;
  this->DataChanged();
  return this->Writable() + index;
}

template <class T>
void vtkBanyanArray<T>::ExportToVoidPointer(void* to)
{
  if (to && this->GetNumberOfValues() > 0)
  {
    std::memcpy(to, this->Values(), this->GetNumberOfValues() * sizeof(T));
  }
}

template <class T>
vtkArrayIterator* vtkBanyanArray<T>::NewIterator()
{
  vtkArrayIterator* iterator = vtkArrayIteratorTemplate<T>::New();
  iterator->Initialize(this);
  return iterator;
}

template <class T>
unsigned long vtkBanyanArray<T>::GetActualMemorySize() const
{
  return this->Data.load() ? this->GenericType::GetActualMemorySize() : 1;
}

template <class T>
void vtkBanyanArray<T>::Squeeze()
{
  if (!this->Release())
  {
    this->GenericType::Squeeze();
  }
}

template <class T>
vtkObjectBase* vtkBanyanArray<T>::NewInstanceInternal() const
{
  return vtkDataArray::CreateDataArray(GenericType::VTK_DATA_TYPE);
}

template <class T>
bool vtkBanyanArray<T>::IsPristine() const
{
  // Who writes through a pointer has to call Modified(); there is no other sign of it.
  auto* self = const_cast<SelfType*>(this);
  return !this->Written && !(this->GivenAway && self->GetMTime() > this->UnchangedSince);
}

template <class T>
std::uint64_t vtkBanyanArray<T>::DecodedBytes() const
{
  return this->Data.load() ? static_cast<std::uint64_t>(this->Size) * sizeof(T) : 0;
}

template <class T>
bool vtkBanyanArray<T>::Release()
{
  const std::unique_lock<std::mutex> lock(this->Decoding, std::try_to_lock);
  if (!lock || this->GivenAway || this->Written || !this->Data.load())
  {
    return false;
  }
  this->OneByOne.store(nullptr);
  this->Data.store(nullptr);
  this->Storage.reset();
  return true;
}

#include "vtkBanyanArrayRanges.txx"

#endif
