// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_GridSteps_h
#define banyan_Filters_GridSteps_h

#include "StepGathering.h"

#include "Base/Hash.h"
#include "Series/Points/GridPoints.h"

#include "vtkSmartPointer.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class vtkDataArray;
class vtkDataObject;
class vtkImageData;

namespace banyan
{

class Communicator;

/// The steps of a curvilinear or rectilinear grid as images in i, j, k, so that they can be written
/// like those of an image; its points beside them.
class GridSteps
{
public:
  /// What a rank has of a step. Plain memory: it is sent as it is.
  struct Facts
  {
    std::int8_t Failed = 0;             ///< it has a problem
    std::int8_t Grid = -1;              ///< the kind of grid, if it has a part of one
    std::int8_t Other = 0;              ///< it has something else
    std::array<std::int8_t, 3> Types{}; ///< of its coordinates
  };

  explicit GridSteps(Communicator& ranks)
    : Ranks(ranks)
    , Gathering(ranks)
  {
  }

  /// Collective. Replaces this rank's data by an image when any rank has such a grid, alone or as
  /// the only block with points. Data stay as they are where a rank has a problem. Throws
  /// CollectiveError, also where the kind of grid is not that of the step before.
  /// @param problem of this rank so far, or nothing
  void Take(vtkSmartPointer<vtkDataObject>& data, const std::string& problem);

  /// Nothing: steps are no such grids. Known after the first Take().
  const std::optional<PointsForm>& Form() const { return this->Kind; }

  /// Collective; throws CollectiveError. Brings the points of the step that was taken last to rank
  /// 0, unless they are those of the last time.
  /// @return whether they are others; the same on all ranks
  bool Gather(const StepAgreement& step);

  /// On rank 0, after Gather(): the points of the whole grid, until the next call.
  PointsView Whole() const;

  /// Lets the points go that were gathered.
  void Release() { this->Values = {}; }

  /// Makes the next Gather() gather points, whatever they are.
  void Forget() { this->Gathered.clear(); }

private:
  vtkSmartPointer<vtkImageData> LookAt(vtkDataObject* data, Facts& facts);
  bool Changed(const StepAgreement& step);
  void GatherCurvilinear(const StepAgreement& step);
  void GatherRectilinear(const StepAgreement& step);
  void Join(const std::vector<std::string>& all, const Box& whole);

  Communicator& Ranks;
  StepGathering Gathering;
  std::optional<PointsForm> Kind;
  bool Looked = false;                                 ///< at a step, so that Kind is known
  vtkSmartPointer<vtkImageData> Piece;                 ///< of this rank, without arrays
  std::array<vtkSmartPointer<vtkDataArray>, 3> Points; ///< of the piece; all null where it is empty
  std::vector<Hash128> Gathered; ///< of the pieces of all ranks, that were gathered last
  glm::ivec3 Samples{ 0 };
  StepValues Values; ///< of the whole grid, on rank 0
};

} // namespace banyan

#endif
