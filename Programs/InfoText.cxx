// SPDX-License-Identifier: BSD-3-Clause
#include "InfoText.h"

#include "TextTable.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

// More lines than fit on a screen help nobody; the CSV has all of them.
constexpr std::size_t ShownSteps = 12;

std::string Counted(std::size_t count, const std::string& noun)
{
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Error bounds are mostly given as fractions, 1/512 for example.
std::string AsFraction(double share)
{
  const double inverse = share > 0.0 ? std::round(1.0 / share) : 0.0;
  return inverse > 1.0 && inverse < 1e6 && 1.0 / inverse == share
           ? "1/" + std::to_string(static_cast<int>(inverse))
           : Digits(share);
}

template <class Vector>
std::string Numbers(const Vector& v)
{
  return Digits(v.x) + " " + Digits(v.y) + " " + Digits(v.z);
}

std::string Heading(const SeriesReport& report)
{
  const SeriesIndex& index = report.Index;
  const glm::ivec3 n = index.Domain.Samples();
  const Box& extent = index.Domain.Extent;
  const std::string samples =
    std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) + " samples";
  std::string text = report.File + "\n  " +
                     (index.Mesh ? "a mesh of " + std::to_string(index.Mesh->Cells) +
                                     " cells and " + std::to_string(index.Mesh->Points) + " points"
                                 : samples) +
                     ", " + Counted(index.Times.size(), "step") + ", times " +
                     Digits(index.Times.front()) + " to " + Digits(index.Times.back()) + "\n";
  for (const ArrayIndex& array : index.Arrays)
  {
    text += "  array " + array.Name + ": " + NameOf(array.Type);
    text += array.Components.size() == 1
              ? "\n"
              : ", " + Counted(array.Components.size(), "component") + "\n";
  }
  if (index.Mesh)
  {
    text += std::string("  the mesh, ") +
            (index.Mesh->OfCells ? "of cells of any type: " : "an octree: ") +
            Megabytes(index.Mesh->Bytes) + "; its values: images of " + samples;
    if (!index.Mesh->Moved.empty())
    {
      text += "; moved points: " + Megabytes(BytesOfPoints(index)) + ", new at " +
              Counted(index.Mesh->Moved.size(), "step");
    }
  }
  for (int axis = 0; !index.Mesh && axis < 3; ++axis)
  {
    text += std::string(axis == 0 ? "  extent" : "") + " " + std::to_string(extent.Lo[axis]) +
            ".." + std::to_string(extent.Hi[axis] - 1);
  }
  if (index.Points)
  {
    const bool curvilinear = index.Points->Form.Kind == GridKind::Curvilinear;
    text +=
      std::string(", points of a ") + (curvilinear ? "curvilinear" : "rectilinear") +
      " grid: " + Megabytes(BytesOfPoints(index)) + ", " +
      (index.Points->Files.size() == 1 ? "the same at all steps"
                                       : "new at " + Counted(index.Points->Files.size(), "step"));
  }
  else if (!index.Mesh)
  {
    text +=
      ", origin " + Numbers(index.Domain.Origin) + ", spacing " + Numbers(index.Domain.Spacing);
  }
  text += "\n  bricks of " + std::to_string(index.BrickCells) + "^3 cells, " +
          Counted(static_cast<std::size_t>(index.Levels), "level") + ", " +
          Counted(index.Segments.size(), "segment") + " of up to " +
          Counted(static_cast<std::size_t>(index.KeyframeInterval), "step") + "\n";
  return text;
}

/// Says what is stored once for several groups of steps.
std::string Repeated(const EncodeStatistics& statistics)
{
  if (statistics.RepeatedSegments == 0)
  {
    return "";
  }
  return "  equal to earlier segments, and not stored again: " +
         Counted(static_cast<std::size_t>(statistics.RepeatedSegments), "segment") + ", " +
         Megabytes(statistics.RepeatedBytes) + "\n";
}

/// How far a look at one brick goes.
std::string Chains(const EncodeStatistics& statistics)
{
  if (statistics.ChainBricks == 0)
  {
    return "";
  }
  return "  steps to decode for a brick of one: " +
         Digits(
           static_cast<double>(statistics.ChainSum) / static_cast<double>(statistics.ChainBricks)) +
         " in the mean, " + std::to_string(statistics.ChainMost) + " at most\n";
}

std::string Size(const SeriesReport& report)
{
  const std::uint64_t raw = report.Index.PayloadBytesIn;
  const std::uint64_t encoded = report.EncodedBytes();
  const std::uint64_t codes = static_cast<std::uint64_t>(report.Values());
  TextTable table({ "Size, index and tables counted", "", "bits per value", "encoded saves" });
  table.AddRow({ "encoded", Megabytes(encoded), Digits(report.BitsPerValue()), "" });
  table.AddRow({ "raw", Megabytes(raw), Digits(8.0 * static_cast<double>(raw) / codes),
    Percent(1.0 - static_cast<double>(encoded) / static_cast<double>(raw)) });
  table.AddRow({ "as 8-bit codes", Megabytes(codes), "8",
    Percent(1.0 - static_cast<double>(encoded) / static_cast<double>(codes)) });
  return "\n" + table.Text() + "  encoded: payloads " +
         Megabytes(report.Index.Statistics.PayloadBytes) + ", tables " +
         Megabytes(report.SegmentBytes - report.Index.Statistics.PayloadBytes) + ", index " +
         Megabytes(report.IndexBytes) +
         (report.Index.Mesh ? ", mesh " + Megabytes(report.Index.Mesh->Bytes) : std::string()) +
         (BytesOfPoints(report.Index) > 0 ? ", points " + Megabytes(BytesOfPoints(report.Index))
                                          : std::string()) +
         "\n" + Repeated(report.Index.Statistics) + Chains(report.Index.Statistics);
}

std::string Described(const Transform& transform)
{
  switch (transform.Kind())
  {
    case TransformKind::Asinh:
      return "asinh(value / " + Digits(transform.Scale()) + ")";
    case TransformKind::Table:
      return "a table of " + Counted(transform.Knots().size(), "knot");
    default:
      return "the value itself";
  }
}

/// How a component was quantized, where that is not simply as it is.
std::string Quantizer(const ComponentReport& component)
{
  const ComponentIndex& index = component.Index;
  std::string text;
  const auto line = [&](const std::string& sentence)
  { text += "  " + component.Name + ": " + sentence + "\n"; };
  const std::string range =
    Digits(index.PromisedRange.Low) + " .. " + Digits(index.PromisedRange.High);
  if (!index.ValueTransform.IsIdentity())
  {
    line("the bound is one on " + Described(index.ValueTransform) +
         ", where the greatest error is " + Digits(index.MeasuredMaxErrorTransformed));
  }
  if (index.RangeFrom != RangeRule::Source::Data)
  {
    line(
      "its range was " +
      std::string(index.RangeFrom == RangeRule::Source::Given ? "given" : "chosen by percentiles") +
      ": " + range);
  }
  if (index.ClampOutside)
  {
    line(Counted(static_cast<std::size_t>(index.ClampedCount), "value") + " clamped to " + range);
  }
  if (!index.FillValues.empty())
  {
    line(Counted(static_cast<std::size_t>(index.FillCount), "fill value") + ", kept bit by bit");
  }
  if (!index.Opacity.empty())
  {
    line("made for an opacity function of " + Counted(index.Opacity.size(), "knot") + ": " +
         Counted(static_cast<std::size_t>(index.InvisibleCount), "invisible value") +
         " out of bound, equation 2 is " + Digits(100.0 * index.OpacityWeightedError()) +
         " % of the squared range");
  }
  return text;
}

std::string Errors(const SeriesReport& report)
{
  TextTable table({ "Error", "range", "bound", "max |error|", "of bound", "RMSE", "PSNR dB",
    "narrowest step", "PSNR dB there", "non-finite" });
  for (const ComponentReport& component : report.Components)
  {
    const ComponentIndex& index = component.Index;
    const double bound = index.ErrorBoundAbsolute;
    const StepReport* narrowest = component.NarrowestStep();
    const std::optional<double> rmse = narrowest ? component.RmseOf(*narrowest) : std::nullopt;
    table.AddRow({ component.Name,
      index.Range.Empty() ? "-" : Digits(index.Range.Low) + " .. " + Digits(index.Range.High),
      Digits(bound), Digits(index.MeasuredMaxError),
      bound > 0.0 ? Percent(index.MeasuredMaxErrorTransformed / bound) : "-",
      Digits(component.Rmse()), Digits(Decibels(index.ReferenceRange().Width(), component.Rmse())),
      narrowest ? std::to_string(narrowest->Step) : "-",
      rmse ? Digits(Decibels(narrowest->Range.Width(), *rmse)) : "-",
      std::to_string(index.NonFiniteCount) });
  }
  std::string quantizers;
  for (const ComponentReport& component : report.Components)
  {
    quantizers += Quantizer(component);
  }
  const bool relative = report.Index.Mode == ErrorBoundMode::RelativeToSeriesRange;
  return "\n" + table.Text() + quantizers + "  asked for: " +
         (relative ? AsFraction(report.Index.ErrorBound) + " of the range of the series\n"
                   : Digits(report.Index.ErrorBound) + ", absolute\n");
}

/// Nothing unless it was asked for.
std::string Between(const SeriesReport& report)
{
  TextTable table({ "Interpolated between steps, estimated", "max |error|", "of range", "RMS",
    "step left out, max", "steps left out", "every n-th sample" });
  bool asked = false;
  for (const ComponentReport& component : report.Components)
  {
    const InterpolationError* const error = component.Between ? &*component.Between : nullptr;
    asked = asked || error;
    if (error && error->Steps > 0)
    {
      const double width = component.Index.ReferenceRange().Width();
      table.AddRow({ component.Name, Digits(error->Largest),
        width > 0.0 ? Percent(error->Largest / width) : "-", Digits(error->Rms),
        Digits(error->LargestLeftOut), std::to_string(error->Steps),
        std::to_string(error->EveryNth) });
    }
    else
    {
      table.AddRow({ component.Name, "-", "-", "-", "-", "0", "-" });
    }
  }
  return asked ? "\n" + table.Text() +
                   "  if values are smooth over three steps; errors of encoding are among them.\n"
                   "  Nothing is known of integers, meshes and less than three steps\n"
               : "";
}

std::string Bricks(const SeriesReport& report)
{
  TextTable table({ "Bricks by level", "bricks", "macro voxels", "unchanged", "stored", "shared",
    "bytes stored", "with NaN or inf" });
  for (const ComponentReport& component : report.Components)
  {
    for (int level = 0; level < report.Index.Levels; ++level)
    {
      const BrickCounts counts = component.Sum(level);
      table.AddRow(
        { component.Name + ", level " + std::to_string(level), std::to_string(counts.Bricks),
          std::to_string(counts.MacroVoxels), std::to_string(counts.Unchanged),
          std::to_string(counts.Stored), std::to_string(counts.Shared),
          Megabytes(counts.StoredBytes), std::to_string(counts.NonFinite) });
    }
  }
  return "\n" + table.Text() +
         "  macro voxels: one value everywhere, nothing stored; unchanged: as at the step before;\n"
         "  shared: with bytes that an earlier brick of the same segment stores\n";
}

std::vector<std::string> SizeHeadings(
  const std::string& first, const SeriesReport& report, std::size_t sizes)
{
  std::vector<std::string> headings{ first };
  for (std::size_t level = 0; level < sizes; ++level)
  {
    headings.push_back(std::to_string(report.VoxelsBelow(level)));
  }
  return headings;
}

std::vector<std::string> SizeRow(const std::string& name, const CountsBySize& counts)
{
  std::vector<std::string> row{ name };
  for (const std::int64_t count : counts)
  {
    row.push_back(std::to_string(count));
  }
  return row;
}

/// Which steps of so many a short table shows.
std::vector<std::size_t> Shown(std::size_t steps)
{
  std::vector<std::size_t> shown;
  const std::size_t count = std::min(steps, ShownSteps);
  for (std::size_t i = 0; i < count; ++i)
  {
    shown.push_back(count < 2 ? 0 : i * (steps - 1) / (count - 1));
  }
  return shown;
}

/// Figure 9 of the study: the number of matching blocks by size at each step.
std::string BySize(const SeriesReport& report, const ComponentReport& component)
{
  const std::size_t sizes = component.Steps[0].Unchanged.size();
  TextTable table(SizeHeadings(component.Name + ", by size in voxels", report, sizes));
  table.AddRow(SizeRow("macro voxels", component.MacroVoxels()));
  table.AddRow(SizeRow("unchanged subtrees", component.Unchanged()));
  const CountsBySize all = component.Unchanged();
  const bool any = std::any_of(all.begin(), all.end(), [](std::int64_t n) { return n != 0; });
  for (const std::size_t i : Shown(any ? component.Steps.size() : 0))
  {
    table.AddRow(SizeRow(
      "  at step " + std::to_string(component.Steps[i].Step), component.Steps[i].Unchanged));
  }
  return "\n" + table.Text();
}

std::string Times(const DecodeTimes& times)
{
  TextTable table({ "Microseconds, one thread", "median", "mean", "95 % below", "measured" });
  const auto row = [&](const std::string& what, const TimeSummary& summary)
  {
    table.AddRow({ what, Digits(summary.Median), Digits(summary.Mean), Digits(summary.Percentile95),
      std::to_string(summary.Count) });
  };
  row("a random brick, warm", times.Warm);
  row("its finest plane alone", times.Finest);
  row("a random brick, cold", times.Cold);
  row("opening the series", times.Open);
  return "\n" + table.Text() +
         "  all bricks in order: " + Digits(times.SequentialBytesPerSecond / 1e9) +
         " GB/s of decoded values\n";
}

} // namespace

std::string InfoToText(const SeriesReport& series, const DecodeTimes* times)
{
  std::string text =
    Heading(series) + Size(series) + Errors(series) + Between(series) + Bricks(series);
  for (const ComponentReport& component : series.Components)
  {
    text += BySize(series, component);
  }
  return times ? text + Times(*times) : text;
}

} // namespace banyan
