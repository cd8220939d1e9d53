// SPDX-License-Identifier: BSD-3-Clause
#include "StaggeredBox.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

StaggeredBox::StaggeredBox(int size)
  : N(size)
  , Row(static_cast<std::size_t>(size) + 4)
  , Stride{ 1, static_cast<std::ptrdiff_t>(Row), static_cast<std::ptrdiff_t>(Row * Row) }
  , Poisson(size)
  , Pressure(static_cast<std::size_t>(size) * size * size, 0.0f)
{
  for (std::vector<float>& array : this->Arrays)
  {
    array.assign(this->Row * this->Row * this->Row, 0.0f);
  }
}

std::vector<float> StaggeredBox::Inner(int array) const
{
  std::vector<float> values;
  values.reserve(this->Pressure.size());
  for (int z = 0; z < this->N; ++z)
  {
    for (int y = 0; y < this->N; ++y)
    {
      const float* row = this->Arrays[array].data() + this->Index(0, y, z);
      values.insert(values.end(), row, row + this->N);
    }
  }
  return values;
}

void StaggeredBox::FillGhosts(float low, float high, ThreadPool& pool)
{
  pool.ParallelFor(4,
    [&](std::int64_t array)
    {
      if (array < 3)
      {
        this->FillVelocityGhosts(static_cast<int>(array));
      }
      else
      {
        this->FillScalarGhosts(low, high);
      }
    });
}

void StaggeredBox::FillVelocityGhosts(int component)
{
  float* v = this->Arrays[component].data();
  for (int axis = 0; axis < 3; ++axis)
  {
    if (axis == component)
    {
      continue; // faces in the walls are never touched: they are zero since the beginning
    }
    const std::ptrdiff_t s = this->Stride[axis];
    const int first = (axis + 1) % 3, second = (axis + 2) % 3;
    for (int j = -1; j <= this->N; ++j)
    {
      for (int i = -1; i <= this->N; ++i)
      {
        std::array<int, 3> at{};
        at[first] = i;
        at[second] = j;
        float* low = v + this->Index(at[0], at[1], at[2]);
        float* high = low + (this->N - 1) * s;
        low[-s] = -low[0];
        high[s] = -high[0];
      }
    }
  }
}

void StaggeredBox::FillScalarGhosts(float low, float high)
{
  const std::ptrdiff_t sy = this->Stride[1], sz = this->Stride[2];
  const int last = this->N - 1;
  for (int j = 0; j < this->N; ++j)
  {
    for (int i = 0; i < this->N; ++i)
    {
      float* x = this->Arrays[3].data() + this->Index(0, i, j);
      x[-1] = 2.0f * low - x[0];
      x[this->N] = 2.0f * high - x[last];
      float* y = this->Arrays[3].data() + this->Index(i, 0, j);
      y[-sy] = y[0];
      y[this->N * sy] = y[last * sy];
      float* z = this->Arrays[3].data() + this->Index(i, j, 0);
      z[-sz] = z[0];
      z[this->N * sz] = z[last * sz];
    }
  }
}

void StaggeredBox::Project(ThreadPool& pool)
{
  const std::ptrdiff_t sy = this->Stride[1], sz = this->Stride[2];
  const std::size_t n = static_cast<std::size_t>(this->N);
  const auto forRows = [&](const auto& body)
  {
    pool.ParallelFor(this->N,
      [&](std::int64_t z)
      {
        for (int y = 0; y < this->N; ++y)
        {
          const std::size_t p = this->Index(0, y, static_cast<int>(z));
          body(this->Arrays[0].data() + p, this->Arrays[1].data() + p, this->Arrays[2].data() + p,
            &this->Pressure[(z * n + y) * n], y, z);
        }
      });
  };
  forRows(
    [&](const float* u, const float* v, const float* w, float* __restrict divergence, auto, auto)
    {
      for (std::size_t x = 0; x < n; ++x)
      {
        divergence[x] = (u[x + 1] - u[x]) + (v[x + sy] - v[x]) + (w[x + sz] - w[x]);
      }
    });
  this->Poisson.Solve(this->Pressure, pool);
  forRows(
    [&](
      float* __restrict u, float* __restrict v, float* __restrict w, const float* q, auto y, auto z)
    {
      for (std::size_t x = 1; x < n; ++x)
      {
        u[x] -= q[x] - q[x - 1];
      }
      for (std::size_t x = 0; y > 0 && x < n; ++x)
      {
        v[x] -= q[x] - *(q + x - n);
      }
      for (std::size_t x = 0; z > 0 && x < n; ++x)
      {
        w[x] -= q[x] - *(q + x - n * n);
      }
    });
}

double StaggeredBox::LargestDivergence() const
{
  double largest = 0.0;
  for (int z = 0; z < this->N; ++z)
  {
    for (int y = 0; y < this->N; ++y)
    {
      for (int x = 0; x < this->N; ++x)
      {
        const std::size_t p = this->Index(x, y, z);
        double divergence = 0.0;
        for (int c = 0; c < 3; ++c)
        {
          divergence += static_cast<double>(this->Arrays[c][p + this->Stride[c]]) -
                        static_cast<double>(this->Arrays[c][p]);
        }
        largest = std::max(largest, std::abs(divergence));
      }
    }
  }
  return largest;
}

} // namespace banyan
