// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_IgnoredOptions_h
#define banyan_Rendering_IgnoredOptions_h

#include <string>

class vtkVolumeMapper;
class vtkVolumeProperty;

namespace banyan
{

/// A sentence that names the options of VTK which are set and have no effect on the picture; empty
/// if there are none.
/// @param mapped whether the array has several components, and the colour function colours them
std::string IgnoredOptions(vtkVolumeMapper* mapper, vtkVolumeProperty* property, bool mapped);

} // namespace banyan

#endif
