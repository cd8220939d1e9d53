// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Bytes.h"
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>

namespace banyan
{
namespace
{

double RandomDouble(std::mt19937_64& random)
{
  double value = BitCast<double>(random());
  while (!std::isfinite(value))
  {
    value = BitCast<double>(random());
  }
  return value;
}

/// All members of the statistics, those that are added later, too.
using StatisticNumbers = std::array<std::uint64_t, sizeof(EncodeStatistics) / 8>;

StatisticNumbers NumbersFromOne()
{
  StatisticNumbers numbers;
  std::iota(numbers.begin(), numbers.end(), 1u);
  return numbers;
}

SeriesIndex MakeIndex(unsigned seed)
{
  std::mt19937_64 random(seed);
  SeriesIndex index;
  index.Domain.Extent = { { -5, 0, 7 }, { 40, 1, 90 } };
  for (int axis = 0; axis < 3; ++axis)
  {
    index.Domain.Origin[axis] = RandomDouble(random);
    index.Domain.Spacing[axis] = RandomDouble(random);
    index.Domain.Direction[axis] = { RandomDouble(random), -0.0, RandomDouble(random) };
  }
  index.Levels = 4;
  index.KeyframeInterval = 2;
  index.ErrorBound = 1.0 / 512;
  index.ActiveScalars = "wind \"speed\"";
  ArrayIndex array;
  array.Name = "wind \"speed\"";
  array.Type = ScalarType::UInt64;
  ComponentIndex component;
  component.Name = "x/\xc3\xa9";
  component.Range = { -5e-324, 1.7976931348623157e308 };
  component.ErrorBoundAbsolute = std::abs(RandomDouble(random));
  component.MeasuredMaxError = std::abs(RandomDouble(random));
  component.SumSquaredError = std::numeric_limits<double>::infinity();
  component.FiniteCount = std::numeric_limits<std::int64_t>::max();
  array.Components.push_back(component);
  component.Range = {};
  component.PromisedRange = { -0.0, 0.1 };
  component.SumSquaredError = 0.3;
  component.StepRmse = { 0.0123, 0.0, std::numeric_limits<double>::infinity() };
  component.ValueTransform = Transform::Table({ { -0.1, 0.3 }, { 0.2, 7.0 } });
  array.Components.push_back(component);
  array.Magnitudes = { { 0.0, 0.1 }, {}, { 5e-324, std::abs(RandomDouble(random)) + 1.0 } };
  index.Arrays.push_back(array);
  index.Times = { -1.5, 0.1, 0.1 + 1e-17 + 3e-17 };
  index.Segments.push_back({ "0123456789abcdef-000000.seg", 0, 2, 4711, random(), random() });
  index.Segments.push_back({ "0123456789abcdef-000001.seg", 2, 1, 815, random(), random() });
  index.PayloadBytesIn = 123456789012345u;
  const StatisticNumbers numbers = NumbersFromOne();
  std::memcpy(static_cast<void*>(&index.Statistics), numbers.data(), sizeof(numbers));
  return index;
}

void ExpectSameBits(double a, double b)
{
  EXPECT_EQ(BitCast<std::uint64_t>(a), BitCast<std::uint64_t>(b)) << a << " and " << b;
}

TEST(IndexText, ComesBackBitExact)
{
  for (unsigned seed = 0; seed < 200; ++seed)
  {
    const SeriesIndex a = MakeIndex(seed);
    const SeriesIndex b = IndexFromText(IndexToText(a), "x");
    EXPECT_EQ(a.Domain.Extent, b.Domain.Extent);
    for (int i = 0; i < 3; ++i)
    {
      ExpectSameBits(a.Domain.Origin[i], b.Domain.Origin[i]);
      ExpectSameBits(a.Domain.Spacing[i], b.Domain.Spacing[i]);
      ExpectSameBits(a.Times[static_cast<std::size_t>(i)], b.Times[static_cast<std::size_t>(i)]);
      for (int j = 0; j < 3; ++j)
      {
        ExpectSameBits(a.Domain.Direction[i][j], b.Domain.Direction[i][j]);
      }
    }
    EXPECT_EQ(a.ActiveScalars, b.ActiveScalars);
    EXPECT_EQ(b.Arrays[0].Type, ScalarType::UInt64);
    for (std::size_t c = 0; c < 2; ++c)
    {
      const ComponentIndex& x = a.Arrays[0].Components[c];
      const ComponentIndex& y = b.Arrays[0].Components[c];
      EXPECT_EQ(x.Name, y.Name);
      ExpectSameBits(x.Range.Low, y.Range.Low);
      ExpectSameBits(x.Range.High, y.Range.High);
      ExpectSameBits(x.PromisedRange.Low, y.PromisedRange.Low);
      ExpectSameBits(x.ErrorBoundAbsolute, y.ErrorBoundAbsolute);
      ExpectSameBits(x.MeasuredMaxError, y.MeasuredMaxError);
      ExpectSameBits(x.SumSquaredError, y.SumSquaredError);
      EXPECT_EQ(x.StepRmse, y.StepRmse);
      EXPECT_EQ(x.FiniteCount, y.FiniteCount);
      EXPECT_TRUE(x.ValueTransform == y.ValueTransform);
    }
    ASSERT_EQ(b.Arrays[0].Magnitudes.size(), 3u);
    EXPECT_TRUE(b.Arrays[0].Magnitudes[1].Empty());
    ExpectSameBits(a.Arrays[0].Magnitudes[2].Low, b.Arrays[0].Magnitudes[2].Low);
    ExpectSameBits(a.Arrays[0].Magnitudes[2].High, b.Arrays[0].Magnitudes[2].High);
    EXPECT_EQ(a.Segments[1].HashHigh, b.Segments[1].HashHigh);
    EXPECT_EQ(a.Segments[1].HashLow, b.Segments[1].HashLow);
    EXPECT_EQ(b.Segments[1].Bytes, 815u);
    StatisticNumbers statistics;
    std::memcpy(statistics.data(), &b.Statistics, sizeof(statistics));
    EXPECT_EQ(statistics, NumbersFromOne());
    EXPECT_EQ(b.PayloadBytesIn, a.PayloadBytesIn);
    EXPECT_EQ(b.KeyframeInterval, 2);
  }
}

TEST(IndexText, DoesNotDependOnTheLocale)
{
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const std::string plain = IndexToText(MakeIndex(1));
  const bool comma = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr;
  EXPECT_EQ(IndexToText(MakeIndex(1)), plain);
  ExpectSameBits(IndexFromText(plain, "x").Times[1], 0.1);
  std::setlocale(LC_ALL, before.c_str());
  if (!comma)
  {
    GTEST_SKIP() << "the locale de_DE.UTF-8 is not installed";
  }
}

void ExpectRejected(const std::string& text, const std::string& word)
{
  try
  {
    (void)IndexFromText(text, "some.banyan");
    ADD_FAILURE() << "accepted, although: " << word;
  }
  catch (const Error& failure)
  {
    EXPECT_NE(std::string(failure.what()).find(word), std::string::npos) << failure.what();
    EXPECT_NE(std::string(failure.what()).find("some.banyan"), std::string::npos);
  }
}

TEST(IndexText, EveryFlippedBitAndEveryTruncationIsNoticed)
{
  const std::string text = IndexToText(MakeIndex(3));
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    for (int bit = 0; bit < 8; ++bit)
    {
      std::string damaged = text;
      damaged[i] = static_cast<char>(damaged[i] ^ (1 << bit));
      EXPECT_THROW((void)IndexFromText(damaged, "x"), Error) << "byte " << i << " bit " << bit;
    }
    EXPECT_THROW((void)IndexFromText(text.substr(0, i), "x"), Error);
  }
  EXPECT_THROW((void)IndexFromText(text + " ", "x"), Error);
}

/// The body with a first line that fits it.
std::string Seal(const std::string& body)
{
  return "BanyanSeries 1 " + ToHex(HashOf(body.data(), body.size())) + "\n" + body;
}

/// Seeds that are refused at once reach none of the code behind.
TEST(IndexText, SeedsOfTheFuzzerAreRead)
{
  int seeds = 0;
  for (const auto& entry :
    std::filesystem::directory_iterator(BANYAN_GOLDEN_DIR "/../../../Fuzz/Seeds/Index"))
  {
    const std::string path = entry.path().string();
    EXPECT_NO_THROW((void)IndexFromText(Seal(ReadWholeFile(path, 1 << 20)), path)) << path;
    ++seeds;
  }
  EXPECT_GT(seeds, 0);
}

TEST(IndexText, SaysWhatIsWrong)
{
  const std::string text = IndexToText(MakeIndex(4));
  ExpectRejected("", "not a Banyan series");
  ExpectRejected("# vtk DataFile Version 3.0\n", "not a Banyan series");
  std::string other = text;
  other.replace(13, 1, "5");
  ExpectRejected(other, "newer Banyan: it has format version 5");
  other.replace(13, 1, "0");
  ExpectRejected(other, "first line");
  for (const char* const version : { "1", "2", "3", "4", "5" })
  {
    ExpectRejected("banyan-series " + std::string(version) + text.substr(14), "encode it anew");
  }
  ExpectRejected("BanyanSeries 99999999999 x", "first line");
  const std::string body = text.substr(text.find('\n') + 1);
  const auto with = [&](const std::string& from, const std::string& to)
  {
    const std::size_t at = body.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return Seal(std::string(body).replace(at, from.size(), to));
  };
  ExpectRejected(Seal("[1]"), "not a JSON object");
  ExpectRejected(Seal("{"), "cannot be understood");
  ExpectRejected(with("\"features\": []", "\"features\": [\"clouds\"]"), "knows 'clouds'");
  ExpectRejected(
    with("\"features\": []", "\"features\": [\"mesh\", \"clouds\"]"), "knows 'clouds'");
  ExpectRejected(with("\"features\": []", "\"features\": [[1]]"), "knows '[1]'");
  ExpectRejected(Seal("{ \"features\": [\"clouds\"] }"), "knows 'clouds'");
  for (const std::string& feature : KnownFeatures())
  {
    ExpectRejected(with("\"features\": []", "\"features\": [\"" + feature + "\"]"),
      "not those that the series has");
  }
  ExpectRejected(with("\"features\": []", "\"features\": \"mesh\""), "features");
  ExpectRejected(with("\"features\"", "\"creatures\""), "'features' is missing");
  ExpectRejected(with("\"levels\": 4", "\"levels\": 5"), "levels");
  ExpectRejected(with("\"levels\": 4", "\"lovels\": 4"), "'levels' is missing");
  ExpectRejected(with("\"levels\": 4", "\"levels\": 4.5"), "levels");
  ExpectRejected(with("\"levels\": 4", "\"levels\": 99999999999"), "levels");
  ExpectRejected(with("\"bytes\": 4711", "\"bytes\": -1"), "bytes");
  ExpectRejected(with("\"bytes\": 4711", "\"bytes\": 18446744073709551615"), "bytes");
  ExpectRejected(with("0123456789abcdef-000000", "../../etc/passwd"), "plain file name");
  ExpectRejected(with("0123456789abcdef-000000", ".hidden"), "plain file name");
  ExpectRejected(with("0123456789abcdef-000000", "0123456789abcdef-000001"), "same file");
  ExpectRejected(with("\"steps\": 2", "\"steps\": 1"), "follow");
  ExpectRejected(with("\"firstStep\": 2", "\"firstStep\": 3"), "follow");
  ExpectRejected(with("uint64", "uint65"), "uint65");
  ExpectRejected(with("  -1.5,", "  7.5,"), "increase");
  ExpectRejected(with("  -1.5,", "  1e999,"), "cannot be understood");
  ExpectRejected(with("  -1.5,", "  null,"), "times");
  ExpectRejected(with("  -5,", "  -2000000000,"), "2^30");
  ExpectRejected(with("  39,", "  -6,"), "no samples");
  ExpectRejected(with("\"magnitudes\": [\n    [\n     0.0,\n     0.1\n    ],", "\"magnitudes\": ["),
    "range of magnitudes for each step");
  ExpectRejected(with("\"kind\": \"table\"", "\"kind\": \"curve\""), "'curve' is not known");
  ExpectRejected(with("\"kind\": \"table\"", "\"kind\": \"asinh\""), "'scale' is missing");
  ExpectRejected(with("\"brickCells\": 16", "\"brickCells\": 15"), "16 or 32");
}

TEST(IndexText, RejectsHugeGridsBeforeAnythingElse)
{
  Grid grid;
  grid.Extent = { { 0, 0, 0 }, { 1 << 30, 1 << 30, 1 << 30 } };
  EXPECT_THROW(CheckGrid(grid, 16), Error);
  grid.Extent.Hi = { 2147483647, 1, 1 };
  EXPECT_THROW(CheckGrid(grid, 16), Error);
  grid.Extent.Hi = { 1 << 30, 1, 1 };
  CheckGrid(grid, 16);
  grid.Spacing.y = 0;
  EXPECT_THROW(CheckGrid(grid, 16), Error);
  grid.Spacing.y = std::nan("");
  EXPECT_THROW(CheckGrid(grid, 16), Error);
}

TEST(IndexText, DescriptionsThatCannotBeWrittenAreRejected)
{
  const std::vector<std::function<void(SeriesIndex&)>> spoilers = {
    [](SeriesIndex& i) { i.Times[0] = std::nan(""); },
    [](SeriesIndex& i) { i.Domain.Origin.x = INFINITY; },
    [](SeriesIndex& i) { i.Domain.Direction[1][1] = std::nan(""); },
    [](SeriesIndex& i) { i.Arrays[0].Name = "\xff\xfe"; },
    [](SeriesIndex& i) { i.Arrays[0].Name = ""; },
    [](SeriesIndex& i) { i.Arrays[0].Components.clear(); },
    [](SeriesIndex& i) { i.Arrays.push_back(i.Arrays[0]); },
    [](SeriesIndex& i) { i.ActiveScalars = "other"; },
    [](SeriesIndex& i) { i.Arrays[0].Components[0].ErrorBoundAbsolute = -1; },
    [](SeriesIndex& i) {
      i.Arrays[0].Components[0].Range = { 0, INFINITY };
    },
    [](SeriesIndex& i) { i.KeyframeInterval = 1025; },
    [](SeriesIndex& i) { i.Arrays.clear(); },
  };
  for (std::size_t s = 0; s < spoilers.size(); ++s)
  {
    SeriesIndex index = MakeIndex(5);
    spoilers[s](index);
    EXPECT_THROW((void)IndexToText(index), Error) << "case " << s;
  }
}

TEST(IndexText, SealedNonsenseIsNoCrash)
{
  const std::string text = IndexToText(MakeIndex(6));
  const std::string body = text.substr(text.find('\n') + 1);
  std::mt19937 random(31);
  int accepted = 0;
  for (int i = 0; i < 3000; ++i)
  {
    std::string changed = body;
    for (unsigned k = 0; k <= random() % 3; ++k)
    {
      const std::size_t at = random() % changed.size();
      const char* const parts[] = { "0", "-", "9", "\"", "[", "]", "{", "}", ",", "null", "1e308",
        "e", ".", "\xff", "99999999999999999999" };
      changed.replace(at, random() % 3, parts[random() % 15]);
    }
    try
    {
      (void)IndexFromText(Seal(changed), "x");
      ++accepted;
    }
    catch (const Error&)
    {
    }
  }
  EXPECT_LT(accepted, 2000);
}

} // namespace
} // namespace banyan
