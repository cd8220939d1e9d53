// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_ArrayLength_h
#define banyan_Inputs_ArrayLength_h

#include "vtkAbstractArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"

#include "Base/Error.h"

#include <string>

namespace banyan
{

/// VTK lets arrays have any length, and nothing checks one before it is read.
/// @param array of points or cells, or null
/// @param where vtkDataObject::POINT or CELL
/// @return a sentence when there is not one tuple for each of them; else nothing
inline std::string WrongLength(vtkAbstractArray* array, int where, vtkIdType expected)
{
  if (!array || array->GetNumberOfTuples() == expected)
  {
    return {};
  }
  const std::string kind = where == vtkDataObject::POINT ? "point" : "cell";
  return "The " + kind + " array " + (array->GetName() ? array->GetName() : "without a name") +
         " has " + std::to_string(array->GetNumberOfTuples()) + " values for " +
         std::to_string(expected) + " " + kind + "s.";
}

/// The same as an Error.
inline void CheckLength(vtkAbstractArray* array, int where, vtkIdType expected)
{
  const std::string problem = WrongLength(array, where, expected);
  if (!problem.empty())
  {
    throw Error(problem);
  }
}

/// The flags of points or cells that are hidden, or others'.
inline vtkAbstractArray* GhostFlags(vtkDataSetAttributes* attributes)
{
  return attributes->GetAbstractArray(vtkDataSetAttributes::GhostArrayName());
}

} // namespace banyan

#endif
