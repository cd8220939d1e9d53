// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellField.h"

#include "Base/Error.h"
#include "Cells/CellOrder.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// Room around a mesh: a part of its longest edge, and so many edges of cells at least.
constexpr int RoomPart = 16;
constexpr int LeastRoom = 8;

std::shared_ptr<DrawnCells> Made(
  const CellMesh& mesh, CellFacts& facts, const CellExtent& ofAll, ThreadPool& pool)
{
  auto cells = std::make_shared<DrawnCells>();
  cells->Mesh = mesh;
  const CellLattice tight = LatticeOf(ofAll);
  cells->Low = ofAll.Low;
  cells->High = ofAll.High;
  cells->Order = OrderOfCells(mesh, facts, tight, pool);
  cells->Count = static_cast<std::int64_t>(cells->Order.size());
  facts.Repeated = facts.Drawn() - cells->Count;
  cells->OrderedBy = tight;
  const int longest = std::max({ tight.Size.x, tight.Size.y, tight.Size.z });
  const int room = std::max(longest / RoomPart, LeastRoom);
  cells->Lattice = tight;
  cells->Lattice.Origin -= room * tight.Edge;
  cells->Lattice.Size += 2 * room;
  return cells;
}

} // namespace

std::shared_ptr<const DrawnCells> DrawnCells::Of(
  const CellMesh& mesh, CellFacts& facts, ThreadPool& pool)
{
  facts = CheckCells(mesh, pool);
  const std::shared_ptr<DrawnCells> cells = Made(mesh, facts, ExtentOf(mesh, facts, pool), pool);
  cells->SetBorder(BorderFacesOf(mesh, facts, cells->Order, pool));
  return cells;
}

std::shared_ptr<DrawnCells> DrawnCells::OfPiece(
  const CellMesh& mesh, CellFacts& facts, const CellExtent& ofAll, ThreadPool& pool)
{
  std::shared_ptr<DrawnCells> cells = Made(mesh, facts, ofAll, pool);
  if (cells->Order.size() >= std::size_t{ 1 } << 31)
  {
    throw Error("The piece of the mesh on this process has 2^31 cells or more: divide it among "
                "more processes");
  }
  cells->SetBorder(BorderFacesOf(mesh, facts, cells->Order, pool));
  cells->IsPiece = true;
  cells->Alone = cells->BorderBits;
  cells->Alone.resize(cells->Order.size(), 0);
  return cells;
}

void DrawnCells::SetBorder(std::vector<BorderFace> border)
{
  this->Border = std::move(border);
  this->BorderBits = BorderBitsOf(this->Border, this->Order.size());
}

std::size_t DrawnCells::Bytes() const
{
  return this->Order.capacity() * sizeof(this->Order[0]) +
         this->Border.capacity() * sizeof(this->Border[0]) + this->BorderBits.capacity() +
         this->Alone.capacity();
}

} // namespace banyan
