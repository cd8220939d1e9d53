// SPDX-License-Identifier: BSD-3-Clause
/// What the golden files of version 1 cover, told by a walk over their bytes that follows
/// Documentation/format.md and shares no code with the readers (but for zstd).

#include "Series/AtomicFile.h"
#include "Series/SeriesTesting.h"
#include "Series/Zstd.h"

#include <set>

namespace banyan
{
namespace
{

using namespace banyan::testing;
namespace fs = std::filesystem;

const std::string Folder = std::string(BANYAN_GOLDEN_DIR) + "/version-1";

struct Walk
{
  std::set<std::string> Codings;
  std::set<int> Flags; ///< of node tables
  int Shared = 0;      ///< bricks whose payload another one has, too
};

/// Number i of a column that is stored as planes.
std::uint64_t Planes(const Bytes& table, std::size_t column, std::size_t width, std::size_t i)
{
  const std::size_t count = table.size() / 54;
  std::uint64_t number = 0;
  for (std::size_t p = 0; p < width; ++p)
  {
    number |= std::uint64_t{ table[column * count + p * count + i] } << 8 * p;
  }
  return number;
}

std::string CodingOf(int mode, const std::uint8_t* payload)
{
  static const char* const widths[] = { "0", "1", "2", "4" };
  if (mode == 0)
  {
    return "macro voxel";
  }
  if (mode == 2)
  {
    return payload[0] == 1 ? "raw zstd" : "raw stored";
  }
  return std::string("lattice ") + widths[payload[0] & 3] +
         (payload[0] & 4 ? " Lorenzo" : " plain") + (payload[0] & 8 ? " zstd" : " stored");
}

void WalkTable(
  const Bytes& table, const std::uint8_t* file, std::set<std::uint64_t>& met, Walk& walk)
{
  std::uint64_t end = 64;
  for (std::size_t i = 0; i < table.size() / 54; ++i)
  {
    const int mode = static_cast<int>(Planes(table, 0, 1, i));
    walk.Flags.insert(static_cast<int>(Planes(table, 1, 1, i)));
    std::uint64_t start = 0;
    if (mode != 0)
    {
      start = end + Planes(table, 26, 8, i);
      walk.Shared += met.insert(start).second ? 0 : 1;
      end = (start + Planes(table, 34, 4, i) + 7) / 8 * 8;
    }
    walk.Codings.insert(CodingOf(mode, file + start));
  }
}

void WalkSegment(const std::string& path, Walk& walk)
{
  const std::string content = ReadWholeFile(path, 1 << 24);
  const std::uint8_t* file = reinterpret_cast<const std::uint8_t*>(content.data());
  ASSERT_EQ(content.substr(0, 8), "BanyanSg");
  ASSERT_EQ(LoadNumber<std::uint32_t>(file + 8), 1u);
  const std::uint8_t* entry = file + LoadNumber<std::uint64_t>(file + 24);
  std::set<std::uint64_t> met;
  for (std::uint32_t t = 0; t < LoadNumber<std::uint32_t>(file + 20); ++t, entry += 64)
  {
    Bytes table(LoadNumber<std::uint64_t>(entry + 16));
    Decompress(file + LoadNumber<std::uint64_t>(entry), LoadNumber<std::uint64_t>(entry + 8),
      table.data(), table.size());
    WalkTable(table, file, met, walk);
  }
}

TEST(GoldenCoverage, EveryCodingOfVersion1Occurs)
{
  Walk walk;
  for (const auto& entry : fs::recursive_directory_iterator(Folder))
  {
    if (entry.path().extension() == ".seg")
    {
      WalkSegment(entry.path().string(), walk);
    }
  }
  std::set<std::string> all = { "macro voxel", "raw stored", "raw zstd", "lattice 0 plain stored" };
  for (const std::string width : { "1", "2", "4" })
  {
    for (const std::string predictor : { "plain", "Lorenzo" })
    {
      all.insert("lattice " + width + " " + predictor + " stored");
      all.insert("lattice " + width + " " + predictor + " zstd");
    }
  }
  EXPECT_EQ(walk.Codings, all);
  EXPECT_EQ(walk.Flags, (std::set<int>{ 0, 1, 3 }));
  EXPECT_GT(walk.Shared, 20);
}

TEST(GoldenCoverage, EveryKindOfSeriesOccurs)
{
  std::set<ScalarType> types;
  std::set<int> brickCells;
  std::set<int> levels;
  std::set<std::string> bounds;
  std::set<bool> promised;
  std::size_t segments = 0;
  std::int64_t unchanged = 0;
  std::int64_t merged = 0;
  std::uintmax_t bytes = 0;
  bool vectors = false;
  for (const auto& entry : fs::recursive_directory_iterator(Folder))
  {
    const bool text = entry.path().extension() == ".txt";
    bytes += entry.is_regular_file() && !text ? entry.file_size() : 0;
    if (entry.path().extension() != ".banyan")
    {
      continue;
    }
    const SeriesIndex index = SeriesFile::Open(entry.path().string())->Index();
    brickCells.insert(index.BrickCells);
    levels.insert(index.Levels);
    bounds.insert(index.ErrorBound == 0                    ? "exact"
                  : index.Mode == ErrorBoundMode::Absolute ? "absolute"
                                                           : "relative");
    segments = std::max(segments, index.Segments.size());
    unchanged += index.Statistics.UnchangedBricks;
    merged += index.Statistics.MergedBricks;
    for (const ArrayIndex& array : index.Arrays)
    {
      types.insert(array.Type);
      promised.insert(array.Components[0].PromisedRange.Empty());
      vectors |= array.Components.size() == 3 && array.Magnitudes.size() == index.Times.size();
    }
  }
  EXPECT_EQ(types.size(), 10u);
  EXPECT_EQ(brickCells, (std::set<int>{ 8, 16 }));
  EXPECT_EQ(levels, (std::set<int>{ 1, 2, 3, 4 }));
  EXPECT_EQ(bounds, (std::set<std::string>{ "absolute", "exact", "relative" }));
  EXPECT_EQ(promised.size(), 2u);
  EXPECT_EQ(segments, 3u);
  EXPECT_GT(unchanged, 20);
  EXPECT_GT(merged, 20);
  EXPECT_TRUE(vectors);
  EXPECT_LT(bytes, 60u * 1024) << "golden files stay small";
}

} // namespace
} // namespace banyan
