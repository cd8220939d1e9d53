// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/AtlasValues.h"

#include "Mesh/CellSeries/StoredCells.h"
#include "Mesh/Series/FreeSamples.h"
#include "Mesh/Series/Rounded.h"
#include "Mesh/Series/StoredMesh.h"
#include "Series/Quantize/FillValues.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// One component of an image, from the values at points.
template <class T>
class ImageComponent
{
public:
  /// @param samples of the values; `copies` as StoredMesh has them
  ImageComponent(const glm::ivec3& image, const std::vector<std::uint32_t>& samples,
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& copies, const FillSet<T>& fills)
    : Image(image)
    , Samples(samples)
    , Copies(copies)
    , Fills(fills)
    , Place(static_cast<std::size_t>(std::int64_t{ image.x } * image.y * image.z), 0)
  {
  }

  /// @param values of the component, `stride` from one to the next; `image` likewise
  void Make(const T* values, int stride, T* image, ThreadPool& pool)
  {
    std::vector<std::uint8_t> known(this->Place.size(), 0);
    std::vector<double> smooth(this->Place.size());
    std::fill(this->Place.begin(), this->Place.end(), 0);
    const auto put = [&](std::uint32_t sample, T value)
    {
      image[std::int64_t{ sample } * stride] = value;
      this->Place[sample] = 1;
      if (std::isfinite(static_cast<double>(value)) && !this->Fills.Holds(value))
      {
        known[sample] = 1;
        smooth[sample] = static_cast<double>(value);
      }
    };
    const T* value = values;
    for (const std::uint32_t sample : this->Samples)
    {
      put(sample, *value);
      value += stride;
    }
    for (const auto& [to, from] : this->Copies)
    {
      if (known[from] != 0)
      {
        put(to, image[std::int64_t{ from } * stride]);
      }
    }
    FillFreeSamples(this->Image, known, smooth, pool);
    for (std::size_t sample = 0; sample < this->Place.size(); ++sample)
    {
      if (this->Place[sample] == 0)
      {
        image[static_cast<std::int64_t>(sample) * stride] = Rounded<T>(smooth[sample]);
      }
    }
  }

private:
  glm::ivec3 Image;
  const std::vector<std::uint32_t>& Samples;
  const std::vector<std::pair<std::uint32_t, std::uint32_t>>& Copies;
  const FillSet<T>& Fills;
  std::vector<std::uint8_t> Place; ///< whether the sample has its value
};

} // namespace

AtlasValues::AtlasValues(const std::shared_ptr<const StoredMesh>& mesh, MeshValues where)
  : Mesh(mesh)
  , Image(mesh->Atlas->Samples())
  , Samples(where == MeshValues::OfCells ? mesh->SampleOfCell : mesh->SampleOfPoint)
  // Cells of different levels are no copies of each other.
  , Copies(where == MeshValues::OfCells ? nullptr : &mesh->Copies)
{
}

AtlasValues::AtlasValues(const std::shared_ptr<const StoredCells>& mesh, MeshValues where)
  : Mesh(mesh)
  , Image(mesh->Samples())
  , Samples(where == MeshValues::OfCells ? mesh->SampleOfCell : mesh->SampleOfPoint)
{
}

void AtlasValues::ToImage(ScalarType type, const void* values, int components,
  const std::vector<double>& fills, void* image, ThreadPool& pool) const
{
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const FillSet<T> set(fills);
      const Pairs none;
      ImageComponent<T> component(
        this->Image, this->Samples, this->Copies ? *this->Copies : none, set);
      for (int c = 0; c < components; ++c)
      {
        component.Make(
          static_cast<const T*>(values) + c, components, static_cast<T*>(image) + c, pool);
      }
    });
}

void AtlasValues::FromImage(ScalarType type, const void* image, int components, void* values) const
{
  Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* from = static_cast<const T*>(image);
      T* to = static_cast<T*>(values);
      for (const std::uint32_t sample : this->Samples)
      {
        to = std::copy_n(from + std::int64_t{ sample } * components, components, to);
      }
    });
}

} // namespace banyan
