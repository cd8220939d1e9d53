// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_EarthquakeSeries_h
#define banyan_Data_EarthquakeSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// An earthquake with the proportions of Northridge, 1994 (`NorthridgeModel` in a
/// `HexWaveSimulation`), on a mesh of cubes as wide as the waves allow. The shortest waves are what
/// the number of cells can carry. Times are in seconds; steps lie at the time steps of the
/// simulation that are nearest. Needs about 160 bytes a cell.
SeriesKind EarthquakeSeries();

} // namespace banyan

#endif
