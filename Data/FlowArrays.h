// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_FlowArrays_h
#define banyan_Data_FlowArrays_h

#include "ImageSeriesWriter.h"

namespace banyan
{

class FlowSimulation;

/// The present state of a flow as an array.
/// @param name "temperature", "velocity" (three components) or "vorticity" (its magnitude)
ImageArray FlowArray(const FlowSimulation& flow, const std::string& name);

} // namespace banyan

#endif
