// SPDX-License-Identifier: BSD-3-Clause
// Memory that encoding takes goes with a group, and not with the series.
#include "Series/SeriesTesting.h"

#include <cstdio>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define BANYAN_TEST_SANITIZED
#elif defined(__has_feature) // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define BANYAN_TEST_SANITIZED
#endif
#endif

namespace banyan::testing
{
namespace
{

constexpr int Samples = 96;
constexpr int StepsOfGroup = 8;
constexpr std::int64_t StepBytes = std::int64_t{ Samples } * Samples * Samples * sizeof(float);

/// Values that are costly to code: smooth ones, and noise of two error bounds.
std::vector<float> StepOf(int number)
{
  std::mt19937 random(static_cast<unsigned>(number));
  std::uniform_real_distribution<float> noise(-0.008f, 0.008f);
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(Samples) * Samples * Samples);
  for (int z = 0; z < Samples; ++z)
  {
    for (int y = 0; y < Samples; ++y)
    {
      const double smooth = std::sin(0.05 * y + 0.1 * number) * std::cos(0.07 * z);
      for (int x = 0; x < Samples; ++x)
      {
        values.push_back(static_cast<float>(smooth * std::sin(0.06 * x)) + noise(random));
      }
    }
  }
  return values;
}

void Encode(const std::string& path, int groups)
{
  ThreadPool pool(2);
  ArrayDescription description;
  description.Name = "a";
  description.Type = ScalarType::Float32;
  description.ComponentNames = { "" };
  description.SeriesRanges = { { -1.01, 1.01 } };
  SeriesEncoder encoder(path, GridOf(Samples, Samples, Samples), { description }, {}, pool);
  for (int step = 0; step < groups * StepsOfGroup; ++step)
  {
    const std::vector<float> values = StepOf(step);
    encoder.AddStep(step, { { values.data() } });
  }
  if (groups > 0)
  {
    encoder.Finish();
  }
}

/// The largest memory that a process of its own has had resident while it encoded so many groups.
std::int64_t PeakBytes(int groups)
{
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0)
  {
    int status = 0;
    try
    {
      Encode(folder / "s.banyan", groups);
    }
    catch (const std::exception& error)
    {
      std::fprintf(stderr, "%s\n", error.what());
      status = 1;
    }
    _exit(status);
  }
  int status = 1;
  rusage usage{};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0);
  return std::int64_t{ usage.ru_maxrss } << 10;
}

TEST(EncodingMemory, GoesWithAGroup)
{
#ifdef BANYAN_TEST_SANITIZED
  GTEST_SKIP() << "Sanitizers keep what was given back.";
#endif
  const std::int64_t nothing = PeakBytes(0);
  const std::int64_t two = PeakBytes(2);
  const std::int64_t six = PeakBytes(6);
  const double group = static_cast<double>(StepsOfGroup * StepBytes);
  std::printf("beside the process, of two groups %.2f times the values of a group, of six %.2f\n",
    static_cast<double>(two - nothing) / group, static_cast<double>(six - nothing) / group);
  EXPECT_GT(static_cast<double>(two - nothing), group);
  EXPECT_LT(static_cast<double>(six - nothing), 1.1 * static_cast<double>(two - nothing));
  // 2.6, as limits.md says, and not one more copy of the values.
  EXPECT_LT(static_cast<double>(six - nothing), 3.4 * group);
}

} // namespace
} // namespace banyan::testing
