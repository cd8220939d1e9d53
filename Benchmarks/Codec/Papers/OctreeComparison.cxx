// SPDX-License-Identifier: BSD-3-Clause
#include "Papers/OctreeComparison.h"

#include "Cache/BrickCache.h"
#include "Papers/PaperQuantizer.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// The codes of one step under both quantizers.
struct StepCodes
{
  std::vector<std::uint16_t> Uniform;
  AdaptiveCodes Adaptive;
};

std::uint64_t OctreeBits(const std::vector<std::uint16_t>& codes,
  const std::vector<std::uint16_t>* previous, const glm::ivec3& samples, PaperOctreeCounts& counts)
{
  PaperOctreeStep step = EncodePaperOctree(
    codes.data(), previous ? previous->data() : nullptr, samples, OctreeComparison::Bits);
  counts = std::move(step.Counts);
  return 8 * step.Stream.size();
}

} // namespace

OctreeComparison CompareWithOctree(
  const SeriesFile& file, int array, int component, int first, int end)
{
  const ArrayIndex& index = file.Index().Arrays[static_cast<std::size_t>(array)];
  const ValueRange range = index.Components[static_cast<std::size_t>(component)].Range;
  const PaperQuantizer quantizer{ range, OctreeComparison::Bits };
  const glm::ivec3 samples = file.Layout(0).Samples();
  const Box whole{ glm::ivec3(0), samples };
  std::vector<std::uint8_t> values(static_cast<std::size_t>(whole.Count()) * SizeOf(index.Type));
  OctreeComparison result;
  StepCodes previous;
  for (int step = std::max(first - 1, 0); step < end; ++step)
  {
    const bool after = !previous.Uniform.empty();
    ReadRegion(
      BrickCache::Of(file), file, { step, array, component, 0 }, whole, values.data(), 1, 0);
    StepCodes codes{ QuantizeUniform(quantizer, index.Type, values.data(), whole.Count()),
      QuantizeAdaptive(quantizer, index.Type, values.data(), samples, OctreeComparison::Subdomain,
        after ? &previous.Adaptive : nullptr) };
    if (step >= first)
    {
      PaperOctreeCounts counts;
      PaperOctreeCounts ofAdaptive;
      result.Voxels += whole.Count();
      result.UniformBits +=
        OctreeBits(codes.Uniform, after ? &previous.Uniform : nullptr, samples, counts);
      result.AdaptiveBits += codes.Adaptive.OriginBits +
                             OctreeBits(codes.Adaptive.Codes,
                               after ? &previous.Adaptive.Codes : nullptr, samples, ofAdaptive);
      result.UniformCodes += counts.CodeBits;
      result.Steps.push_back(std::move(counts));
    }
    previous = std::move(codes);
  }
  return result;
}

} // namespace banyan
