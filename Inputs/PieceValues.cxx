// SPDX-License-Identifier: BSD-3-Clause
#include "PieceValues.h"

#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace banyan
{
namespace
{

/// The ghost flags of points when some are hidden, else nullptr.
const unsigned char* HidingFlags(vtkImageData* image)
{
  return image->HasAnyBlankPoints() ? image->GetPointGhostArray()->GetPointer(0) : nullptr;
}

bool IsHidden(unsigned char flags)
{
  return (flags & vtkDataSetAttributes::HIDDENPOINT) != 0;
}

vtkUnsignedCharArray* FlagsOf(vtkImageData* image, ArrayFlags flags)
{
  return flags == ArrayFlags::OfPoints ? image->GetPointGhostArray() : image->GetCellGhostArray();
}

/// The flags that a series keeps: pieces and their neighbours are none of its own.
unsigned char BitsOf(ArrayFlags flags)
{
  return flags == ArrayFlags::OfPoints ? HiddenPointBits : HiddenCellBits;
}

/// The values as one block of tuples; arrays of another layout are copied into `keep` first.
const void* Block(vtkDataArray* array, vtkSmartPointer<vtkDataArray>& keep)
{
  if (IsOneBlock(array))
  {
    return array->GetVoidPointer(0);
  }
  keep.TakeReference(vtkDataArray::CreateDataArray(array->GetDataType()));
  keep->DeepCopy(array);
  return keep->GetVoidPointer(0);
}

template <class T>
std::vector<ValueRange> Ranges(
  const T* values, vtkIdType tuples, int components, const unsigned char* flags)
{
  std::vector<ValueRange> ranges(components);
  for (vtkIdType tuple = 0; tuple < tuples; ++tuple, values += components)
  {
    if (flags && IsHidden(flags[tuple]))
    {
      continue;
    }
    for (int c = 0; c < components; ++c)
    {
      const double value = static_cast<double>(values[c]);
      if (std::isfinite(value))
      {
        ranges[c].Include(value);
      }
    }
  }
  return ranges;
}

/// Calls `row(first tuple in the box, first tuple in the part)` for each row of samples.
template <class Row>
void ForEachRow(const Box& part, const Box& box, Row&& row)
{
  const glm::ivec3 size = box.Size();
  std::int64_t inPart = 0;
  for (int z = part.Lo.z; z < part.Hi.z; ++z)
  {
    for (int y = part.Lo.y; y < part.Hi.y; ++y)
    {
      const std::int64_t inBox =
        (std::int64_t{ z - box.Lo.z } * size.y + (y - box.Lo.y)) * size.x + part.Lo.x - box.Lo.x;
      row(inBox, inPart);
      inPart += part.Size().x;
    }
  }
}

Box ExtentOf(vtkImageData* image)
{
  const int* e = image->GetExtent();
  return { { e[0], e[2], e[4] }, { e[1] + 1, e[3] + 1, e[5] + 1 } };
}

} // namespace

bool IsOneBlock(vtkDataArray* array)
{
  return array->HasStandardMemoryLayout() || vtkBanyanDeferred::IsDeferred(array);
}

ScalarType TypeOf(vtkDataArray* array)
{
  switch (array->GetDataType())
  {
    vtkTemplateMacro(return ScalarTypeOf<VTK_TT>());
    default:
      throw Error("The array " + std::string(array->GetName() ? array->GetName() : "") +
                  " is of a type that cannot be written: " + array->GetDataTypeAsString() + ".");
  }
}

std::vector<ValueRange> FiniteRangesOf(vtkImageData* image, vtkDataArray* array)
{
  vtkSmartPointer<vtkDataArray> keep;
  const void* values = Block(array, keep);
  return Dispatch(TypeOf(array),
    [&](auto tag)
    {
      return Ranges(static_cast<const typename decltype(tag)::Type*>(values),
        array->GetNumberOfTuples(), array->GetNumberOfComponents(), HidingFlags(image));
    });
}

void CopyPart(vtkImageData* image, vtkDataArray* array, const Box& part, void* values)
{
  vtkSmartPointer<vtkDataArray> keep;
  const auto* from = static_cast<const unsigned char*>(Block(array, keep));
  auto* to = static_cast<unsigned char*>(values);
  const std::size_t tupleBytes = SizeOf(TypeOf(array)) * array->GetNumberOfComponents();
  const int tuples = part.Size().x;
  ForEachRow(part, ExtentOf(image),
    [&](std::int64_t inBox, std::int64_t inPart)
    { std::memcpy(to + inPart * tupleBytes, from + inBox * tupleBytes, tuples * tupleBytes); });
}

bool Hides(vtkImageData* image, ArrayFlags flags)
{
  vtkUnsignedCharArray* const array = FlagsOf(image, flags);
  const unsigned char* const first = array ? array->GetPointer(0) : nullptr;
  return array && std::any_of(first, first + array->GetNumberOfTuples(),
                    [bits = BitsOf(flags)](unsigned char flag) { return (flag & bits) != 0; });
}

Box CellsIn(const Box& samples, const Box& whole)
{
  Box cells = samples;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells.Hi[axis] -= whole.Size()[axis] > 1 ? 1 : 0;
  }
  return cells.Empty() ? Box{} : cells;
}

void CopyFlags(vtkImageData* image, ArrayFlags flags, const Box& part, std::uint8_t* bytes)
{
  vtkUnsignedCharArray* const array = FlagsOf(image, flags);
  if (!array)
  {
    std::fill_n(bytes, part.Count(), std::uint8_t{ 0 });
    return;
  }
  const Box extent = ExtentOf(image);
  const Box box = flags == ArrayFlags::OfPoints ? extent : CellsIn(extent, extent);
  const unsigned char bits = BitsOf(flags);
  const int count = part.Size().x;
  ForEachRow(part, box,
    [&](std::int64_t inBox, std::int64_t inPart)
    {
      const unsigned char* const from = array->GetPointer(0) + inBox;
      std::transform(from, from + count, bytes + inPart,
        [bits](unsigned char flag) { return static_cast<std::uint8_t>(flag & bits); });
    });
}

void PlacePart(
  const void* values, const Box& part, void* wholeValues, const Box& whole, std::size_t tupleBytes)
{
  const auto* from = static_cast<const unsigned char*>(values);
  auto* to = static_cast<unsigned char*>(wholeValues);
  ForEachRow(part, whole,
    [&](std::int64_t inWhole, std::int64_t inPart)
    {
      std::memcpy(
        to + inWhole * tupleBytes, from + inPart * tupleBytes, part.Size().x * tupleBytes);
    });
}

} // namespace banyan
