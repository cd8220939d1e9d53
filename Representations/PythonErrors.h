// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_PythonErrors_h
#define banyan_Representations_PythonErrors_h

#include <string>

class vtkSMProxy;

namespace banyan
{

/// Makes the Python call that we are inside of raise RuntimeError(sentence) when it returns, if
/// there is such a call: in pvpython, pvbatch and ParaView's Python shell, not in the window's own
/// actions. VTK's error messages never raise, so a script would go on and end with success.
void RaiseInPython(const std::string& sentence);

/// Lets Python, if we are inside of it, give up what it keeps for nobody: proxies that the
/// traceback of the last error refers to, and those in cycles. It would do so at any time, and a
/// proxy that goes while the ranks are busy together, in the script of a filter for instance, waits
/// for them for ever.
void ForgetGarbageOfPython();

/// Asks the server for the information property ErrorMessage of a proxy, and raises it if it is not
/// empty.
void RaiseErrorOf(vtkSMProxy* proxy);

} // namespace banyan

#endif
