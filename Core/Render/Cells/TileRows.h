// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_TileRows_h
#define banyan_Render_Cells_TileRows_h

#include "Render/Raycast/RayTile.h"
#include "Render/Scene/RayLattice.h"

#include <cstdint>

namespace banyan
{

/// The samples of a tile's rays in rows: a row holds those of one interval of all rays, counted
/// from the eye. A ray's head is in the row before its first whole sample, its tail in the one
/// behind the last.
struct TileRows
{
  static constexpr int None = -1;

  /// Takes the samples of a tile.
  /// @param lattice of the tile's rays
  void Take(const RayTile& tile, const LatticeSetup& lattice);

  double FirstNumber = 0.0; ///< of the interval that row 0 holds
  int Count = 0;            ///< rows in all; 0 where no ray has samples
  bool AnyEnds = false;     ///< whether some ray has a head or tail

  // By axis and slot. A whole sample of row n lies at Zero + n * tile.WholeStep, in fixed-point
  // numbers that double holds exactly. Rays without whole samples, whose WholeStep is 0, are at
  // their head, or at their tail if they have none.
  alignas(64) double Zero[3][RayTile::Slots];
  alignas(64) std::uint32_t ZeroLow[3][RayTile::Slots]; ///< the same modulo 256 cells
  alignas(64) float Step[3][RayTile::Slots];            ///< in cells
  // By slot: rows.
  alignas(64) std::int32_t First[RayTile::Slots]; ///< of the whole samples
  alignas(64) std::int32_t End[RayTile::Slots];
  alignas(64) std::int32_t Head[RayTile::Slots]; ///< None where there is none
  alignas(64) std::int32_t Tail[RayTile::Slots];
  // By packet: the rows that have heads or tails, First > Last where none has.
  struct Range
  {
    std::int32_t First;
    std::int32_t Last;
  };
  Range Heads[RayTile::Slots / RayTile::PacketSize];
  Range Tails[RayTile::Slots / RayTile::PacketSize];
};

} // namespace banyan

#endif
