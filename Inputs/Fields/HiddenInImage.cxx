// SPDX-License-Identifier: BSD-3-Clause
#include "Fields/HiddenInImage.h"

#include "ArrayLength.h"
#include "Render/Bricks/HiddenCells.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

namespace banyan
{
namespace
{

constexpr std::uint8_t HidingBits =
  vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::REFINEDCELL;

/// @param where vtkDataObject::POINT or CELL
/// @return null unless some flag has one of these bits
const std::uint8_t* FlagsWith(
  std::uint8_t bits, vtkUnsignedCharArray* flags, int where, vtkIdType expected)
{
  if (!flags)
  {
    return nullptr;
  }
  CheckLength(flags, where, expected);
  const std::uint8_t* const first = flags->GetPointer(0);
  // Without an early end, which compilers make vectors of: most flags are of ghosts alone.
  std::uint8_t all = 0;
  for (vtkIdType i = 0; i < expected; ++i)
  {
    all = static_cast<std::uint8_t>(all | first[i]);
  }
  return (all & bits) != 0 ? first : nullptr;
}

/// Null unless some are hidden.
const std::uint8_t* FlagsOfHiddenCells(vtkImageData* image)
{
  return FlagsWith(
    HidingBits, image->GetCellGhostArray(), vtkDataObject::CELL, image->GetNumberOfCells());
}

} // namespace

const std::uint8_t* FlagsOfHiddenPoints(vtkImageData* image)
{
  return FlagsWith(vtkDataSetAttributes::HIDDENPOINT, image->GetPointGhostArray(),
    vtkDataObject::POINT, image->GetNumberOfPoints());
}

bool HasHiddenCells(vtkImageData* image)
{
  return FlagsOfHiddenCells(image) != nullptr;
}

void HideCellsOf(vtkImageData* image, const glm::ivec3& first, HiddenCells& hidden)
{
  if (const std::uint8_t* const flags = FlagsOfHiddenCells(image))
  {
    const int* const extent = image->GetExtent();
    const Box own{ glm::ivec3(extent[0], extent[2], extent[4]) - first,
      glm::ivec3(extent[1], extent[3], extent[5]) - first };
    hidden.Hide(own, flags, HidingBits);
  }
}

} // namespace banyan
