#include "Render/EnhancedBrickSource.h"

#include <cmath>
#include <vector>

namespace banyan
{
namespace
{

/// Reads a row of a brick's samples.
void ReadRow(const BrickView& view, int count, int y, int z, double* row)
{
  Dispatch(view.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const from =
        static_cast<const T*>(view.Values) + z * view.Stride[2] + y * view.Stride[1];
      for (int x = 0; x < count; ++x)
      {
        row[x] = static_cast<double>(from[x * view.Stride[0]]);
      }
    });
}

/// Dense samples of a brick that is being made.
template <class T>
BrickView EnhancedView(const TemporalEnhancement& how, const glm::ivec3& samples,
  const BrickView& now, const BrickView* previous, const BrickView* next, ScalarType type)
{
  const auto width = static_cast<std::size_t>(samples.x);
  const auto values = std::make_shared<std::vector<T>>(width * samples.y * samples.z);
  std::vector<double> here(width);
  std::vector<double> before(width);
  std::vector<double> after(width);
  T* out = values->data();
  for (int z = 0; z < samples.z; ++z)
  {
    for (int y = 0; y < samples.y; ++y)
    {
      ReadRow(now, samples.x, y, z, here.data());
      if (previous)
      {
        ReadRow(*previous, samples.x, y, z, before.data());
      }
      if (next)
      {
        ReadRow(*next, samples.x, y, z, after.data());
      }
      for (std::size_t x = 0; x < width; ++x, ++out)
      {
        *out = static_cast<T>(
          EnhancedValue(how, here[x], previous ? &before[x] : nullptr, next ? &after[x] : nullptr));
      }
    }
  }
  BrickView view;
  view.Values = values->data();
  view.Type = type;
  view.Stride[0] = 1;
  view.Stride[1] = samples.x;
  view.Stride[2] = std::ptrdiff_t{ samples.x } * samples.y;
  view.Owner = values;
  return view;
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
  const BrickView now = this->Now->Load(brick);
  const BrickView previous = this->Previous ? this->Previous->Load(brick) : BrickView{};
  const BrickView next = this->Next ? this->Next->Load(brick) : BrickView{};
  const glm::ivec3 samples = this->CellsOf(brick).Size() + 1;
  const BrickView* const before = this->Previous ? &previous : nullptr;
  const BrickView* const after = this->Next ? &next : nullptr;
  // Macro voxels come in double precision whatever the array has; one of the steps may be none.
  const bool wide = now.Type == ScalarType::Float64 && now.Stride[0] != 0;
  return wide ? EnhancedView<double>(this->How, samples, now, before, after, ScalarType::Float64)
              : EnhancedView<float>(this->How, samples, now, before, after, ScalarType::Float32);
}

} // namespace banyan
