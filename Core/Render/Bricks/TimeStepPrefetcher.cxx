// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/TimeStepPrefetcher.h"

#include "Render/Bricks/EnhancedBrickSource.h"
#include "Render/Bricks/SeriesBrickSource.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// What was loaded of a source, of all steps that it is made of; nothing where it is not of a
/// series.
void AddLoaded(const BrickSource* source, std::vector<FieldBricks>& loaded)
{
  if (const auto* const series = dynamic_cast<const SeriesBrickSource*>(source))
  {
    for (FieldBricks& field : series->Loaded())
    {
      loaded.push_back(std::move(field));
    }
  }
  else if (const auto* const enhanced = dynamic_cast<const EnhancedBrickSource*>(source))
  {
    for (const BrickSource* const step : enhanced->Steps())
    {
      AddLoaded(step, loaded);
    }
  }
}

} // namespace

void TimeStepPrefetcher::Drawing(const SeriesFile& series, int step)
{
  this->Decoder.Stop();
  this->NextStep = this->Direction.Asked(series, step);
}

void TimeStepPrefetcher::Drawn(
  const std::shared_ptr<const SeriesFile>& series, const BrickSource& source)
{
  if (this->NextStep < 0)
  {
    return;
  }
  std::vector<FieldBricks> wanted;
  AddLoaded(&source, wanted);
  const int steps = series->Index().Steps();
  for (FieldBricks& field : wanted)
  {
    field.Field.Step += this->Direction.Stride();
  }
  wanted.erase(std::remove_if(wanted.begin(), wanted.end(),
                 [steps](const FieldBricks& field)
                 { return field.Field.Step < 0 || field.Field.Step >= steps; }),
    wanted.end());
  this->Decoder.Start(series, std::move(wanted), this->Cache.Budget() / 2);
}

} // namespace banyan
