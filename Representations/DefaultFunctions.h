// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_DefaultFunctions_h
#define banyan_Representations_DefaultFunctions_h

#include <memory>

class vtkDataArray;
class vtkDataObject;
class vtkVolumeProperty;

namespace banyan
{

class Communicator;

/// Colours and opacities over the range of an array (of vectors: of their lengths), for when
/// ParaView gives none: it does only with an array that was chosen by name.
class DefaultFunctions
{
public:
  DefaultFunctions();
  ~DefaultFunctions();

  /// Collective over the ranks of the process group. Where a rank cannot read its values, all ranks
  /// tell it as an error of the property, which stays as it is.
  /// @param array null on ranks without data
  /// @param data that the array is of; where these are blocks, those of its name in all of them
  /// count
  void Apply(vtkDataArray* array, vtkDataObject* data, bool colors, bool opacities,
    vtkVolumeProperty* property);

private:
  std::unique_ptr<Communicator> Ranks; ///< made at the first call
};

} // namespace banyan

#endif
