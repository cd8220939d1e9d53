// SPDX-License-Identifier: BSD-3-Clause
#include "StandardField.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

struct Blob
{
  double Center[3];
  double Width;
  double Amplitude;
};

constexpr Blob Blobs[] = {
  { { .35, .40, .45 }, .10, 1.0 },
  { { .65, .55, .40 }, .08, .9 },
  { { .50, .70, .65 }, .07, .8 },
  { { .25, .25, .70 }, .06, .9 },
  { { .75, .30, .70 }, .09, .7 },
  { { .60, .20, .25 }, .05, 1.0 },
  { { .30, .75, .25 }, .06, .8 },
  { { .80, .80, .30 }, .05, .9 },
};
constexpr double Pi = 3.14159265358979323846;
constexpr double Base = 0.1;
constexpr double SineAmplitude = 0.10;
constexpr double WaveAmplitude = 0.06;
// What the sum reaches; the field is scaled from here to [0, 1].
constexpr double Lowest = -0.0597561449;
constexpr double Highest = 1.18257499;

double InRange(double sum)
{
  return std::clamp((sum - Lowest) / (Highest - Lowest), 0.0, 1.0);
}

double Gaussian(double distance, double width)
{
  return std::exp(-distance * distance / (2.0 * width * width));
}

} // namespace

double StandardField(const glm::dvec3& p)
{
  double sum = Base;
  for (const Blob& blob : Blobs)
  {
    const glm::dvec3 center(blob.Center[0], blob.Center[1], blob.Center[2]);
    sum += blob.Amplitude * Gaussian(glm::length(p - center), blob.Width);
  }
  sum += SineAmplitude * std::sin(8 * Pi * p.x) * std::sin(8 * Pi * p.y) * std::sin(8 * Pi * p.z);
  sum +=
    WaveAmplitude * std::sin(2 * Pi * (9 * p.x + 5 * p.y)) * std::sin(2 * Pi * (7 * p.z - 3 * p.x));
  return InRange(sum);
}

StandardFieldSlices::StandardFieldSlices(int size)
  : Size(static_cast<std::size_t>(size))
{
  const auto at = [this](std::size_t i)
  { return static_cast<double>(i) / static_cast<double>(this->Size - 1); };
  for (std::size_t i = 0; i < this->Size; ++i)
  {
    this->Sine.push_back(std::sin(8 * Pi * at(i)));
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const Blob& blob : Blobs)
    {
      Factors factors;
      for (std::size_t i = 0; i < this->Size; ++i)
      {
        factors.push_back(
          Gaussian(at(i) - blob.Center[axis], blob.Width) * (axis == 2 ? blob.Amplitude : 1.0));
      }
      this->BlobFactors[axis].push_back(std::move(factors));
    }
  }
  this->WaveInPlane.reserve(this->Size * this->Size);
  for (std::size_t y = 0; y < this->Size; ++y)
  {
    for (std::size_t x = 0; x < this->Size; ++x)
    {
      this->WaveInPlane.push_back(std::sin(2 * Pi * (9 * at(x) + 5 * at(y))));
    }
  }
}

void StandardFieldSlices::Slice(int z, float* values) const
{
  const auto last = static_cast<double>(this->Size - 1);
  std::vector<double> wave(this->Size); // sin(2 pi (7z - 3x)), scaled
  for (std::size_t x = 0; x < this->Size; ++x)
  {
    wave[x] = WaveAmplitude * std::sin(2 * Pi * (7 * z - 3 * static_cast<double>(x)) / last);
  }
  std::vector<double> row(this->Size);
  for (std::size_t y = 0; y < this->Size; ++y)
  {
    const double sine = SineAmplitude * this->Sine[static_cast<std::size_t>(z)] * this->Sine[y];
    const double* inPlane = this->WaveInPlane.data() + y * this->Size;
    for (std::size_t x = 0; x < this->Size; ++x)
    {
      row[x] = Base + sine * this->Sine[x] + inPlane[x] * wave[x];
    }
    for (std::size_t blob = 0; blob < this->BlobFactors[0].size(); ++blob)
    {
      const double factor =
        this->BlobFactors[2][blob][static_cast<std::size_t>(z)] * this->BlobFactors[1][blob][y];
      const double* alongX = this->BlobFactors[0][blob].data();
      for (std::size_t x = 0; x < this->Size; ++x)
      {
        row[x] += factor * alongX[x];
      }
    }
    std::transform(row.begin(), row.end(), values + y * this->Size,
      [](double sum) { return static_cast<float>(InRange(sum)); });
  }
}

} // namespace banyan
