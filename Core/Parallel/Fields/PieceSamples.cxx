// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceSamples.h"

#include "Base/Error.h"

#include <limits>

namespace banyan
{

SampledBox MissingSamples(const Box& samples)
{
  static const double missing = std::numeric_limits<double>::quiet_NaN();
  SampledBox box;
  box.Samples = samples;
  box.View.Values = &missing;
  box.View.Type = ScalarType::Float64;
  box.View.Stride[0] = box.View.Stride[1] = box.View.Stride[2] = 0;
  return box;
}

ScalarType TypeWithMissing(ScalarType type)
{
  return SizeOf(type) <= 2 || type == ScalarType::Float32 ? ScalarType::Float32
                                                          : ScalarType::Float64;
}

void PieceSamples::SetShell(std::vector<SampledBox> parts)
{
  this->Shell = std::move(parts);
  this->ShellIsKnown = true;
}

BrickView PieceSamples::OwnView(const Box& samples) const
{
  const glm::ivec3 first = this->Own->Array().Samples.Lo;
  return this->Own->View({ samples.Lo - first, samples.Hi - first });
}

BrickView PieceSamples::View(const Box& samples) const
{
  if (!this->Own)
  {
    throw Error("samples were asked of a rank that has none");
  }
  if (this->IsInside(samples))
  {
    return this->OwnView(samples);
  }
  const Box inside = Intersection(samples, this->Own->Array().Samples);
  std::vector<SampledBox> parts;
  std::int64_t known = inside.Empty() ? 0 : inside.Count();
  for (const SampledBox& part : this->Shell)
  {
    const Box common = Intersection(part.Samples, samples);
    if (!common.Empty())
    {
      known += common.Count();
      parts.push_back(part);
    }
  }
  if (!inside.Empty())
  {
    parts.push_back({ this->OwnView(inside), inside });
  }
  if (known == samples.Count())
  {
    return Assemble(parts, samples, this->Type());
  }
  parts.insert(parts.begin(), MissingSamples(samples));
  return Assemble(parts, samples, TypeWithMissing(this->Type()));
}

std::size_t PieceSamples::ViewBytes(const Box& samples) const
{
  if (this->IsInside(samples))
  {
    const glm::ivec3 first = this->Own->Array().Samples.Lo;
    return this->Own->ViewBytes({ samples.Lo - first, samples.Hi - first });
  }
  return static_cast<std::size_t>(samples.Count()) * sizeof(double);
}

} // namespace banyan
