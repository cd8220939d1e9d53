// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesSource.h"

#include "Cache/BrickCache.h"

#include <utility>

namespace banyan
{

SeriesSource::SeriesSource(std::shared_ptr<const SeriesFile> file)
  : File(std::move(file))
{
}

bool SeriesSource::Next(SourceStep& step)
{
  const SeriesIndex& index = this->File->Index();
  if (this->Step + 1 >= index.Steps())
  {
    return false;
  }
  ++this->Step;
  step = {};
  step.Time = index.Times[static_cast<std::size_t>(this->Step)];
  step.Domain = index.Domain;
  step.Samples = index.Domain.Samples();
  for (const ArrayIndex& array : index.Arrays)
  {
    step.Arrays.push_back({ array.Name, array.Type, static_cast<int>(array.Components.size()) });
  }
  return true;
}

void SeriesSource::ReadValues(std::size_t array, std::vector<std::uint8_t>& values)
{
  const ArrayIndex& index = this->File->Index().Arrays[array];
  const Box whole{ glm::ivec3(0), this->File->Layout(0).Samples() };
  const int components = static_cast<int>(index.Components.size());
  values.resize(BytesOf({ index.Name, index.Type, components }, whole.Hi));
  // Each brick is needed once: there is nothing to keep.
  BrickCache cache(0);
  for (int component = 0; component < components; ++component)
  {
    ReadRegion(cache, *this->File, { this->Step, static_cast<int>(array), component, 0 }, whole,
      values.data(), components, component);
  }
}

} // namespace banyan
