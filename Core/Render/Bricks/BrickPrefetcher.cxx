// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/BrickPrefetcher.h"

#include "Render/Bricks/PackedBrick.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

constexpr std::uintptr_t Line = 64; // bytes of the caches

/// Of bytes that follow each other.
void AskForBytes(const char* first, std::ptrdiff_t bytes)
{
  const auto begin = reinterpret_cast<std::uintptr_t>(first);
  const std::uintptr_t end = begin + static_cast<std::uintptr_t>(bytes);
  for (std::uintptr_t at = begin / Line * Line; at < end; at += Line)
  {
    __builtin_prefetch(reinterpret_cast<const void*>(at), 0, 2); // for the second cache
  }
}

/// The axis that rays go along most.
int MainAxis(const glm::dvec3& direction)
{
  const glm::dvec3 along = glm::abs(direction);
  return along.x >= along.y && along.x >= along.z ? 0 : along.y >= along.z ? 1 : 2;
}

} // namespace

BrickPrefetcher::BrickPrefetcher(
  const PackedBrick& brick, const Box& cells, const CornerRays& corners, std::int64_t calls)
{
  const Box some = Intersection(cells, brick.Cells());
  if (some.Empty())
  {
    return;
  }
  const bool numbers = brick.HasNumbers();
  const std::ptrdiff_t unit = numbers ? sizeof(std::int16_t) : sizeof(float);
  this->Values = numbers ? reinterpret_cast<const char*>(brick.NumbersOfSamples())
                         : reinterpret_cast<const char*>(brick.Values());
  this->Stride[0] = (brick.HasGradients() ? 4 : 1) * unit;
  this->Stride[1] = brick.StrideY() * unit;
  this->Stride[2] = brick.StrideZ() * unit;
  this->Axis = MainAxis(corners[0].Direction);
  this->Low = some.Lo - brick.Corner();
  this->High = some.Hi - brick.Corner();
  this->Slice = this->Low[this->Axis];
  this->SliceEnd = this->High[this->Axis] + 1;
  this->SliceStep = this->Axis == 0 ? static_cast<int>(Line / this->Stride[0]) : 1;
  const std::int64_t perCall = this->SliceStep * std::max<std::int64_t>(calls, 1);
  this->SlicesPerCall = static_cast<int>((this->SliceEnd - this->Slice + perCall - 1) / perCall);
  this->PlaceRays(corners, brick.Corner());
}

/// Finds where the rays are in all slices, from the first and the last one.
/// @param corner of the brick
void BrickPrefetcher::PlaceRays(const CornerRays& corners, const glm::ivec3& corner)
{
  const int planes[2] = { this->Low[this->Axis] + corner[this->Axis],
    this->High[this->Axis] + corner[this->Axis] };
  glm::dvec3 least[2] = { glm::dvec3(1e9), glm::dvec3(1e9) };
  glm::dvec3 most[2] = { glm::dvec3(-1e9), glm::dvec3(-1e9) };
  for (const Ray& ray : corners)
  {
    for (int side = 0; side < 2; ++side)
    {
      const double t = (planes[side] - ray.Origin[this->Axis]) / ray.Direction[this->Axis];
      // Behind the eye, too: what lies between the planes is on a line with both. A ray along the
      // plane, whose t is no number, may be anywhere.
      const glm::dvec3 p =
        ray.Origin + (std::abs(t) < 1e6 ? t : 0.0) * ray.Direction - glm::dvec3(corner);
      least[side] = glm::min(least[side], p);
      most[side] = glm::max(most[side], p);
    }
  }
  const auto slices = static_cast<double>(std::max(planes[1] - planes[0], 1));
  this->Least = glm::vec3(least[0]);
  this->Most = glm::vec3(most[0]);
  this->LeastStep = glm::vec3((least[1] - least[0]) / slices);
  this->MostStep = glm::vec3((most[1] - most[0]) / slices);
}

Box BrickPrefetcher::NextSlice()
{
  if (this->Slice >= this->SliceEnd)
  {
    return {};
  }
  const auto from = static_cast<float>(this->Slice - this->Low[this->Axis]);
  const float to = from + static_cast<float>(this->SliceStep - 1);
  const glm::vec3 least =
    glm::min(this->Least + from * this->LeastStep, this->Least + to * this->LeastStep);
  const glm::vec3 most =
    glm::max(this->Most + from * this->MostStep, this->Most + to * this->MostStep);
  Box samples{ glm::clamp(glm::ivec3(glm::floor(least)), this->Low, this->High),
    glm::clamp(glm::ivec3(glm::floor(most)) + 1, this->Low, this->High) + 1 };
  samples.Lo[this->Axis] = this->Slice;
  samples.Hi[this->Axis] = std::min(this->Slice + this->SliceStep, this->SliceEnd);
  this->Slice += this->SliceStep;
  return samples;
}

void BrickPrefetcher::AskFor(const Box& samples) const
{
  for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
  {
    for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
    {
      const char* const row = this->Values + z * this->Stride[2] + y * this->Stride[1];
      AskForBytes(row + samples.Lo.x * this->Stride[0], samples.Size().x * this->Stride[0]);
    }
  }
}

} // namespace banyan
