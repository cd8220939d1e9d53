// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_HotBlobsSeries_h
#define banyan_Data_HotBlobsSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// Hot blobs that rise and roll up (`HotBlobs` in a `FlowSimulation`).
SeriesKind HotBlobsSeries();

} // namespace banyan

#endif
