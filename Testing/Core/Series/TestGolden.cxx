// SPDX-License-Identifier: BSD-3-Clause
/// Series that were written once and have to be read as they were for ever; see Golden/README.md.
///
/// To write such files with the encoder as it is:
///
///     BANYAN_WRITE_GOLDEN=<folder> TestSeries --gtest_filter=Golden.WhatIsWrittenToday*
///
/// makes `<folder>/version-<N>`, N being the version of the format, or adds series that it does not
/// have yet.

#include "Series/GoldenFiles.h"

#include "Mesh/CellSeries/CellsFile.h"
#include "Mesh/Series/AtlasValues.h"
#include "Mesh/Series/MeshFile.h"
#include "Series/Format/AtomicFile.h"
#include "Series/SeriesTesting.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace banyan
{
namespace
{

using namespace banyan::testing;
namespace fs = std::filesystem;

const std::string GoldenFolder = BANYAN_GOLDEN_DIR;

/// The folders `version-<N>`, in order.
std::vector<std::string> GoldenVersions()
{
  std::vector<std::string> folders;
  for (const auto& entry : fs::directory_iterator(GoldenFolder))
  {
    if (entry.is_directory())
    {
      folders.push_back(entry.path().string());
    }
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

std::string MessageOf(const std::string& path, const FieldKey* field)
{
  try
  {
    const auto file = SeriesFile::Open(path);
    if (field != nullptr)
    {
      (void)file->Nodes(*field);
    }
  }
  catch (const Error& failure)
  {
    return failure.what();
  }
  return "nothing is wrong";
}

std::string FirstSegment(const std::string& path)
{
  return SeriesFile::Open(path)->Index().Segments.at(0).File;
}

/// In place and without waiting for the disk, which is what takes the time of tests.
void Overwrite(const std::string& path, const std::string& content)
{
  std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
  ASSERT_EQ(fs::file_size(path), content.size());
}

std::string WithByte(std::string content, std::size_t at, char value)
{
  content.at(at) = value;
  return content;
}

/// What a quantizer promises: fill values and what is not finite come back as they were, all others
/// within the bound in the transformed domain, of what they were clamped to; or invisible as
/// before.
template <class T>
void ExpectAsQuantized(
  std::vector<T> own, const std::vector<T>& decoded, const ComponentIndex& component)
{
  const InvisibleIntervals invisible = component.Opacity.empty()
                                         ? InvisibleIntervals()
                                         : InvisibleIntervals(OpacityFunction(component.Opacity));
  const Transform& f = component.ValueTransform;
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    if (!std::isfinite(static_cast<double>(own[i])) ||
        std::count(component.FillValues.begin(), component.FillValues.end(),
          static_cast<double>(own[i])) > 0)
    {
      EXPECT_TRUE(SameBits(own[i], decoded[i])) << "voxel " << i;
      continue;
    }
    T expected = own[i];
    if (component.ClampOutside)
    {
      (void)ClampToRange(component.PromisedRange, &own[i], 1, &expected);
    }
    const double was = static_cast<double>(expected);
    const double is = static_cast<double>(decoded[i]);
    EXPECT_TRUE(
      std::abs(f.Forward(is) - f.Forward(was)) <= component.ErrorBoundAbsolute ||
      (invisible.IntervalOf(was) >= 0 && invisible.IntervalOf(was) == invisible.IntervalOf(is)))
      << "voxel " << i << ": " << was << " became " << is;
  }
}

/// Values of a component as GoldenValues has them: by sample, or by point or cell of the mesh.
template <class T>
std::vector<T> DecodedValues(
  const SeriesFile& file, const GoldenCase& series, const GoldenArray& array, const FieldKey& key)
{
  const std::vector<T> image = ReadAll<T>(file, key);
  if (!series.OnMesh && !series.OnCells)
  {
    return image;
  }
  const bool ofCells = !array.CellArray.empty();
  const MeshValues where = ofCells ? MeshValues::OfCells : MeshValues::OfPoints;
  const MeshIndex& index = *file.Index().Mesh;
  std::vector<T> values(static_cast<std::size_t>(ofCells ? index.Cells : index.Points));
  (series.OnMesh ? AtlasValues(ReadMesh(file), where) : AtlasValues(ReadCells(file), where))
    .FromImage(ScalarTypeOf<T>(), image.data(), 1, values.data());
  return values;
}

/// Checks the bits of values at hidden points, and takes them out of what is compared later.
template <class T>
void ExpectHiddenAsTheyWere(
  const GoldenCase& series, int step, std::vector<T>& own, std::vector<T>& decoded)
{
  const GoldenArray& flags = series.Arrays[0];
  if (flags.Flags != ArrayFlags::OfPoints)
  {
    return;
  }
  const Bytes hidden = GoldenValues(series, flags, step);
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    if (hidden[i] != 0)
    {
      EXPECT_TRUE(SameBits(own[i], decoded[i])) << "hidden voxel " << i;
      own[i] = decoded[i] = T{};
    }
  }
}

/// Every voxel of an array against what the encoder was given.
template <class T>
void ExpectWithinBound(
  const SeriesFile& file, const GoldenCase& series, int a, const ArrayIndex& written)
{
  const GoldenArray& array = series.Arrays[static_cast<std::size_t>(a)];
  const std::size_t components = array.Components.size();
  for (int step = 0; step < series.Steps; ++step)
  {
    const Bytes bytes = GoldenValues(series, array, step);
    for (std::size_t c = 0; c < components; ++c)
    {
      std::vector<T> own;
      for (std::size_t at = c * sizeof(T); at < bytes.size(); at += components * sizeof(T))
      {
        own.push_back(LoadNumber<T>(bytes.data() + at));
      }
      std::vector<T> decoded =
        DecodedValues<T>(file, series, array, { step, a, static_cast<int>(c), 0 });
      SCOPED_TRACE(
        array.Name + " step " + std::to_string(step) + " component " + std::to_string(c));
      if (array.Flags == ArrayFlags::None)
      {
        ExpectHiddenAsTheyWere(series, step, own, decoded);
      }
      if (series.Options.QuantizerOfArray.count(array.Name) > 0)
      {
        ExpectAsQuantized(own, decoded, written.Components[c]);
      }
      else
      {
        EXPECT_TRUE(WithinBound(own, decoded, written.Components[c].ErrorBoundAbsolute));
      }
    }
  }
}

TEST(Golden, EveryVersionIsReadAsItWasWritten)
{
  const std::vector<std::string> folders = GoldenVersions();
  ASSERT_FALSE(folders.empty());
  ASSERT_EQ(folders.size(), 1u);
  EXPECT_EQ(fs::path(folders[0]).filename(), "version-1");
  for (const std::string& folder : folders)
  {
    int series = 0;
    for (const auto& entry : fs::directory_iterator(folder))
    {
      if (entry.path().extension() == ".banyan")
      {
        ++series;
        EXPECT_EQ("version-" + std::to_string(VersionOf(entry.path().string())),
          fs::path(folder).filename().string());
      }
    }
    EXPECT_GT(series, 0) << folder;
    for (const std::string& sentence : Differences(LoadChecksums(folder), ReadGolden(folder)))
    {
      ADD_FAILURE() << folder << ": " << sentence;
    }
  }
}

/// Adds series to golden files; those that are there stay as they are.
void AddGolden(const std::string& from, const std::string& to)
{
  GoldenParts parts = fs::exists(to) ? LoadChecksums(to) : GoldenParts{};
  fs::create_directories(to);
  for (const auto& entry : fs::directory_iterator(from))
  {
    const std::string series = to + "/" + entry.path().filename().string();
    if (entry.path().extension() == ".banyan" && !fs::exists(series))
    {
      fs::copy(entry.path(), series);
      fs::copy(entry.path().string() + ".d", series + ".d");
    }
  }
  for (const auto& part : ReadGolden(to))
  {
    parts.insert(part); // what is listed stays
  }
  SaveChecksums(to, parts);
}

/// The list of cases must go on being what the encoder can write, or the files of the next version
/// could not be made.
TEST(Golden, WhatIsWrittenTodayHoldsItsBoundAndIsTheSameEachTime)
{
  const TemporaryFolder temporary;
  fs::create_directory(temporary / "first");
  fs::create_directory(temporary / "second");
  for (const GoldenCase& series : GoldenCases())
  {
    SCOPED_TRACE(series.Name);
    (void)WriteGoldenSeries(temporary / "second", series);
    const SeriesIndex index = WriteGoldenSeries(temporary / "first", series);
    const auto file = SeriesFile::Open(temporary / ("first/" + series.Name + ".banyan"));
    for (int a = 0; a < static_cast<int>(series.Arrays.size()); ++a)
    {
      const ArrayIndex& written = index.Arrays[static_cast<std::size_t>(a)];
      Dispatch(written.Type, [&](auto tag)
        { ExpectWithinBound<typename decltype(tag)::Type>(*file, series, a, written); });
    }
  }
  const GoldenParts parts = ReadGolden(temporary / "first");
  EXPECT_EQ(Differences(parts, ReadGolden(temporary / "second")), std::vector<std::string>{});
  if (const char* folder = std::getenv("BANYAN_WRITE_GOLDEN"))
  {
    const std::string name = std::string(folder) + "/version-" +
                             std::to_string(VersionOf(temporary / "first/types.banyan"));
    AddGolden(temporary / "first", name);
  }
}

TEST(Golden, ChecksumsComeBackAndEveryDifferenceIsSaid)
{
  const TemporaryFolder temporary;
  const GoldenParts parts = LoadChecksums(GoldenVersions()[0]);
  SaveChecksums(temporary.Path(), parts);
  EXPECT_EQ(LoadChecksums(temporary.Path()), parts);
  for (const auto& part : parts)
  {
    GoldenParts other = parts;
    other[part.first] += "0";
    std::vector<std::string> sentences = Differences(parts, other);
    ASSERT_EQ(sentences.size(), 1u);
    EXPECT_NE(sentences[0].find(part.first), std::string::npos);
    EXPECT_NE(sentences[0].find(part.second), std::string::npos);
    other.erase(part.first);
    EXPECT_EQ(Differences(parts, other).size(), 1u);
    EXPECT_EQ(Differences(other, parts).size(), 1u);
  }
}

/// One byte anywhere: the checksum of its file differs in any case, and but for bytes that lie in a
/// gap the reader notices, too.
TEST(Golden, OneChangedByteIsNoticed)
{
  for (const std::string& folder : GoldenVersions())
  {
    const GoldenParts expected = LoadChecksums(folder);
    std::mt19937 random(7);
    int noticed = 0;
    for (const std::string& name :
      { std::string("line.banyan"), "line.banyan.d/" + FirstSegment(folder + "/line.banyan") })
    {
      const TemporaryFolder temporary;
      fs::create_directory(temporary / "copy");
      fs::copy(folder + "/line.banyan", temporary / "copy");
      fs::copy(folder + "/line.banyan.d", temporary / "copy/line.banyan.d");
      const GoldenParts whole = ReadGolden(temporary / "copy");
      const std::string path = temporary / ("copy/" + name);
      const std::string content = ReadWholeFile(path, 1 << 24);
      for (int i = 0; i < 60; ++i)
      {
        const std::size_t at = random() % content.size();
        const char changed = static_cast<char>(content[at] ^ (1 << random() % 8));
        Overwrite(path, WithByte(content, at, changed));
        const std::vector<std::string> sentences =
          Differences(whole, ReadGolden(temporary / "copy"));
        ASSERT_FALSE(sentences.empty()) << "byte " << at;
        EXPECT_NE(sentences[0].find("file " + name), std::string::npos) << sentences[0];
        noticed += sentences.size() > 1 ? 1 : 0;
        Overwrite(path, content);
      }
      for (const auto& part : whole)
      {
        EXPECT_EQ(part.second, expected.at(part.first));
      }
    }
    EXPECT_GT(noticed, 90);
  }
}

TEST(Golden, NewerVersionsAreRefusedInOneSentence)
{
  const TemporaryFolder temporary;
  for (const std::string& folder : GoldenVersions())
  {
    const std::string copy = temporary / fs::path(folder).filename().string();
    fs::copy(folder, copy, fs::copy_options::recursive);
    const std::string path = copy + "/tiny.banyan";
    const FieldKey field;
    EXPECT_EQ(MessageOf(path, &field), "nothing is wrong");

    const std::string name = FirstSegment(path);
    const std::string segment = path + ".d/" + name;
    const std::string whole = ReadWholeFile(segment, 1 << 24);
    Overwrite(segment, WithByte(whole, 8, 9));
    std::string message = MessageOf(path, &field);
    EXPECT_NE(message.find("format version"), std::string::npos) << message;
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find('9'), std::string::npos) << message;
    Overwrite(segment, whole);

    // A newer index may hold anything after the version; its number has to be said all the same.
    const std::string index = ReadWholeFile(path, 1 << 24);
    const std::size_t rest = index.find(' ', std::string("BanyanSeries ").size());
    for (const std::string& after : { index.substr(rest), std::string("\n"), std::string(" ?") })
    {
      Overwrite(path, "BanyanSeries 9" + after);
      message = MessageOf(path, nullptr);
      EXPECT_NE(message.find("format version 9"), std::string::npos) << message;
      EXPECT_NE(message.find("this Banyan reads version"), std::string::npos) << message;
      EXPECT_NE(message.find("tiny.banyan"), std::string::npos) << message;
    }
  }
}

} // namespace
} // namespace banyan
