// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_CompositePlan_h
#define banyan_Parallel_Composite_CompositePlan_h

#include "Parallel/Composite/Footprints.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// Describes the machine; the same on all ranks.
struct CompositeCosts
{
  double BytesPerSecond = 1.25e9;    ///< of one rank's link
  double SecondsPerMessage = 10e-6;  ///< until a short message is there
  double PackedBytesPerSecond = 2e9; ///< of pixels (4 bytes each) that one rank packs or unpacks
  double PackingRatio = 2.5;         ///< that packing is expected to reach
};

/// Whether packing pays: the root unpacks while it receives, so the slower of the two counts.
bool PackingPays(const CompositeCosts& costs);

/// Which rank composites which part of a picture, so that every rank knows what to send where and
/// what it will receive. A pure function of its arguments: no message is needed for it.
///
/// The picture is cut into square tiles of cells of 8 x 8 pixels. Where at most one rank other than
/// the root may draw in a cell, that rank sends its pixels straight to the root. All other cells of
/// a tile have one owner, a rank that may draw there; those that may draw there too send it their
/// pixels, it blends them and sends the result to the root. The root sends nothing: what lies
/// before and behind its own pixels comes to it apart.
/// @par Source: "A parallel visualization pipeline for terascale earthquake simulations", section
/// 4.2 (SLIC), with tiles in the place of spans.
struct CompositePlan
{
  static constexpr int CellPixels = 8;

  /// How pixels of a cell become final.
  enum class Kind : std::uint8_t
  {
    Final,  ///< on the sender: nothing of the root is there
    Behind, ///< on the root, which has something behind them
    Split   ///< on the root, which has pixels between those before and those behind them
  };
  static constexpr int Kinds = 3;

  struct Cell
  {
    std::uint16_t Others = 0; ///< ranks other than the root that may draw here
    Kind How = Kind::Final;
  };
  struct Tile
  {
    int Owner = -1;  ///< -1 if no cell needs one
    int Meeting = 1; ///< most fragments that travel to the owner for one pixel
    int Chunk = 0;
    std::uint8_t Kinds = 0; ///< a bit per kind of its cells
  };
  /// A run of pixels in a row of the picture; `Reversed` ones are sent from right to left, so that
  /// pixels that follow each other are neighbours.
  struct Run
  {
    int Y = 0;
    int Lo = 0;
    int Hi = 0;
    bool Reversed = false;
  };
  using Region = std::vector<Run>;

  int Ranks = 0;
  int Root = 0; ///< the rank that gets the picture
  PixelRect Viewport;
  int TilePixels = 0;
  int Chunks = 1; ///< parts that are sent one after the other
  glm::ivec2 CellCounts{ 0 };
  glm::ivec2 TileCounts{ 0 };
  std::vector<Cell> Cells; ///< `[y][x]`
  std::vector<Tile> Tiles; ///< `[y][x]`
  /// Per rank and row of cells: the cells that the rank may draw in, as an interval.
  std::vector<std::vector<Footprint::Interval>> Covered;
  std::vector<std::vector<int>> TilesOfChunk;
  std::vector<std::vector<int>> TilesOfRank; ///< tiles that the rank may draw in, ascending

  bool Covers(int rank, int cellX, int cellY) const
  {
    const Footprint::Interval row = this->Covered[rank][cellY];
    return row.Lo <= cellX && cellX < row.Hi;
  }
  PixelRect RectOfTile(int tile) const;

  /// Pixels of one kind in a tile that `rank` sends straight to the root.
  void DirectRegion(int rank, int tile, Kind kind, Region& region) const;
  /// Gives the pixels that a rank sends to the owner of the tile, or blends as the owner.
  void SharedRegion(int rank, int tile, Kind kind, Region& region) const;
  /// Gives the pixels that the owner of the tile sends to the root after blending.
  void ResultRegion(int tile, Kind kind, Region& region) const;

private:
  template <typename Wanted>
  void Collect(int tile, const Wanted& wanted, int rank, Region& region) const;
};

/// @param footprints where each rank may draw, inside the viewport
/// @param behind pixels that the root will blend over something
/// @param ordered whether pixels before and behind those of the root must be kept apart
CompositePlan PlanCompositing(const std::vector<Footprint>& footprints, const PixelRect& viewport,
  const PixelRect& behind, bool ordered, int root = 0);

} // namespace banyan

#endif
