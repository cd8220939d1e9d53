// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanArrayRanges_txx
#define vtkBanyanArrayRanges_txx

// The answers of vtkBanyanArray when it is asked for ranges.
#include "vtkBanyanArray.h"

#include "vtkUnsignedCharArray.h"

#include <cmath>

template <class T>
std::vector<banyan::ValueRange> vtkBanyanArray<T>::Scan(
  const unsigned char* ghosts, unsigned char skip, Infinities infinities) const
{
  const int components = this->NumberOfComponents;
  const vtkIdType tuples = this->GetNumberOfTuples();
  const bool finiteOnly = infinities == Infinities::Skip;
  std::vector<banyan::ValueRange> ranges(components + 1);
  const T* value = this->Values();
  for (vtkIdType tuple = 0; tuple < tuples; ++tuple, value += components)
  {
    if (ghosts && (ghosts[tuple] & skip))
    {
      continue;
    }
    double squares = 0.0;
    for (int c = 0; c < components; ++c)
    {
      const double x = static_cast<double>(value[c]);
      squares += x * x;
      if (!finiteOnly || !std::isinf(x))
      {
        ranges[c].Include(x); // NaN compares false and changes nothing
      }
    }
    if (!finiteOnly || !std::isinf(squares))
    {
      ranges[components].Include(squares);
    }
  }
  if (components == 1)
  {
    ranges[1] = ranges[0];
  }
  else if (!ranges[components].Empty())
  {
    ranges[components] = { std::sqrt(ranges[components].Low), std::sqrt(ranges[components].High) };
  }
  return ranges;
}

template <class T>
bool vtkBanyanArray<T>::AreOwn(const unsigned char* ghosts, unsigned char skip) const
{
  vtkUnsignedCharArray* const flags = this->Source.Flags;
  return flags ? ghosts && ghosts == flags->GetPointer(0) && this->Source.HasFlags(flags) &&
                   (skip & banyan::HiddenPointBits) != 0
               : !ghosts;
}

template <class T>
std::vector<banyan::ValueRange> vtkBanyanArray<T>::Told(Infinities infinities)
{
  if (this->DecodedBytes() == 0)
  {
    std::vector<banyan::ValueRange> ranges = this->OfPiece.Components;
    ranges.push_back(this->OfPiece.Magnitude);
    return ranges;
  }
  std::vector<banyan::ValueRange>& ranges = this->Scanned[static_cast<int>(infinities)];
  if (ranges.empty())
  {
    const bool some = this->Source.Flags != nullptr;
    ranges = this->Scan(
      some ? this->Source.Flags->GetPointer(0) : nullptr, banyan::HiddenPointBits, infinities);
  }
  return ranges;
}

template <class T>
std::vector<banyan::ValueRange> vtkBanyanArray<T>::Answer(
  const unsigned char* ghosts, unsigned char skip, Infinities infinities)
{
  // Values that were changed are nobody's but the array's: no memory of them is kept either.
  return this->IsPristine() && this->AreOwn(ghosts, skip) ? this->Told(infinities)
                                                          : this->Scan(ghosts, skip, infinities);
}

namespace vtkBanyanArrayDetail
{
/// Writes a range as VTK does: an empty one is from the largest double to the smallest.
inline void Write(const banyan::ValueRange& from, double* to)
{
  to[0] = from.Empty() ? VTK_DOUBLE_MAX : from.Low;
  to[1] = from.Empty() ? VTK_DOUBLE_MIN : from.High;
}

/// @param component -1 for the magnitude, which comes last
inline void WriteOne(const std::vector<banyan::ValueRange>& from, int component, double* to)
{
  const int components = static_cast<int>(from.size()) - 1;
  if (component < components)
  {
    Write(from[component < 0 ? components : component], to);
  }
}

inline void WriteAll(const std::vector<banyan::ValueRange>& from, double* to)
{
  for (std::size_t c = 0; c + 1 < from.size(); ++c)
  {
    Write(from[c], to + 2 * c);
  }
}
}

template <class T>
void vtkBanyanArray<T>::ComputeRange(double range[2], int component)
{
  this->ComputeRange(range, component, nullptr, 0);
}

template <class T>
void vtkBanyanArray<T>::ComputeRange(
  double range[2], int component, const unsigned char* ghosts, unsigned char skip)
{
  vtkBanyanArrayDetail::WriteOne(this->Answer(ghosts, skip, Infinities::Count), component, range);
}

template <class T>
std::vector<banyan::ValueRange> vtkBanyanArray<T>::FiniteAnswer(
  const unsigned char* ghosts, unsigned char skip)
{
  if (!this->IsPristine() || (ghosts && !this->AreOwn(ghosts, skip)))
  {
    return this->Answer(ghosts, skip, Infinities::Skip);
  }
  std::vector<banyan::ValueRange> ranges = this->OfSeries.Components;
  ranges.push_back(this->OfSeries.Magnitude);
  return ranges;
}

template <class T>
void vtkBanyanArray<T>::ComputeFiniteRange(double range[2], int component)
{
  this->ComputeFiniteRange(range, component, nullptr, 0);
}

template <class T>
void vtkBanyanArray<T>::ComputeFiniteRange(
  double range[2], int component, const unsigned char* ghosts, unsigned char skip)
{
  vtkBanyanArrayDetail::WriteOne(this->FiniteAnswer(ghosts, skip), component, range);
}

template <class T>
bool vtkBanyanArray<T>::ComputeScalarRange(double* ranges)
{
  return this->ComputeScalarRange(ranges, nullptr, 0);
}

template <class T>
bool vtkBanyanArray<T>::ComputeScalarRange(
  double* ranges, const unsigned char* ghosts, unsigned char skip)
{
  vtkBanyanArrayDetail::WriteAll(this->Answer(ghosts, skip, Infinities::Count), ranges);
  return this->Size > 0;
}

template <class T>
bool vtkBanyanArray<T>::ComputeVectorRange(double range[2])
{
  return this->ComputeVectorRange(range, nullptr, 0);
}

template <class T>
bool vtkBanyanArray<T>::ComputeVectorRange(
  double range[2], const unsigned char* ghosts, unsigned char skip)
{
  vtkBanyanArrayDetail::WriteOne(this->Answer(ghosts, skip, Infinities::Count), -1, range);
  return this->Size > 0;
}

template <class T>
bool vtkBanyanArray<T>::ComputeFiniteScalarRange(double* ranges)
{
  return this->ComputeFiniteScalarRange(ranges, nullptr, 0);
}

template <class T>
bool vtkBanyanArray<T>::ComputeFiniteScalarRange(
  double* ranges, const unsigned char* ghosts, unsigned char skip)
{
  vtkBanyanArrayDetail::WriteAll(this->FiniteAnswer(ghosts, skip), ranges);
  return this->Size > 0;
}

template <class T>
bool vtkBanyanArray<T>::ComputeFiniteVectorRange(double range[2])
{
  return this->ComputeFiniteVectorRange(range, nullptr, 0);
}

template <class T>
bool vtkBanyanArray<T>::ComputeFiniteVectorRange(
  double range[2], const unsigned char* ghosts, unsigned char skip)
{
  vtkBanyanArrayDetail::WriteOne(this->FiniteAnswer(ghosts, skip), -1, range);
  return this->Size > 0;
}

#endif
