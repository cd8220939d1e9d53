// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Timer.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

#ifdef BANYAN_TESTS_HAVE_ZLIB
#include <zlib.h>
#endif

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

std::vector<std::string> FilesOf(const std::string& dataset, const std::string& extension)
{
  std::vector<std::string> files;
  const char* data = std::getenv("BANYAN_DATA_DIR");
  const std::string folder = std::string(data != nullptr ? data : "") + "/" + dataset;
  if (data != nullptr && fs::is_directory(folder))
  {
    for (const auto& entry : fs::directory_iterator(folder))
    {
      if (entry.path().extension() == extension)
      {
        files.push_back(entry.path().string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string ReadFile(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), {} };
}

std::vector<float> AsFloats(const std::string& bytes)
{
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
  return values;
}

/// Encodes and reads on one thread, checks every voxel, and says what it cost.
void Measure(const std::string& name, const Grid& grid, const Steps<float>& steps)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  Timer timer;
  const SeriesIndex index = Encode(path, grid, steps, {}, 1);
  const double encodeSeconds = timer.Seconds();
  const auto file = SeriesFile::Open(path);
  const ComponentIndex& component = index.Arrays[0].Components[0];
  ThreadPool::SetProcessWidth(1);
  double decodeSeconds = 0;
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    timer.Restart();
    const std::vector<float> decoded = ReadAll<float>(*file, { static_cast<int>(s), 0, 0, 0 });
    decodeSeconds += timer.Seconds();
    EXPECT_TRUE(WithinBound(steps[s], decoded, component.ErrorBoundAbsolute)) << "step " << s;
  }
  ThreadPool::SetProcessWidth(0);
  std::uint64_t bytes = fs::file_size(path);
  for (const SegmentIndex& segment : index.Segments)
  {
    bytes += segment.Bytes;
  }
  const double voxels = static_cast<double>(component.FiniteCount + component.NonFiniteCount);
  const double bitsPerVoxel = 8 * static_cast<double>(bytes) / voxels;
  const double psnr = 20 * std::log10(component.PromisedRange.Width() /
                                      std::sqrt(component.SumSquaredError / voxels));
  std::printf("%s: %.3f bits per voxel, PSNR %.1f dB, encoded at %.0f MB/s, read at %.0f MB/s\n",
    name.c_str(), bitsPerVoxel, psnr, 4e-6 * voxels / encodeSeconds, 4e-6 * voxels / decodeSeconds);
  EXPECT_LT(bitsPerVoxel, 8) << "no better than plain 8-bit codes";
  EXPECT_GT(psnr, 54) << "uniform errors of range / 512 give 58.9 dB";
  EXPECT_LE(component.MeasuredMaxError, component.ErrorBoundAbsolute);
  EXPECT_EQ(index.Statistics.RawBricks, 0);
}

TEST(RealData, ViscousFingers)
{
  const auto files = FilesOf("viscous_fingers_run01", ".raw");
  if (files.empty())
  {
    GTEST_SKIP() << "BANYAN_DATA_DIR has no viscous_fingers_run01";
  }
  Steps<float> steps;
  for (const std::string& file : files)
  {
    steps.push_back(AsFloats(ReadFile(file)));
    ASSERT_EQ(steps.back().size(), 64u * 64 * 64) << file;
  }
  EXPECT_EQ(steps.size(), 17u);
  Measure("viscous fingers", GridOf(64, 64, 64), steps);
}

#ifdef BANYAN_TESTS_HAVE_ZLIB
std::string FromBase64(const std::string& text)
{
  static const std::string digits =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text)
  {
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos)
    {
      continue; // white space and padding
    }
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8)
    {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255);
    }
  }
  return bytes;
}

/// The values of the only array of a VTK image file with inline, zlib-compressed binary data and
/// 32-bit headers.
std::vector<float> ReadInlineImage(const std::string& path)
{
  const std::string text = ReadFile(path);
  const std::size_t start = text.find('>', text.find("<DataArray")) + 1;
  std::string body = text.substr(start, text.find('<', start) - start);
  body.erase(std::remove_if(body.begin(), body.end(), ::isspace), body.end());
  const auto number = [](const std::string& bytes, std::size_t i)
  {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + 4 * i, 4);
    return std::size_t{ value };
  };
  const std::size_t blocks = number(FromBase64(body.substr(0, 8)), 0);
  const std::size_t headerDigits = (4 * (3 + blocks) + 2) / 3 * 4;
  const std::string header = FromBase64(body.substr(0, headerDigits));
  const std::string packed = FromBase64(body.substr(headerDigits));
  std::string values;
  std::size_t at = 0;
  for (std::size_t b = 0; b < blocks; ++b)
  {
    const bool last = b + 1 == blocks && number(header, 2) != 0;
    std::string block(number(header, last ? 2 : 1), '\0');
    uLongf size = block.size();
    if (uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
          reinterpret_cast<const Bytef*>(packed.data()) + at, number(header, 3 + b)) != Z_OK)
    {
      ADD_FAILURE() << path << " cannot be unpacked";
    }
    at += number(header, 3 + b);
    values += block;
  }
  return AsFloats(values);
}

TEST(RealData, HurricaneIsabel)
{
  const auto files = FilesOf("isabel_velmag", ".vti");
  if (files.empty())
  {
    GTEST_SKIP() << "BANYAN_DATA_DIR has no isabel_velmag";
  }
  Steps<float> steps;
  for (const std::string& file : files)
  {
    steps.push_back(ReadInlineImage(file));
    ASSERT_EQ(steps.back().size(), 125u * 125 * 25) << file;
  }
  EXPECT_EQ(steps.size(), 8u);
  Measure("hurricane Isabel", GridOf(125, 125, 25), steps);
}
#endif

} // namespace
} // namespace banyan::testing
