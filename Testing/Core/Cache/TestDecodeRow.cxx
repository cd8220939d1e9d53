// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Error.h"

#include <cstring>
#include <limits>

namespace banyan::testing
{
namespace
{

/// Samples of a part, brick by brick and sample by sample.
template <class T>
std::vector<T> ByBricks(const SeriesFile& file, const FieldKey& field, std::int64_t first,
  int count, const Box& part, const glm::i64vec3& stride, std::vector<T> values)
{
  for (int k = 0; k < count; ++k)
  {
    const Box samples = file.Layout(field.Level).SamplesOf(first + k);
    const glm::ivec3 n = samples.Size();
    std::vector<T> brick(static_cast<std::size_t>(samples.Count()));
    file.DecodeBrick(field, first + k, brick.data());
    const Box own = Intersection(samples, part);
    for (int z = own.Lo.z; z < own.Hi.z; ++z)
    {
      for (int y = own.Lo.y; y < own.Hi.y; ++y)
      {
        for (int x = own.Lo.x; x < own.Hi.x; ++x)
        {
          const glm::ivec3 from = glm::ivec3(x, y, z) - samples.Lo;
          const glm::ivec3 to = glm::ivec3(x, y, z) - part.Lo;
          values[static_cast<std::size_t>(to.x * stride.x + to.y * stride.y + to.z * stride.z)] =
            brick[static_cast<std::size_t>((from.z * n.y + from.y) * n.x + from.x)];
        }
      }
    }
  }
  return values;
}

/// Rows of one, of all and of some bricks, whole and in part, at all levels and steps.
template <class T>
void CheckRows(const glm::ivec3& size, Steps<T> steps, int cells)
{
  const TemporaryFolder folder;
  EncodeOptions options;
  options.BrickCells = cells;
  Encode(folder / "s.banyan", GridOf(size.x, size.y, size.z), steps, options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  std::mt19937 random(size.x);
  for (int level = 0; level < file->Index().Levels; ++level)
  {
    const BrickLayout layout = file->Layout(level);
    const glm::ivec3 bricks = layout.Bricks();
    for (int round = 0; round < 24; ++round)
    {
      const FieldKey field{ static_cast<int>(random() % steps.size()), 0, 0, level };
      const int begin = static_cast<int>(random() % static_cast<unsigned>(bricks.x));
      const int count =
        round == 0 ? bricks.x - begin
                   : 1 + static_cast<int>(random() % static_cast<unsigned>(bricks.x - begin));
      const std::int64_t first =
        layout.IndexOf({ begin, static_cast<int>(random() % static_cast<unsigned>(bricks.y)),
          static_cast<int>(random() % static_cast<unsigned>(bricks.z)) });
      Box part{ layout.SamplesOf(first).Lo, layout.SamplesOf(first + count - 1).Hi };
      if (round % 2 == 1)
      {
        part.Lo = glm::min(part.Lo + glm::ivec3(3, 1, 2), part.Hi - 1);
        part.Lo.x = std::min(part.Lo.x, layout.SamplesOf(first).Hi.x - (count > 1 ? 2 : 1));
      }
      const glm::ivec3 n = part.Size();
      const int gap = 1 + round % 3;
      const glm::i64vec3 stride{ gap, gap * n.x + 1, (gap * n.x + 1) * n.y };
      std::vector<T> values(static_cast<std::size_t>(stride.z * n.z), T(3));
      const std::vector<T> expected = ByBricks<T>(*file, field, first, count, part, stride, values);
      file->DecodeRow(field, first, count, part, stride, values.data());
      EXPECT_EQ(std::memcmp(values.data(), expected.data(), values.size() * sizeof(T)), 0)
        << "level " << level << ", bricks " << first << " and " << count - 1 << " more, step "
        << field.Step;
    }
  }
}

template <class T>
void CheckRows(const glm::ivec3& size, int cells)
{
  CheckRows<T>(size, Sample<T>(GridOf(size.x, size.y, size.z), 5, Wavy<T>), cells);
}

} // namespace

TEST(DecodeRow, IsWhatItsBricksHold)
{
  CheckRows<float>({ 180, 40, 17 }, 16); // longer than what is kept at once
  CheckRows<float>({ 50, 33, 17 }, 16);
  CheckRows<double>({ 33, 34, 18 }, 16);
  CheckRows<std::int16_t>({ 100, 17, 33 }, 16);
  CheckRows<float>({ 1, 40, 40 }, 16);
}

TEST(DecodeRow, HoldsForAnyOrderOfAxes)
{
  for (int smooth = 0; smooth < 3; ++smooth)
  {
    const auto along = [smooth](int x, int y, int z, int step)
    {
      const double fast[3] = { 0.05 * x, 0.05 * y, 0.05 * z };
      const double slow[3] = { 0.9 * x, 0.9 * y, 0.9 * z };
      double value = 0.1 * step;
      for (int a = 0; a < 3; ++a)
      {
        value += std::sin(a == smooth ? fast[a] : slow[a]);
      }
      return value;
    };
    CheckRows<float>({ 40, 36, 34 }, Sample<float>(GridOf(40, 36, 34), 3, along), 16);
  }
}

TEST(DecodeRow, HoldsWithExceptionsAndBricksOfOneValue)
{
  auto steps = Sample<float>(GridOf(140, 36, 36), 3, Wavy<float>);
  steps[1][40] = std::numeric_limits<float>::quiet_NaN();
  CheckRows<float>({ 140, 36, 36 }, steps, 16);
  const auto flat = [](int x, int y, int, int step)
  { return x < 60 ? 5.0 : std::sin(0.2 * x + 0.1 * y + step); };
  CheckRows<float>({ 140, 36, 36 }, Sample<float>(GridOf(140, 36, 36), 3, flat), 16);
}

TEST(DecodeRow, RefusesPartsOutsideOfTheRow)
{
  const TemporaryFolder folder;
  const Grid grid = GridOf(70, 36, 36);
  EncodeOptions options;
  options.BrickCells = 16;
  Encode(folder / "s.banyan", grid, Sample<float>(grid, 1, Wavy<float>), options);
  const auto file = SeriesFile::Open(folder / "s.banyan");
  std::vector<float> values(70 * 70 * 36);
  const auto refused = [&](std::int64_t first, int count, const Box& part) {
    EXPECT_THROW(file->DecodeRow({}, first, count, part, { 1, 70, 4900 }, values.data()), Error);
  };
  const int bricks = file->Layout(0).Bricks().x;
  file->DecodeRow({}, 0, 2, { { 0, 0, 0 }, { 33, 17, 17 } }, { 1, 70, 4900 }, values.data());
  refused(0, 2, { { 0, 0, 0 }, { 34, 17, 17 } });
  refused(0, 2, { { 0, 0, 0 }, { 33, 18, 17 } });
  refused(1, 2, { { 15, 0, 0 }, { 40, 17, 17 } });
  refused(0, 2, { { 17, 0, 0 }, { 33, 17, 17 } }); // the first brick would hold none of it
  refused(0, 0, { { 0, 0, 0 }, { 16, 17, 17 } });
  refused(0, bricks + 1, { { 0, 0, 0 }, { 70, 17, 17 } }); // goes on in the next row
  refused(0, 2, { { 4, 4, 4 }, { 4, 17, 17 } });
}

} // namespace banyan::testing
