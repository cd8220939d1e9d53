// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_SourceInspector_h
#define banyan_Filters_SourceInspector_h

#include "BanyanFiltersModule.h" // For export macro
#include "vtkSmartPointer.h"     // For return type

#include <memory>

class vtkAlgorithm;
class vtkInformation;

namespace banyan
{

/// Knows more about a source than its output tells: a hook for the application, whose sources this
/// module does not know. The writer asks it about every source upstream of its input.
class BANYANFILTERS_EXPORT SourceInspector
{
public:
  virtual ~SourceInspector() = default;

  /// Makes a source that reads files read its present step again at the next update, so that what
  /// it complains about is said while the writer listens.
  virtual void Forget(vtkAlgorithm* source) const = 0;

  /// Returns what the file that the source has just read says of itself (WHOLE_EXTENT, ORIGIN,
  /// SPACING and active scalars, as far as known). Some sources present all files of a series as
  /// they found the first one.
  /// @return nullptr when nothing is known
  virtual vtkSmartPointer<vtkInformation> InformationOfFile(vtkAlgorithm* source) const = 0;

  /// The one to ask, or nullptr.
  static const SourceInspector* Get();
  static void Set(std::unique_ptr<SourceInspector> inspector);
};

} // namespace banyan

#endif
