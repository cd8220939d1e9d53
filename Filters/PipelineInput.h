// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_PipelineInput_h
#define banyan_Filters_PipelineInput_h

#include <vector>

class vtkAlgorithm;
class vtkDataObject;

namespace banyan
{

/// The end of a pipeline, from which steps are pulled. A failure upstream becomes an Error with the
/// upstream message, also where VTK's own readers report success.
///
/// One rank's view; nothing here is collective.
class PipelineInput
{
public:
  /// @param producer of the data; nullptr makes every call fail
  PipelineInput(vtkAlgorithm* producer, int port)
    : Producer(producer)
    , Port(port)
  {
  }

  /// The times of the input, or none; throws Error when they do not increase, or when the input
  /// does not say what it holds. Files are read anew from here on (see SourceInspector::Forget).
  /// @param wanted false: none are returned, whatever they are
  std::vector<double> Times(bool wanted) const;

  /// Updates the input to one piece of the whole extent.
  /// @param time nullptr leaves the time as it was
  /// @param withFiles whether to compare extents with those in files (see
  /// SourceInspector::ExtentInFile), which may parse them once more
  vtkDataObject* Pull(int piece, int pieces, const double* time, bool withFiles) const;

  /// Returns what the last Pull() gave.
  vtkDataObject* Data() const;

private:
  std::vector<vtkAlgorithm*> Sources() const;
  void Forget() const;

  vtkAlgorithm* Producer;
  int Port;
};

} // namespace banyan

#endif
