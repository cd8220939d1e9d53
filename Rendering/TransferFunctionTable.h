#ifndef banyan_Rendering_TransferFunctionTable_h
#define banyan_Rendering_TransferFunctionTable_h

#include "Render/RayCaster.h"

#include <cstdint>

class vtkVolumeProperty;

namespace banyan
{

/// The transfer function of component 0 of a volume property: colour, scalar opacity and its unit
/// distance, tabulated over the range of both functions.
/// @param entries of the table, at least 2
TransferFunction MakeTransferFunction(vtkVolumeProperty* property, int entries = 4096);

/// The same, made anew only when the property has other functions or these have changed: thousands
/// of values are looked up for each, which takes longer than some pictures.
class KeptTransferFunction
{
public:
  const TransferFunction& Of(vtkVolumeProperty* property);

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
