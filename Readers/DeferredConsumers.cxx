// SPDX-License-Identifier: BSD-3-Clause
#include "DeferredConsumers.h"

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationExecutivePortVectorKey.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"

#include <set>
#include <utility>
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

/// Executives that are alive: each is observed until it is destroyed.
std::set<vtkExecutive*>& Alive()
{
  static auto* const alive = new std::set<vtkExecutive*>; // executives may outlive static objects
  return *alive;
}

void ForgetExecutive(vtkObject* executive, unsigned long, void*, void*)
{
  Alive().erase(static_cast<vtkExecutive*>(executive));
}

void Observe(vtkExecutive* executive)
{
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(&ForgetExecutive);
  executive->AddObserver(vtkCommand::DeleteEvent, command);
  Alive().insert(executive);
}

using Connections = std::vector<std::pair<vtkExecutive*, int>>;

/// How often an executive has the information of somebody's output on an input port of its own.
std::size_t TimesConnected(vtkExecutive* executive, int input, vtkInformation* port)
{
  std::size_t times = 0;
  if (input < executive->GetNumberOfInputPorts())
  {
    vtkInformationVector* const inputs = executive->GetInputInformation(input);
    for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
    {
      times += inputs->GetInformationObject(i) == port;
    }
  }
  return times;
}

/**
 * Finds out what is connected to a port; false where that cannot be told.
 *
 * VTK's list of consumers keeps pointers to those that were destroyed without being disconnected.
 * But each that lives holds a reference to the information of the port: it is its input
 * information.
 */
bool LivingConsumers(vtkInformation* port, std::set<vtkExecutive*>& living)
{
  const int count = vtkExecutive::CONSUMERS()->Length(port);
  vtkExecutive** const executives = vtkExecutive::CONSUMERS()->GetExecutives(port);
  int* const ports = vtkExecutive::CONSUMERS()->GetPorts(port);
  std::set<std::pair<vtkExecutive*, int>> known;
  Connections others;
  for (int i = 0; i < count; ++i)
  {
    if (Alive().count(executives[i]))
    {
      known.emplace(executives[i], ports[i]);
    }
    else
    {
      others.emplace_back(executives[i], ports[i]);
    }
  }
  std::size_t accounted = 0;
  living.clear();
  for (const auto& [executive, input] : known)
  {
    const std::size_t times = TimesConnected(executive, input, port);
    accounted += times;
    if (times > 0)
    {
      living.insert(executive);
    }
  }
  // One reference is the port's own.
  const auto references = static_cast<std::size_t>(port->GetReferenceCount() - 1);
  if (references == accounted)
  {
    for (const auto& [executive, input] : others)
    {
      vtkExecutive::CONSUMERS()->Remove(port, executive, input);
    }
    return true;
  }
  if (references != accounted + others.size())
  {
    return false;
  }
  for (const auto& other : others)
  {
    if (living.insert(other.first).second)
    {
      Observe(other.first);
    }
  }
  return true;
}

/// Algorithms that are connected to any port; false where that cannot be told.
bool ConsumersOf(vtkAlgorithm& producer, std::vector<vtkAlgorithm*>& consumers)
{
  consumers.clear();
  for (int port = 0; port < producer.GetNumberOfOutputPorts(); ++port)
  {
    std::set<vtkExecutive*> living;
    if (!LivingConsumers(producer.GetOutputInformation(port), living))
    {
      return false;
    }
    for (vtkExecutive* const executive : living)
    {
      if (!executive->GetAlgorithm())
      {
        return false;
      }
      consumers.push_back(executive->GetAlgorithm());
    }
  }
  return true;
}

} // namespace

void AddDeferredJudge(DeferredJudge judge)
{
  Judges().push_back(judge);
}

bool ConsumersReadDeferred(vtkAlgorithm& producer)
{
  std::set<vtkAlgorithm*> seen{ &producer };
  std::vector<std::pair<vtkAlgorithm*, DeferredUse>> open{ { &producer, DeferredUse::HandedOn } };
  while (!open.empty())
  {
    const auto [at, use] = open.back();
    open.pop_back();
    std::vector<vtkAlgorithm*> consumers;
    if (!ConsumersOf(*at, consumers) || (consumers.empty() && use == DeferredUse::HandedOn))
    {
      return false;
    }
    for (vtkAlgorithm* const consumer : consumers)
    {
      const DeferredUse next = Judge(*consumer);
      if (next == DeferredUse::Unknown)
      {
        return false;
      }
      if (next != DeferredUse::Fine && seen.insert(consumer).second)
      {
        open.emplace_back(consumer, next);
      }
    }
  }
  return true;
}

} // namespace banyan
