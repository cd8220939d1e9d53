// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_RawSource_h
#define banyan_Programs_RawSource_h

#include "SourceSteps.h"

#include <fstream>

namespace banyan
{

/// Steps of one array in files without a header, little-endian, each file with one or more whole
/// steps: `[step][z][y][x][component]`.
class RawSource : public SourceSteps
{
public:
  /// Throws Error when a file cannot be read, or does not hold whole steps.
  RawSource(std::vector<std::string> files, const SourceArray& array, const glm::ivec3& samples);

  bool Next(SourceStep& step) override;
  void ReadValues(std::size_t array, std::vector<std::uint8_t>& values) override;

private:
  std::vector<std::string> Files;
  SourceArray Array;
  glm::ivec3 Samples;
  std::size_t File = 0;    ///< the next one to open
  std::int64_t Left = 0;   ///< steps that the open one still has
  std::int64_t InFile = 0; ///< number of the step at hand in it
  std::ifstream Stream;
};

} // namespace banyan

#endif
