// SPDX-License-Identifier: BSD-3-Clause
#include "Fields/PlainSamples.h"

#include "Fields/HiddenInImage.h"

#include "Base/Error.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <string>
#include <utility>

namespace banyan
{
namespace
{

std::string NameOf(vtkDataArray* array)
{
  return array->GetName() ? array->GetName() : "";
}

ScalarType TypeOf(vtkDataArray* array)
{
  switch (array->GetDataType())
  {
    vtkTemplateMacro(return ScalarTypeOf<VTK_TT>());
    default:
      throw Error("Array '" + NameOf(array) + "' has the type " + array->GetDataTypeAsString() +
                  ", which cannot be drawn: convert it to float.");
  }
}

/// Keeps VTK objects from being deleted as long as the pointer is held.
std::shared_ptr<const void> HoldAlive(vtkDataArray* array, vtkImageData* image)
{
  using Pair = std::pair<vtkSmartPointer<vtkDataArray>, vtkSmartPointer<vtkImageData>>;
  return std::make_shared<const Pair>(array, image);
}

} // namespace

SampleArray PlainSamples(
  vtkImageData* image, vtkDataArray* values, int component, const glm::ivec3& first)
{
  const vtkSmartPointer<vtkDataArray> plain = vtkBanyanDeferred::Plain(values);
  if (!plain)
  {
    throw Error("The values of array '" + NameOf(values) + "' could not be decoded.");
  }
  int extent[6];
  image->GetExtent(extent);
  SampleArray array;
  array.Values = plain->GetVoidPointer(0);
  array.Type = TypeOf(plain);
  array.Components = plain->GetNumberOfComponents();
  array.Component = component;
  array.Samples = { glm::ivec3(extent[0], extent[2], extent[4]) - first,
    glm::ivec3(extent[1] + 1, extent[3] + 1, extent[5] + 1) - first };
  const glm::ivec3 samples = array.Samples.Size();
  array.Stride[0] = array.Components;
  array.Stride[1] = array.Stride[0] * samples.x;
  array.Stride[2] = array.Stride[1] * samples.y;
  array.Flags = FlagsOfHiddenPoints(image);
  array.Owner = HoldAlive(plain, image);
  return array;
}

} // namespace banyan
