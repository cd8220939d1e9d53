// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Bytes.h"
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Format/IndexText.h"
#include "Series/Format/SegmentFormat.h"

#include <fstream>
#include <functional>
#include <iterator>
#include <map>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

/// Every file of a series by name, index first.
using Files = std::map<std::string, std::string>;

std::string ReadFile(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), {} };
}

struct Original
{
  Files Content;
  std::vector<std::vector<float>> Values; ///< per step and level
};

std::vector<std::vector<float>> ReadEverything(const std::string& path)
{
  std::vector<std::vector<float>> values;
  const auto file = SeriesFile::Open(path);
  for (int s = 0; s < file->Index().Steps(); ++s)
  {
    for (int level = 0; level < file->Index().Levels; ++level)
    {
      const FieldKey field = { s, 0, 0, level };
      values.push_back(ReadAll<float>(*file, field));
      // What drawing decides by must be right as well. Masks are cut so that floats hold them.
      std::vector<float> nodes;
      for (const BrickNode& node : *file->Nodes(field))
      {
        nodes.push_back(static_cast<float>(node.Range.Low));
        nodes.push_back(static_cast<float>(node.Range.High));
        for (int part = 0; part < 64; part += 16)
        {
          nodes.push_back(static_cast<float>(node.Mask >> part & 0xffff));
        }
        nodes.push_back(static_cast<float>((node.Uniform ? 1 : 0) + (node.HasNonFinite ? 2 : 0)));
      }
      values.push_back(std::move(nodes));
    }
  }
  return values;
}

Original MakeOriginal(const TemporaryFolder& folder)
{
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(35, 33, 34);
  auto steps = Sample<float>(grid, 5,
    [](int x, int y, int z, int s)
    { return z < 16 && x < 16 ? 1.0f : static_cast<float>(Wavy<float>(x, y, z, y < 16 ? 0 : s)); });
  steps[3][77] = NAN;
  EncodeOptions options;
  options.KeyframeInterval = 2;
  options.BrickCells = 16;
  Encode(path, grid, steps, options);
  Original original;
  original.Values = ReadEverything(path);
  original.Content["s.banyan"] = ReadFile(path);
  for (const auto& entry : fs::directory_iterator(path + ".d"))
  {
    original.Content["s.banyan.d/" + entry.path().filename().string()] =
      ReadFile(entry.path().string());
  }
  return original;
}

bool SameValues(const std::vector<std::vector<float>>& a, const std::vector<std::vector<float>>& b)
{
  if (a.size() != b.size())
  {
    return false;
  }
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    if (a[i].size() != b[i].size() ||
        std::memcmp(a[i].data(), b[i].data(), a[i].size() * sizeof(float)) != 0)
    {
      return false;
    }
  }
  return true;
}

/// One random change of one or two files.
std::string Mutate(Files& files, std::mt19937& random)
{
  std::vector<std::string> names;
  for (const auto& file : files)
  {
    names.push_back(file.first);
  }
  const std::string name = names[random() % names.size()];
  std::string& bytes = files[name];
  const std::size_t at = random() % bytes.size();
  const std::size_t length = 1 + random() % 64;
  switch (random() % 9)
  {
    case 0:
    case 1:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
      return "bit flip at " + std::to_string(at) + " of " + name;
    case 2:
      bytes[at] = static_cast<char>(random());
      return "byte change at " + std::to_string(at) + " of " + name;
    case 3:
      bytes.resize(at);
      return "truncation to " + std::to_string(at) + " of " + name;
    case 4:
      bytes.replace(at, length, std::min(length, bytes.size() - at), '\0');
      return "zeros at " + std::to_string(at) + " of " + name;
    case 5:
    {
      const std::size_t other = random() % bytes.size();
      for (std::size_t i = 0; i < length && at + i < bytes.size() && other + i < bytes.size(); ++i)
      {
        std::swap(bytes[at + i], bytes[other + i]);
      }
      return "swap of ranges in " + name;
    }
    case 6:
      bytes.swap(files[names[1 + random() % (names.size() - 1)]]);
      return "swap of files with " + name;
    case 7:
      bytes.insert(at, length, static_cast<char>(random()));
      return "insertion at " + std::to_string(at) + " of " + name;
    default:
      bytes.erase(at, length);
      return "removal at " + std::to_string(at) + " of " + name;
  }
}

void Write(const TemporaryFolder& folder, const Files& files)
{
  for (const auto& [name, bytes] : files)
  {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
}

TEST(Mutations, AThousandOfThemGiveAnErrorOrTheRightValues)
{
  const TemporaryFolder source;
  const Original original = MakeOriginal(source);
  ASSERT_EQ(original.Content.size(), 4u);
  const TemporaryFolder folder;
  fs::create_directory(folder / "s.banyan.d");
  std::mt19937 random(20250101);
  int errors = 0;
  for (int i = 0; i < 1000; ++i)
  {
    Files files = original.Content;
    const std::string what = Mutate(files, random);
    Write(folder, files);
    try
    {
      EXPECT_TRUE(SameValues(ReadEverything(folder / "s.banyan"), original.Values))
        << "wrong values after " << what;
    }
    catch (const Error&)
    {
      ++errors;
    }
  }
  // Only changes of padding, and changes that change nothing, may pass.
  EXPECT_GT(errors, 900);
  EXPECT_LT(errors, 1000);
}

TEST(Mutations, EveryByteOutsideThePayloadsIsGuarded)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const Grid grid = GridOf(20, 18, 17);
  EncodeOptions options;
  options.BrickCells = 16;
  const SeriesIndex index = Encode(path, grid,
    Sample<float>(
      grid, 1, [](int x, int y, int z, int) { return x < 17 ? 0.25 : Wavy<float>(x, y, z, 0); }),
    options);
  const auto expected = ReadEverything(path);
  const std::string segment = path + ".d/" + index.Segments[0].File;
  const std::string good = ReadFile(segment);
  const auto payloadEnd =
    LoadNumber<std::uint64_t>(reinterpret_cast<const std::uint8_t*>(good.data()) + 40);
  std::mt19937 random(12);
  std::size_t harmless = 0;
  for (std::size_t at = 0; at < good.size(); at = at == 63 ? payloadEnd : at + 1)
  {
    for (int i = 0; i < 4; ++i)
    {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ (1 << random() % 8));
      std::ofstream(segment, std::ios::binary) << bad;
      try
      {
        EXPECT_TRUE(SameValues(ReadEverything(path), expected)) << "byte " << at;
        ++harmless;
        EXPECT_EQ(good[at], '\0') << "byte " << at << " is no padding, but nobody looks at it";
      }
      catch (const Error&)
      {
      }
    }
  }
  EXPECT_LT(harmless, 4u * 64 * 4) << "more than the padding of four sections";
}

/// Makes all hashes of the chain fit again, as somebody could who means ill.
void Reseal(Files& files)
{
  SeriesIndex index;
  try
  {
    index = IndexFromText(files["s.banyan"], "x");
  }
  catch (const Error&)
  {
    return;
  }
  for (SegmentIndex& segment : index.Segments)
  {
    std::string& bytes = files["s.banyan.d/" + segment.File];
    auto* data = reinterpret_cast<std::uint8_t*>(bytes.data());
    const auto offset = LoadNumber<std::uint64_t>(data + 24);
    if (offset < bytes.size() && (bytes.size() - offset) % group::EntryBytes == 0)
    {
      for (std::uint64_t at = offset; at < bytes.size(); at += group::EntryBytes)
      {
        const auto section = LoadNumber<std::uint64_t>(data + at);
        const auto stored = LoadNumber<std::uint32_t>(data + at + 8);
        if (section < bytes.size() && stored < bytes.size() - section)
        {
          StoreNumber(data + at + 16, ShortHashOf(data + section, stored));
        }
      }
      StoreNumber(data + 32, ShortHashOf(data + offset, bytes.size() - offset));
    }
    StoreNumber(data + 56, ShortHashOf(data, 56));
    const Hash128 hash = HashOf(data, segment::HeaderBytes);
    segment.HashLow = hash.Low;
    segment.HashHigh = hash.High;
    segment.Bytes = bytes.size();
  }
  files["s.banyan"] = IndexToText(index);
}

TEST(Mutations, SealedAgainTheyAreNoCrash)
{
  const TemporaryFolder source;
  const Original original = MakeOriginal(source);
  const TemporaryFolder folder;
  fs::create_directory(folder / "s.banyan.d");
  std::mt19937 random(99);
  int errors = 0;
  for (int i = 0; i < 600; ++i)
  {
    Files files = original.Content;
    std::string& bytes = std::next(files.begin(), 1 + static_cast<int>(random() % 3))->second;
    // Headers and directories are small, so they need an aim; sizes stay.
    const std::size_t at = i % 3 == 0   ? 8 + random() % 56
                           : i % 3 == 1 ? bytes.size() - 1 - random() % 300
                                        : random() % bytes.size();
    bytes[at] = static_cast<char>(i % 2 == 0 ? bytes[at] ^ (1 << random() % 8) : random());
    Reseal(files);
    Write(folder, files);
    try
    {
      (void)ReadEverything(folder / "s.banyan");
    }
    catch (const Error&)
    {
      ++errors;
    }
  }
  EXPECT_GT(errors, 300);
}

} // namespace
} // namespace banyan::testing
