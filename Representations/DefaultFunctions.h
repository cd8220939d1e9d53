// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_DefaultFunctions_h
#define banyan_Representations_DefaultFunctions_h

#include <memory>

class vtkBanyanVolumeMapper;
class vtkDataObject;
class vtkVolumeProperty;

namespace banyan
{

class Communicator;

/// Colours and opacities over the range of an array (of vectors: of their lengths; of colours: 0 to
/// 255), for when ParaView gives none: it does only with an array that was chosen by name.
class DefaultFunctions
{
public:
  DefaultFunctions();
  ~DefaultFunctions();

  /// Collective over the ranks of the process group. Does nothing where neither is asked for. Where
  /// a rank cannot read its values, all ranks tell it as an error of the property, which stays as
  /// it is.
  /// @param mapper says which array is drawn
  /// @param data null on ranks without any; where these are blocks, the arrays of that name in all
  /// of them count
  /// @param property its components are independent unless colours are drawn
  void Apply(vtkBanyanVolumeMapper* mapper, vtkDataObject* data, bool colors, bool opacities,
    vtkVolumeProperty* property);

private:
  std::unique_ptr<Communicator> Ranks; ///< made at the first call
};

} // namespace banyan

#endif
