// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_StandardSeries_h
#define banyan_Data_StandardSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// One step of the field of the ray caster's standard scenes (`StandardField`).
SeriesKind StandardSeries();

} // namespace banyan

#endif
