// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_ExchangeBytes_h
#define banyan_Parallel_Cells_ExchangeBytes_h

#include "Base/Bytes.h"

#include <vector>

namespace banyan
{

class Communicator;

/// Collective: a message from each rank to each. Pairs without one exchange nothing; all sizes are
/// known to all ranks, 8 bytes per pair.
/// @param to by rank
/// @return by rank, what they have sent to this one
std::vector<Bytes> ExchangeBytes(Communicator& communicator, std::vector<Bytes> to);

} // namespace banyan

#endif
