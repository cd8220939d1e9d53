// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/SampledBox.h"

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
