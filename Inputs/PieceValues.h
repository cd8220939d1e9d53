// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_PieceValues_h
#define banyan_Inputs_PieceValues_h

#include "BanyanInputsModule.h"

#include "Base/Box.h"
#include "Base/ScalarType.h"
#include "Series/Format/SeriesIndex.h"

#include <vector>

class vtkDataArray;
class vtkImageData;

namespace banyan
{

/// The type of an array of numbers (not of bits, which have none).
BANYANINPUTS_EXPORT ScalarType TypeOf(vtkDataArray* array);

/// Whether GetVoidPointer() gives the array's own values as one block of tuples.
BANYANINPUTS_EXPORT bool IsOneBlock(vtkDataArray* array);

/// Extremes of the finite values of a point array, one per component; points that the image hides
/// do not count.
BANYANINPUTS_EXPORT std::vector<ValueRange> FiniteRangesOf(
  vtkImageData* image, vtkDataArray* array);

/// Copies a part of an image's point array, `[z][y][x][components]`, x and components fastest, in
/// the array's own type.
/// @param part inside the image's extent
/// @param values room for part.Count() tuples
BANYANINPUTS_EXPORT void CopyPart(
  vtkImageData* image, vtkDataArray* array, const Box& part, void* values);

/// Whether an image hides points, or cells.
BANYANINPUTS_EXPORT bool Hides(vtkImageData* image, ArrayFlags flags);

/// Cells as boxes: the cell whose lowest corner is a sample has the place of that.
/// @param samples of the image, or of a piece of it
/// @param whole all samples of the image
BANYANINPUTS_EXPORT Box CellsIn(const Box& samples, const Box& whole);

/// Which points or cells of a part are hidden, as a series has it; none where an image has no
/// flags.
/// @param part samples, or cells (see CellsIn), inside the image
/// @param bytes room for part.Count()
BANYANINPUTS_EXPORT void CopyFlags(
  vtkImageData* image, ArrayFlags flags, const Box& part, std::uint8_t* bytes);

/// Copies tuples that are packed as `part` says into their place in a whole.
/// @param part inside `whole`
/// @param tupleBytes bytes of one tuple
BANYANINPUTS_EXPORT void PlacePart(
  const void* values, const Box& part, void* wholeValues, const Box& whole, std::size_t tupleBytes);

} // namespace banyan

#endif
