// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_StepReport_h
#define banyan_Filters_StepReport_h

#include "Parallel/Composite/GatherPlan.h"
#include "Series/Format/SeriesIndex.h"
#include "Series/Grid/Grid.h"

#include <set>
#include <string>
#include <vector>

class vtkDataArraySelection;
class vtkDataObject;
class vtkMultiProcessStream;

namespace banyan
{

/// An array that is to be written, as one rank or all ranks see it.
struct WrittenArray
{
  std::string Name;
  ScalarType Type = ScalarType::Float32;
  std::vector<std::string> Components; ///< names, which may be empty
  std::vector<ValueRange> Ranges;      ///< of the finite values, one per component
  ArrayFlags Flags = ArrayFlags::None; ///< not among those that are agreed on: see Hides
};

/// Holds what one rank says about its piece of a step.
struct StepReport
{
  std::string Problem; ///< a sentence when this rank cannot go on
  std::string Warning; ///< a sentence about what will not be written
  bool Aborted = false;
  Grid Piece;                       ///< Extent is the rank's own and may be empty
  std::string ActiveScalars;        ///< may be empty
  std::vector<WrittenArray> Arrays; ///< sorted by name; none when the piece is empty
  /// Arrays of numbers that are there and were not chosen ("point array p"), while others were.
  std::vector<std::string> NotChosen;
  bool HidesPoints = false; ///< some of the piece
  bool HidesCells = false;

  void Save(vtkMultiProcessStream& stream) const;
  void Load(vtkMultiProcessStream& stream);
};

/// Looks at a rank's piece.
/// @param selection names of point arrays; an empty selection means all
/// @param withRanges whether to go through all values for their ranges
StepReport ReportOf(vtkDataObject* data, vtkDataArraySelection& selection, bool withRanges);

/// Holds what all ranks agree on about a step. Every rank that has the same reports has the same
/// agreement.
struct StepAgreement
{
  std::string Problem; ///< of the lowest rank that has one, which it names; or of all together
  std::string Warning;
  bool Aborted = false;
  Grid Whole;
  std::string ActiveScalars;
  std::vector<WrittenArray> Arrays;
  GatherPlan Plan;
  GatherPlan CellPlan;             ///< of cells (see CellsIn); where some are hidden
  std::set<std::string> NotChosen; ///< on any rank
  bool HidesPoints = false;
  bool HidesCells = false;
  std::vector<bool> HoldsWhole; ///< by rank: its piece is the whole extent
};

StepAgreement Agree(const std::vector<StepReport>& reports);

/// The array of a series that says which points or cells are hidden.
WrittenArray HiddenFlags(ArrayFlags flags);

/// Says what changed between two grids, as half a sentence ("the spacing was ... and is ..."), or
/// nothing.
std::string ChangeBetween(const Grid& before, const Grid& now);

/// Says what changed between two steps, as half a sentence ("the array p was float32 and is
/// float64"), or nothing.
std::string ChangeBetween(const StepAgreement& before, const StepAgreement& now);

} // namespace banyan

#endif
