// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_FewChangesSeries_h
#define banyan_Data_FewChangesSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// The field of the ray caster's standard scenes (`StandardField`), which rests, and a ball that
/// goes round in it once: nearly all bricks of a step are those of the step before.
SeriesKind FewChangesSeries();

} // namespace banyan

#endif
