#include "Report.h"

#include <cstdio>
#include <exception>

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
  return message;
}

} // namespace

std::string CsvHeader()
{
  return "dataset,method,bits_of_accuracy,max_error_over_bound,psnr_db,bits_per_voxel,encode_mb_s,"
         "decode_mb_s,random_brick_us,error_bound,range,bytes";
}

std::string CsvLine(const Measurement& m)
{
  const std::string brick =
    m.RandomBrickMicroseconds ? Number(*m.RandomBrickMicroseconds) : std::string();
  return m.Dataset + "," + m.Method + "," + std::to_string(m.BitsOfAccuracy) + "," +
         Number(m.ErrorOverBound()) + "," + Number(m.SignalToNoiseDecibels) + "," +
         Number(m.BitsPerVoxel) + "," + Number(m.EncodeMegabytesPerSecond) + "," +
         Number(m.DecodeMegabytesPerSecond) + "," + brick + "," + Number(m.ErrorBound) + "," +
         Number(m.Range) + "," + std::to_string(m.Bytes);
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
