#ifndef banyan_Filters_PieceValues_h
#define banyan_Filters_PieceValues_h

#include "Base/Box.h"
#include "Base/ScalarType.h"
#include "Series/SeriesIndex.h"

#include <vector>

class vtkDataArray;
class vtkImageData;

namespace banyan
{

/// The type of an array of numbers (not of bits, which have none).
ScalarType TypeOf(vtkDataArray* array);

/// Whether GetVoidPointer() gives the array's own values as one block of tuples.
bool IsOneBlock(vtkDataArray* array);

/// Extremes of the finite values of a point array, one per component; points that the image hides
/// do not count.
std::vector<ValueRange> FiniteRangesOf(vtkImageData* image, vtkDataArray* array);

/// Copies a part of an image's point array, `[z][y][x][components]`, x and components fastest, in
/// the array's own type. Hidden points become NaN (in arrays of float or double; integers are
/// copied as they are).
/// @param part inside the image's extent
/// @param values room for part.Count() tuples
void CopyPart(vtkImageData* image, vtkDataArray* array, const Box& part, void* values);

/// Copies tuples that are packed as `part` says into their place in a whole.
/// @param part inside `whole`
/// @param tupleBytes bytes of one tuple
void PlacePart(
  const void* values, const Box& part, void* wholeValues, const Box& whole, std::size_t tupleBytes);

} // namespace banyan

#endif
