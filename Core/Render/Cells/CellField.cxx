// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellField.h"

#include "Cells/CellOrder.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Room around a mesh: a part of its longest edge, and so many edges of cells at least.
constexpr int RoomPart = 16;
constexpr int LeastRoom = 8;

} // namespace

std::shared_ptr<const DrawnCells> DrawnCells::Of(
  const CellMesh& mesh, CellFacts& facts, ThreadPool& pool)
{
  auto cells = std::make_shared<DrawnCells>();
  cells->Mesh = mesh;
  facts = CheckCells(mesh, pool);
  const CellExtent extent = ExtentOf(mesh, facts, pool);
  const CellLattice tight = LatticeOf(extent);
  cells->Low = extent.Low;
  cells->High = extent.High;
  cells->Order = OrderOfCells(mesh, facts, tight, pool);
  facts.Repeated = facts.Drawn() - static_cast<std::int64_t>(cells->Order.size());
  cells->Border = BorderFacesOf(mesh, facts, cells->Order, pool);
  cells->BorderBits = BorderBitsOf(cells->Border, cells->Order.size());
  const int longest = std::max({ tight.Size.x, tight.Size.y, tight.Size.z });
  const int room = std::max(longest / RoomPart, LeastRoom);
  cells->Lattice = tight;
  cells->Lattice.Origin -= room * tight.Edge;
  cells->Lattice.Size += 2 * room;
  return cells;
}

std::size_t DrawnCells::Bytes() const
{
  return this->Order.capacity() * sizeof(this->Order[0]) +
         this->Border.capacity() * sizeof(this->Border[0]) + this->BorderBits.capacity();
}

} // namespace banyan
