// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/CellPieces.h"

#include "Base/Error.h"
#include "Cells/CellOrder.h"
#include "Cells/FaceKeys.h"
#include "Cells/PlaceHash.h"
#include "Parallel/Cells/ExchangeBytes.h"
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

std::size_t RankFor(FaceKey key, int size)
{
  return static_cast<std::size_t>(key % static_cast<FaceKey>(size));
}

/// Which of the faces that ranks ask about belong to the border: one byte each, 1 or 0.
/// @param asked by rank
std::vector<Bytes> AnswerAbout(const std::vector<Bytes>& asked)
{
  struct Entry
  {
    LoneFace Face;
    std::size_t Rank;
    std::size_t Index;
  };
  std::vector<Entry> entries;
  std::vector<Bytes> answers(asked.size());
  for (std::size_t rank = 0; rank < asked.size(); ++rank)
  {
    const std::size_t count = asked[rank].size() / sizeof(LoneFace);
    answers[rank].assign(count, 0);
    for (std::size_t i = 0; i < count; ++i)
    {
      entries.push_back(
        { LoadNumber<LoneFace>(asked[rank].data() + i * sizeof(LoneFace)), rank, i });
    }
  }
  std::sort(entries.begin(), entries.end(),
    [](const Entry& a, const Entry& b)
    {
      return std::tie(a.Face.Key, a.Face.Owner, a.Rank, a.Index) <
             std::tie(b.Face.Key, b.Face.Owner, b.Rank, b.Index);
    });
  // As in one mesh: of an odd number of cells the first one keeps the face.
  for (std::size_t begin = 0, end = 0; begin < entries.size(); begin = end)
  {
    for (end = begin + 1; end < entries.size() && entries[end].Face.Key == entries[begin].Face.Key;)
    {
      ++end;
    }
    answers[entries[begin].Rank][entries[begin].Index] = (end - begin) % 2 == 1 ? 1 : 0;
  }
  return answers;
}

/// Leaves those faces that no other piece has.
void TakeOutShared(Communicator& communicator, DrawnCells& cells)
{
  const int size = communicator.Size();
  const std::vector<LoneFace> faces = LoneFacesOf(cells);
  std::vector<Bytes> asked(static_cast<std::size_t>(size));
  for (const LoneFace& face : faces)
  {
    Bytes& message = asked[RankFor(face.Key, size)];
    message.resize(message.size() + sizeof(face));
    StoreNumber(message.data() + message.size() - sizeof(face), face);
  }
  const std::vector<Bytes> answers =
    ExchangeBytes(communicator, AnswerAbout(ExchangeBytes(communicator, std::move(asked))));
  std::vector<std::size_t> taken(answers.size(), 0);
  std::vector<BorderFace> border;
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    const std::size_t rank = RankFor(faces[i].Key, size);
    if (answers[rank].at(taken[rank]++) != 0)
    {
      border.push_back(cells.Border[i]);
    }
  }
  cells.SetBorder(std::move(border));
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
  std::string failure;
  CellExtent mine;
  Attempt(failure,
    [&]
    {
      facts = CheckCells(mesh, pool);
      mine = ExtentOf(mesh, facts, pool);
    });
  ThrowTogether(communicator, failure);
  const CellExtent extent = ExtentOfAll(communicator, mine);
  LeaveOutRepeated(communicator, mesh, mine, extent, facts);
  std::shared_ptr<DrawnCells> cells;
  Attempt(failure, [&] { cells = DrawnCells::OfPiece(mesh, facts, extent, pool); });
  ThrowTogether(communicator, failure);
  TakeOutShared(communicator, *cells);
  return cells;
}

} // namespace banyan
