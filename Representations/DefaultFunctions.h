// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_DefaultFunctions_h
#define banyan_Representations_DefaultFunctions_h

class vtkDataArray;
class vtkDataObject;
class vtkVolumeProperty;

namespace banyan
{

/// Colours and opacities over the range of an array (of vectors: of their lengths), for when
/// ParaView gives none: it does only with an array that was chosen by name. Collective over the
/// ranks of the process group.
/// @param array null on ranks without data
/// @param data that the array is of; where these are blocks, those of its name in all of them count
void UseDefaultFunctions(vtkDataArray* array, vtkDataObject* data, bool colors, bool opacities,
  vtkVolumeProperty* property);

} // namespace banyan

#endif
