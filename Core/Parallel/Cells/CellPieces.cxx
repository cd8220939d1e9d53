// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/CellPieces.h"

#include "Base/Error.h"
#include "Cells/CellOrder.h"
#include "Cells/FaceKeys.h"
#include "Cells/PlaceHash.h"
#include "Parallel/Cells/HashedQuestions.h"
#include "Parallel/Cells/RepeatedCells.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

namespace banyan
{
namespace
{

/// A face that one cell of a piece has alone.
struct LoneFace
{
  FaceKey Key;
  CellKey Owner;
};
static_assert(sizeof(LoneFace) == 24, "sent as it is");

std::vector<LoneFace> LoneFacesOf(const DrawnCells& cells)
{
  const CellKeys order(cells.Mesh, cells.OrderedBy);
  std::vector<LoneFace> faces;
  faces.reserve(cells.Border.size());
  for (const BorderFace& face : cells.Border)
  {
    const std::uint32_t number = cells.Order[face.Cell];
    const MeshCell cell = cells.Mesh.Cell(number);
    CornerHashes hashes{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(CornersOf(cell.Shape)); ++i)
    {
      hashes[i] = HashOfPlace(cells.Mesh.Point(cell.Points[i]));
    }
    std::array<FaceKey, 6> keys{};
    FaceKeysOf(cell.Shape, hashes, keys);
    faces.push_back({ keys[face.Face], order.Of(number) });
  }
  return faces;
}

/// Which of the faces that ranks ask about belong to the border: one byte each, 1 or 0.
std::vector<Bytes> AnswerAbout(const std::vector<Bytes>& asked)
{
  std::vector<Bytes> answers(asked.size());
  for (std::size_t rank = 0; rank < asked.size(); ++rank)
  {
    answers[rank].assign(asked[rank].size() / sizeof(LoneFace), 0);
  }
  using Entry = AskedRecord<LoneFace>;
  std::vector<Entry> entries = RecordsOf<LoneFace>(asked, sizeof(LoneFace));
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b)
    {
      return std::tie(a.Of.Key, a.Of.Owner, a.Rank, a.Index) <
             std::tie(b.Of.Key, b.Of.Owner, b.Rank, b.Index);
    });
  // As in one mesh: of an odd number of cells the first one keeps the face.
  ForGroups(
    entries, [](const Entry& a, const Entry& b) { return a.Of.Key == b.Of.Key; },
    [&](std::size_t begin, std::size_t end)
    { answers[entries[begin].Rank][entries[begin].Index] = (end - begin) % 2 == 1 ? 1 : 0; });
  return answers;
}

/// Collective: leaves those faces that no other piece has.
void TakeOutShared(Communicator& communicator, DrawnCells& cells)
{
  std::string failure;
  HashedQuestions questions(communicator.Size(), sizeof(LoneFace));
  Attempt(failure,
    [&]
    {
      for (const LoneFace& face : LoneFacesOf(cells))
      {
        StoreNumber(questions.Add(face.Key), face);
      }
    });
  const Bytes answers = questions.Ask(communicator, 1, AnswerAbout, failure);
  Collective(communicator,
    [&]
    {
      std::vector<BorderFace> border;
      for (std::size_t i = 0; i < answers.size(); ++i)
      {
        if (answers[i] != 0)
        {
          border.push_back(cells.Border[i]);
        }
      }
      cells.SetBorder(std::move(border));
    });
}

/// What the lattice of all pieces follows from.
CellExtent ExtentOfAll(Communicator& communicator, const CellExtent& mine)
{
  std::vector<CellExtent> extents(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), extents.data());
  CellExtent all;
  for (const CellExtent& extent : extents)
  {
    all.Include(extent);
  }
  return all;
}

} // namespace

std::shared_ptr<const DrawnCells> DrawnPiece(
  Communicator& communicator, const CellMesh& mesh, CellFacts& facts, ThreadPool& pool)
{
  CellExtent mine;
  Collective(communicator,
    [&]
    {
      facts = CheckCells(mesh, pool);
      mine = ExtentOf(mesh, facts, pool);
    });
  const CellExtent extent = ExtentOfAll(communicator, mine);
  LeaveOutRepeated(communicator, mesh, mine, extent, facts);
  std::shared_ptr<DrawnCells> cells;
  Collective(communicator, [&] { cells = DrawnCells::OfPiece(mesh, facts, extent, pool); });
  TakeOutShared(communicator, *cells);
  cells->Count = static_cast<std::int64_t>(AllSum(communicator, static_cast<double>(cells->Count)));
  return cells;
}

} // namespace banyan
