// SPDX-License-Identifier: BSD-3-Clause
#include "Papers/OctreeComparison.h"
#include "Programs/ProgramsTesting.h"

namespace banyan
{
namespace
{

using namespace testing;

constexpr int StepCount = 7;

TEST(OctreeComparison, IsThatOfTheDecodedCodes)
{
  const TemporaryFolder folder;
  const std::string path = folder / "corners.banyan";
  Encode(path, CornersGrid(), Sample<float>(CornersGrid(), StepCount, CornersAt), CornersOptions());
  const auto file = SeriesFile::Open(path);
  const OctreeComparison all = CompareWithOctree(*file, 0, 0, 0, StepCount);
  const ValueRange range = file->Index().Arrays[0].Components[0].Range;
  std::uint64_t bytes = 0;
  std::vector<std::uint16_t> previous;
  for (int step = 0; step < StepCount; ++step)
  {
    std::vector<std::uint16_t> codes;
    for (const float value : ReadAll<float>(*file, { step, 0, 0, 0 }))
    {
      codes.push_back(static_cast<std::uint16_t>(
        std::min(255.0, std::floor((value - range.Low) / (range.High - range.Low) * 256))));
    }
    bytes += EncodePaperOctree(
      codes.data(), previous.empty() ? nullptr : previous.data(), { 80, 48, 34 }, 8)
               .Stream.size();
    previous = codes;
  }
  EXPECT_EQ(all.UniformBits, 8 * bytes);
  EXPECT_LT(all.UniformCodes, all.UniformBits);
  EXPECT_GT(all.AdaptiveBits, 0u);
  EXPECT_EQ(all.Voxels, 80 * 48 * 34 * StepCount);
  // One step by itself is encoded after the one before.
  const OctreeComparison one = CompareWithOctree(*file, 0, 0, 2, 3);
  ASSERT_EQ(one.Steps.size(), 1u);
  EXPECT_EQ(one.Steps[0].Bits(), all.Steps[2].Bits());
  EXPECT_EQ(one.Steps[0].MergedSubtrees, all.Steps[2].MergedSubtrees);
  // The program prints the same.
  const ProgramResult result = RunProgram(std::string(BANYAN_BENCH_OCTREES) + " " + path);
  EXPECT_EQ(result.Status, 0);
  for (const char* phrase : { "values in the study's octrees", "uniform quantizer",
         "adaptive quantizer", "macro voxels", "merged subtrees" })
  {
    EXPECT_NE(result.Output.find(phrase), std::string::npos) << phrase << "\n" << result.Output;
  }
  EXPECT_NE(RunProgram(std::string(BANYAN_BENCH_OCTREES) + " " + (folder / "none")).Status, 0);
}

} // namespace
} // namespace banyan
