// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_StepWindow_h
#define banyan_Filters_StepWindow_h

#include "BanyanFiltersModule.h" // For export macro
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <array>
#include <optional>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;

namespace banyan
{

/// A step of time and its neighbours, which an algorithm takes from its first input. Steps that it
/// has are not asked for again: playing forward reads each step once. Data are kept by reference.
///
/// Neighbours are pulled within the algorithm's execution. VTK's way to several steps, with
/// CONTINUE_EXECUTING, never ends where one of them cannot be read.
class BANYANFILTERS_EXPORT StepWindow
{
public:
  /// Which steps around the wanted one.
  struct Neighbours
  {
    bool Previous = true;
    bool Next = true;
    int Distance = 1; ///< in steps; at least 1
  };

  /// To be called in REQUEST_UPDATE_EXTENT: asks the input for the wanted step, unless it is there.
  /// @param time that is wanted; none means the first. The step taken is the last one not after it.
  void Request(
    vtkAlgorithm* owner, const std::optional<double>& time, const Neighbours& neighbours);

  /// To be called in REQUEST_DATA, after it: takes what the input has now, and pulls what is
  /// missing. Throws std::runtime_error when a step cannot be read.
  void Take(vtkAlgorithm* owner);

  /// Returns the step that was taken; null for a neighbour that does not exist or was not wanted.
  vtkDataObject* Previous() const { return this->Of(0); }
  vtkDataObject* Now() const { return this->Of(1); }
  vtkDataObject* Next() const { return this->Of(2); }

private:
  struct Kept
  {
    double Time = 0.0;
    vtkSmartPointer<vtkDataObject> Data;
  };

  static std::vector<double> TimesOf(vtkInformation* input);
  void ForgetWhatChanged(vtkAlgorithm* owner, vtkInformation* input);
  const Kept* Find(double time) const;
  void Keep(double time, vtkDataObject* data);
  vtkDataObject* Of(int place) const;

  std::array<std::optional<double>, 3> Wanted; ///< times: previous, now, next
  std::vector<Kept> Steps;
  std::vector<vtkTypeInt64> Stamp; ///< of what else was asked of the input
  bool Timeless = false;           ///< the input has no steps
};

} // namespace banyan

#endif
