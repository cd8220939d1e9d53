// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_OptionsWithoutEffect_h
#define banyan_Representations_OptionsWithoutEffect_h

#include <map>
#include <string>

class vtkSMProxy;
class vtkSMPVRepresentationProxy;

namespace banyan
{

/// A sentence for each property of a display of "Banyan Volume" that is set and has no effect on
/// it, in the words of ParaView's panel. The key is the property's name.
/// @param view that shows the display; null looks at no lights
std::map<std::string, std::string> OptionsWithoutEffect(
  vtkSMPVRepresentationProxy* display, vtkSMProxy* view);

} // namespace banyan

#endif
