// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/BorderFaces.h"

#include "Base/FirstFailure.h"
#include "Base/LargePages.h"
#include "Base/RadixSort.h"
#include "Base/ThreadPool.h"
#include "Cells/CellCorners.h"
#include "Cells/EqualRuns.h"
#include "Cells/FaceKeys.h"
#include "Cells/PlaceHash.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

namespace banyan
{
namespace
{

/// Cells that are near each other in the order: most of their faces pair off in a table that fits
/// the first-level cache, and most of the others in one that fits the second-level cache.
constexpr std::size_t RunCells = 256;
constexpr std::size_t GroupRuns = 16;

/// A face, and whose it is: the cell's place in the order, times 8, and the number of the face.
struct FoundFace
{
  FaceKey Key;
  std::uint64_t Owner;
};
using FoundFaces = std::vector<FoundFace, InLargePages<FoundFace>>;

/// The faces that all threads have found.
FoundFaces Joined(std::vector<FoundFaces> parts)
{
  FoundFaces all = std::move(parts[0]);
  for (std::size_t part = 1; part < parts.size(); ++part)
  {
    all.insert(all.end(), parts[part].begin(), parts[part].end());
    parts[part] = {};
  }
  return all;
}

/// Calls function(owner, key) for the faces of a cell.
template <class Function>
void ForKeys(
  CellShape shape, const CornerHashes& hashes, std::size_t firstOwner, const Function& function)
{
  std::array<FaceKey, 6> keys;
  const int faces = FaceKeysOf(shape, hashes, keys);
  for (std::size_t face = 0; face < static_cast<std::size_t>(faces); ++face)
  {
    if (keys[face] != 0)
    {
      function(firstOwner + face, keys[face]);
    }
  }
}

/// Hashes of the corners of cells.
class HashReader
{
public:
  HashReader(const CellMesh& mesh, const std::vector<std::uint32_t>& order, ThreadPool& pool)
    : Mesh(mesh)
    , Order(order)
    , Hashes(NewInLargePages<std::uint64_t>(static_cast<std::size_t>(mesh.PointCount)))
  {
    FirstFailure none;
    ForRuns(mesh.PointCount, pool, none,
      [this](std::int64_t begin, std::int64_t end, int)
      {
        for (std::int64_t point = begin; point < end; ++point)
        {
          this->Hashes[static_cast<std::size_t>(point)] = HashOfPlace(this->Mesh.Point(point));
        }
      });
  }

  /// Calls function(owner, key) for the faces of a run of cells.
  template <class Function>
  void ForFaces(std::size_t run, Function&& function) const
  {
    const std::size_t end = std::min((run + 1) * RunCells, this->Order.size());
    std::array<HashedCell, 32> cells;
    for (std::size_t begin = run * RunCells; begin < end; begin += cells.size())
    {
      const std::size_t count = std::min(cells.size(), end - begin);
      this->Read(begin, count, cells);
      for (std::size_t i = 0; i < count; ++i)
      {
        ForKeys(cells[i].Cell.Shape, cells[i].Hashes, (begin + i) * 8, function);
      }
    }
  }

  /// Calls function(begin, end, worker, faces) for groups of runs, in parallel, and returns the
  /// faces of all threads.
  template <class Function>
  FoundFaces Collect(ThreadPool& pool, const Function& function) const
  {
    std::vector<FoundFaces> parts(static_cast<std::size_t>(pool.Width()));
    const std::size_t runs = (this->Order.size() + RunCells - 1) / RunCells;
    const std::function<void(std::int64_t, int)> each = [&](std::int64_t group, int worker)
    {
      const std::size_t begin = static_cast<std::size_t>(group) * GroupRuns;
      function(
        begin, std::min(begin + GroupRuns, runs), worker, parts[static_cast<std::size_t>(worker)]);
    };
    pool.ParallelFor(static_cast<std::int64_t>((runs + GroupRuns - 1) / GroupRuns), each);
    return Joined(std::move(parts));
  }

private:
  struct HashedCell
  {
    MeshCell Cell;
    CornerHashes Hashes;
  };

  /// Several cells side by side: they lie anywhere in memory, which is waited for together.
  void Read(std::size_t begin, std::size_t count, std::array<HashedCell, 32>& cells) const
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      cells[i].Cell = this->Mesh.Cell(this->Order[begin + i]);
    }
    for (std::size_t i = 0; i < count; ++i)
    {
      for (std::size_t k = 0; k < 8; ++k)
      {
        // Corners that the shape does not have are point 0.
        cells[i].Hashes[k] = this->Hashes[static_cast<std::size_t>(cells[i].Cell.Points[k])];
      }
    }
  }

  const CellMesh& Mesh;
  const std::vector<std::uint32_t>& Order;
  ArrayInLargePages<std::uint64_t> Hashes;
};

/// Pairs off the faces of cells that follow one another.
/// @tparam SlotBits for more slots than cells have faces
template <std::size_t Cells, int SlotBits>
class PairTable
{
public:
  /// @param owner counted from that of the first cell; those of a face come in their order
  void Add(FaceKey key, std::size_t owner)
  {
    std::size_t slot = key >> (64 - SlotBits);
    while (this->Keys[slot] != 0 && this->Keys[slot] != key)
    {
      slot = (slot + 1) & (Slots - 1);
    }
    // Half of all faces are new: a branch would be guessed wrong.
    const bool isNew = this->Keys[slot] == 0;
    this->Keys[slot] = key;
    this->Owners[slot] = static_cast<std::uint16_t>(isNew ? owner : this->Owners[slot] ^ Paired);
    this->Used[this->Count] = static_cast<std::uint16_t>(slot);
    this->Count += isNew ? 1 : 0;
  }

  /// Calls function(key, owner) for the faces without a partner, and forgets all.
  template <class Function>
  void Take(const Function& function)
  {
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      const std::size_t slot = this->Used[i];
      if ((this->Owners[slot] & Paired) == 0)
      {
        function(this->Keys[slot], this->Owners[slot]);
      }
      this->Keys[slot] = 0;
    }
    this->Count = 0;
  }

private:
  static constexpr std::size_t Slots = std::size_t{ 1 } << SlotBits;
  static constexpr std::uint16_t Paired = 0x8000;
  static_assert(Cells * 8 <= Paired && 6 * Cells < Slots && SlotBits <= 16);
  std::array<FaceKey, Slots> Keys{};
  std::array<std::uint16_t, Slots> Owners{};
  std::array<std::uint16_t, 6 * Cells + 1> Used{};
  std::size_t Count = 0;
};

/// Runs first, then groups of them.
struct PairTables
{
  PairTable<RunCells, 12> OfRun;
  PairTable<RunCells * GroupRuns, 15> OfGroup;
};

FoundFaces WithoutPartnerInGroup(const HashReader& reader, ThreadPool& pool)
{
  std::vector<PairTables> tables(static_cast<std::size_t>(pool.Width()));
  return reader.Collect(pool,
    [&](std::size_t begin, std::size_t end, int worker, FoundFaces& faces)
    {
      PairTables& table = tables[static_cast<std::size_t>(worker)];
      const std::size_t firstOfGroup = begin * RunCells * 8;
      for (std::size_t run = begin; run < end; ++run)
      {
        const std::size_t first = run * RunCells * 8;
        reader.ForFaces(
          run, [&](std::size_t owner, FaceKey key) { table.OfRun.Add(key, owner - first); });
        table.OfRun.Take([&](FaceKey key, std::size_t owner)
          { table.OfGroup.Add(key, first - firstOfGroup + owner); });
      }
      table.OfGroup.Take(
        [&](FaceKey key, std::size_t owner) {
          faces.push_back({ key, firstOfGroup + owner });
        });
    });
}

/// @param same faces whose keys agree in their upper bits
void TakeOdd(FoundFaces& same, FoundFaces& odd)
{
  std::sort(same.begin(), same.end(),
    [](const FoundFace& a, const FoundFace& b)
    { return a.Key != b.Key ? a.Key < b.Key : a.Owner < b.Owner; });
  for (std::size_t begin = 0, end = 0; begin < same.size(); begin = end)
  {
    for (end = begin + 1; end < same.size() && same[end].Key == same[begin].Key;)
    {
      ++end;
    }
    if ((end - begin) % 2 == 1)
    {
      odd.push_back(same[begin]);
    }
  }
}

/// Faces that are there an odd number of times, each with its lowest owner, in any order.
FoundFaces WithoutPartner(const FoundFaces& faces, ThreadPool& pool)
{
  if (faces.size() > std::numeric_limits<std::uint32_t>::max())
  {
    throw Error("The mesh has too many faces that one cell alone has: divide it among more "
                "processes");
  }
  KeyedNumbers sorted(faces.size());
  FirstFailure none;
  ForRuns(static_cast<std::int64_t>(faces.size()), pool, none,
    [&](std::int64_t begin, std::int64_t end, int)
    {
      for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      {
        sorted.Keys[i] = faces[i].Key;
        sorted.Values[i] = static_cast<std::uint32_t>(i);
      }
    });
  // Three digits part nearly all keys.
  constexpr int firstBit = 64 - 3 * RadixDigitBits;
  RadixSort(sorted, firstBit, 64, pool);
  std::vector<FoundFaces> parts(static_cast<std::size_t>(pool.Width()));
  std::vector<FoundFaces> runs(parts.size());
  ForEqualRuns(sorted, firstBit, pool,
    [&](std::size_t begin, std::size_t end, int worker)
    {
      if (end - begin == 2 && sorted.Keys[begin] == sorted.Keys[begin + 1])
      {
        return;
      }
      FoundFaces& same = runs[static_cast<std::size_t>(worker)];
      same.clear();
      for (std::size_t i = begin; i < end; ++i)
      {
        same.push_back(faces[sorted.Values[i]]);
      }
      TakeOdd(same, parts[static_cast<std::size_t>(worker)]);
    });
  return Joined(std::move(parts));
}

/// Tells most keys that are not in a set.
class KeyFilter
{
public:
  explicit KeyFilter(const FoundFaces& faces)
  {
    // A key in 64 that is not in the set passes.
    while (this->Words.size() < faces.size())
    {
      this->Words.resize(2 * this->Words.size());
    }
    for (const FoundFace& face : faces)
    {
      this->Words[this->WordOf(face.Key)] |= BitOf(face.Key);
    }
  }

  bool MayHave(FaceKey key) const { return (this->Words[this->WordOf(key)] & BitOf(key)) != 0; }

private:
  std::size_t WordOf(FaceKey key) const { return key >> 6 & (this->Words.size() - 1); }
  static std::uint64_t BitOf(FaceKey key) { return std::uint64_t{ 1 } << (key & 63); }

  std::vector<std::uint64_t> Words = std::vector<std::uint64_t>(1);
};

/// All faces that no other cell has. Where a cell lies on two others whose common face paired off
/// in their run, its own face is found without a partner. It belongs to the first of the three: so
/// all are looked at once more.
FoundFaces FacesOfCells(const HashReader& reader, ThreadPool& pool)
{
  const KeyFilter filter(WithoutPartner(WithoutPartnerInGroup(reader, pool), pool));
  const FoundFaces candidates = reader.Collect(pool,
    [&](std::size_t begin, std::size_t end, int, FoundFaces& faces)
    {
      for (std::size_t run = begin; run < end; ++run)
      {
        reader.ForFaces(run,
          [&](std::size_t owner, FaceKey key)
          {
            if (filter.MayHave(key))
            {
              faces.push_back({ key, owner });
            }
          });
      }
    });
  return WithoutPartner(candidates, pool);
}

/// The sides of a grid that a cell touches: two bits per axis, as faces of hexahedra are numbered.
unsigned SidesOf(const CellMesh& mesh, std::int64_t cell)
{
  unsigned sides = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::int64_t cells = mesh.Size[axis] - 1;
    const std::int64_t at = cell % cells;
    cell /= cells;
    sides |= (at == 0 ? 1U : 0U) << 2 * axis | (at == cells - 1 ? 2U : 0U) << 2 * axis;
  }
  return sides;
}

/// The faces of a grid's six sides, where they do not meet each other as those of a ring do. No
/// others are looked at: two cells have them.
FoundFaces FacesOfGrid(
  const CellMesh& mesh, const std::vector<std::uint32_t>& order, ThreadPool& pool)
{
  std::vector<FoundFaces> parts(static_cast<std::size_t>(pool.Width()));
  FirstFailure none;
  WithCorners(mesh,
    [&](const auto& reader)
    {
      ForRuns(static_cast<std::int64_t>(order.size()), pool, none,
        [&](std::int64_t begin, std::int64_t end, int worker)
        {
          for (auto place = static_cast<std::size_t>(begin); place < static_cast<std::size_t>(end);
               ++place)
          {
            const unsigned sides = SidesOf(mesh, order[place]);
            if (sides != 0)
            {
              const CellPlaces places = reader.At(order[place], mesh.Cell(order[place]));
              CornerHashes hashes{};
              std::transform(places.begin(), places.end(), hashes.begin(), HashOfPlace);
              ForKeys(CellShape::Hexahedron, hashes, place * 8,
                [&](std::size_t owner, FaceKey key)
                {
                  if ((sides >> owner % 8 & 1U) != 0)
                  {
                    parts[static_cast<std::size_t>(worker)].push_back({ key, owner });
                  }
                });
            }
          }
        });
    });
  return WithoutPartner(Joined(std::move(parts)), pool);
}

std::vector<BorderFace> InOrder(const FoundFaces& faces, std::size_t cells, ThreadPool& pool)
{
  std::vector<std::uint64_t> owners(faces.size());
  std::transform(
    faces.begin(), faces.end(), owners.begin(), [](const FoundFace& face) { return face.Owner; });
  std::vector<std::uint32_t> none(faces.size());
  int bits = 3;
  while (cells >> (bits - 3) != 0)
  {
    ++bits;
  }
  RadixSort(owners, none, bits, pool);
  std::vector<BorderFace> border(faces.size());
  std::transform(owners.begin(), owners.end(), border.begin(),
    [](std::uint64_t owner)
    {
      return BorderFace{ static_cast<std::uint32_t>(owner / 8),
        static_cast<std::uint8_t>(owner % 8) };
    });
  return border;
}

} // namespace

std::vector<BorderFace> BorderFacesOf(const CellMesh& mesh, const CellFacts& facts,
  const std::vector<std::uint32_t>& order, ThreadPool& pool)
{
  const bool wholeGrid = mesh.Is != CellMesh::Kind::Cells && facts.LeftOut.empty();
  const FoundFaces faces =
    wholeGrid ? FacesOfGrid(mesh, order, pool) : FacesOfCells(HashReader(mesh, order, pool), pool);
  return InOrder(faces, order.size(), pool);
}

std::vector<std::uint8_t> BorderBitsOf(const std::vector<BorderFace>& border, std::size_t cells)
{
  std::vector<std::uint8_t> bits(border.empty() ? 0 : cells);
  for (const BorderFace& face : border)
  {
    bits[face.Cell] = static_cast<std::uint8_t>(bits[face.Cell] | 1u << face.Face);
  }
  return bits;
}

} // namespace banyan
