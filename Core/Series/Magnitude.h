#ifndef banyan_Series_Magnitude_h
#define banyan_Series_Magnitude_h

#include "Series/Quantizer.h"

#include <vector>

namespace banyan
{

class ThreadPool;

/// Extremes of the length (L2 norm, in double precision) of the vectors that an array of tuples
/// decodes to; tuples with a component that is not finite do not count. The result does not depend
/// on the number of threads.
/// @param values `[tuples][components]`, the originals
/// @param lattices one per component
ValueRange MagnitudeRange(ScalarType type, const void* values, std::int64_t tuples,
  const std::vector<Quantizer>& lattices, ThreadPool& pool);

} // namespace banyan

#endif
