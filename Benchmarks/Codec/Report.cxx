// SPDX-License-Identifier: BSD-3-Clause
#include "Report.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <vector>

namespace banyan::bench
{
namespace
{

std::string Number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string NumberOrNothing(const std::optional<double>& value)
{
  return value ? Number(*value) : std::string();
}

std::string MessageOf(const Measurement& m)
{
  char text[256];
  std::snprintf(text, sizeof(text),
    "%-12s %2d bits  %-18s %8.4f bits/voxel  error/bound %6.4f  %5.0f / %5.0f MB/s",
    m.Dataset.c_str(), m.BitsOfAccuracy, m.Method.c_str(), m.BitsPerVoxel, m.ErrorOverBound(),
    m.EncodeMegabytesPerSecond, m.DecodeMegabytesPerSecond);
  std::string message = text;
  if (m.RandomBrickMicroseconds)
  {
    std::snprintf(text, sizeof(text), "  %7.1f us/brick", *m.RandomBrickMicroseconds);
    message += text;
  }
  if (m.FinestBrickMicroseconds && m.KeptBrickMicroseconds)
  {
    std::snprintf(text, sizeof(text), " (coarser planes kept: %.1f, all kept: %.1f)",
      *m.FinestBrickMicroseconds, *m.KeptBrickMicroseconds);
    message += text;
  }
  return message;
}

/// What writing one value takes where as many are written as a step has, and nothing else is done.
double TicksOfFilling(std::size_t count)
{
  count = std::min(count, std::size_t{ 1 } << 26);
  std::vector<float> values(count);
  std::vector<char> others(std::size_t{ 64 } << 20);
  std::vector<double> times;
  for (int pass = 0; pass < 5; ++pass)
  {
    std::fill(others.begin(), others.end(), static_cast<char>(pass)); // takes the caches
    const auto begin = std::chrono::steady_clock::now();
    std::fill(values.begin(), values.end(), static_cast<float>(pass));
    times.push_back(
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  std::sort(times.begin(), times.end());
  return times[times.size() / 2] * stages::TicksPerSecond() / static_cast<double>(count);
}

/// A line per stage: ticks of the processor's clock per sample, the share of all, how often.
std::string StagesOf(const Measurement& m)
{
  const stages::Spent& spent = *m.Decoding;
  double all = 0;
  for (const std::uint64_t ticks : spent.Ticks)
  {
    all += static_cast<double>(ticks);
  }
  char text[128];
  std::snprintf(
    text, sizeof(text), "  %-28s %8s %7s %10s\n", "stage of decoding", "cycles", "%", "times");
  std::string table = text;
  for (int stage = 0; stage < stages::Count; ++stage)
  {
    const double ticks = static_cast<double>(spent.Ticks[stage]);
    std::snprintf(text, sizeof(text), "  %-28s %8.3f %7.2f %10llu\n", stages::TextOf(stage),
      ticks / m.Samples, all > 0 ? 100 * ticks / all : 0.0,
      static_cast<unsigned long long>(spent.Times[stage]));
    table += text;
  }
  std::snprintf(text, sizeof(text), "  %-28s %8.3f per sample, of %.3g GHz\n", "all",
    all / m.Samples, stages::TicksPerSecond() / 1e9);
  table += text;
  const double symbols = static_cast<double>(spent.SymbolsRead);
  std::snprintf(text, sizeof(text), "  %-28s %8.3f per sample, of %.3g cycles each\n",
    "symbols and flags read", symbols / m.Samples,
    symbols > 0 ? static_cast<double>(spent.Ticks[stages::Symbols]) / symbols : 0.0);
  table += text;
  std::snprintf(text, sizeof(text), "  %-28s %8.3f per sample\n", "filling memory, for scale",
    TicksOfFilling(static_cast<std::size_t>(m.SamplesOfStep)));
  return table + text;
}

} // namespace

std::string CsvHeader()
{
  return "dataset,method,bits_of_accuracy,max_error_over_bound,psnr_db,bits_per_voxel,encode_mb_s,"
         "decode_mb_s,random_brick_us,error_bound,range,bytes,finest_brick_us,kept_brick_us";
}

std::string CsvLine(const Measurement& m)
{
  return m.Dataset + "," + m.Method + "," + std::to_string(m.BitsOfAccuracy) + "," +
         Number(m.ErrorOverBound()) + "," + Number(m.SignalToNoiseDecibels) + "," +
         Number(m.BitsPerVoxel) + "," + Number(m.EncodeMegabytesPerSecond) + "," +
         Number(m.DecodeMegabytesPerSecond) + "," + NumberOrNothing(m.RandomBrickMicroseconds) +
         "," + Number(m.ErrorBound) + "," + Number(m.Range) + "," + std::to_string(m.Bytes) + "," +
         NumberOrNothing(m.FinestBrickMicroseconds) + "," +
         NumberOrNothing(m.KeptBrickMicroseconds);
}

bool Report(const RawSeries& series, const MethodList& methods, const std::vector<int>& bits,
  const MeasureOptions& options, std::ostream& csv, std::ostream& messages)
{
  bool kept = true;
  for (const int accuracy : bits)
  {
    for (const auto& method : methods)
    {
      try
      {
        const Measurement measurement = Measure(*method, series, accuracy, options);
        csv << CsvLine(measurement) << std::endl; // at once, so that nothing is lost
        messages << MessageOf(measurement) << std::endl;
        if (measurement.Decoding)
        {
          messages << StagesOf(measurement);
        }
        if (method->Ours() && measurement.ErrorOverBound() > 1.0)
        {
          messages << method->Name() << " exceeds its error bound." << std::endl;
          kept = false;
        }
      }
      catch (const std::exception& problem)
      {
        messages << series.Name() << ", " << accuracy << " bits: " << method->Name()
                 << " failed: " << problem.what() << std::endl;
        kept = kept && !method->Ours();
      }
    }
  }
  return kept;
}

} // namespace banyan::bench
