// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Steps/InterpolatedBrickSource.h"

#include "Base/Digest.h"
#include "Render/Bricks/JoinedComponents.h"
#include "Render/Bricks/SampledBox.h"

#include <utility>

namespace banyan
{
namespace
{

Box SamplesOf(const Box& cells)
{
  return { cells.Lo, cells.Hi + 1 };
}

ValueRange Between(const ValueRange& a, const ValueRange& b)
{
  ValueRange hull = a;
  hull.Include(b);
  return a.Empty() || b.Empty() ? ValueRange{} : hull;
}

} // namespace

InterpolatedBrickSource::InterpolatedBrickSource(
  ScalarType type, std::vector<Part> parts, Ends joined, int how)
  : Type(type)
  , Joins(joined.Earlier != nullptr)
  , JoinedHow(how)
{
  for (Part& part : parts)
  {
    this->Parts.push_back({ part.Steps.Earlier.get(), part.Steps.Later.get() });
    this->How.push_back(std::move(part.How));
    this->Owned.push_back(std::move(part.Steps));
  }
  this->Drawn =
    this->Joins ? View{ joined.Earlier.get(), joined.Later.get() } : this->Parts.front();
  this->Owned.push_back(std::move(joined));
}

std::unique_ptr<BrickSource> InterpolatedBrickSource::MakeLevel(int level, const Box& domain)
{
  const auto at = [&](const View& steps) -> View {
    return { steps.Earlier->AtLevel(level, domain), steps.Later->AtLevel(level, domain) };
  };
  const View drawn = at(this->Drawn);
  if (!drawn.Earlier)
  {
    return nullptr;
  }
  std::unique_ptr<InterpolatedBrickSource> source(new InterpolatedBrickSource);
  source->Type = this->Type;
  source->Drawn = drawn;
  for (const View& part : this->Parts)
  {
    source->Parts.push_back(at(part));
  }
  source->How = this->How;
  source->Joins = this->Joins;
  source->JoinedHow = this->JoinedHow;
  return source;
}

/// Whether a brick is known to be the same at both steps.
bool InterpolatedBrickSource::IsSame(std::int64_t brick) const
{
  const std::optional<Hash128> earlier = this->Drawn.Earlier->ContentOf(brick);
  return earlier && earlier == this->Drawn.Later->ContentOf(brick);
}

ValueRange InterpolatedBrickSource::RangeOf(std::int64_t brick) const
{
  if (this->IsSame(brick))
  {
    return this->Drawn.Earlier->RangeOf(brick);
  }
  std::vector<ValueRange> ranges;
  for (const View& part : this->Parts)
  {
    ranges.push_back(Between(part.Earlier->RangeOf(brick), part.Later->RangeOf(brick)));
  }
  return this->Joins ? JoinedBounds(this->JoinedHow, ranges) : ranges.front();
}

ValueMask InterpolatedBrickSource::MaskOf(std::int64_t brick) const
{
  if (this->IsSame(brick))
  {
    return this->Drawn.Earlier->MaskOf(brick);
  }
  const ValueRange range = this->RangeOf(brick);
  const MaskRange over = this->MasksAreOver();
  return range.Empty() ? 0 : MaskOfBins(over.BinOf(range.Low), over.BinOf(range.High));
}

std::optional<UniformValue> InterpolatedBrickSource::UniformValueOf(std::int64_t brick) const
{
  const std::optional<UniformValue> earlier = this->Drawn.Earlier->UniformValueOf(brick);
  if (this->IsSame(brick))
  {
    return earlier;
  }
  const std::optional<UniformValue> later = this->Drawn.Later->UniformValueOf(brick);
  if (this->Joins || !earlier || !later)
  {
    return std::nullopt;
  }
  return Dispatch(this->Type,
    [&](auto tag) -> std::optional<UniformValue>
    {
      using T = typename decltype(tag)::Type;
      T value = static_cast<T>(earlier->Value);
      const T next = static_cast<T>(later->Value);
      this->How.front().Interpolate(this->Type, &value, 1, &next, 1);
      return UniformValue{ static_cast<double>(value), this->Type };
    });
}

std::optional<Hash128> InterpolatedBrickSource::ContentOf(std::int64_t brick) const
{
  const std::optional<Hash128> earlier = this->Drawn.Earlier->ContentOf(brick);
  const std::optional<Hash128> later = this->Drawn.Later->ContentOf(brick);
  if (!earlier || !later || earlier == later)
  {
    return later ? earlier : std::nullopt;
  }
  Digest content;
  content.Add(*earlier);
  content.Add(*later);
  for (const BetweenSteps& how : this->How)
  {
    content.Add(how.Fraction);
    content.Add(how.FillValues);
  }
  return content.Get();
}

std::size_t InterpolatedBrickSource::LoadBytes(std::int64_t brick) const
{
  if (this->IsSame(brick))
  {
    return this->Drawn.Earlier->LoadBytes(brick);
  }
  const auto samples = static_cast<std::size_t>(SamplesOf(this->CellsOf(brick)).Count());
  std::size_t bytes = this->Joins ? samples * SizeOf(JoinedType(this->JoinedHow)) : 0;
  for (const View& part : this->Parts)
  {
    bytes += part.Earlier->LoadBytes(brick) + part.Later->LoadBytes(brick) +
             2 * samples * SizeOf(this->Type);
  }
  return bytes;
}

/// A component in the array's own type, x fastest.
BrickView InterpolatedBrickSource::LoadPart(std::int64_t brick, std::size_t part) const
{
  const Box samples = SamplesOf(this->CellsOf(brick));
  const auto dense = [&](BrickSource* source, void*& values)
  {
    BrickView view = AllocateView(samples, this->Type, values);
    CopySamples({ source->Load(brick), samples }, samples, this->Type, values);
    return view;
  };
  void* values = nullptr;
  void* next = nullptr;
  BrickView view = dense(this->Parts[part].Earlier, values);
  const BrickView later = dense(this->Parts[part].Later, next);
  this->How[part].Interpolate(this->Type, values, 1, later.Values, samples.Count());
  return view;
}

BrickView InterpolatedBrickSource::Load(std::int64_t brick)
{
  if (this->IsSame(brick))
  {
    return this->Drawn.Earlier->Load(brick);
  }
  if (!this->Joins)
  {
    return this->LoadPart(brick, 0);
  }
  std::vector<BrickView> parts;
  for (std::size_t part = 0; part < this->Parts.size(); ++part)
  {
    parts.push_back(this->LoadPart(brick, part));
  }
  return Joined(this->JoinedHow, parts, SamplesOf(this->CellsOf(brick)).Size());
}

std::vector<const BrickSource*> InterpolatedBrickSource::Sources() const
{
  std::vector<const BrickSource*> sources{ this->Drawn.Earlier, this->Drawn.Later };
  for (std::size_t part = 0; this->Joins && part < this->Parts.size(); ++part)
  {
    sources.push_back(this->Parts[part].Earlier);
    sources.push_back(this->Parts[part].Later);
  }
  return sources;
}

} // namespace banyan
