// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/SampledBox.h"

#include <algorithm>
#include <memory>

namespace banyan
{
namespace
{

template <class From, class To>
void CopyPart(const SampledBox& from, const Box& target, To* out)
{
  const Box part = Intersection(from.Samples, target);
  const glm::ivec3 size = target.Size();
  const auto* values = static_cast<const From*>(from.View.Values);
  for (int z = part.Lo.z; z < part.Hi.z; ++z)
  {
    for (int y = part.Lo.y; y < part.Hi.y; ++y)
    {
      const glm::ivec3 source = glm::ivec3(part.Lo.x, y, z) - from.Samples.Lo;
      const glm::ivec3 to = glm::ivec3(part.Lo.x, y, z) - target.Lo;
      const From* row = values + source.x * from.View.Stride[0] + source.y * from.View.Stride[1] +
                        source.z * from.View.Stride[2];
      To* outRow = out + (static_cast<std::ptrdiff_t>(to.z) * size.y + to.y) * size.x + to.x;
      for (int x = 0; x < part.Size().x; ++x)
      {
        outRow[x] = static_cast<To>(row[x * from.View.Stride[0]]);
      }
    }
  }
}

} // namespace

BrickView ViewFrom(const SampledBox& from, const glm::ivec3& first)
{
  BrickView view = from.View;
  std::ptrdiff_t offset = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    offset += (first[axis] - from.Samples.Lo[axis]) * view.Stride[axis];
  }
  view.Values =
    static_cast<const char*>(view.Values) + offset * static_cast<std::ptrdiff_t>(SizeOf(view.Type));
  return view;
}

void CopySamples(const SampledBox& from, const Box& target, ScalarType type, void* out)
{
  Dispatch(type,
    [&](auto toTag)
    {
      using To = typename decltype(toTag)::Type;
      Dispatch(from.View.Type, [&](auto fromTag)
        { CopyPart<typename decltype(fromTag)::Type>(from, target, static_cast<To*>(out)); });
    });
}

Hash128 HashOfSamples(const BrickView& view, const glm::ivec3& size)
{
  return Dispatch(view.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const auto count = static_cast<std::size_t>(size.x) * size.y * size.z;
      const std::unique_ptr<T[]> values(new T[count]); // not initialised: that takes time
      T* out = values.get();
      for (int z = 0; z < size.z; ++z)
      {
        for (int y = 0; y < size.y; ++y, out += size.x)
        {
          const T* const row =
            static_cast<const T*>(view.Values) + y * view.Stride[1] + z * view.Stride[2];
          // Rows are too short for the processor to guess where the next ones lie.
          __builtin_prefetch(row + view.Stride[2]);
          __builtin_prefetch(row + view.Stride[2] + size.x - 1);
          if (view.Stride[0] == 1)
          {
            std::copy_n(row, size.x, out);
            continue;
          }
          for (int x = 0; x < size.x; ++x)
          {
            out[x] = row[x * view.Stride[0]];
          }
        }
      }
      return HashOf(values.get(), count * sizeof(T), static_cast<std::uint64_t>(view.Type));
    });
}

BrickView AllocateView(const Box& samples, ScalarType type, void*& values)
{
  const auto bytes = std::make_shared<std::vector<double>>(
    (static_cast<std::size_t>(samples.Count()) * SizeOf(type) + sizeof(double) - 1) /
    sizeof(double));
  const glm::ivec3 size = samples.Size();
  BrickView view;
  view.Values = values = bytes->data();
  view.Type = type;
  view.Stride[1] = size.x;
  view.Stride[2] = std::ptrdiff_t{ size.x } * size.y;
  view.Owner = std::shared_ptr<const void>(bytes, bytes->data());
  return view;
}

BrickView Assemble(const std::vector<SampledBox>& parts, const Box& samples, ScalarType type)
{
  void* values = nullptr;
  BrickView view = AllocateView(samples, type, values);
  for (const SampledBox& part : parts)
  {
    CopySamples(part, samples, type, values);
  }
  return view;
}

} // namespace banyan
