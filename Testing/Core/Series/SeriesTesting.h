// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_SeriesTesting_h
#define banyan_Testing_SeriesTesting_h

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Encode/SeriesEncoder.h"
#include "Series/Quantize/ValueArithmetic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <stdlib.h>

namespace banyan::testing
{

/// A folder of its own, removed at the end.
class TemporaryFolder
{
public:
  TemporaryFolder()
  {
    std::string name = (std::filesystem::temp_directory_path() / "banyan-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
    {
      throw std::runtime_error("no temporary folder");
    }
    this->Name = name;
  }
  ~TemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(this->Name, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string operator/(const std::string& file) const { return this->Name + "/" + file; }
  const std::string& Path() const { return this->Name; }
  bool Empty() const { return std::filesystem::is_empty(this->Name); }

private:
  std::string Name;
};

inline Grid GridOf(int x, int y, int z)
{
  Grid grid;
  grid.Extent.Hi = { x, y, z };
  return grid;
}

template <class T>
ValueRange RangeOf(const std::vector<T>& values)
{
  ValueRange range;
  for (const T value : values)
  {
    if (std::isfinite(static_cast<double>(value)))
    {
      range.Include({ DoubleNotAbove(value), DoubleNotBelow(value) });
    }
  }
  return range;
}

/// Steps of one array with one component, `[step][z][y][x]`.
template <class T>
using Steps = std::vector<std::vector<T>>;

/// f(x, y, z, step) at every sample.
template <class T, class Function>
Steps<T> Sample(const Grid& grid, int steps, Function&& f)
{
  const glm::ivec3 n = grid.Samples();
  Steps<T> result;
  for (int s = 0; s < steps; ++s)
  {
    std::vector<T> values;
    values.reserve(static_cast<std::size_t>(grid.Extent.Count()));
    for (int z = 0; z < n.z; ++z)
    {
      for (int y = 0; y < n.y; ++y)
      {
        for (int x = 0; x < n.x; ++x)
        {
          values.push_back(static_cast<T>(f(x, y, z, s)));
        }
      }
    }
    result.push_back(std::move(values));
  }
  return result;
}

template <class T>
ArrayDescription Describe(const Steps<T>& steps, const std::string& name = "values")
{
  ArrayDescription description;
  description.Name = name;
  description.Type = ScalarTypeOf<T>();
  description.ComponentNames = { "" };
  ValueRange range;
  for (const auto& step : steps)
  {
    range.Include(RangeOf(step));
  }
  description.SeriesRanges = { range };
  return description;
}

template <class T>
SeriesIndex Encode(const std::string& path, const Grid& grid, const Steps<T>& steps,
  const EncodeOptions& options, int threads = 2)
{
  ThreadPool pool(threads);
  SeriesEncoder encoder(path, grid, { Describe(steps) }, options, pool);
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
  }
  return encoder.Finish();
}

/// The whole of one field.
template <class T>
std::vector<T> ReadAll(const SeriesFile& file, const FieldKey& field)
{
  const Box whole = { glm::ivec3(0), file.Layout(field.Level).Samples() };
  std::vector<T> values(static_cast<std::size_t>(whole.Count()));
  BrickCache cache(std::uint64_t{ 1 } << 28);
  ReadRegion(cache, file, field, whole, values.data(), 1, 0);
  return values;
}

template <class T>
bool SameBits(T a, T b)
{
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

/// Every voxel within the bound in its own type; NaN and infinities bit-exact.
template <class T>
::testing::AssertionResult WithinBound(
  const std::vector<T>& original, const std::vector<T>& decoded, double bound)
{
  if (original.size() != decoded.size())
  {
    return ::testing::AssertionFailure() << "sizes differ";
  }
  for (std::size_t i = 0; i < original.size(); ++i)
  {
    const bool finite = std::isfinite(static_cast<double>(original[i]));
    using Wide = long double;
    const Wide error = static_cast<Wide>(decoded[i]) - static_cast<Wide>(original[i]);
    if (finite ? !(std::abs(error) <= static_cast<Wide>(bound))
               : !SameBits(original[i], decoded[i]))
    {
      return ::testing::AssertionFailure() << "voxel " << i << ": " << +original[i] << " became "
                                           << +decoded[i] << ", bound " << bound;
    }
  }
  return ::testing::AssertionSuccess();
}

/// Encodes, opens, and checks every voxel of every step at the finest level.
template <class T>
SeriesIndex RoundTrip(const Grid& grid, const Steps<T>& steps, const EncodeOptions& options)
{
  const TemporaryFolder folder;
  const std::string path = folder / "series.banyan";
  const SeriesIndex index = Encode(path, grid, steps, options);
  const auto file = SeriesFile::Open(path);
  const double bound = index.Arrays[0].Components[0].ErrorBoundAbsolute;
  EXPECT_EQ(file->Index().Steps(), static_cast<int>(steps.size()));
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    const auto decoded = ReadAll<T>(*file, { static_cast<int>(s), 0, 0, 0 });
    EXPECT_TRUE(WithinBound(steps[s], decoded, bound)) << "step " << s;
  }
  return file->Index();
}

/// A smooth field with some noise, in the range of T.
template <class T>
double Wavy(int x, int y, int z, int step)
{
  const double smooth =
    std::sin(0.21 * x + 0.1 * step) * std::cos(0.17 * y) * std::sin(0.3 * z + 1);
  const double noise = 0.02 * std::sin(12.9898 * x + 78.233 * y + 37.719 * z + step);
  const double unit = 0.5 + 0.48 * smooth + 0.5 * noise;
  if (std::is_floating_point_v<T>)
  {
    return 100.0 * unit - 30.0;
  }
  const double high = std::min(static_cast<double>(std::numeric_limits<T>::max()), 1e15);
  const double low = std::max(static_cast<double>(std::numeric_limits<T>::lowest()), -1e15);
  return std::floor(low + (high - low) * unit);
}

} // namespace banyan::testing

#endif
