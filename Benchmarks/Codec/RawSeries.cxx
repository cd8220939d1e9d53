// SPDX-License-Identifier: BSD-3-Clause
#include "RawSeries.h"

#include "Base/Error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace banyan::bench
{
namespace
{

namespace fs = std::filesystem;

std::vector<float> ReadFloats(const std::string& path, std::uint64_t count)
{
  std::error_code problem;
  const std::uint64_t bytes = fs::file_size(path, problem);
  if (problem)
  {
    throw Error("The file of raw values cannot be read.", { path });
  }
  if (bytes != count * sizeof(float))
  {
    throw Error("The file of raw values has another size than its description says.",
      { path, {}, bytes, count * sizeof(float) });
  }
  std::vector<float> values(count);
  std::ifstream stream(path, std::ios::binary);
  stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(bytes));
  if (!stream)
  {
    throw Error("The file of raw values cannot be read.", { path });
  }
  return values;
}

/// The value that `percentile` percent of the finite values do not exceed.
float PercentileOf(std::vector<float> values, double percentile)
{
  const auto end =
    std::remove_if(values.begin(), values.end(), [](float value) { return !std::isfinite(value); });
  const auto count = end - values.begin();
  const auto place = std::min<std::ptrdiff_t>(
    count - 1, static_cast<std::ptrdiff_t>(percentile / 100.0 * static_cast<double>(count)));
  std::nth_element(values.begin(), values.begin() + place, end);
  return values[static_cast<std::size_t>(place)];
}

} // namespace

RawSeries RawSeries::Open(const std::string& description)
{
  try
  {
    std::ifstream stream(description);
    const nlohmann::json json = nlohmann::json::parse(stream);
    const auto& samples = json.at("samples");
    const glm::ivec3 counts(samples.at(0), samples.at(1), samples.at(2));
    const int steps = json.at("steps");
    constexpr int largest = 1 << 15;
    for (const int count : { counts.x, counts.y, counts.z, steps })
    {
      if (count < 1 || count > largest)
      {
        throw Error(
          "The numbers of samples and steps have to lie between 1 and 32768.", { description });
      }
    }
    const std::uint64_t values =
      std::uint64_t(counts.x) * counts.y * std::uint64_t(counts.z) * steps;
    const fs::path raw = fs::path(description).parent_path() / json.at("file").get<std::string>();
    return { json.at("name"), counts, ReadFloats(raw.string(), values),
      json.value("range_percentile", 100.0) };
  }
  catch (const nlohmann::json::exception& problem)
  {
    throw Error(std::string("The description of a raw series is damaged: ") + problem.what(),
      { description });
  }
}

RawSeries::RawSeries(
  const std::string& name, const glm::ivec3& samples, std::vector<float> values, double percentile)
  : SeriesName(name)
  , SampleCounts(samples)
  , Values(std::move(values))
{
  const std::size_t voxels = this->VoxelsPerStep();
  if (this->Values.empty() || this->Values.size() % voxels != 0)
  {
    throw Error("The series '" + name + "' has no whole number of steps.");
  }
  this->StepCount = static_cast<int>(this->Values.size() / voxels);
  for (const float value : this->Values)
  {
    if (std::isfinite(value))
    {
      this->Full.Include(value);
    }
  }
  if (this->Full.Empty() || !(percentile > 0.0 && percentile <= 100.0))
  {
    throw Error("The series '" + name + "' has no finite value, or no valid percentile.");
  }
  this->Cut = this->Full;
  if (percentile < 100.0)
  {
    this->Cut.High = PercentileOf(this->Values, percentile);
  }
}

std::size_t RawSeries::VoxelsPerStep() const
{
  return std::size_t(this->SampleCounts.x) * this->SampleCounts.y * this->SampleCounts.z;
}

const float* RawSeries::Step(int step) const
{
  return this->Values.data() + this->VoxelsPerStep() * static_cast<std::size_t>(step);
}

Grid RawSeries::Domain() const
{
  Grid grid;
  grid.Extent.Hi = this->SampleCounts;
  return grid;
}

} // namespace banyan::bench
