// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_RayCastMeasure_h
#define banyan_Benchmarks_RayCastMeasure_h

#include "RayCastRenderer.h"

#include <ostream>
#include <string>
#include <vector>

namespace banyan::bench
{

/// One line of the report.
struct RayCastMeasurement
{
  std::string Scene;
  std::string Renderer;
  int Threads = 1;
  Setting Accuracy;
  double FrameMilliseconds = 0; ///< median of the repeated frames
  double FirstFrameMilliseconds = 0;
  std::optional<double> TreeMilliseconds;  ///< of the first frame, where it was made
  double ProcessorMilliseconds = 0;        ///< median, of all threads together
  std::optional<double> ProbeMilliseconds; ///< medians, where the renderer tells
  std::optional<double> StrideMilliseconds;
  std::optional<std::int64_t> Samples;
  PictureError Error;                          ///< of the picture in 8 bits
  std::optional<double> LargestErrorUnrounded; ///< in 1/255, where the renderer has floats
  std::optional<double> EstimatedError;        ///< the same, as the renderer expects it
};

struct RayCastMeasuring
{
  int Threads = 1;
  int Repeat = 3;
  /// Settings that would take longer than this are timed less often than `Repeat`: at least once,
  /// and twice with one sample per voxel, which is compared most.
  double PatienceSeconds = 6.0;
  /// Of scenes and renderers that no goal compares, only one sample per voxel.
  bool GoalsOnly = false;
  std::vector<double> Settings; ///< only these sample distances and tolerances; none means all
  std::string PictureFolder;    ///< where pictures at step 1 go; empty for none
};

/// Draws a scene with all settings of all renderers: first all of them once, then up to `Repeat`
/// times in turns, so that whatever slows the machine down for a while slows down everybody.
std::vector<RayCastMeasurement> MeasureScene(const BenchScene& scene, const FloatImage& reference,
  const RendererList& renderers, const RayCastMeasuring& options);

/// Names of the columns, without the end of the line.
std::string RayCastCsvHeader();
std::string RayCastCsvLine(const RayCastMeasurement& measurement);
/// The same for people.
std::string RayCastMessage(const RayCastMeasurement& measurement);

} // namespace banyan::bench

#endif
