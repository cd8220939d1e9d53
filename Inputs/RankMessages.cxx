// SPDX-License-Identifier: BSD-3-Clause
#include "RankMessages.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include "vtkCharArray.h"
#include "vtkCommunicator.h"
#include "vtkDataObject.h"
#include "vtkNew.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr int DataTag = 0;

} // namespace

std::vector<vtkMultiProcessStream> AllGatherStreams(
  Communicator& ranks, const vtkMultiProcessStream& mine)
{
  const std::vector<unsigned char> bytes = mine.GetRawData();
  std::vector<vtkMultiProcessStream> all;
  for (const std::string& theirs : AllGatherStrings(ranks, std::string(bytes.begin(), bytes.end())))
  {
    all.emplace_back();
    all.back().SetRawData(std::vector<unsigned char>(theirs.begin(), theirs.end()));
  }
  return all;
}

std::vector<vtkSmartPointer<vtkDataObject>> GatherData(Communicator& ranks, vtkDataObject* mine)
{
  vtkNew<vtkCharArray> message;
  std::string failure;
  if (ranks.Rank() > 0)
  {
    Attempt(failure, [&] { vtkCommunicator::MarshalDataObject(mine, message); });
  }
  const std::vector<double> lengths =
    AllGatherValues(ranks, static_cast<double>(message->GetNumberOfValues()));
  std::vector<vtkSmartPointer<vtkDataObject>> all;
  if (ranks.Rank() == 0)
  {
    Attempt(failure,
      [&]
      {
        all.resize(lengths.size());
        all.front() = mine;
        const double longest = *std::max_element(lengths.begin(), lengths.end());
        message->SetNumberOfValues(static_cast<vtkIdType>(longest));
      });
  }
  ThrowTogether(ranks, failure);
  if (ranks.Rank() > 0)
  {
    ranks.Send(0, DataTag, message->GetPointer(0), static_cast<std::size_t>(lengths[ranks.Rank()]));
    ranks.WaitAll();
  }
  // One after the other, so that rank 0 holds one message at a time. A failure must not keep it
  // from receiving those that others are sending.
  for (std::size_t rank = 1; rank < all.size(); ++rank)
  {
    const auto length = static_cast<vtkIdType>(lengths[rank]);
    message->SetNumberOfValues(length); // frees nothing
    ranks.Receive(
      static_cast<int>(rank), DataTag, message->GetPointer(0), static_cast<std::size_t>(length));
    ranks.WaitAll();
    Attempt(failure, [&] { all[rank] = vtkCommunicator::UnMarshalDataObject(message); });
  }
  ThrowTogether(ranks, failure);
  return all;
}

} // namespace banyan
