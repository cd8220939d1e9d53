// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_LiveFunctions_h
#define banyan_Representations_LiveFunctions_h

#include "FunctionWatch.h"

class vtkClientServerStream;
class vtkSMProxy;

namespace banyan
{

/// The colours and opacities of a display, on the client of a server. Somebody drags a point of
/// them; ParaView tells the server when that has ended, and this while it lasts.
class LiveFunctions
{
public:
  /// @param changed called when a point has moved on the client
  explicit LiveFunctions(const std::function<void()>& changed)
    : Colors(changed)
    , Opacity(changed)
  {
  }

  /// @param display whose functions are meant from now on
  void Watch(vtkSMProxy* display);

  /// Appends what gives the server's functions the points that those of the client have.
  static void AppendPoints(vtkSMProxy* display, vtkClientServerStream& stream);

private:
  FunctionWatch Colors;
  FunctionWatch Opacity;
};

} // namespace banyan

#endif
