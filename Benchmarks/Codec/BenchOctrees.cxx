// SPDX-License-Identifier: BSD-3-Clause
#include "Papers/OctreeComparison.h"
#include "SeriesReport.h"
#include "TextTable.h"

#include "Base/Error.h"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace
{

using namespace banyan;

constexpr const char* Help =
  "banyan-bench-octrees FILE: what the encoding of the study that Banyan started from would take\n"
  "for what the encoded series FILE (name.banyan) decodes to: 8-bit codes, uniform or adaptive, in\n"
  "octrees down to single voxels that are merged over time (its table 2 and figure 9).\n";

std::vector<std::string> SizeRow(const std::string& name, const std::vector<std::int64_t>& counts)
{
  std::vector<std::string> row{ name };
  for (const std::int64_t count : counts)
  {
    row.push_back(std::to_string(count));
  }
  return row;
}

std::string ShareTable(const std::string& name, const OctreeComparison& octree)
{
  TextTable table({ name + " in the study's octrees", "bits per value", "saved of 8 bits" });
  const auto row = [&](const std::string& what, std::uint64_t bits)
  {
    table.AddRow({ what, Digits(static_cast<double>(bits) / static_cast<double>(octree.Voxels)),
      Percent(SavedShare(bits, octree.Voxels, OctreeComparison::Bits)) });
  };
  row("uniform quantizer", octree.UniformBits);
  row("  its codes alone", octree.UniformCodes);
  row("adaptive quantizer", octree.AdaptiveBits);
  return table.Text();
}

std::string SizeTable(const SeriesReport& report, const OctreeComparison& octree)
{
  std::vector<std::int64_t> macro(octree.Steps[0].MacroVoxels.size(), 0);
  std::vector<std::int64_t> merged(macro.size(), 0);
  std::vector<std::string> headings{ "its nodes by size in voxels" };
  for (std::size_t level = 0; level < macro.size(); ++level)
  {
    headings.push_back(std::to_string(report.VoxelsOf(std::int64_t{ 1 } << level)));
    for (const PaperOctreeCounts& step : octree.Steps)
    {
      macro[level] += step.MacroVoxels[level];
      merged[level] += step.MergedSubtrees[level];
    }
  }
  TextTable table(headings);
  table.AddRow(SizeRow("macro voxels", macro));
  table.AddRow(SizeRow("merged subtrees", merged));
  return table.Text();
}

void Compare(const std::string& path)
{
  const auto file = SeriesFile::Open(path);
  const SeriesReport report = ReportSeries(*file, {});
  for (const ComponentReport& component : report.Components)
  {
    const OctreeComparison octree =
      CompareWithOctree(*file, component.Array, component.Component, 0, file->Index().Steps());
    std::printf(
      "%s\n%s\n", ShareTable(component.Name, octree).c_str(), SizeTable(report, octree).c_str());
  }
}

} // namespace

int main(int argc, char** argv)
{
  if (argc != 2 || argv[1][0] == '-')
  {
    std::fputs(Help, argc == 2 ? stdout : stderr);
    return argc == 2 ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  try
  {
    Compare(argv[1]);
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-octrees: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
