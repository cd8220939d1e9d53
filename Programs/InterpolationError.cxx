// SPDX-License-Identifier: BSD-3-Clause
#include "InterpolationError.h"

#include "Cache/BrickCache.h"
#include "Series/Decode/BetweenSteps.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Grid/LevelGrid.h"
#include "Series/Quantize/FillValues.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

namespace banyan
{
namespace
{

// A second or so for most series; enough samples for maxima that are not far off.
constexpr int MostSteps = 64;
constexpr std::int64_t MostSamples = std::int64_t{ 1 } << 18;

template <class T>
class Estimate
{
public:
  Estimate(const SeriesFile& series, const FieldKey& field)
    : Series(series)
    , Field(field)
    , Fills(this->Component().FillValues)
    , Flags(series.Index().FindFlags(ArrayFlags::OfPoints))
    , Samples{ glm::ivec3(0), GridOfLevel(series.Index().Domain, field.Level).Samples() }
  {
  }

  void LeaveOut(int step)
  {
    const std::vector<double>& times = this->Series.Index().Times;
    const auto at = static_cast<std::size_t>(step);
    const double before = times[at] - times[at - 1];
    const double after = times[at + 1] - times[at];
    const double longer = std::max(before, after);
    std::vector<T> made = this->Read<T>(this->Field, step - 1);
    const std::vector<T> later = this->Read<T>(this->Field, step + 1);
    const std::vector<T> now = this->Read<T>(this->Field, step);
    const std::vector<std::uint8_t> hidden = this->Hidden(step);
    const BetweenSteps how{ before / (before + after), this->Component().FillValues };
    how.Interpolate(
      ScalarTypeOf<T>(), made.data(), 1, later.data(), static_cast<std::int64_t>(made.size()));
    // v'' before after / 2 where a step is left out, at most v'' longer^2 / 8 between two.
    const double share = longer / before * (longer / after) / 4.0;
    for (std::size_t i = 0; i < now.size(); ++i)
    {
      const double off = std::abs(static_cast<double>(made[i]) - static_cast<double>(now[i]));
      if (!std::isfinite(off) || this->Fills.Holds(made[i]) || this->Fills.Holds(now[i]) ||
          (!hidden.empty() && hidden[i] != 0))
      {
        continue;
      }
      this->Error.LargestLeftOut = std::max(this->Error.LargestLeftOut, off);
      this->Error.Largest = std::max(this->Error.Largest, share * off);
      this->Squares += share * off * (share * off);
      ++this->Count;
    }
    ++this->Error.Steps;
  }

  InterpolationError Get() const
  {
    InterpolationError error = this->Error;
    error.EveryNth = 1 << this->Field.Level;
    error.Rms = this->Count > 0 ? std::sqrt(this->Squares / static_cast<double>(this->Count)) : 0.0;
    return error;
  }

private:
  const ComponentIndex& Component() const
  {
    return this->Series.Index()
      .Arrays.at(static_cast<std::size_t>(this->Field.Array))
      .Components.at(static_cast<std::size_t>(this->Field.Component));
  }

  template <class Value>
  std::vector<Value> Read(FieldKey field, int step) const
  {
    field.Step = step;
    std::vector<Value> values(static_cast<std::size_t>(this->Samples.Count()));
    ReadRegion(
      BrickCache::Of(this->Series), this->Series, field, this->Samples, values.data(), 1, 0);
    return values;
  }

  /// What one of the steps hides; empty where the series hides nothing.
  std::vector<std::uint8_t> Hidden(int step) const
  {
    std::vector<std::uint8_t> hidden;
    for (int other = step - 1; this->Flags >= 0 && other <= step + 1; ++other)
    {
      const std::vector<std::uint8_t> flags =
        this->Read<std::uint8_t>({ 0, this->Flags, 0, this->Field.Level }, other);
      hidden.resize(flags.size(), 0);
      std::transform(flags.begin(), flags.end(), hidden.begin(), hidden.begin(),
        [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a | b); });
    }
    return hidden;
  }

  const SeriesFile& Series;
  FieldKey Field;
  FillSet<T> Fills;
  int Flags;
  Box Samples;
  InterpolationError Error;
  double Squares = 0.0;
  std::int64_t Count = 0;
};

} // namespace

InterpolationError EstimateInterpolation(const SeriesFile& series, int array, int component)
{
  const SeriesIndex& index = series.Index();
  const ScalarType type = index.Arrays.at(static_cast<std::size_t>(array)).Type;
  const int inner = index.Steps() - 2;
  if (index.Mesh || inner < 1 || !AreInterpolated(type))
  {
    return {};
  }
  FieldKey field{ 0, array, component, 0 };
  const auto samples = [&] {
    return Box{ glm::ivec3(0), GridOfLevel(index.Domain, field.Level).Samples() }.Count();
  };
  while (field.Level + 1 < index.Levels && samples() > MostSamples)
  {
    ++field.Level;
  }
  return Dispatch(type,
    [&](auto tag) -> InterpolationError
    {
      using T = typename decltype(tag)::Type;
      if constexpr (std::is_floating_point_v<T>)
      {
        Estimate<T> estimate(series, field);
        const int count = std::min(inner, MostSteps);
        for (int i = 0; i < count; ++i)
        {
          const auto place = std::int64_t{ i } * (inner - 1) / std::max(count - 1, 1);
          estimate.LeaveOut(1 + static_cast<int>(place));
        }
        return estimate.Get();
      }
      return {};
    });
}

} // namespace banyan
