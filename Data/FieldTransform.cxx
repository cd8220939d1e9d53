// SPDX-License-Identifier: BSD-3-Clause
#include "FieldTransform.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <fftw3.h>

#include <algorithm>
#include <new>

namespace banyan
{

PeriodicField::PeriodicField(int size)
  : N(size)
{
  if (size < 4 || size % 2 != 0)
  {
    throw Error("A periodic field needs an even number of at least 4 samples per axis.",
      { {}, {}, static_cast<std::uint64_t>(std::max(size, 0)), 4 });
  }
  const std::size_t reals = 2 * this->ModeCount();
  // FFTW's own allocator: its vector instructions want aligned memory, the same for each field.
  this->Memory.reset(fftwf_alloc_real(reals));
  if (!this->Memory)
  {
    throw std::bad_alloc();
  }
  std::fill_n(this->Memory.get(), reals, 0.0f);
}

void PeriodicField::Release::operator()(float* memory) const
{
  fftwf_free(memory);
}

struct FieldTransform::Plans
{
  fftwf_plan Forward = nullptr;
  fftwf_plan Backward = nullptr;
};

FieldTransform::FieldTransform(int size)
  : Self(new Plans)
  , N(size)
{
  PeriodicField pattern(size);
  auto* modes = reinterpret_cast<fftwf_complex*>(pattern.Modes());
  this->Self->Forward =
    fftwf_plan_dft_r2c_3d(size, size, size, pattern.Values(), modes, FFTW_ESTIMATE);
  this->Self->Backward =
    fftwf_plan_dft_c2r_3d(size, size, size, modes, pattern.Values(), FFTW_ESTIMATE);
}

FieldTransform::~FieldTransform()
{
  fftwf_destroy_plan(this->Self->Forward);
  fftwf_destroy_plan(this->Self->Backward);
}

void FieldTransform::ToModes(const std::vector<PeriodicField*>& fields, ThreadPool& pool) const
{
  const float scale = 1.0f / (static_cast<float>(this->N) * this->N * this->N);
  pool.ParallelFor(static_cast<std::int64_t>(fields.size()),
    [&](std::int64_t i)
    {
      PeriodicField& field = *fields[i];
      fftwf_execute_dft_r2c(
        this->Self->Forward, field.Values(), reinterpret_cast<fftwf_complex*>(field.Modes()));
      const std::size_t count = field.ModeCount();
      PeriodicField::Complex* modes = field.Modes();
      for (std::size_t m = 0; m < count; ++m)
      {
        modes[m] *= scale;
      }
    });
}

void FieldTransform::ToValues(const std::vector<PeriodicField*>& fields, ThreadPool& pool) const
{
  pool.ParallelFor(static_cast<std::int64_t>(fields.size()),
    [&](std::int64_t i)
    {
      PeriodicField& field = *fields[i];
      fftwf_execute_dft_c2r(
        this->Self->Backward, reinterpret_cast<fftwf_complex*>(field.Modes()), field.Values());
    });
}

} // namespace banyan
