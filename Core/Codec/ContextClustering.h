// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_ContextClustering_h
#define banyan_Codec_ContextClustering_h

#include "Codec/SymbolWriter.h"

namespace banyan
{

/// Lets contexts that are alike have one table, where that costs less than tables of their own:
/// sums up their counts, so that their frequencies are the same. Matters where few symbols are
/// coded, and leaves fewer tables to decode with.
///
/// Integer arithmetic: the same on every machine.
void ClusterContexts(ContextCounts& counts);

} // namespace banyan

#endif
