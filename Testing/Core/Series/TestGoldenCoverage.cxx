// SPDX-License-Identifier: BSD-3-Clause
/// What the golden files cover, told by a walk over their bytes that follows
/// Documentation/format.md and shares no code with the readers (but for zstd, and the numbers of
/// modes, blocks and bricks).

#include "Codec/BlockModes.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"
#include "Series/Format/Zstd.h"
#include "Series/ScalarStepTable.h"
#include "Series/SeriesTesting.h"

#include <map>
#include <set>

namespace banyan
{
namespace
{

using namespace banyan::testing;
using group::BlockEntry;
using group::NodeEntry;
using group::StepTable;
namespace fs = std::filesystem;

const std::string Folder = std::string(BANYAN_GOLDEN_DIR) + "/version-1";

/// What there is, with the number of blocks, bricks or heads that have it.
using Found = std::map<std::string, int>;

struct Segment
{
  std::string Content;
  std::vector<Bytes> Sections;

  const std::uint8_t* Data() const
  {
    return reinterpret_cast<const std::uint8_t*>(this->Content.data());
  }
};

Segment Load(const std::string& path, Found& found)
{
  Segment segment{ ReadWholeFile(path, 1 << 24), {} };
  const std::uint8_t* file = segment.Data();
  EXPECT_EQ(segment.Content.substr(0, 8), "BanyanSg");
  EXPECT_EQ(LoadNumber<std::uint32_t>(file + 8), 1u);
  const std::uint8_t* entry = file + LoadNumber<std::uint64_t>(file + 24);
  for (std::uint32_t i = 0; i < LoadNumber<std::uint32_t>(file + 20); ++i, entry += 24)
  {
    const std::uint8_t* stored = file + LoadNumber<std::uint64_t>(entry);
    const std::uint32_t storedBytes = LoadNumber<std::uint32_t>(entry + 8);
    Bytes section(LoadNumber<std::uint32_t>(entry + 12));
    if (storedBytes == section.size())
    {
      section.assign(stored, stored + storedBytes);
    }
    else
    {
      Decompress(stored, storedBytes, section.data(), section.size());
    }
    found[storedBytes == section.size() ? "section stored" : "section packed"] += 1;
    segment.Sections.push_back(section);
  }
  return segment;
}

/// "References": places of a group of S steps, from 1; 0 is the last step of the segment before.
struct Places
{
  int A = 0, B = 0; ///< both 0: none

  Places(int place, int steps, bool open)
  {
    if (place == steps)
    {
      return;
    }
    const int left = steps - place;
    const int d = left & -left;
    this->B = place + d;
    this->A = std::max(place - d, 0);
    this->A = this->A == 0 && !open ? this->B : this->A;
  }
};

std::uint64_t Varint(const std::uint8_t*& at)
{
  const std::uint64_t low = *at & 127;
  return *at++ < 128 ? low : low | Varint(at) << 7;
}

void WalkExceptions(const std::uint8_t* at, std::uint32_t bytes, Found& found)
{
  const std::uint8_t* end = at + bytes;
  (void)Varint(at);
  Bytes content(Varint(at));
  const bool packed = *at++ == 1;
  if (packed)
  {
    Decompress(at, static_cast<std::size_t>(end - at), content.data(), content.size());
  }
  else
  {
    content.assign(at, end);
  }
  static const char* const kinds[] = { "list", "mask", "all" };
  found[packed ? "exceptions packed" : "exceptions stored"] += 1;
  found[std::string("exceptions as ") + kinds[content[0]]] += 1;
}

void WalkBlock(const BlockEntry& block, const Segment& segment, const Places& places, Found& found)
{
  const std::uint8_t* file = segment.Data();
  const std::string exceptions = block.Exceptions.Bytes > 0 ? " with exceptions" : "";
  if (block.Uniform || block.Same)
  {
    const bool before = block.Same && places.A == 0;
    found[std::string(block.Uniform ? "uniform"
                      : before      ? "same as before"
                                    : "same") +
          exceptions] += 1;
  }
  else
  {
    const std::string mode = "mode " + std::to_string(block.Mode);
    found[mode + (block.Payload.Bytes > 0 ? "" : " without payload")] += 1;
    found[std::string("residuals") + exceptions] += 1;
    const int reference = block.Mode / 3;
    found["refers before"] +=
      places.B != 0 && places.A == 0 && reference != 0 && reference != 4 ? 1 : 0;
  }
  if (block.Payload.Bytes > 0)
  {
    found["lanes " + std::to_string(1 << (file[block.Payload.Offset] & 3))] += 1;
  }
  if (block.Exceptions.Bytes > 0)
  {
    WalkExceptions(file + block.Exceptions.Offset, block.Exceptions.Bytes, found);
  }
}

void WalkBrick(const NodeEntry& node, Found& found)
{
  found["brick not finite"] += node.HasNonFinite ? 1 : 0;
  found["brick nothing finite"] += node.NothingFinite ? 1 : 0;
  found["brick uniform"] += node.Uniform ? 1 : 0;
  found["brick with values"] += node.Explicit ? 1 : 0;
  found["brick at rest"] += node.Age > 0 ? 1 : 0;
  found["brick with content"] += node.Content != 0 ? 1 : 0;
}

/// Counts payloads and exceptions that some block before has too.
void CountShared(const StepTable& table, std::set<std::uint64_t>& met, Found& found)
{
  for (const auto& plane : table.Planes)
  {
    for (const BlockEntry& block : plane)
    {
      for (const group::Place& place : { block.Payload, block.Exceptions })
      {
        found["shared"] += place.Bytes > 0 && !met.insert(place.Offset).second ? 1 : 0;
      }
    }
  }
}

/// "Decoded in the order 8, 4, 2, 6, 1, ...": places from the greatest distance to references down.
std::vector<int> OrderOf(int steps)
{
  std::vector<int> order{ steps };
  for (int d = 1 << 11; d > 0; d /= 2)
  {
    for (int place = 1; place < steps; ++place)
    {
      const int left = steps - place;
      if ((left & -left) == d)
      {
        order.push_back(place);
      }
    }
  }
  return order;
}

/// Kind of a head, which starts with the numbers of the lattice.
/// @param before those of the segment before; empty if there is none. Replaced
bool WalkHead(const Bytes& head, int steps, Bytes& before, Found& found)
{
  Bytes lattice(head.begin(), head.begin() + 32); // axes to the greatest number
  lattice[3] = head[3] == 1 ? 1 : 0;
  const bool open = head[3] == 2;
  const bool first = before.empty();
  const bool differs = !first && before != lattice;
  EXPECT_FALSE(open && (first || differs));
  found[open           ? "head open"
        : head[3] == 1 ? "head without lattice"
        : differs      ? "head closed, another lattice"
        : first        ? "head closed, first"
        : steps == 1   ? "head closed, one step"
                       : "head closed"] += 1;
  std::size_t at = lattice.size();
  for (int set = 0; set < 2; ++set)
  {
    while (head[at++] >= 128) // the set's size
    {
    }
    for (int context = 0; context < 308; ++context)
    {
      const int symbols = head[at++];
      found["context with another one's table"] += symbols == 73 ? 1 : 0;
      for (int s = 0; s < (symbols == 73 ? 1 : symbols); ++s)
      {
        at += symbols != 73 && head[at] >= 128 ? 2 : 1;
      }
    }
  }
  EXPECT_EQ(at, head.size());
  before = lattice;
  return open;
}

/// All steps of a component in a segment.
/// @param sections its step tables, by step
void WalkField(const Segment& segment, const std::vector<Bytes>& sections,
  const group::TableShape& shape, bool open, std::set<std::uint64_t>& met, Found& found)
{
  const int steps = static_cast<int>(sections.size());
  std::vector<StepTable> tables(sections.size() + 1); // by place
  for (const int place : OrderOf(steps))
  {
    const Places places(place, steps, open);
    const group::TableReference reference{ places.B - 1,
      places.B > 0 ? &tables[static_cast<std::size_t>(places.B)] : nullptr };
    StepTable& table = tables[static_cast<std::size_t>(place)];
    table =
      ReadStepTable(sections[static_cast<std::size_t>(place) - 1], shape, place - 1, reference);
    for (const auto& plane : table.Planes)
    {
      for (const BlockEntry& block : plane)
      {
        WalkBlock(block, segment, places, found);
      }
    }
    for (const auto& level : table.Levels)
    {
      for (const NodeEntry& node : level)
      {
        WalkBrick(node, found);
      }
    }
    CountShared(table, met, found);
  }
}

/// The components of a series through its segments.
void WalkSeries(const std::string& path, Found& found)
{
  SCOPED_TRACE(path);
  const SeriesIndex index = SeriesFile::Open(path)->Index();
  std::size_t components = 0;
  for (const ArrayIndex& array : index.Arrays)
  {
    components += array.Components.size();
  }
  std::vector<Bytes> before(components);
  for (const SegmentIndex& named : index.Segments)
  {
    found["group of " + std::to_string(named.Steps)] += 1;
    const Segment segment = Load(path + ".d/" + named.File, found);
    ASSERT_EQ(segment.Sections.size(), 1 + components * static_cast<std::size_t>(1 + named.Steps));
    std::set<std::uint64_t> met;
    for (std::size_t c = 0; c < components; ++c)
    {
      const Bytes& head = segment.Sections[1 + c];
      const bool open = WalkHead(head, named.Steps, before[c], found);
      const group::TableShape shape = group::ShapeOf(
        index.Domain.Samples(), { head[0], head[1], head[2] }, index.BrickCells, index.Levels);
      std::vector<Bytes> sections;
      for (std::size_t i = 1 + components + c; i < segment.Sections.size(); i += components)
      {
        sections.push_back(segment.Sections[i]);
      }
      WalkField(segment, sections, shape, open, met, found);
    }
  }
}

TEST(GoldenCoverage, EveryCodingOccurs)
{
  Found found;
  for (const auto& entry : fs::directory_iterator(Folder))
  {
    if (entry.path().extension() == ".banyan")
    {
      WalkSeries(entry.path().string(), found);
    }
  }
  std::set<std::string> all = { "uniform", "uniform with exceptions", "same",
    "same with exceptions", "same as before", "refers before", "residuals",
    "residuals with exceptions", "lanes 1", "lanes 2", "lanes 4", "lanes 8", "exceptions packed",
    "exceptions stored", "exceptions as list", "exceptions as mask", "exceptions as all",
    "head open", "head without lattice", "head closed, first", "head closed, another lattice",
    "head closed, one step", "section stored", "section packed", "brick not finite",
    "brick nothing finite", "brick uniform", "brick with values", "brick at rest",
    "brick with content", "shared", "context with another one's table", "group of 1", "group of 2",
    "group of 3", "group of 4", "group of 8" };
  for (int mode = 0; mode < block::ModeCount; ++mode)
  {
    if (mode != 2) // neither a reference nor interpolation: no encoder takes it
    {
      all.insert("mode " + std::to_string(mode));
    }
  }
  for (const std::string& name : all)
  {
    EXPECT_GT(found[name], 0) << name;
  }
}

TEST(GoldenCoverage, EveryKindOfSeriesOccurs)
{
  std::set<ScalarType> types;
  std::set<int> brickCells, intervals;
  std::set<std::string> kinds, features;
  std::uintmax_t bytes = 0;
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
    intervals.insert(index.KeyframeInterval);
    kinds.insert(index.ErrorBound == 0                    ? "exact"
                 : index.Mode == ErrorBoundMode::Absolute ? "absolute"
                                                          : "relative");
    for (const std::string& feature : FeaturesOf(index))
    {
      features.insert(feature);
    }
    for (const ArrayIndex& array : index.Arrays)
    {
      kinds.insert("flags " + std::to_string(static_cast<int>(array.Flags)));
      types.insert(array.Type);
      kinds.insert(array.Components.size() > 1 ? "vector" : "scalar");
      for (const ComponentIndex& component : array.Components)
      {
        kinds.insert(
          "transform " + std::to_string(static_cast<int>(component.ValueTransform.Kind())));
        kinds.insert("range " + std::to_string(static_cast<int>(component.RangeFrom)));
        kinds.insert(component.FillCount > 0 ? "fill values" : "none");
        kinds.insert(component.ClampedCount > 0 ? "clamped" : "none");
        kinds.insert(component.InvisibleCount > 0 ? "invisible" : "none");
      }
    }
  }
  EXPECT_EQ(types.size(), 10u);
  EXPECT_EQ(brickCells, (std::set<int>{ 16, 32 }));
  EXPECT_EQ(intervals, (std::set<int>{ 1, 2, 3, 4, 8 }));
  EXPECT_EQ(
    kinds, (std::set<std::string>{ "exact", "absolute", "relative", "vector", "scalar",
             "transform 0", "transform 1", "transform 2", "range 0", "range 1", "range 2",
             "fill values", "clamped", "invisible", "none", "flags 0", "flags 1", "flags 2" }));
  const std::vector<std::string> known = KnownFeatures();
  EXPECT_EQ(features, std::set<std::string>(known.begin(), known.end()))
    << "each feature of the format has a golden series";
  EXPECT_LT(bytes, 256u * 1024) << "golden files stay small";
}

} // namespace
} // namespace banyan
