// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_ConvectionSeries_h
#define banyan_Data_ConvectionSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// A box of air that is suddenly heated on one side and cooled on the other
/// (`ConvectionSimulation`), from the start until the first streams of hot and cold air have
/// crossed it. The seed decides a small disturbance of the temperature at the start, without which
/// the flow would be the same in all planes between the side walls.
SeriesKind ConvectionSeries();

} // namespace banyan

#endif
