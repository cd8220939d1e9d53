// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/CoarseSamples.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Composite/GatherPlan.h"
#include "Render/Bricks/BrickSource.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

constexpr int CoarseTag = 74;

/// Returns a type that the views of all ranks can be converted to.
ScalarType CommonType(const std::vector<ScalarType>& types)
{
  const bool one =
    std::all_of(types.begin(), types.end(), [&](ScalarType type) { return type == types.front(); });
  return one ? types.front() : ScalarType::Float64;
}

/// An array of its own, for a box of samples.
SampleArray ArrayOf(const BrickView& view, const Box& samples, bool colours)
{
  SampleArray array;
  array.Component = colours ? SampleArray::Colours : 0;
  array.Values = view.Values;
  array.Type = view.Type;
  std::copy_n(view.Stride, 3, array.Stride);
  array.Samples = samples;
  array.Owner = view.Owner;
  return array;
}

/// All samples of a box from parts of it.
/// @param missing whether the parts leave some out
PieceSamples Join(
  std::vector<SampledBox> parts, const Box& samples, ScalarType type, bool missing, bool colours)
{
  if (samples.Empty())
  {
    return {};
  }
  if (missing)
  {
    parts.insert(parts.begin(), MissingSamples(samples));
  }
  return PieceSamples(
    ArrayOf(Assemble(parts, samples, missing ? TypeWithMissing(type) : type), samples, colours));
}

} // namespace

CoarsePieces::CoarsePieces(
  const PieceGrid& finest, const glm::ivec3& cells, const glm::ivec3& edges)
  : Every(edges)
  , LastFine(cells)
{
  for (int rank = 0; rank < finest.Ranks(); ++rank)
  {
    const Box& fine = finest.SamplesOf(rank);
    Box held;
    Box needed;
    if (!fine.Empty())
    {
      needed = CellsAtLevel({ fine.Lo, fine.Hi - 1 }, edges);
      held = { needed.Lo, (fine.Hi - 1) / edges + 1 };
      for (int axis = 0; axis < 3; ++axis)
      {
        // The last fine sample is repeated where the last cell is not whole.
        if (fine.Hi[axis] > cells[axis])
        {
          held.Hi[axis] = (cells[axis] + edges[axis] - 1) / edges[axis] + 1;
        }
      }
      needed.Hi = needed.Empty() ? needed.Lo : needed.Hi + 1;
    }
    this->Held.push_back(held.Empty() ? Box{} : held);
    this->Needed.push_back(needed.Empty() ? Box{} : needed);
  }
}

void CoarsePieces::Copy(
  const PieceSamples& mine, const Box& samples, ScalarType type, void* out) const
{
  const Box& own = mine.Array().Array().Samples;
  const auto fine = [this](int coarse, int axis)
  { return std::min(coarse * this->Every[axis], this->LastFine[axis]); };
  std::size_t at = 0;
  for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
  {
    // A slice at a time: views of magnitudes and of hidden samples are copies.
    const Box slice{ { own.Lo.x, own.Lo.y, fine(z, 2) }, { own.Hi.x, own.Hi.y, fine(z, 2) + 1 } };
    const BrickView view = mine.View(slice);
    Dispatch(view.Type,
      [&](auto from)
      {
        using From = typename decltype(from)::Type;
        const From* const values = static_cast<const From*>(view.Values);
        Dispatch(type,
          [&](auto to)
          {
            using To = typename decltype(to)::Type;
            To* next = static_cast<To*>(out) + at;
            for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
            {
              const From* const row = values + (fine(y, 1) - own.Lo.y) * view.Stride[1];
              for (int x = samples.Lo.x; x < samples.Hi.x; ++x)
              {
                *next++ = static_cast<To>(row[(fine(x, 0) - own.Lo.x) * view.Stride[0]]);
              }
            }
          });
      });
    at += static_cast<std::size_t>(samples.Size().x) * static_cast<std::size_t>(samples.Size().y);
  }
}

PieceSamples CoarsePieces::Gather(Communicator& communicator, const PieceSamples& mine,
  const std::vector<ScalarType>& viewTypes) const
{
  PieceSamples gathered;
  communicator.Together(
    [&](Communicator& ranks) { gathered = this->GatherTogether(ranks, mine, viewTypes); });
  return gathered;
}

PieceSamples CoarsePieces::GatherTogether(Communicator& communicator, const PieceSamples& mine,
  const std::vector<ScalarType>& viewTypes) const
{
  const int self = communicator.Rank();
  const ScalarType type = CommonType(viewTypes);
  std::vector<SampledBox> parts;
  std::vector<BrickView> sent; ///< keeps what is sent until it has arrived
  bool missing = false;
  std::string failure;
  for (int rank = 0; rank < communicator.Size(); ++rank)
  {
    const Box& needed = this->Needed[static_cast<std::size_t>(rank)];
    if (needed.Empty())
    {
      continue;
    }
    const GatherPlan plan = PlanGathering(needed, this->Held);
    missing = missing || (rank == self && !plan.Missing.empty());
    for (const GatherPlan::Part& part : plan.Parts)
    {
      if (rank != self && part.Rank != self)
      {
        continue;
      }
      void* values = nullptr;
      const BrickView view = AllocateView(part.Samples, type, values);
      const std::size_t bytes = static_cast<std::size_t>(part.Samples.Count()) * SizeOf(type);
      if (part.Rank == self)
      {
        Attempt(failure, [&] { this->Copy(mine, part.Samples, type, values); });
      }
      if (rank != self)
      {
        communicator.Send(rank, CoarseTag, values, bytes);
        sent.push_back(view);
        continue;
      }
      parts.push_back({ view, part.Samples });
      if (part.Rank != self)
      {
        communicator.Receive(part.Rank, CoarseTag, values, bytes);
      }
    }
  }
  communicator.WaitAll();
  ThrowTogether(communicator, failure);
  return Join(std::move(parts), this->Needed[static_cast<std::size_t>(self)], type, missing,
    mine.HasColours());
}

} // namespace banyan
