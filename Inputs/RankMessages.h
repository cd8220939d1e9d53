// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_RankMessages_h
#define banyan_Inputs_RankMessages_h

#include "BanyanInputsModule.h"

#include "vtkMultiProcessStream.h"
#include "vtkSmartPointer.h"

#include <vector>

class vtkDataObject;

namespace banyan
{

class Communicator;

/// Collective: what every rank says, in the order of ranks.
BANYANINPUTS_EXPORT std::vector<vtkMultiProcessStream> AllGatherStreams(
  Communicator& ranks, const vtkMultiProcessStream& mine);

/// Collective: the data of all ranks, in the order of ranks, on rank 0; nothing on the others.
/// Throws CollectiveError.
BANYANINPUTS_EXPORT std::vector<vtkSmartPointer<vtkDataObject>> GatherData(
  Communicator& ranks, vtkDataObject* mine);

} // namespace banyan

#endif
