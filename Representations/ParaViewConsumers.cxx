// SPDX-License-Identifier: BSD-3-Clause
// Algorithms that ParaView itself connects to a reader, and how they treat arrays that decode on
// first touch.
#include "DeferredConsumers.h"

#include "vtkAlgorithm.h"
#include "vtkPVDataRepresentation.h"

namespace
{

banyan::DeferredUse JudgeRepresentation(vtkPVDataRepresentation& representation)
{
  // A display has one representation per way to show the data. All are connected, and the one that
  // is chosen is visible. The others never ask for data.
  bool fine = !representation.GetVisibility();
  for (const char* name : { "vtkBanyanVolumeRepresentation", "vtkOutlineRepresentation",
         "vtkPVGridAxes3DRepresentation", "vtkPolarAxesRepresentation" })
  {
    fine = fine || representation.IsA(name);
  }
  return fine ? banyan::DeferredUse::Fine : banyan::DeferredUse::Unknown;
}

banyan::DeferredUse JudgeParaView(vtkAlgorithm& consumer)
{
  if (auto* representation = vtkPVDataRepresentation::SafeDownCast(&consumer))
  {
    return JudgeRepresentation(*representation);
  }
  if (consumer.IsA("vtkPVPostFilter"))
  {
    // It stands behind each source. Alone, it is asked for information, not for values.
    return banyan::DeferredUse::HandedOnIfAsked;
  }
  if (consumer.IsA("vtkPVExtractSelection") && consumer.GetNumberOfInputConnections(1) == 0)
  {
    // It stands beside each display. Without a selection its output is empty.
    return banyan::DeferredUse::Fine;
  }
  return banyan::DeferredUse::Unknown;
}

const bool Added = (banyan::AddDeferredJudge(&JudgeParaView), true);

} // namespace
