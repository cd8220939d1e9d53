#include "Render/StepAhead.h"

#include "Render/SeriesBrickSource.h"

namespace banyan
{

void StepAhead::Drawing(const SeriesFile& series, int step)
{
  this->Decoder.Stop();
  if (series.Id() != this->SeriesId)
  {
    this->SeriesId = series.Id();
    this->Step = -1;
    this->Stride = 0;
  }
  if (step != this->Step)
  {
    this->Stride = this->Step < 0 ? 0 : step - this->Step;
    this->Step = step;
  }
  const int next = step + this->Stride;
  const bool exists = next >= 0 && next < series.Index().Steps();
  this->NextStep = this->Stride != 0 && exists ? next : -1;
}

void StepAhead::Drawn(
  const std::shared_ptr<const SeriesFile>& series, const SeriesBrickSource& source)
{
  if (this->NextStep < 0)
  {
    return;
  }
  std::vector<FieldBricks> wanted = source.Loaded();
  for (FieldBricks& field : wanted)
  {
    field.Field.Step = this->NextStep;
  }
  this->Decoder.Start(series, std::move(wanted), this->Cache.DecodedBudget() / 2);
}

} // namespace banyan
