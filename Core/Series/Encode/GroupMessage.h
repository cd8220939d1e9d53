// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_GroupMessage_h
#define banyan_Series_Encode_GroupMessage_h

#include "Base/Bytes.h"
#include "Series/Encode/GroupEncoder.h"

namespace banyan
{

/// Packs what EncodeGroup returned into bytes that another process of the same program understands:
/// one rank encodes, another one keeps the index. Every bit of every number survives.
Bytes PackGroup(const EncodedGroup& group);

/// Inverse of PackGroup. Throws Error when the bytes are no such message.
EncodedGroup UnpackGroup(const Bytes& message);

} // namespace banyan

#endif
