// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_StepGathering_h
#define banyan_Filters_StepGathering_h

#include "StepReport.h"

#include <vector>

class vtkDataArray;
class vtkImageData;

namespace banyan
{

class Communicator;

/// What users read where the values of a group do not fit into memory.
inline constexpr const char* NoMemoryForGroup =
  "There is not enough memory for a group of steps of the series. Lower 'Keyframe Interval' "
  "(KeyframeInterval).";

/// The values of one step, by array: `[z][y][x][components]` of the whole extent.
using StepValues = std::vector<std::vector<unsigned char>>;

/// The array of that name; names that VTK does not know were made from the array's place.
vtkDataArray* ArrayOf(vtkImageData* image, const std::string& name);

/// Brings the pieces of a step to the rank that is going to encode it.
class StepGathering
{
public:
  explicit StepGathering(Communicator& ranks)
    : Ranks(ranks)
  {
  }

  /// Collective; throws CollectiveError. A rank that holds everything itself needs no message.
  /// @param mine this rank's piece
  /// @param arrays which ones, in the order of `whole`
  /// @param owner the rank that receives
  /// @param whole on the owner: made as large as needed, and filled
  void Gather(vtkImageData* mine, const StepAgreement& step,
    const std::vector<WrittenArray>& arrays, int owner, StepValues& whole);

private:
  void Transfer(vtkImageData* mine, const StepAgreement& step, const WrittenArray& array, int owner,
    std::vector<unsigned char>* whole);
  void Copy(vtkImageData* mine, const WrittenArray& array, const Box& part, unsigned char* to);

  Communicator& Ranks;
  std::vector<unsigned char> Message;
  std::string Problem; ///< of this rank's values, to be agreed on
};

} // namespace banyan

#endif
