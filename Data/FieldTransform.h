// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_FieldTransform_h
#define banyan_Data_FieldTransform_h

#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A real field on an N^3 periodic grid, held either as N^3 values or as its Fourier coefficients,
/// both in the same memory.
///
/// Values: `[z][y][x]`, x fastest, rows padded to `RowReals()` floats.
/// Coefficients: `[kz][ky][kx]` with kx in [0, N/2] and rows of `RowModes()`; the coefficients of
/// negative kx are the complex conjugates and not stored.
class PeriodicField
{
public:
  using Complex = std::complex<float>;

  /// @param size N, even and at least 4. The field starts as zero.
  explicit PeriodicField(int size);

  int Size() const { return this->N; }
  std::size_t RowModes() const { return static_cast<std::size_t>(this->N / 2 + 1); }
  std::size_t RowReals() const { return 2 * this->RowModes(); }
  std::size_t ModeCount() const
  {
    return static_cast<std::size_t>(this->N) * this->N * this->RowModes();
  }

  float* Values() { return this->Memory.get(); }
  const float* Values() const { return this->Memory.get(); }
  Complex* Modes() { return reinterpret_cast<Complex*>(this->Memory.get()); }
  const Complex* Modes() const { return reinterpret_cast<const Complex*>(this->Memory.get()); }

  float& Value(int x, int y, int z) { return this->Values()[this->RowStart(y, z) + x]; }
  float Value(int x, int y, int z) const { return this->Values()[this->RowStart(y, z) + x]; }

private:
  std::size_t RowStart(int y, int z) const
  {
    return (static_cast<std::size_t>(z) * this->N + y) * this->RowReals();
  }
  struct Release
  {
    void operator()(float* memory) const;
  };
  std::unique_ptr<float[], Release> Memory;
  int N;
};

/// Discrete Fourier transforms of `PeriodicField`s, in place, in single precision (FFTW).
///
/// Plans are estimated, not measured, and each transform runs on one thread: equal input gives
/// equal bits on the same machine, for any number of threads.
class FieldTransform
{
public:
  /// @param size N of the fields
  explicit FieldTransform(int size);
  ~FieldTransform();
  FieldTransform(const FieldTransform&) = delete;
  FieldTransform& operator=(const FieldTransform&) = delete;

  /// Values to coefficients, scaled by 1/N^3: the coefficient of mode 0 is the mean.
  void ToModes(const std::vector<PeriodicField*>& fields, ThreadPool& pool) const;
  /// Coefficients to values, unscaled: the inverse of `ToModes`.
  void ToValues(const std::vector<PeriodicField*>& fields, ThreadPool& pool) const;

private:
  struct Plans;
  std::unique_ptr<Plans> Self;
  int N;
};

} // namespace banyan

#endif
