#ifndef banyan_Data_FlowArrays_h
#define banyan_Data_FlowArrays_h

#include "ImageSeriesWriter.h"

namespace banyan
{

class FlowSimulation;

/// The present state of a flow as the arrays of these names: "velocity" (three components),
/// "vorticity" (its magnitude), and any other name for the temperature, whatever it stands for.
std::vector<ImageArray> FlowArrays(
  const FlowSimulation& flow, const std::vector<std::string>& names);

} // namespace banyan

#endif
