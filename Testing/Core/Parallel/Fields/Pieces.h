// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Pieces_Pieces_h
#define banyan_Testing_Core_Pieces_Pieces_h

#include "Parallel/Balance/ZoneTree.h"
#include "Render/Scenes.h"

#include <cstring>
#include <vector>

namespace pieces
{

using namespace banyan;

/// A part of a whole grid in memory of its own, as a reader deals it to a rank.
template <class T>
struct Piece
{
  std::vector<T> Values;
  SampleArray Array;

  Piece(const std::vector<T>& whole, const glm::ivec3& n, const Box& samples)
  {
    this->Array.Type = ScalarTypeOf<T>();
    if (samples.Empty())
    {
      return;
    }
    for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
    {
      for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
      {
        const T* row = whole.data() + n.x * (y + std::size_t(n.y) * z);
        this->Values.insert(this->Values.end(), row + samples.Lo.x, row + samples.Hi.x);
      }
    }
    this->Array.Values = this->Values.data();
    this->Array.Samples = samples;
    this->Array.Stride[1] = samples.Size().x;
    this->Array.Stride[2] = std::ptrdiff_t{ samples.Size().x } * samples.Size().y;
  }
  Piece(const Piece&) = delete;
  void operator=(const Piece&) = delete;
};

/// How a reader may deal samples to ranks.
enum class Deal
{
  Slabs,     ///< along z, with one layer of samples in common
  Blocks,    ///< of a kd-tree
  Ghosts,    ///< blocks with one more layer of cells around
  OneHasAll, ///< the last rank
  Everybody, ///< all ranks have everything
  SomeIdle,  ///< every third rank has nothing
  Hole,      ///< what the second rank should have is missing
  Pinwheel   ///< no plane goes between the pieces, if there are enough ranks
};

inline Box SamplesOfCells(const Box& cells)
{
  return cells.Empty() ? Box{} : Box{ cells.Lo, cells.Hi + 1 };
}

/// Five boxes around each other; all others have nothing.
inline std::vector<Box> PinwheelOf(const glm::ivec3& cells, int ranks)
{
  const glm::ivec3 a = cells / 3;
  const glm::ivec3 b = cells - a;
  std::vector<Box> zones{ { { 0, 0, 0 }, { b.x, a.y, cells.z } },
    { { b.x, 0, 0 }, { cells.x, b.y, cells.z } },
    { { a.x, b.y, 0 }, { cells.x, cells.y, cells.z } },
    { { 0, a.y, 0 }, { a.x, cells.y, cells.z } }, { { a.x, a.y, 0 }, { b.x, b.y, cells.z } } };
  zones.resize(static_cast<std::size_t>(ranks));
  return zones;
}

/// The samples of each rank's piece.
inline std::vector<Box> Dealt(Deal deal, const glm::ivec3& n, int ranks)
{
  const Box whole{ glm::ivec3(0), n };
  const glm::ivec3 cells = n - 1;
  std::vector<Box> pieces;
  if (deal == Deal::Pinwheel && ranks >= 5)
  {
    for (const Box& zone : PinwheelOf(cells, ranks))
    {
      pieces.push_back(SamplesOfCells(zone));
    }
    return pieces;
  }
  const std::vector<Box> blocks = ZonesOf(EqualZoneTree(cells, ranks));
  for (int rank = 0; rank < ranks; ++rank)
  {
    Box piece = SamplesOfCells(blocks[static_cast<std::size_t>(rank)]);
    if (deal == Deal::Slabs)
    {
      piece = whole;
      piece.Lo.z = cells.z * rank / ranks;
      piece.Hi.z = cells.z * (rank + 1) / ranks + 1;
    }
    else if (deal == Deal::Ghosts && !piece.Empty())
    {
      piece = Intersection({ piece.Lo - 1, piece.Hi + 1 }, whole);
    }
    else if (deal == Deal::OneHasAll)
    {
      piece = rank == ranks - 1 ? whole : Box{};
    }
    else if (deal == Deal::Everybody)
    {
      piece = whole;
    }
    else if (deal == Deal::Hole && rank == 1)
    {
      piece = Box{};
    }
    pieces.push_back(piece);
  }
  if (deal == Deal::SomeIdle)
  {
    const int holders = ranks - (ranks + 1) / 3;
    const std::vector<Box> fewer = ZonesOf(EqualZoneTree(cells, holders));
    int next = 0;
    for (int rank = 0; rank < ranks; ++rank)
    {
      const bool idle = rank % 3 == 1;
      pieces[static_cast<std::size_t>(rank)] =
        idle ? Box{} : SamplesOfCells(fewer[static_cast<std::size_t>(next++)]);
    }
  }
  return pieces;
}

} // namespace pieces

#endif
