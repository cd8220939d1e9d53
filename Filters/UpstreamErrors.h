// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_UpstreamErrors_h
#define banyan_Filters_UpstreamErrors_h

#include <memory>
#include <string>
#include <utility>
#include <vector>

class vtkAlgorithm;
class vtkObject;

namespace banyan
{

/// Listens to the error messages that come up while a pipeline is updated. Some of VTK's readers
/// say that they cannot read a file and then report success with whatever is in memory; nothing
/// but the message tells. (For a raw file that is too short, MetaIO's line on std::cerr does.)
///
/// Exceptions of Python scripts, which report success as well, count; their warnings do not.
///
/// Messages are still shown where they would be shown without this. For the main thread.
class UpstreamErrors
{
public:
  /// Listens until destroyed, to the output window and to all algorithms upstream of `last` (and
  /// itself) whose messages go elsewhere.
  explicit UpstreamErrors(vtkAlgorithm* last);
  ~UpstreamErrors();
  UpstreamErrors(const UpstreamErrors&) = delete;
  UpstreamErrors& operator=(const UpstreamErrors&) = delete;

  /// The first message, on one line and without where in the source it comes from; or nothing.
  std::string First() const;

private:
  void ListenUpstream(vtkAlgorithm* algorithm);
  void ListenTo(vtkObject* object);
  void Take(vtkObject*, unsigned long, void* text);

  class Tee;
  std::vector<std::pair<vtkObject*, unsigned long>> Observers;
  std::unique_ptr<Tee> StandardError;
  std::string Text;
  std::string Scripts; ///< what they wrote to Python's standard error
};

} // namespace banyan

#endif
