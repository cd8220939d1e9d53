// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_EnhancedArray_h
#define banyan_Inputs_EnhancedArray_h

#include "Render/Steps/TemporalEnhancement.h"

#include "BanyanInputsModule.h" // For export macro
#include "vtkSmartPointer.h"

class vtkDataArray;

namespace banyan
{

/// Says what is enhanced of an array.
enum class EnhancedPart
{
  Vectors = -2, ///< all components: vectors keep their direction and get the enhanced length
  Length = -1,  ///< one value: the length
  Component = 0 ///< and on: one value, that component
};

/// The enhanced values of an array as a new one named `name_enhanced`: of float64 if the array is,
/// otherwise of float32. Arrays are of VTK's own types; previous and next have as many tuples and
/// components as `now`, or are null. Works on the thread pool of the process.
BANYANINPUTS_EXPORT vtkSmartPointer<vtkDataArray> EnhancedArray(const TemporalEnhancement& how,
  vtkDataArray* now, vtkDataArray* previous, vtkDataArray* next,
  EnhancedPart part = EnhancedPart::Vectors);

} // namespace banyan

#endif
