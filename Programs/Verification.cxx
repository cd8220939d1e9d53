// SPDX-License-Identifier: BSD-3-Clause
#include "Verification.h"

#include "Agreement.h"
#include "VerifiedMesh.h"

#include "Base/Bytes.h"
#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Series/Points/PointsReader.h"
#include "Series/Quantize/FillValues.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>

namespace banyan
{
namespace
{

/// Writes as many digits as bring back the same bits, and the bits of what is not a number.
template <class T>
std::string Exactly(T value)
{
  if constexpr (std::is_integral_v<T>)
  {
    return std::to_string(value);
  }
  else
  {
    char text[64];
    std::snprintf(
      text, sizeof(text), sizeof(T) == 4 ? "%.9g" : "%.17g", static_cast<double>(value));
    if (!std::isnan(value))
    {
      return text;
    }
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    std::snprintf(text, sizeof(text), "NaN (bits 0x%" PRIx64 ")",
      static_cast<std::uint64_t>(BitCast<Bits>(value)));
    return text;
  }
}

/// The opacity function that stands in when none is given.
OpacityFunction Ramp(const ValueRange& range)
{
  if (!(range.Width() > 0.0))
  {
    return OpacityFunction({ { range.Empty() ? 0.0 : range.Low, 1.0 } });
  }
  return OpacityFunction({ { range.Low, 0.0 }, { range.High, 1.0 } });
}

/// Returns the range of the originals, as far as the index knows it.
ValueRange RangeOf(const ComponentIndex& component)
{
  return component.PromisedRange.Empty() ? component.Range : component.PromisedRange;
}

InvisibleIntervals IntervalsOf(const ComponentIndex& component)
{
  return component.Opacity.empty() ? InvisibleIntervals{}
                                   : InvisibleIntervals(OpacityFunction(component.Opacity));
}

/// Compares one series with one source.
class Comparison
{
public:
  Comparison(const SeriesFile& series, SourceSteps& source, const VerificationChoice& choice)
    : Series(series)
    , Source(source)
    , Choice(choice)
    , Whole{ glm::ivec3(0), series.Layout(0).Samples() }
  {
    const SeriesIndex& index = series.Index();
    if (index.Mesh)
    {
      this->Mesh.emplace(series);
    }
    this->Result.Times = index.Times;
    for (const int array : ChosenArrays(index, choice.Arrays))
    {
      const ArrayIndex& found = index.Arrays[static_cast<std::size_t>(array)];
      for (std::size_t c = 0; c < found.Components.size(); ++c)
      {
        ComponentVerification component;
        component.Array = array;
        component.Component = static_cast<int>(c);
        component.Name = NameOfComponent(found, c);
        component.Bound = found.Components[c].ErrorBoundAbsolute;
        component.Transformed = !found.Components[c].ValueTransform.IsIdentity();
        this->Result.Components.push_back(std::move(component));
        this->Opacities.push_back(choice.Opacity ? *choice.Opacity
                                  : !found.Components[c].Opacity.empty()
                                    ? OpacityFunction(found.Components[c].Opacity)
                                    : Ramp(RangeOf(found.Components[c])));
      }
    }
  }

  Verification Run(const std::function<void(int)>& progress)
  {
    const int steps = this->Series.Index().Steps();
    SourceStep step;
    for (int number = 0; number < steps; ++number)
    {
      if (!this->Source.Next(step))
      {
        throw Error("The source ends after " + std::to_string(number) +
                    " time steps, and the series has " + std::to_string(steps) + ".");
      }
      CheckAgreement(this->Series.Index(), number, step, this->Choice.Arrays);
      this->CompareStep(number, step);
      if (progress)
      {
        progress(number + 1);
      }
    }
    if (this->Source.Next(step))
    {
      throw Error(
        "The source has more time steps than the " + std::to_string(steps) + " of the series.");
    }
    for (ComponentVerification& component : this->Result.Components)
    {
      component.TooLoose = this->LooserThanAsked(component);
    }
    return std::move(this->Result);
  }

private:
  void CompareStep(int number, const SourceStep& step)
  {
    this->Hidden.clear();
    if (this->Mesh)
    {
      this->Mesh->CheckParts(number, *step.Mesh);
    }
    this->CompareMissingFlags(number, step);
    std::vector<std::uint8_t> original;
    for (std::size_t a = 0; a < step.Arrays.size(); ++a)
    {
      if (!step.IsValue(a))
      {
        this->Source.ReadValues(a, original);
        if (step.Points)
        {
          this->ComparePoints(number, step.Arrays[a], step.AxisOf(a), original);
          continue;
        }
        this->Mesh->Compare(number, *step.Mesh, static_cast<int>(a), step.Arrays[a].Type, original);
        continue;
      }
      bool read = false;
      for (std::size_t c = 0; c < this->Result.Components.size(); ++c)
      {
        const ComponentVerification& component = this->Result.Components[c];
        if (!step.Arrays[a].IsSourceOf(this->ArrayOf(component)))
        {
          continue;
        }
        if (!read)
        {
          this->Source.ReadValues(a, original);
          read = true;
        }
        if (this->ArrayOf(component).Flags == ArrayFlags::OfPoints)
        {
          this->Hidden = original; // flags come first
        }
        this->CompareComponent(number, c, original);
      }
    }
  }

  /// A source that does not speak of flags at a step hides nothing then.
  void CompareMissingFlags(int number, const SourceStep& step)
  {
    for (std::size_t c = 0; c < this->Result.Components.size(); ++c)
    {
      const ArrayIndex& array = this->ArrayOf(this->Result.Components[c]);
      const bool there = std::any_of(step.Arrays.begin(), step.Arrays.end(),
        [&](const SourceArray& other) { return other.IsSourceOf(array); });
      if (array.Flags != ArrayFlags::None && !there)
      {
        this->CompareComponent(
          number, c, std::vector<std::uint8_t>(static_cast<std::size_t>(this->Whole.Count()), 0));
      }
    }
  }

  /// Points of a grid must be the same bits.
  void ComparePoints(
    int number, const SourceArray& array, int axis, const std::vector<std::uint8_t>& original) const
  {
    const PointsForm& form = this->Series.Index().Points->Form;
    std::array<std::vector<std::uint8_t>, 3> mine;
    std::array<void*, 3> to{};
    for (int a = 0; a < 3; ++a)
    {
      const auto at = static_cast<std::size_t>(a);
      const std::int64_t count = form.Kind == GridKind::Rectilinear ? this->Whole.Size()[a]
                                 : a == 0                           ? 3 * this->Whole.Count()
                                                                    : 0;
      mine[at].resize(static_cast<std::size_t>(count) * SizeOf(form.Types[at]));
      to[at] = mine[at].data();
    }
    ReadPoints(this->Series.Folder(), this->Series.Index(), number, 0, this->Whole, to,
      ThreadPool::Process());
    const auto at = static_cast<std::size_t>(axis);
    if (array.Type != form.Types[at] || original != mine[at])
    {
      throw Error("At step " + std::to_string(number) +
                  " the points of the source differ from those of the series.");
    }
  }

  const ArrayIndex& ArrayOf(const ComponentVerification& component) const
  {
    return this->Series.Index().Arrays[static_cast<std::size_t>(component.Array)];
  }

  void CompareComponent(int number, std::size_t c, const std::vector<std::uint8_t>& original)
  {
    ComponentVerification& component = this->Result.Components[c];
    const ArrayIndex& array = this->ArrayOf(component);
    const std::size_t size = SizeOf(array.Type);
    int stride = static_cast<int>(array.Components.size());
    this->Decoded.resize(static_cast<std::size_t>(this->Whole.Count()) * size);
    // Each brick is needed once: there is nothing to keep.
    BrickCache cache(0);
    ReadRegion(cache, this->Series, { number, component.Array, component.Component, 0 },
      this->Whole, this->Decoded.data(), 1, 0);
    std::int64_t count = this->Whole.Count();
    if (this->Mesh)
    {
      this->Decoded = this->Mesh->ValuesOf(array, this->Decoded);
      count = static_cast<std::int64_t>(this->Decoded.size() / size);
    }
    const std::uint8_t* first =
      original.data() + static_cast<std::size_t>(component.Component) * size;
    const ComponentIndex& index = array.Components[static_cast<std::size_t>(component.Component)];
    const std::uint8_t* const hidden =
      this->Hidden.empty() || array.Flags != ArrayFlags::None ? nullptr : this->Hidden.data();
    std::vector<std::uint8_t> clamped;
    if (index.ClampOutside)
    {
      // The series promises nearness to the clamped values.
      clamped.resize(this->Decoded.size());
      component.Clamped += ClampComponent(array.Type, first, stride, count, index.PromisedRange,
        index.FillValues, hidden, clamped.data());
      first = clamped.data();
      stride = 1;
    }
    const Judgement judgement{ component.Bound, index.ValueTransform, ValueClasses(RangeOf(index)),
      &this->Opacities[c], IntervalsOf(index), index.FillValues, hidden };
    const ValueErrors errors = CompareValues(
      array.Type, first, stride, this->Decoded.data(), count, judgement, ThreadPool::Process());
    if (errors.WorstError > component.All.WorstError)
    {
      component.Worst = this->Describe(number, array.Type, errors, first, stride);
    }
    component.All.Merge(errors, 0);
    component.Steps.push_back(errors);
  }

  WorstValue Describe(int number, ScalarType type, const ValueErrors& errors,
    const std::uint8_t* original, int stride) const
  {
    WorstValue worst;
    worst.Step = number;
    worst.Error = errors.WorstError;
    // Points and cells of a mesh are counted along x.
    const glm::ivec3 size =
      this->Mesh ? glm::ivec3(std::numeric_limits<int>::max(), 1, 1) : this->Whole.Hi;
    const std::int64_t i = errors.Worst;
    worst.Index = this->Series.Index().Domain.Extent.Lo + glm::ivec3(static_cast<int>(i % size.x),
                                                            static_cast<int>(i / size.x % size.y),
                                                            static_cast<int>(i / size.x / size.y));
    Dispatch(type,
      [&](auto tag)
      {
        using T = typename decltype(tag)::Type;
        worst.Original = Exactly(reinterpret_cast<const T*>(original)[i * stride]);
        worst.Decoded = Exactly(reinterpret_cast<const T*>(this->Decoded.data())[i]);
      });
    return worst;
  }

  /// The index promises less than was asked for. What a relative bound refers to is the range of
  /// the source, or a wider one that the encoder was told, or the one that was chosen by a rule;
  /// with a transform, the width of what they become.
  std::string LooserThanAsked(const ComponentVerification& component) const
  {
    const SeriesIndex& index = this->Series.Index();
    const ComponentIndex& found =
      this->ArrayOf(component).Components[static_cast<std::size_t>(component.Component)];
    const double chosen = found.ValueTransform.TransformedWidth(found.PromisedRange);
    const double width =
      found.RangeFrom == RangeRule::Source::Data
        ? std::max(chosen, found.ValueTransform.TransformedWidth(component.All.Range))
        : chosen;
    const double asked =
      index.Mode == ErrorBoundMode::Absolute ? index.ErrorBound : index.ErrorBound * width;
    if (component.Bound <= asked * (1.0 + 1e-12))
    {
      return {};
    }
    char text[200];
    std::snprintf(text, sizeof(text),
      "its bound is stated as %.9g, and what was asked for comes to %.9g", component.Bound, asked);
    return text;
  }

  const SeriesFile& Series;
  SourceSteps& Source;
  const VerificationChoice& Choice;
  Box Whole;
  std::optional<VerifiedMesh> Mesh;       ///< nothing: the series is of images
  std::vector<OpacityFunction> Opacities; ///< one per component of the result
  std::vector<std::uint8_t> Decoded;
  std::vector<std::uint8_t> Hidden; ///< of the source at the step under way; empty: none is
  Verification Result;
};

} // namespace

bool Verification::Proven() const
{
  return std::all_of(this->Components.begin(), this->Components.end(),
    [](const ComponentVerification& component) { return component.Proven(); });
}

Verification Verify(const SeriesFile& series, SourceSteps& source, const VerificationChoice& choice,
  const std::function<void(int)>& progress)
{
  return Comparison(series, source, choice).Run(progress);
}

} // namespace banyan
