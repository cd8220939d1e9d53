// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/RepeatedCells.h"

#include "Cells/CellOrder.h"
#include "Parallel/Cells/HashedQuestions.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <glm/common.hpp>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

static_assert(sizeof(CellKey) == 16, "sent as it is");

/// A box in the world; upside down where there is nothing.
struct WorldBox
{
  glm::dvec3 Low;
  glm::dvec3 High;

  bool Holds(const glm::dvec3& point) const
  {
    return point == glm::clamp(point, this->Low, this->High);
  }
};

/// What is in this rank's box and in that of another one.
std::vector<WorldBox> SharedBoxes(Communicator& communicator, const CellExtent& mine)
{
  const WorldBox box{ mine.Low, mine.High };
  std::vector<WorldBox> boxes(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&box, sizeof(box), boxes.data());
  std::vector<WorldBox> shared;
  for (std::size_t rank = 0; rank < boxes.size(); ++rank)
  {
    const WorldBox both{ glm::max(box.Low, boxes[rank].Low), glm::min(box.High, boxes[rank].High) };
    if (rank != static_cast<std::size_t>(communicator.Rank()) && both.Low.x <= both.High.x &&
        both.Low.y <= both.High.y && both.Low.z <= both.High.z)
    {
      shared.push_back(both);
    }
  }
  return shared;
}

/// The numbers of drawn cells that others may have, too.
std::vector<std::int64_t> CellsInBoxes(
  const CellMesh& mesh, const CellFacts& facts, const std::vector<WorldBox>& boxes)
{
  std::vector<std::int64_t> cells;
  for (std::int64_t number = 0; number < mesh.CellCount && !boxes.empty(); ++number)
  {
    if (facts.Draws(number))
    {
      const glm::dvec3 corner = mesh.Point(mesh.Cell(number).Points[0]);
      if (std::any_of(
            boxes.begin(), boxes.end(), [&](const WorldBox& box) { return box.Holds(corner); }))
      {
        cells.push_back(number);
      }
    }
  }
  return cells;
}

/// Which of the cells that ranks ask about a higher rank has, too: one byte each, 1 or 0.
std::vector<Bytes> AnswerAbout(const std::vector<Bytes>& asked)
{
  std::vector<Bytes> answers(asked.size());
  for (std::size_t rank = 0; rank < asked.size(); ++rank)
  {
    answers[rank].assign(asked[rank].size() / sizeof(CellKey), 0);
  }
  using Entry = AskedRecord<CellKey>;
  std::vector<Entry> entries = RecordsOf<CellKey>(asked, sizeof(CellKey));
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b)
    { return std::tie(a.Of, a.Rank, a.Index) < std::tie(b.Of, b.Rank, b.Index); });
  ForGroups(
    entries, [](const Entry& a, const Entry& b) { return a.Of == b.Of; },
    [&](std::size_t begin, std::size_t end)
    {
      for (std::size_t i = begin; i < end; ++i)
      {
        answers[entries[i].Rank][entries[i].Index] = entries[i].Rank < entries[end - 1].Rank;
      }
    });
  return answers;
}

} // namespace

void LeaveOutRepeated(Communicator& communicator, const CellMesh& mesh, const CellExtent& mine,
  const CellExtent& ofAll, CellFacts& facts)
{
  const std::vector<WorldBox> boxes = SharedBoxes(communicator, mine);
  std::vector<std::int64_t> cells;
  HashedQuestions questions(communicator.Size(), sizeof(CellKey));
  std::string failure;
  Attempt(failure,
    [&]
    {
      const CellLattice lattice = LatticeOf(ofAll);
      const CellKeys keys(mesh, lattice);
      cells = CellsInBoxes(mesh, facts, boxes);
      for (const std::int64_t cell : cells)
      {
        const CellKey key = keys.Of(cell);
        StoreNumber(questions.Add(key.Hash), key);
      }
    });
  const Bytes answers = questions.Ask(communicator, 1, AnswerAbout, failure);
  Collective(communicator,
    [&]
    {
      for (std::size_t i = 0; i < cells.size(); ++i)
      {
        if (answers[i] != 0)
        {
          facts.LeftOut.resize(static_cast<std::size_t>(mesh.CellCount), 0);
          facts.LeftOut[static_cast<std::size_t>(cells[i])] = 1;
        }
      }
    });
}

} // namespace banyan
