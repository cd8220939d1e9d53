// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_TransferFunctionTable_h
#define banyan_Rendering_TransferFunctionTable_h

#include "Render/Levels/RayCaster.h"

#include <cstdint>

class vtkVolumeProperty;

namespace banyan
{

/// The transfer function of component 0 of a volume property: colour, scalar opacity and its unit
/// distance, as VTK evaluates them (GetColor, GetValue), tabulated by TabulateFunction: its colours
/// below and above the range, its steps and logarithms included.
///
/// In categories (an indexed look-up), numbers that are labels (or are rounded to them in float32)
/// have their colours, and all others those that the map has for them: of NaN, or beyond the range.
/// A value that is not a number is transparent whatever the map says. Throws Error when a
/// logarithmic opacity function begins at 0 or below, or a value has none.
/// @param white whether samples have colours of their own: then no map colours them
TransferFunction MakeTransferFunction(vtkVolumeProperty* property, bool white = false);

/// Whether values are labels with a colour each: a value between two labels then means nothing.
bool ShowsCategories(vtkVolumeProperty* property);

/// The same, made anew only when the property has other functions or these have changed: thousands
/// of values are looked up for each, which takes longer than some pictures.
class KeptTransferFunction
{
public:
  const TransferFunction& Of(vtkVolumeProperty* property, bool white = false);

private:
  TransferFunction Function;
  const void* Made[2] = {}; ///< of which functions
  std::uint64_t Times[2] = {};
};

/// Shading of component 0 of a volume property; the light is the viewer's, whatever lights there
/// are.
RayShading MakeShading(vtkVolumeProperty* property);

} // namespace banyan

#endif
