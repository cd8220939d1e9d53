// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Wall_h
#define banyan_Benchmarks_Wall_h

#include "Parallel/Composite/PicturePlace.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace banyan::bench
{

/// A wall of equal tiles without gaps, as wide as 16:9: tile i is shown by rank i.
struct Wall
{
  glm::ivec2 Size{ 0 }; ///< pixels
  std::vector<PicturePlace> Tiles;

  /// @param megapixels above 0; met within one pixel per tile and axis
  /// @param tiles at least 1; their columns and rows are those with the squarest tiles
  Wall(double megapixels, int tiles)
  {
    const double width = std::sqrt(1e6 * megapixels * 16.0 / 9.0);
    const double height = width * 9.0 / 16.0;
    glm::ivec2 counts(1);
    double best = -1.0;
    for (int columns = 1; columns <= tiles; ++columns)
    {
      const int rows = tiles / columns;
      const double aspect = width / columns / (height / rows);
      const double square = std::min(aspect, 1.0 / aspect);
      if (columns * rows == tiles && square > best)
      {
        best = square;
        counts = { columns, rows };
      }
    }
    const glm::ivec2 tile(std::lround(width / counts.x), std::lround(height / counts.y));
    this->Size = tile * counts;
    for (int i = 0; i < tiles; ++i)
    {
      const glm::ivec2 low = tile * glm::ivec2(i % counts.x, i / counts.x);
      this->Tiles.push_back({ { low, low + tile }, i, {} });
    }
  }
};

/// A column of the table: a wall, and the ranks that draw it.
struct WallColumn
{
  double Megapixels = 4.0;
  int Tiles = 1; ///< of the first ranks
  int Ranks = 1;
};

} // namespace banyan::bench

#endif
