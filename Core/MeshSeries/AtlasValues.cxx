#include "MeshSeries/AtlasValues.h"

#include "MeshSeries/FreeSamples.h"
#include "Series/FillValues.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// The number of the type next to a value that lies within its range.
template <class T>
T Rounded(double value)
{
  if constexpr (std::is_floating_point_v<T>)
  {
    return static_cast<T>(value);
  }
  else
  {
    // The greatest double that is not above the type's greatest number.
    constexpr double high = sizeof(T) < 8 ? static_cast<double>(std::numeric_limits<T>::max())
                            : std::is_signed_v<T> ? 9223372036854774784.0
                                                  : 18446744073709549568.0;
    constexpr double low = static_cast<double>(std::numeric_limits<T>::lowest());
    return static_cast<T>(std::min(std::max(std::nearbyint(value), low), high));
  }
}

/// One component of an image, from the values at points.
template <class T>
class ImageComponent
{
public:
  ImageComponent(const StoredMesh& mesh, const FillSet<T>& fills)
    : Mesh(mesh)
    , Fills(fills)
    , Place(static_cast<std::size_t>(mesh.Atlas->SampleCount()), 0)
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
    for (const std::uint32_t sample : this->Mesh.SampleOfPoint)
    {
      put(sample, *value);
      value += stride;
    }
    for (const auto& [to, from] : this->Mesh.Copies)
    {
      if (known[from] != 0)
      {
        put(to, image[std::int64_t{ from } * stride]);
      }
    }
    FillFreeSamples(this->Mesh.Atlas->Samples(), known, smooth, pool);
    for (std::size_t sample = 0; sample < this->Place.size(); ++sample)
    {
      if (this->Place[sample] == 0)
      {
        image[static_cast<std::int64_t>(sample) * stride] = Rounded<T>(smooth[sample]);
      }
    }
  }

private:
  const StoredMesh& Mesh;
  const FillSet<T>& Fills;
  std::vector<std::uint8_t> Place; ///< whether the sample has its value
};

} // namespace

AtlasValues::AtlasValues(std::shared_ptr<const StoredMesh> mesh)
  : Mesh(std::move(mesh))
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
      ImageComponent<T> component(*this->Mesh, set);
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
      for (const std::uint32_t sample : this->Mesh->SampleOfPoint)
      {
        to = std::copy_n(from + std::int64_t{ sample } * components, components, to);
      }
    });
}

} // namespace banyan
