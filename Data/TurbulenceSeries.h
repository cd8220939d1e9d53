// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_TurbulenceSeries_h
#define banyan_Data_TurbulenceSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// Decaying isotropic turbulence (`RandomSpectrum` in a `FlowSimulation`).
SeriesKind TurbulenceSeries();

} // namespace banyan

#endif
