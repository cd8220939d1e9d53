// SPDX-License-Identifier: BSD-3-Clause
#include "StepTable.h"

#include <cstdio>

namespace banyan
{
namespace
{

std::optional<double> Count(std::int64_t count)
{
  return static_cast<double>(count);
}

/// Decibels against the range of the step itself; none where nothing is wrong, or nothing known.
std::optional<double> PsnrOfOwnRange(const StepLine& line)
{
  const std::optional<double> rmse = line.Report->Components[line.Component].RmseOf(line.At());
  return rmse ? Decibels(line.At().Range.Width(), *rmse) : std::nullopt;
}

/// A column of the bricks of the finest level.
StepColumn BrickColumn(const std::string& name, std::int64_t BrickCounts::*member)
{
  return { name, [member](const StepLine& line) { return Count(line.At().Levels[0].*member); } };
}

/// A column per size of nodes.
void AddSizes(std::vector<StepColumn>& columns, const SeriesReport& report, const std::string& name,
  CountsBySize StepReport::*member)
{
  for (std::size_t size = 0; size < (report.Components[0].Steps[0].*member).size(); ++size)
  {
    columns.push_back({ name + "_" + std::to_string(report.VoxelsBelow(size)),
      [member, size](const StepLine& line) { return Count((line.At().*member)[size]); } });
  }
}

std::string Quoted(const std::string& text)
{
  std::string quoted = "\"";
  for (const char c : text)
  {
    quoted += c == '"' ? "\"\"" : std::string(1, c);
  }
  return quoted + "\"";
}

} // namespace

std::vector<StepColumn> StepColumns(const SeriesReport& report)
{
  std::vector<StepColumn> columns{
    { "step", [](const StepLine& line) { return Count(line.At().Step); } },
    { "time", [](const StepLine& line) { return line.At().Time; } },
    { "low",
      [](const StepLine& line)
      {
        const ValueRange& range = line.At().Range;
        return range.Empty() ? std::nullopt : std::optional<double>(range.Low);
      } },
    { "high",
      [](const StepLine& line)
      {
        const ValueRange& range = line.At().Range;
        return range.Empty() ? std::nullopt : std::optional<double>(range.High);
      } },
    { "rmse", [](const StepLine& line)
      { return line.Report->Components[line.Component].RmseOf(line.At()); } },
    { "psnr_of_own_range", PsnrOfOwnRange },
    BrickColumn("bricks", &BrickCounts::Bricks),
    BrickColumn("macro_voxel_bricks", &BrickCounts::MacroVoxels),
    BrickColumn("unchanged_bricks", &BrickCounts::Unchanged),
    BrickColumn("stored_bricks", &BrickCounts::Stored),
    BrickColumn("shared_bricks", &BrickCounts::Shared),
    BrickColumn("bricks_with_non_finite", &BrickCounts::NonFinite),
    { "stored_bytes_all_levels",
      [](const StepLine& line)
      {
        BrickCounts sum;
        for (const BrickCounts& level : line.At().Levels)
        {
          sum.Add(level);
        }
        return static_cast<double>(sum.StoredBytes);
      } },
  };
  AddSizes(columns, report, "macro_voxels", &StepReport::MacroVoxels);
  AddSizes(columns, report, "unchanged", &StepReport::Unchanged);
  return columns;
}

std::vector<StepLine> StepLines(const SeriesReport& report)
{
  std::vector<StepLine> lines;
  for (std::size_t c = 0; c < report.Components.size(); ++c)
  {
    for (std::size_t s = 0; s < report.Components[c].Steps.size(); ++s)
    {
      lines.push_back({ &report, c, s });
    }
  }
  return lines;
}

std::string StepCsv(const SeriesReport& report)
{
  const std::vector<StepColumn> columns = StepColumns(report);
  std::string text = "array";
  for (const StepColumn& column : columns)
  {
    text += "," + column.Name;
  }
  text += "\n";
  for (const StepLine& line : StepLines(report))
  {
    text += Quoted(line.Of().Name);
    for (const StepColumn& column : columns)
    {
      const std::optional<double> value = column.Value(line);
      char digits[32] = "";
      if (value)
      {
        std::snprintf(digits, sizeof(digits), "%.17g", *value);
      }
      text += ",";
      text += digits;
    }
    text += "\n";
  }
  return text;
}

} // namespace banyan
