// SPDX-License-Identifier: BSD-3-Clause
// Points of grids in series, by Core alone: every bit comes back, and damage is noticed.
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"
#include "Series/Points/PointsCode.h"
#include "Series/Points/PointsReader.h"

#include <fstream>

namespace banyan
{
namespace
{

using namespace banyan::testing;

/// Any bits: NaN, infinities and both zeros among them.
template <class T>
std::vector<T> AnyBits(std::size_t count, unsigned seed)
{
  std::mt19937_64 random(seed);
  std::vector<T> values(count);
  for (T& value : values)
  {
    const std::uint64_t bits = random() % 3 == 0 ? 0 : random();
    std::memcpy(&value, &bits, sizeof(T));
  }
  values[0] = static_cast<T>(-0.0);
  return values;
}

template <class T>
void ExpectAllBits(const glm::ivec3& size, int components)
{
  const std::size_t count = static_cast<std::size_t>(size.x) * size.y * size.z * components;
  const std::vector<T> values = AnyBits<T>(count, 7);
  const ScalarType type = ScalarTypeOf<T>();
  const Bytes packed =
    PackPoints(type, components, size, reinterpret_cast<const std::uint8_t*>(values.data()));
  std::vector<T> back(count);
  UnpackPoints(type, components, size, packed.data(), packed.size(),
    reinterpret_cast<std::uint8_t*>(back.data()));
  EXPECT_EQ(std::memcmp(back.data(), values.data(), count * sizeof(T)), 0);
  EXPECT_LE(packed.size(), count * sizeof(T));
  Bytes longer(count * sizeof(T) + 1);
  EXPECT_THROW(UnpackPoints(type, components, size, longer.data(), longer.size(),
                 reinterpret_cast<std::uint8_t*>(back.data())),
    Error);
  if (packed.size() < count * sizeof(T))
  {
    EXPECT_THROW(UnpackPoints(type, components, size, packed.data(), packed.size() - 1,
                   reinterpret_cast<std::uint8_t*>(back.data())),
      Error);
  }
}

TEST(PointsCode, EveryBitComesBack)
{
  for (const glm::ivec3& size : { glm::ivec3(1), glm::ivec3(5, 1, 1), glm::ivec3(1, 7, 3),
         glm::ivec3(1, 1, 9), glm::ivec3(6, 5, 4) })
  {
    ExpectAllBits<float>(size, 3);
    ExpectAllBits<double>(size, 3);
    ExpectAllBits<double>(size, 1);
    ExpectAllBits<std::int16_t>(size, 1);
    ExpectAllBits<std::uint64_t>(size, 2);
  }
}

/// Coordinates that bend along all axes, of samples x fastest.
template <class T>
std::vector<T> Bent(const glm::ivec3& samples, double time)
{
  std::vector<T> points;
  ForPositions({ glm::ivec3(0), samples },
    [&](const glm::ivec3& s)
    {
      const double r = 2.0 + 0.01 * s.x;
      points.push_back(static_cast<T>(r * std::cos(0.02 * s.y) + time));
      points.push_back(static_cast<T>(r * std::sin(0.02 * s.y)));
      points.push_back(static_cast<T>(0.1 * s.z + 0.01 * std::sin(0.1 * s.x)));
    });
  return points;
}

TEST(PointsCode, SmoothGridsTakeAFifthOfTheirBits)
{
  const glm::ivec3 samples(64);
  const std::vector<float> points = Bent<float>(samples, 0.0);
  const Bytes packed = PackPoints(
    ScalarType::Float32, 3, samples, reinterpret_cast<const std::uint8_t*>(points.data()));
  EXPECT_LT(packed.size(), points.size() * sizeof(float) / 5);
}

/// Without a checksum before it: an error or other points, and nothing more.
TEST(PointsCode, DamagedChunksAreHarmless)
{
  const glm::ivec3 samples{ 9, 8, 7 };
  const std::vector<float> points = Bent<float>(samples, 0.0);
  const Bytes packed = PackPoints(
    ScalarType::Float32, 3, samples, reinterpret_cast<const std::uint8_t*>(points.data()));
  ASSERT_LT(packed.size(), points.size() * sizeof(float));
  std::mt19937 random(3);
  std::vector<float> back(points.size());
  int errors = 0;
  for (int i = 0; i < 1000; ++i)
  {
    Bytes bad = packed;
    bad[random() % bad.size()] ^= static_cast<std::uint8_t>(1u << random() % 8);
    bad.resize(bad.size() - (i % 3 == 0 ? random() % 9 : 0));
    try
    {
      UnpackPoints(ScalarType::Float32, 3, samples, bad.data(), bad.size(),
        reinterpret_cast<std::uint8_t*>(back.data()));
    }
    catch (const Error&)
    {
      ++errors;
    }
  }
  EXPECT_GT(errors, 300);
}

/// Encodes steps of a curvilinear grid whose points move at some of them.
class GridPoints : public ::testing::Test
{
protected:
  static constexpr int Steps = 7;
  static double TimeOfPoints(int step) { return step < 2 ? 0.0 : step < 5 ? 1.0 : 0.0; }

  PointsView ViewOf(const std::vector<double>& points) const
  {
    PointsView view;
    view.Form = this->Form;
    view.Samples = this->Samples;
    view.Values[0] = points.data();
    return view;
  }

  SeriesIndex Encode()
  {
    EncodeOptions options;
    options.Mode = ErrorBoundMode::Absolute;
    options.KeyframeInterval = 2;
    options.Points = this->Form;
    SeriesEncoder encoder(this->Path, GridOf(this->Samples.x, this->Samples.y, this->Samples.z),
      { { "u", ScalarType::Float32, { "" }, {}, {} } }, options, this->Pool);
    std::vector<float> values(static_cast<std::size_t>(
      std::int64_t{ this->Samples.x } * this->Samples.y * this->Samples.z));
    for (int step = 0; step < Steps; ++step)
    {
      const std::vector<double> points = Bent<double>(this->Samples, TimeOfPoints(step));
      encoder.SetPoints(this->ViewOf(points));
      values[5] = static_cast<float>(step);
      encoder.AddStep(step, { { values.data() } });
    }
    return encoder.Finish();
  }

  std::vector<double> Read(const SeriesFile& file, int step, int level, const Box& part)
  {
    std::vector<double> points(static_cast<std::size_t>(3 * part.Count()));
    ReadPoints(file.Folder(), file.Index(), step, level, part, { points.data() }, this->Pool);
    return points;
  }

  PointsForm Form{ GridKind::Curvilinear,
    { ScalarType::Float64, ScalarType::Float64, ScalarType::Float64 } };
  glm::ivec3 Samples{ 130, 65, 3 }; ///< more chunks than one along two axes
  TemporaryFolder Folder;
  std::string Path = Folder / "grid.banyan";
  ThreadPool Pool{ 2 };
};

TEST_F(GridPoints, ComeBackAtEachStepAndLevel)
{
  const SeriesIndex index = this->Encode();
  ASSERT_EQ(index.Points->Files.size(), 3u);
  EXPECT_EQ(index.Points->Files[1].FirstStep, 2);
  EXPECT_EQ(index.Points->Files[2].FirstStep, 5);
  EXPECT_EQ(index.Points->Files[0].File, index.Points->Files[2].File);
  const auto file = SeriesFile::Open(this->Path);
  for (int step = 0; step < Steps; ++step)
  {
    const std::vector<double> wanted = Bent<double>(this->Samples, TimeOfPoints(step));
    EXPECT_EQ(this->Read(*file, step, 0, { glm::ivec3(0), this->Samples }), wanted);
    for (int level = 0; level < index.Levels; ++level)
    {
      const BrickLayout layout = file->Layout(level);
      const Box part{ layout.Samples() / 3, layout.Samples() };
      const std::vector<double> got = this->Read(*file, step, level, part);
      std::size_t at = 0;
      ForPositions(part,
        [&](const glm::ivec3& sample)
        {
          const glm::ivec3 fine = layout.FineSample(sample);
          const std::size_t from =
            3 * static_cast<std::size_t>(
                  (std::int64_t{ fine.z } * this->Samples.y + fine.y) * this->Samples.x + fine.x);
          ASSERT_EQ(got[at], wanted[from]);
          ASSERT_EQ(got[at + 2], wanted[from + 2]);
          at += 3;
        });
    }
  }
}

TEST_F(GridPoints, AnySmallDamageIsNoticed)
{
  this->Samples = { 9, 8, 7 };
  const SeriesIndex index = this->Encode();
  const auto file = SeriesFile::Open(this->Path);
  const std::string path = file->Folder() + "/" + index.Points->Files[0].File;
  const std::string content = ReadWholeFile(path, 1 << 20);
  const Box whole{ glm::ivec3(0), this->Samples };
  for (std::size_t at = 0; at < content.size(); ++at)
  {
    std::string bad = content;
    bad[at] = static_cast<char>(bad[at] ^ (1 << at % 8));
    std::ofstream(path, std::ios::binary) << bad;
    EXPECT_THROW((void)this->Read(*file, 0, 0, whole), Error) << at;
  }
  std::ofstream(path, std::ios::binary) << content;
  EXPECT_NO_THROW((void)this->Read(*file, 0, 0, whole));
}

/// Whoever makes checksums fit gets an error, or wrong points: never more.
TEST_F(GridPoints, SizesThatLieAreRefused)
{
  this->Samples = { 70, 8, 7 };
  SeriesIndex index = this->Encode();
  PointsFile& points = index.Points->Files[0];
  const auto file = SeriesFile::Open(this->Path);
  const std::string path = file->Folder() + "/" + points.File;
  const std::string content = ReadWholeFile(path, 1 << 20);
  const Box whole{ glm::ivec3(0), this->Samples };
  constexpr std::size_t head = 64 + 2 * 16;
  const auto refused = [&](std::size_t place, std::uint64_t number)
  {
    std::string bad = content;
    std::memcpy(&bad[place], &number, sizeof(number));
    const Hash128 hash = HashOf(bad.data(), head);
    points.HashLow = hash.Low;
    points.HashHigh = hash.High;
    std::ofstream(path, std::ios::binary) << bad;
    std::vector<double> values(static_cast<std::size_t>(3 * whole.Count()));
    EXPECT_THROW(
      ReadPoints(file->Folder(), index, 0, 0, whole, { values.data() }, this->Pool), Error)
      << place << " " << number;
  };
  for (const std::uint64_t number :
    { std::uint64_t{ 0 }, std::uint64_t{ 1 }, ~std::uint64_t{ 0 }, std::uint64_t{ 1 } << 40 })
  {
    refused(64 + 8, number); // bytes of the first chunk
    refused(80 + 8, number); // of the second one
    refused(16, number + 5); // chunks
  }
  refused(8, 2); // version
}

TEST_F(GridPoints, OtherFormsAndNumbersAreRefused)
{
  EncodeOptions options;
  options.Mode = ErrorBoundMode::Absolute;
  options.Points = this->Form;
  SeriesEncoder encoder(this->Path, GridOf(9, 8, 7),
    { { "u", ScalarType::Float32, { "" }, {}, {} } }, options, this->Pool);
  const std::vector<double> points = Bent<double>({ 9, 8, 7 }, 0.0);
  this->Samples = { 9, 8, 6 };
  EXPECT_THROW(encoder.SetPoints(this->ViewOf(points)), Error);
  options.Points.reset();
  SeriesEncoder plain(this->Folder / "plain.banyan", GridOf(9, 8, 7),
    { { "u", ScalarType::Float32, { "" }, {}, {} } }, options, this->Pool);
  this->Samples = { 9, 8, 7 };
  EXPECT_THROW(plain.SetPoints(this->ViewOf(points)), Error);
}

TEST_F(GridPoints, AStepWithoutPointsIsRefused)
{
  EncodeOptions options;
  options.Mode = ErrorBoundMode::Absolute;
  options.Points = this->Form;
  SeriesEncoder encoder(this->Path, GridOf(9, 8, 7),
    { { "u", ScalarType::Float32, { "" }, {}, {} } }, options, this->Pool);
  const std::vector<float> values(9 * 8 * 7);
  EXPECT_THROW(encoder.AddStep(0.0, { { values.data() } }), Error);
}

TEST_F(GridPoints, AnIndexThatDoesNotFitIsRefused)
{
  this->Samples = { 9, 8, 7 };
  const SeriesIndex index = this->Encode();
  EXPECT_EQ(FeaturesOf(index), std::vector<std::string>{ "grid points" });
  const SeriesIndex back = IndexFromText(IndexToText(index), "a");
  EXPECT_TRUE(back.Points->Form == index.Points->Form);
  EXPECT_EQ(back.Points->Files[1].HashHigh, index.Points->Files[1].HashHigh);
  const auto refused = [&](const std::function<void(SeriesIndex&)>& change)
  {
    SeriesIndex bad = index;
    change(bad);
    EXPECT_THROW((void)IndexToText(bad), Error);
  };
  refused([](SeriesIndex& bad) { bad.Points->Files.clear(); });
  refused([](SeriesIndex& bad) { bad.Points->Files[0].FirstStep = 1; });
  refused([](SeriesIndex& bad) { bad.Points->Files[1].FirstStep = 5; });
  refused([](SeriesIndex& bad) { bad.Points->Files[2].FirstStep = Steps; });
  refused([](SeriesIndex& bad) { bad.Points->Files[1].File = "../points"; });
  refused([](SeriesIndex& bad) { bad.Points->Files[2].Bytes += 1; });
  refused([](SeriesIndex& bad) { bad.Points->Form.Types[1] = ScalarType::Float32; });
  refused([](SeriesIndex& bad) { bad.Domain.Spacing.x = 2.0; });
  refused([](SeriesIndex& bad) { bad.Mesh = MeshIndex{ false, "a.mesh", 1, 0, 0, 8, 1 }; });
}

TEST_F(GridPoints, AnotherSeriesTakesTheirPlace)
{
  this->Samples = { 9, 8, 7 };
  const SeriesIndex before = this->Encode();
  this->Samples = { 9, 8, 6 };
  const SeriesIndex now = this->Encode();
  for (const PointsFile& file : before.Points->Files)
  {
    EXPECT_FALSE(std::filesystem::exists(this->Path + ".d/" + file.File));
  }
  for (const PointsFile& file : now.Points->Files)
  {
    EXPECT_TRUE(std::filesystem::exists(this->Path + ".d/" + file.File));
  }
}

TEST_F(GridPoints, NothingIsLeftOfASeriesThatIsGivenUp)
{
  {
    EncodeOptions options;
    options.Mode = ErrorBoundMode::Absolute;
    options.Points = this->Form;
    this->Samples = { 9, 8, 7 };
    SeriesEncoder encoder(this->Path, GridOf(9, 8, 7),
      { { "u", ScalarType::Float32, { "" }, {}, {} } }, options, this->Pool);
    encoder.SetPoints(this->ViewOf(Bent<double>({ 9, 8, 7 }, 0.0)));
  }
  EXPECT_TRUE(this->Folder.Empty());
}

} // namespace
} // namespace banyan
