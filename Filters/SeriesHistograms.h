// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_SeriesHistograms_h
#define banyan_Filters_SeriesHistograms_h

#include "StepReport.h"

#include "Series/Encode/SeriesEncoder.h"

#include <map>
#include <string>
#include <vector>

class vtkImageData;

namespace banyan
{

class Communicator;

/// Counts the values of a series in the first pass, of the arrays that need it, each sample by the
/// one rank that gives it to the encoder: the same counts on any number of ranks.
class SeriesHistograms
{
public:
  explicit SeriesHistograms(const EncodeOptions& options)
    : Options(options)
  {
  }

  /// Adds what a rank gives of a step.
  /// @param image its piece; hidden points do not count
  void Count(vtkImageData* image, const StepAgreement& step, int rank);

  /// Gives all ranks the counts of all. Collective. Throws CollectiveError.
  void Merge(Communicator& ranks, const std::vector<WrittenArray>& arrays);

  /// After Merge: one per component, or none.
  std::vector<ValueHistogram> Of(const std::string& array) const;

private:
  EncodeOptions Options;
  std::map<std::string, std::vector<ValueHistogram>> Counts; ///< by name
};

} // namespace banyan

#endif
