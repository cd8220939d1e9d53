// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesSource.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Series/Points/PointsReader.h"

#include <array>
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
  this->AddPoints(step);
  for (const ArrayIndex& array : index.Arrays)
  {
    step.Arrays.push_back({ array.Name, array.Type, static_cast<int>(array.Components.size()) });
  }
  return true;
}

/// The arrays that are the points of the grid, first of all.
void SeriesSource::AddPoints(SourceStep& step)
{
  const SeriesIndex& index = this->File->Index();
  this->Points = 0;
  if (!index.Points)
  {
    return;
  }
  const PointsForm& form = index.Points->Form;
  step.Points = SourcePoints{ form.Kind };
  const bool curvilinear = form.Kind == GridKind::Curvilinear;
  for (int axis = 0; axis < (curvilinear ? 1 : 3); ++axis)
  {
    const auto a = static_cast<std::size_t>(axis);
    step.Points->Arrays[a] = axis;
    SourceArray array{ "", form.Types[a], curvilinear ? 3 : 1 };
    array.Tuples = curvilinear ? 0 : step.Samples[axis];
    step.Arrays.push_back(array);
    ++this->Points;
  }
}

void SeriesSource::ReadPointsOf(std::size_t axis, std::vector<std::uint8_t>& values)
{
  const SeriesIndex& index = this->File->Index();
  const PointsForm& form = index.Points->Form;
  const Box whole{ glm::ivec3(0), index.Domain.Samples() };
  std::array<std::vector<std::uint8_t>, 3> all;
  std::array<void*, 3> to{};
  for (std::size_t a = 0; a < this->Points; ++a)
  {
    const std::int64_t count =
      form.Kind == GridKind::Curvilinear ? 3 * whole.Count() : whole.Size()[static_cast<int>(a)];
    all[a].resize(static_cast<std::size_t>(count) * SizeOf(form.Types[a]));
    to[a] = all[a].data();
  }
  ReadPoints(this->File->Folder(), index, this->Step, 0, whole, to, ThreadPool::Process());
  values = std::move(all[axis]);
}

void SeriesSource::ReadValues(std::size_t array, std::vector<std::uint8_t>& values)
{
  if (array < this->Points)
  {
    this->ReadPointsOf(array, values);
    return;
  }
  array -= this->Points;
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
