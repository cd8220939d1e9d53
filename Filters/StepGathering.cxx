// SPDX-License-Identifier: BSD-3-Clause
#include "StepGathering.h"

#include "PieceValues.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Large enough for a network to be at full speed, small beside a step.
constexpr std::size_t MessageBytes = std::size_t{ 16 } << 20;
constexpr int MessageTag = 1; // beside the one of Meet

/// Cuts a box into parts of at most `samples` each (at least one), the slowest axis first.
void Cut(const Box& box, std::int64_t samples, std::vector<Box>& parts)
{
  const glm::ivec3 size = box.Size();
  const int axis = size.z > 1 ? 2 : size.y > 1 ? 1 : 0;
  if (box.Count() <= samples || size[axis] < 2)
  {
    parts.push_back(box);
    return;
  }
  Box low = box;
  Box high = box;
  low.Hi[axis] = high.Lo[axis] = box.Lo[axis] + size[axis] / 2;
  Cut(low, samples, parts);
  Cut(high, samples, parts);
}

/// The parts that a rank sends, in the order in which the owner receives them.
std::vector<GatherPlan::Part> Messages(const GatherPlan& plan, std::size_t tupleBytes)
{
  const auto samples =
    static_cast<std::int64_t>(std::max<std::size_t>(MessageBytes / tupleBytes, 1));
  std::vector<GatherPlan::Part> messages;
  for (const GatherPlan::Part& part : plan.Parts)
  {
    std::vector<Box> boxes;
    Cut(part.Samples, samples, boxes);
    for (const Box& box : boxes)
    {
      messages.push_back({ part.Rank, box });
    }
  }
  return messages;
}

std::size_t TupleBytes(const WrittenArray& array)
{
  return SizeOf(array.Type) * array.Components.size();
}

} // namespace

vtkDataArray* ArrayOf(vtkImageData* image, const std::string& name)
{
  vtkPointData* points = image->GetPointData();
  if (vtkDataArray* array = points->GetArray(name.c_str()))
  {
    return array;
  }
  const std::string prefix = "Unnamed";
  return points->GetArray(std::stoi(name.substr(prefix.size())));
}

void StepGathering::Gather(vtkImageData* mine, const StepAgreement& step,
  const std::vector<WrittenArray>& arrays, int owner, StepValues& whole)
{
  const bool receives = this->Ranks.Rank() == owner;
  const auto makeRoom = [&]
  {
    std::size_t bytes = MessageBytes;
    whole.resize(receives ? arrays.size() : 0);
    for (std::size_t i = 0; i < arrays.size(); ++i)
    {
      bytes = std::max(bytes, TupleBytes(arrays[i]));
      if (receives)
      {
        whole[i].resize(
          static_cast<std::size_t>(step.Whole.Extent.Count()) * TupleBytes(arrays[i]));
      }
    }
    this->Message.resize(bytes);
  };
  Collective(this->Ranks, makeRoom, NoMemoryForGroup);
  this->Problem.clear();
  for (std::size_t i = 0; i < arrays.size(); ++i)
  {
    const bool flags = arrays[i].Flags != ArrayFlags::None;
    if (flags && receives)
    {
      // Not all of them may come: see CellsIn.
      std::fill(whole[i].begin(), whole[i].end(), 0);
    }
    if (flags && !(arrays[i].Flags == ArrayFlags::OfPoints ? step.HidesPoints : step.HidesCells))
    {
      continue;
    }
    // Cells lie beside each other otherwise than the samples that have their places.
    const bool direct =
      step.HoldsWhole[static_cast<std::size_t>(owner)] && arrays[i].Flags != ArrayFlags::OfCells;
    if (!direct)
    {
      this->Transfer(mine, step, arrays[i], owner, receives ? &whole[i] : nullptr);
    }
    else if (receives)
    {
      this->Copy(mine, arrays[i], step.Whole.Extent, whole[i].data());
    }
  }
  ThrowTogether(this->Ranks, this->Problem);
}

/// A failure must not keep the messages from being sent that others wait for.
void StepGathering::Copy(
  vtkImageData* mine, const WrittenArray& array, const Box& part, unsigned char* to)
{
  std::string failure;
  Attempt(failure,
    [&]
    {
      if (array.Flags == ArrayFlags::None)
      {
        CopyPart(mine, ArrayOf(mine, array.Name), part, to);
      }
      else
      {
        CopyFlags(mine, array.Flags, part, to);
      }
    });
  if (!failure.empty())
  {
    this->Problem = "The values of the array " + array.Name + " cannot be copied: " + failure;
  }
}

void StepGathering::Transfer(vtkImageData* mine, const StepAgreement& step,
  const WrittenArray& array, int owner, std::vector<unsigned char>* whole)
{
  const std::size_t tupleBytes = TupleBytes(array);
  const GatherPlan& plan = array.Flags == ArrayFlags::OfCells ? step.CellPlan : step.Plan;
  for (const GatherPlan::Part& message : Messages(plan, tupleBytes))
  {
    const std::size_t bytes = static_cast<std::size_t>(message.Samples.Count()) * tupleBytes;
    const bool sends = this->Ranks.Rank() == message.Rank;
    if (sends)
    {
      this->Copy(mine, array, message.Samples, this->Message.data());
    }
    if (sends && !whole)
    {
      this->Ranks.Send(owner, MessageTag, this->Message.data(), bytes);
    }
    if (!sends && whole)
    {
      this->Ranks.Receive(message.Rank, MessageTag, this->Message.data(), bytes);
    }
    this->Ranks.WaitAll();
    if (whole)
    {
      PlacePart(
        this->Message.data(), message.Samples, whole->data(), step.Whole.Extent, tupleBytes);
    }
  }
}

} // namespace banyan
