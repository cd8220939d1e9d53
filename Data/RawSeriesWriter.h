// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_RawSeriesWriter_h
#define banyan_Data_RawSeriesWriter_h

#include <fstream>
#include <string>
#include <vector>

namespace banyan
{

/// Writes all steps of one array into one headerless file of little-endian single-precision
/// values, `[step][z][y][x][component]`, component fastest. The file gets its name only when it is
/// whole; a writer that is destroyed before `Finish` leaves nothing.
class RawSeriesWriter
{
public:
  /// Throws Error when the file cannot be made.
  explicit RawSeriesWriter(const std::string& path);
  ~RawSeriesWriter();
  RawSeriesWriter(const RawSeriesWriter&) = delete;
  RawSeriesWriter& operator=(const RawSeriesWriter&) = delete;

  /// Also takes a part of a step, when the parts come in order of memory. Throws Error when the
  /// disk is full.
  void AddStep(const std::vector<float>& values);
  void Finish();

private:
  std::string Path;
  std::ofstream File;
  bool Finished = false;
};

} // namespace banyan

#endif
