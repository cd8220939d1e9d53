// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_LargeArrays_h
#define banyan_Readers_LargeArrays_h

#include "vtkType.h"

class vtkDataArray;

namespace banyan
{

/// SetNumberOfTuples of a plain array without values. Large ones lie in large pages: the system
/// clears new memory page by page, which takes longer than decoding where pages are small. Throws
/// std::bad_alloc.
void SetTuples(vtkDataArray* array, vtkIdType tuples);

} // namespace banyan

#endif
