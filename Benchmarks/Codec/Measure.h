// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Measure_h
#define banyan_Benchmarks_Measure_h

#include "CodecMethod.h"

#include "Codec/DecodeStages.h"

#include <optional>
#include <string>

namespace banyan::bench
{

struct MeasureOptions
{
  int Repeat = 3; ///< timed passes; their median counts
  /// No further pass begins once the passes of one kind took this long together.
  double PatienceSeconds = 20;
  bool Stages = false;    ///< one more pass counts the stages of decoding
  int Bricks = 2000;      ///< random bricks per timed pass
  std::string WorkFolder; ///< exists; each encoding gets a folder of its own in it, removed later
};

/// One line of the report.
struct Measurement
{
  std::string Dataset;
  std::string Method;
  int BitsOfAccuracy = 0;
  double ErrorBound = 0;
  double LargestError = 0;
  double Range = 0; ///< that the bound and the PSNR refer to
  double SignalToNoiseDecibels = 0;
  std::uint64_t Bytes = 0;
  double BitsPerVoxel = 0;
  double EncodeMegabytesPerSecond = 0; ///< of float32 values, 10^6 bytes
  double DecodeMegabytesPerSecond = 0;
  std::optional<double> RandomBrickMicroseconds; ///< nothing is decoded before
  std::optional<double> FinestBrickMicroseconds; ///< the coarser planes are, where they are kept
  std::optional<double> KeptBrickMicroseconds;   ///< the brick itself is, where it is kept
  std::optional<stages::Spent> Decoding;         ///< of all samples, of one pass
  double Samples = 0;                            ///< of all steps
  std::size_t SamplesOfStep = 0;

  /// LargestError / ErrorBound; for a bound of 0 it is 0 or infinite.
  double ErrorOverBound() const;
};

/// The absolute bound that `bits` of accuracy stand for.
double ErrorBoundFor(const RawSeries& series, int bits);

/// Encodes all steps, decodes all steps in order, then decodes random bricks by themselves: with
/// nothing decoded before, and with what the decoder keeps. Before the timed passes of decoding
/// comes one that compares what is decoded with the original. Times are processor time of the whole
/// process, so that threads which a method starts do not help it, and other users of the machine
/// disturb less. Throws what the method throws.
Measurement Measure(
  CodecMethod& method, const RawSeries& series, int bits, const MeasureOptions& options);

} // namespace banyan::bench

#endif
