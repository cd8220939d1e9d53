// SPDX-License-Identifier: BSD-3-Clause
#include "EnhancedArray.h"

#include "Base/ThreadPool.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace banyan
{
namespace
{

constexpr vtkIdType TuplesAtOnce = 4096;

template <class T>
void CopyValues(const T* from, std::size_t count, double* to)
{
  std::transform(from, from + count, to, [](T value) { return static_cast<double>(value); });
}

/// Tuples of an array, components fastest.
void ReadTuples(vtkDataArray* array, vtkIdType first, vtkIdType count, std::vector<double>& values)
{
  const int components = array->GetNumberOfComponents();
  values.resize(static_cast<std::size_t>(count * components));
  if (array->HasStandardMemoryLayout())
  {
    const void* const from = array->GetVoidPointer(first * components);
    switch (array->GetDataType())
    {
      vtkTemplateMacro(CopyValues(static_cast<const VTK_TT*>(from), values.size(), values.data()));
    }
    return;
  }
  for (vtkIdType i = 0; i < count * components; ++i)
  {
    values[static_cast<std::size_t>(i)] =
      array->GetComponent(first + i / components, static_cast<int>(i % components));
  }
}

/// The scalar of each tuple that is compared with other steps': its length or one component.
void Measure(const std::vector<double>& tuples, int components, EnhancedPart part,
  std::vector<double>& measures)
{
  measures.resize(tuples.size() / static_cast<std::size_t>(components));
  const bool length = components > 1 && static_cast<int>(part) < 0;
  const std::size_t component =
    length || static_cast<int>(part) < 0 ? 0 : static_cast<std::size_t>(part);
  for (std::size_t i = 0; i < measures.size(); ++i)
  {
    const double* const tuple = &tuples[i * static_cast<std::size_t>(components)];
    double squares = 0.0;
    for (int c = 0; length && c < components; ++c)
    {
      squares += tuple[c] * tuple[c];
    }
    measures[i] = length ? std::sqrt(squares) : tuple[component];
  }
}

/// Buffers of a worker.
class Chunk
{
public:
  Chunk(const TemporalEnhancement& how, vtkDataArray* now, vtkDataArray* previous,
    vtkDataArray* next, EnhancedPart part)
    : How(how)
    , Now(now)
    , Previous(previous)
    , Next(next)
    , Part(part)
  {
  }

  void Enhance(vtkIdType first, vtkIdType count, vtkDataArray* result)
  {
    const int components = this->Now->GetNumberOfComponents();
    const auto measure = [&](vtkDataArray* array, std::vector<double>& measures)
    {
      if (array)
      {
        ReadTuples(array, first, count, this->Tuples);
        Measure(this->Tuples, components, this->Part, measures);
      }
    };
    measure(this->Previous, this->Before);
    measure(this->Next, this->After);
    measure(this->Now, this->Measures); // Tuples stay those of the step itself
    for (std::size_t i = 0; i < this->Measures.size(); ++i)
    {
      const double value = this->Measures[i];
      const double enhanced = EnhancedValue(this->How, value,
        this->Previous ? &this->Before[i] : nullptr, this->Next ? &this->After[i] : nullptr);
      if (result->GetNumberOfComponents() == 1)
      {
        this->Measures[i] = enhanced;
        continue;
      }
      // A vector of no length has no direction; what is not finite stays.
      const double factor = value > 0.0 && std::isfinite(value) ? enhanced / value : 1.0;
      for (int c = 0; c < components; ++c)
      {
        this->Tuples[i * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)] *=
          factor;
      }
    }
    const bool scalars = result->GetNumberOfComponents() == 1;
    Write(scalars ? this->Measures : this->Tuples, first * result->GetNumberOfComponents(), result);
  }

private:
  static void Write(const std::vector<double>& values, vtkIdType firstValue, vtkDataArray* result)
  {
    void* const to = result->GetVoidPointer(firstValue);
    if (result->GetDataType() == VTK_DOUBLE)
    {
      std::copy(values.begin(), values.end(), static_cast<double*>(to));
      return;
    }
    std::transform(values.begin(), values.end(), static_cast<float*>(to),
      [](double value) { return static_cast<float>(value); });
  }

  TemporalEnhancement How;
  vtkDataArray* Now;
  vtkDataArray* Previous;
  vtkDataArray* Next;
  EnhancedPart Part;
  std::vector<double> Tuples;
  std::vector<double> Measures;
  std::vector<double> Before;
  std::vector<double> After;
};

} // namespace

vtkSmartPointer<vtkDataArray> EnhancedArray(const TemporalEnhancement& how, vtkDataArray* now,
  vtkDataArray* previous, vtkDataArray* next, EnhancedPart part)
{
  vtkSmartPointer<vtkDataArray> result;
  if (now->GetDataType() == VTK_DOUBLE)
  {
    result = vtkSmartPointer<vtkDoubleArray>::New();
  }
  else
  {
    result = vtkSmartPointer<vtkFloatArray>::New();
  }
  const vtkIdType tuples = now->GetNumberOfTuples();
  result->SetName((std::string(now->GetName() ? now->GetName() : "") + "_enhanced").c_str());
  if (part == EnhancedPart::Vectors)
  {
    result->SetNumberOfComponents(now->GetNumberOfComponents());
    result->CopyComponentNames(now);
  }
  result->SetNumberOfTuples(tuples);

  ThreadPool& pool = ThreadPool::Process();
  std::vector<Chunk> workers(
    static_cast<std::size_t>(pool.Width()), Chunk(how, now, previous, next, part));
  pool.ParallelFor((tuples + TuplesAtOnce - 1) / TuplesAtOnce,
    [&](std::int64_t chunk, int worker)
    {
      const vtkIdType first = chunk * TuplesAtOnce;
      workers[static_cast<std::size_t>(worker)].Enhance(
        first, std::min(TuplesAtOnce, tuples - first), result);
    });
  return result;
}

} // namespace banyan
