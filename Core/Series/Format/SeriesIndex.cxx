// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/SeriesIndex.h"

#include "Base/Error.h"
#include "Series/Quantize/QuantizationError.h"

#include <algorithm>

namespace banyan
{

double ComponentIndex::OpacityWeightedError() const
{
  return this->FiniteCount > 0
           ? ShareOfSquaredRange(this->SumWeightedError / static_cast<double>(this->FiniteCount),
               this->ReferenceRange())
           : 0.0;
}

const ValueRange& ComponentIndex::ReferenceRange() const
{
  const bool chosen = this->RangeFrom != RangeRule::Source::Data || !this->FillValues.empty();
  return chosen && !this->PromisedRange.Empty() ? this->PromisedRange : this->Range;
}

const std::vector<PointsFile>& SeriesIndex::FilesOfPoints() const
{
  static const std::vector<PointsFile> none;
  return this->Points ? this->Points->Files : this->Mesh ? this->Mesh->Moved : none;
}

const PointsFile& PointsIndex::FileOf(int step) const
{
  const auto after = std::upper_bound(this->Files.begin(), this->Files.end(), step,
    [](int wanted, const PointsFile& file) { return wanted < file.FirstStep; });
  if (after == this->Files.begin())
  {
    throw Error("The series has no points of step " + std::to_string(step));
  }
  return *(after - 1);
}

int SeriesIndex::FindFlags(ArrayFlags flags) const
{
  const auto found = std::find_if(this->Arrays.begin(), this->Arrays.end(),
    [&](const ArrayIndex& array) { return array.Flags == flags; });
  return found == this->Arrays.end() ? -1 : static_cast<int>(found - this->Arrays.begin());
}

int SeriesIndex::FindArray(const std::string& name) const
{
  const auto found = std::find_if(this->Arrays.begin(), this->Arrays.end(),
    [&name](const ArrayIndex& array) { return array.Name == name; });
  return found == this->Arrays.end() ? -1 : static_cast<int>(found - this->Arrays.begin());
}

const SegmentIndex& SeriesIndex::SegmentOf(int step) const
{
  const auto after = std::upper_bound(this->Segments.begin(), this->Segments.end(), step,
    [](int wanted, const SegmentIndex& segment) { return wanted < segment.FirstStep; });
  if (step < 0 || after == this->Segments.begin() ||
      step >= (after - 1)->FirstStep + (after - 1)->Steps)
  {
    throw Error("The series has no step " + std::to_string(step) + ": it has " +
                std::to_string(this->Steps()) + " steps, counted from 0");
  }
  return *(after - 1);
}

} // namespace banyan
