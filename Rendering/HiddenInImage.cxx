// SPDX-License-Identifier: BSD-3-Clause
#include "HiddenInImage.h"

#include "ArrayLength.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Bricks/HiddenCells.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <string>

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

} // namespace

const std::uint8_t* FlagsOfHiddenPoints(vtkImageData* image)
{
  return FlagsWith(vtkDataSetAttributes::HIDDENPOINT, image->GetPointGhostArray(),
    vtkDataObject::POINT, image->GetNumberOfPoints());
}

const std::uint8_t* FlagsOfHiddenCells(vtkImageData* image)
{
  return FlagsWith(
    HidingBits, image->GetCellGhostArray(), vtkDataObject::CELL, image->GetNumberOfCells());
}

std::shared_ptr<const HiddenCells> GatherHiddenCells(
  Communicator& communicator, vtkImageData* image, const glm::ivec3& first, const glm::ivec3& cells)
{
  const auto hidden = std::make_shared<HiddenCells>(cells);
  std::string failure;
  std::string mine;
  try
  {
    if (const std::uint8_t* const flags = image ? FlagsOfHiddenCells(image) : nullptr)
    {
      const int* const extent = image->GetExtent();
      const Box own{ glm::ivec3(extent[0], extent[2], extent[4]) - first,
        glm::ivec3(extent[1], extent[3], extent[5]) - first };
      hidden->Hide(own, flags, HidingBits);
      mine = hidden->ToBytes();
    }
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  const std::string agreed = AgreeOnError(communicator, failure);
  if (!agreed.empty())
  {
    throw Error(agreed);
  }
  for (const std::string& bytes : AllGatherStrings(communicator, mine))
  {
    hidden->Add(bytes);
  }
  return hidden;
}

} // namespace banyan
