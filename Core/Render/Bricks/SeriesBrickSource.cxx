// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/SeriesBrickSource.h"

#include "Render/Bricks/JoinedComponents.h"

#include <algorithm>
#include <iterator>

namespace banyan
{
namespace
{

/// A view of samples stored densely, x fastest.
BrickView DenseView(const void* values, ScalarType type, const glm::ivec3& samples)
{
  BrickView view;
  view.Values = values;
  view.Type = type;
  view.Stride[0] = 1;
  view.Stride[1] = samples.x;
  view.Stride[2] = std::ptrdiff_t{ samples.x } * samples.y;
  return view;
}

/// One value that stands for every sample: all strides are zero.
BrickView UniformView(double value)
{
  const auto held = std::make_shared<const double>(value);
  BrickView view;
  view.Values = held.get();
  view.Type = ScalarType::Float64;
  view.Stride[0] = view.Stride[1] = view.Stride[2] = 0;
  view.Owner = held;
  return view;
}

} // namespace

SeriesBrickSource::SeriesBrickSource(
  std::shared_ptr<const SeriesFile> series, const FieldKey& field, int component, BrickCache& cache)
  : Series(std::move(series))
  , Field(field)
  , Component(component)
  , Cache(cache)
  , Layout(this->Series->Layout(field.Level))
{
  const ArrayIndex& array = this->Series->Index().Arrays.at(static_cast<std::size_t>(field.Array));
  const int count = static_cast<int>(array.Components.size());
  this->Type = array.Type;
  this->IsJoined = component < 0 && count > 1;
  if (component >= count)
  {
    throw Error("Array '" + array.Name + "' has no component " + std::to_string(component),
      { this->Series->Path(), {}, static_cast<std::uint64_t>(component),
        static_cast<std::uint64_t>(count - 1) });
  }
  if (component == SampleArray::Colours)
  {
    CheckColours(count);
  }
  std::vector<ValueRange> ranges;
  for (int c = 0; c < count; ++c)
  {
    if (this->IsJoined || c == std::max(component, 0))
    {
      this->Components.push_back(c);
      this->Nodes.push_back(this->Series->Nodes(this->KeyOf(this->Components.size() - 1)));
      ranges.push_back(array.Components[static_cast<std::size_t>(c)].Range);
    }
  }
  this->Flags = { field.Step, this->Series->Index().FindFlags(ArrayFlags::OfPoints), 0,
    field.Level };
  if (this->Flags.Array >= 0)
  {
    this->NodesOfFlags = this->Series->Nodes(this->Flags);
  }
  if (this->IsJoined)
  {
    const ValueRange range = JoinedBounds(component, ranges);
    this->Masks = range.Empty() ? MaskRange{} : MaskRange{ range.Low, range.High };
  }
  else
  {
    this->Masks = this->Series->MaskRangeOf(field.Array, this->Components.front());
    this->Step =
      this->Type == ScalarType::Float32 ? this->Series->StepOfValues(this->KeyOf(0)) : 0.0;
  }
}

std::unique_ptr<BrickSource> SeriesBrickSource::MakeLevel(int level, const Box&)
{
  FieldKey field = this->Field;
  field.Level += level;
  if (field.Level >= this->Series->Index().Levels)
  {
    return nullptr;
  }
  auto source =
    std::make_unique<SeriesBrickSource>(this->Series, field, this->Component, this->Cache);
  source->LoadedBricks = this->LoadedBricks;
  return source;
}

std::unique_ptr<SeriesBrickSource> SeriesBrickSource::AtStep(int step, int level) const
{
  FieldKey field = this->Field;
  field.Step = step;
  field.Level += level;
  return std::make_unique<SeriesBrickSource>(this->Series, field, this->Component, this->Cache);
}

FieldKey SeriesBrickSource::KeyOf(std::size_t component) const
{
  FieldKey key = this->Field;
  key.Component = this->Components[component];
  return key;
}

ValueRange SeriesBrickSource::JoinedRange(std::int64_t brick) const
{
  std::vector<ValueRange> ranges;
  for (const NodeList& nodes : this->Nodes)
  {
    ranges.push_back((*nodes)[static_cast<std::size_t>(brick)].Range);
  }
  return JoinedBounds(this->Component, ranges);
}

ValueRange SeriesBrickSource::RangeOf(std::int64_t brick) const
{
  return this->IsJoined ? this->JoinedRange(brick)
                        : (*this->Nodes.front())[static_cast<std::size_t>(brick)].Range;
}

ValueMask SeriesBrickSource::MaskOf(std::int64_t brick) const
{
  if (!this->IsJoined)
  {
    return (*this->Nodes.front())[static_cast<std::size_t>(brick)].Mask;
  }
  const ValueRange range = this->JoinedRange(brick);
  return range.Empty() ? 0
                       : MaskOfBins(this->Masks.BinOf(range.Low), this->Masks.BinOf(range.High));
}

std::optional<UniformValue> SeriesBrickSource::UniformValueOf(std::int64_t brick) const
{
  const BrickNode& node = (*this->Nodes.front())[static_cast<std::size_t>(brick)];
  if (this->IsJoined || !node.Uniform || this->HidesPointsOf(brick))
  {
    return std::nullopt;
  }
  return UniformValue{ node.Range.Low, ScalarType::Float64 };
}

std::optional<Hash128> SeriesBrickSource::ContentOf(std::int64_t brick) const
{
  const auto number = static_cast<std::size_t>(brick);
  const int how = this->IsJoined ? this->Component : 0;
  Hash128 content{ static_cast<std::uint64_t>(this->Type), static_cast<std::uint64_t>(-how) };
  const auto add = [&content](const BrickNode& node)
  {
    const std::uint64_t parts[] = { content.Low, content.High, node.Identity.Low,
      node.Identity.High, node.Uniform ? 1u : 0u };
    content = HashOf(parts, sizeof(parts));
  };
  for (const NodeList& nodes : this->Nodes)
  {
    add((*nodes)[number]);
  }
  if (this->HidesPointsOf(brick))
  {
    add((*this->NodesOfFlags)[number]);
  }
  return content;
}

std::size_t SeriesBrickSource::LoadBytes(std::int64_t brick) const
{
  const auto samples = static_cast<std::size_t>(this->Layout.SamplesOf(brick).Count());
  std::size_t bytes = this->IsJoined ? samples * SizeOf(JoinedType(this->Component)) : 0;
  for (const NodeList& nodes : this->Nodes)
  {
    bytes += (*nodes)[static_cast<std::size_t>(brick)].Uniform ? 0 : samples * SizeOf(this->Type);
  }
  return bytes;
}

BrickView SeriesBrickSource::LoadComponent(std::int64_t brick, std::size_t component) const
{
  const BrickNode& node = (*this->Nodes[component])[static_cast<std::size_t>(brick)];
  if (node.Uniform)
  {
    return UniformView(node.Range.Low);
  }
  const auto values = this->Cache.Get(*this->Series, this->KeyOf(component), brick);
  BrickView view = DenseView(values->Bytes.data(), values->Type, values->Samples.Size());
  view.Owner = values;
  return view;
}

BrickView SeriesBrickSource::LoadJoined(std::int64_t brick) const
{
  std::vector<BrickView> parts;
  for (std::size_t c = 0; c < this->Components.size(); ++c)
  {
    parts.push_back(this->LoadComponent(brick, c));
  }
  return Joined(this->Component, parts, this->Layout.SamplesOf(brick).Size());
}

bool SeriesBrickSource::HidesPointsOf(std::int64_t brick) const
{
  if (!this->NodesOfFlags)
  {
    return false;
  }
  const BrickNode& flags = (*this->NodesOfFlags)[static_cast<std::size_t>(brick)];
  return !flags.Uniform || flags.Range.Low != 0.0;
}

/// A copy: what is hidden changes from step to step, and the cache has values for all of them.
BrickView SeriesBrickSource::WithoutHidden(std::int64_t brick, const BrickView& view) const
{
  const auto flags = this->Cache.Get(*this->Series, this->Flags, brick);
  SampleArray array;
  array.Values = view.Values;
  array.Type = view.Type;
  std::copy(std::begin(view.Stride), std::end(view.Stride), array.Stride);
  array.Samples = { glm::ivec3(0), flags->Samples.Size() };
  array.Flags = reinterpret_cast<const std::uint8_t*>(flags->Bytes.data());
  return ArraySamples(array).View(array.Samples);
}

BrickView SeriesBrickSource::Load(std::int64_t brick)
{
  this->Note(brick);
  const BrickView view = this->IsJoined ? this->LoadJoined(brick) : this->LoadComponent(brick, 0);
  return this->HidesPointsOf(brick) ? this->WithoutHidden(brick, view) : view;
}

void SeriesBrickSource::Note(std::int64_t brick) const
{
  const std::lock_guard<std::mutex> lock(this->LoadedBricks->Mutex);
  LoadRecord::Level& level = this->LoadedBricks->Levels[this->Field.Level];
  level.Has.resize(this->Nodes.front()->size());
  const auto number = static_cast<std::size_t>(brick);
  if (!level.Has[number])
  {
    level.Has[number] = true;
    level.Bricks.push_back(brick);
  }
}

std::vector<FieldBricks> SeriesBrickSource::Fields(const std::vector<std::int64_t>& bricks) const
{
  std::vector<FieldBricks> fields;
  for (std::size_t c = 0; c < this->Components.size() && !bricks.empty(); ++c)
  {
    fields.push_back({ this->KeyOf(c), bricks });
  }
  return fields;
}

std::vector<FieldBricks> SeriesBrickSource::Loaded() const
{
  const std::lock_guard<std::mutex> lock(this->LoadedBricks->Mutex);
  std::vector<FieldBricks> loaded;
  for (const auto& [number, level] : this->LoadedBricks->Levels)
  {
    for (std::size_t c = 0; c < this->Components.size(); ++c)
    {
      FieldKey field = this->KeyOf(c);
      field.Level = number;
      loaded.push_back({ field, level.Bricks });
    }
  }
  return loaded;
}

} // namespace banyan
