// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_IceTCompositing_h
#define banyan_Rendering_IceTCompositing_h

#include "Parallel/Compositing.h"

class vtkMultiProcessController;

namespace banyan
{

/// IceT's radix-k, of ParaView's own library, over the ranks of a controller: in floats, ordered.
/// Bytes are those that IceT says it has sent; messages are not known. One rank alone keeps its
/// picture. Where IceT complains on one rank, all throw the same Error.
CompositeOptions::Compositor IceTRadixK(vtkMultiProcessController* controller);

} // namespace banyan

#endif
