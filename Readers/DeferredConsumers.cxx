#include "DeferredConsumers.h"

#include "vtkAlgorithm.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationExecutivePortVectorKey.h"

#include <set>
#include <vector>

namespace banyan
{
namespace
{

DeferredUse JudgeOurOwn(vtkAlgorithm& consumer)
{
  if (consumer.IsA("vtkBanyanTemporalEnhancement"))
  {
    return DeferredUse::HandedOn;
  }
  for (const char* name : { "vtkBanyanDecode", "vtkBanyanSeriesWriter", "vtkBanyanVolumeMapper" })
  {
    if (consumer.IsA(name))
    {
      return DeferredUse::Fine;
    }
  }
  return DeferredUse::Unknown;
}

std::vector<DeferredJudge>& Judges()
{
  static std::vector<DeferredJudge> judges{ &JudgeOurOwn };
  return judges;
}

DeferredUse Judge(vtkAlgorithm& consumer)
{
  for (const DeferredJudge judge : Judges())
  {
    const DeferredUse use = judge(consumer);
    if (use != DeferredUse::Unknown)
    {
      return use;
    }
  }
  return DeferredUse::Unknown;
}

std::vector<vtkAlgorithm*> ConsumersOf(vtkAlgorithm& producer)
{
  std::vector<vtkAlgorithm*> consumers;
  for (int port = 0; port < producer.GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* const info = producer.GetOutputInformation(port);
    const int count = vtkExecutive::CONSUMERS()->Length(info);
    vtkExecutive** const executives = vtkExecutive::CONSUMERS()->GetExecutives(info);
    for (int i = 0; i < count; ++i)
    {
      if (executives[i] && executives[i]->GetAlgorithm())
      {
        consumers.push_back(executives[i]->GetAlgorithm());
      }
    }
  }
  return consumers;
}

} // namespace

void AddDeferredJudge(DeferredJudge judge)
{
  Judges().push_back(judge);
}

bool ConsumersReadDeferred(vtkAlgorithm& producer)
{
  std::set<vtkAlgorithm*> seen{ &producer };
  std::vector<vtkAlgorithm*> open{ &producer };
  while (!open.empty())
  {
    vtkAlgorithm* const at = open.back();
    open.pop_back();
    const std::vector<vtkAlgorithm*> consumers = ConsumersOf(*at);
    if (consumers.empty())
    {
      return false;
    }
    for (vtkAlgorithm* const consumer : consumers)
    {
      const DeferredUse use = Judge(*consumer);
      if (use == DeferredUse::Unknown)
      {
        return false;
      }
      if (use == DeferredUse::HandedOn && seen.insert(consumer).second)
      {
        open.push_back(consumer);
      }
    }
  }
  return true;
}

} // namespace banyan
