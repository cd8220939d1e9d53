// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_SeriesSource_h
#define banyan_Programs_SeriesSource_h

#include "Series/Decode/SeriesFile.h"
#include "SourceSteps.h"

#include <memory>

namespace banyan
{

/// Another encoded series, as it decodes.
class SeriesSource : public SourceSteps
{
public:
  explicit SeriesSource(std::shared_ptr<const SeriesFile> file);

  bool Next(SourceStep& step) override;
  void ReadValues(std::size_t array, std::vector<std::uint8_t>& values) override;

private:
  void AddPoints(SourceStep& step);
  void ReadPointsOf(std::size_t axis, std::vector<std::uint8_t>& values);

  std::shared_ptr<const SeriesFile> File;
  std::size_t Points = 0; ///< arrays that are points of the grid
  int Step = -1;          ///< at hand
};

} // namespace banyan

#endif
