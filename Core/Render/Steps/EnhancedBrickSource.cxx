// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Steps/EnhancedBrickSource.h"

#include "Base/Digest.h"
#include "Render/Bricks/SampledBox.h"

#include <vector>

namespace banyan
{
namespace
{

/// The samples of a view in double precision, x fastest.
std::vector<double> InDouble(const BrickView& view, const Box& samples)
{
  std::vector<double> values(static_cast<std::size_t>(samples.Count()));
  CopySamples({ view, samples }, samples, ScalarType::Float64, values.data());
  return values;
}

} // namespace

EnhancedBrickSource::EnhancedBrickSource(const TemporalEnhancement& how,
  std::unique_ptr<BrickSource> previous, std::unique_ptr<BrickSource> now,
  std::unique_ptr<BrickSource> next)
  : How(how)
  , Owned{ std::move(previous), std::move(now), std::move(next) }
  , Previous(this->Owned[0].get())
  , Now(this->Owned[1].get())
  , Next(this->Owned[2].get())
{
  this->FindMaskRange();
}

EnhancedBrickSource::EnhancedBrickSource(
  const TemporalEnhancement& how, BrickSource* previous, BrickSource* now, BrickSource* next)
  : How(how)
  , Previous(previous)
  , Now(now)
  , Next(next)
{
  this->FindMaskRange();
}

void EnhancedBrickSource::FindMaskRange()
{
  const MaskRange plain = this->Now->MasksAreOver();
  const ValueRange range = EnhancedRange(this->How, { plain.Low, plain.High });
  this->Over = { range.Low, range.High };
}

std::unique_ptr<BrickSource> EnhancedBrickSource::MakeLevel(int level, const Box& domain)
{
  const auto at = [&](BrickSource* source)
  { return source ? source->AtLevel(level, domain) : nullptr; };
  BrickSource* const now = at(this->Now);
  return now ? std::unique_ptr<BrickSource>(
                 new EnhancedBrickSource(this->How, at(this->Previous), now, at(this->Next)))
             : nullptr;
}

ValueRange EnhancedBrickSource::RangeOf(std::int64_t brick) const
{
  return EnhancedRange(this->How, this->Now->RangeOf(brick));
}

ValueMask EnhancedBrickSource::MaskOf(std::int64_t brick) const
{
  const ValueRange range = this->RangeOf(brick);
  return range.Empty() ? 0 : MaskOfBins(this->Over.BinOf(range.Low), this->Over.BinOf(range.High));
}

std::optional<UniformValue> EnhancedBrickSource::UniformValueOf(std::int64_t brick) const
{
  const std::optional<UniformValue> now = this->Now->UniformValueOf(brick);
  const std::optional<UniformValue> previous =
    this->Previous ? this->Previous->UniformValueOf(brick) : now;
  const std::optional<UniformValue> next = this->Next ? this->Next->UniformValueOf(brick) : now;
  if (!now || !previous || !next)
  {
    return std::nullopt;
  }
  const double value = EnhancedValue(this->How, now->Value,
    this->Previous ? &previous->Value : nullptr, this->Next ? &next->Value : nullptr);
  // As Load() rounds it.
  return UniformValue{ static_cast<double>(static_cast<float>(value)), ScalarType::Float32 };
}

std::optional<Hash128> EnhancedBrickSource::ContentOf(std::int64_t brick) const
{
  Digest content;
  content.Add(this->How);
  for (const BrickSource* const step : this->Steps())
  {
    const std::optional<Hash128> its = step ? step->ContentOf(brick) : Hash128();
    if (!its)
    {
      return std::nullopt;
    }
    content.Add(step != nullptr);
    content.Add(*its);
  }
  return content.Get();
}

std::size_t EnhancedBrickSource::LoadBytes(std::int64_t brick) const
{
  const glm::ivec3 samples = this->CellsOf(brick).Size() + 1;
  std::size_t bytes = sizeof(double) * static_cast<std::size_t>(samples.x) * samples.y * samples.z;
  for (const BrickSource* step : { this->Previous, this->Now, this->Next })
  {
    bytes += step ? step->LoadBytes(brick) : 0;
  }
  return bytes;
}

BrickView EnhancedBrickSource::Load(std::int64_t brick)
{
  const Box cells = this->CellsOf(brick);
  const Box samples{ cells.Lo, cells.Hi + 1 };
  const BrickView now = this->Now->Load(brick);
  std::vector<double> values = InDouble(now, samples);
  std::vector<double> before;
  std::vector<double> after;
  if (this->Previous)
  {
    before = InDouble(this->Previous->Load(brick), samples);
  }
  if (this->Next)
  {
    after = InDouble(this->Next->Load(brick), samples);
  }
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = EnhancedValue(this->How, values[i], this->Previous ? &before[i] : nullptr,
      this->Next ? &after[i] : nullptr);
  }
  // Macro voxels come in double precision whatever the array has.
  const bool wide = now.Type == ScalarType::Float64 && now.Stride[0] != 0;
  void* enhanced = nullptr;
  BrickView view =
    AllocateView(samples, wide ? ScalarType::Float64 : ScalarType::Float32, enhanced);
  const BrickView all{ values.data(), ScalarType::Float64,
    { 1, samples.Size().x, std::ptrdiff_t{ samples.Size().x } * samples.Size().y }, {} };
  CopySamples({ all, samples }, samples, view.Type, enhanced);
  return view;
}

} // namespace banyan
