// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_LineToClient_h
#define banyan_Representations_LineToClient_h

#include "PictureServer.h"

namespace banyan
{

/// The line to the client of this server, by ParaView's own connection: messages are called in the
/// client by the number PictureParcel::Tag. Without a client they are dropped.
PictureServer::Line LineToClient();

/// The client's end: calls what has come from the server, for about so many seconds at most.
/// @return whether that was all
bool ReadMessages(double seconds);

} // namespace banyan

#endif
