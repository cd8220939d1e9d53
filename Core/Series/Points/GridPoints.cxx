// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Points/GridPoints.h"

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace banyan
{
namespace
{

constexpr int ChunkSamples = 64; ///< per axis; a part of the format

} // namespace

PointsLayout::PointsLayout(const PointsForm& form, const glm::ivec3& samples)
  : Form(form)
  , Samples(samples)
  , Chunks(
      form.Kind == GridKind::Rectilinear ? glm::ivec3(3, 1, 1) : (samples - 1) / ChunkSamples + 1)
{
}

std::int64_t PointsLayout::ChunkCount() const
{
  return std::int64_t{ this->Chunks.x } * this->Chunks.y * this->Chunks.z;
}

Box PointsLayout::SamplesOf(std::int64_t chunk) const
{
  if (this->Form.Kind == GridKind::Rectilinear)
  {
    return { glm::ivec3(0), { this->Samples[static_cast<int>(chunk)], 1, 1 } };
  }
  const std::int64_t row = chunk / this->Chunks.x;
  const glm::ivec3 place{ static_cast<int>(chunk % this->Chunks.x),
    static_cast<int>(row % this->Chunks.y), static_cast<int>(row / this->Chunks.y) };
  const glm::ivec3 first = place * ChunkSamples;
  return { first, glm::min(first + ChunkSamples, this->Samples) };
}

ScalarType PointsLayout::TypeOf(std::int64_t chunk) const
{
  const bool own = this->Form.Kind == GridKind::Rectilinear;
  return this->Form.Types[own ? static_cast<std::size_t>(chunk) : 0];
}

std::size_t PointsLayout::TupleBytes(std::int64_t chunk) const
{
  return static_cast<std::size_t>(this->Components()) * SizeOf(this->TypeOf(chunk));
}

std::size_t PointsLayout::BytesOf(std::int64_t chunk) const
{
  return static_cast<std::size_t>(this->SamplesOf(chunk).Count()) * this->TupleBytes(chunk);
}

std::uint64_t BytesOfPoints(const SeriesIndex& index)
{
  std::uint64_t bytes = 0;
  std::set<std::string> seen;
  for (const PointsFile& file : index.FilesOfPoints())
  {
    bytes += seen.insert(file.File).second ? file.Bytes : 0;
  }
  return bytes;
}

std::optional<std::int64_t> FirstNotFinite(ScalarType type, int components, const void* values,
  std::int64_t tuples, const std::uint8_t* flags)
{
  return Dispatch(type,
    [&](auto tag) -> std::optional<std::int64_t>
    {
      using T = typename decltype(tag)::Type;
      const T* value = static_cast<const T*>(values);
      for (std::int64_t i = 0; std::is_floating_point_v<T> && i < tuples; ++i)
      {
        const bool hidden = flags && (flags[i] & HiddenPointBits) != 0;
        for (int c = 0; c < components; ++c, ++value)
        {
          if (!hidden && !std::isfinite(static_cast<double>(*value)))
          {
            return i;
          }
        }
      }
      return std::nullopt;
    });
}

} // namespace banyan
