// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_QuantizersTesting_h
#define banyan_Testing_QuantizersTesting_h

#include "Series/Quantize/FillValues.h"
#include "Series/SeriesTesting.h"

namespace banyan::testing
{

/// One array, of which all values were counted beforehand.
inline std::vector<ArrayDescription> Counted(
  const Steps<float>& steps, const EncodeOptions& options, const std::string& name = "values")
{
  ArrayDescription description = Describe(steps, name);
  description.SeriesRanges.clear();
  description.Histograms.resize(1);
  for (const auto& step : steps)
  {
    CountComponent(ScalarType::Float32, step.data(), static_cast<std::int64_t>(step.size()), 1, 0,
      options.QuantizerFor(name).FillValues, description.Histograms[0]);
  }
  return { description };
}

/// An encoded series that is open.
struct Written
{
  TemporaryFolder Folder;
  SeriesIndex Index;
  std::shared_ptr<SeriesFile> File;

  Written(const Grid& grid, const Steps<float>& steps, const EncodeOptions& options)
  {
    ThreadPool pool(2);
    const std::string path = this->Folder / "series.banyan";
    SeriesEncoder encoder(path, grid, Counted(steps, options), options, pool);
    for (std::size_t s = 0; s < steps.size(); ++s)
    {
      encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
    }
    (void)encoder.Finish();
    this->File = SeriesFile::Open(path);
    this->Index = this->File->Index();
  }
  const ComponentIndex& Component() const { return this->Index.Arrays[0].Components[0]; }
  std::vector<float> Read(int step) const { return ReadAll<float>(*this->File, { step, 0, 0, 0 }); }
  std::uint64_t Bytes() const
  {
    return this->Index.Statistics.PayloadBytes + this->Index.Statistics.TableBytes;
  }
};

/// The greatest |f(decoded) - f(original)| of finite values; the others must have the same bits.
template <class Function>
double GreatestError(const Written& written, const Steps<float>& steps, Function&& f)
{
  double greatest = 0;
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    const std::vector<float> decoded = written.Read(static_cast<int>(s));
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      if (std::isfinite(steps[s][i]))
      {
        greatest = std::max(greatest, double(std::abs(f(decoded[i]) - f(steps[s][i]))));
      }
      else
      {
        EXPECT_TRUE(SameBits(decoded[i], steps[s][i]));
      }
    }
  }
  return greatest;
}

} // namespace banyan::testing

#endif
