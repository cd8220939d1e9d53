// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_JetSeries_h
#define banyan_Data_JetSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// Nozzle fluid in a turbulent jet (`JetInflow` in a `FlowSimulation`, with `ScalarTransport`).
SeriesKind JetSeries();

} // namespace banyan

#endif
