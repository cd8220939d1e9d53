// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellSource.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/Cells/CellCaster.h"
#include "Render/Cells/MeshLattice.h"
#include "Render/Cells/PointMeans.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace banyan
{
namespace
{

/// Most bricks along an axis: they say where values are, and 32 along each axis take 0.5 MB.
constexpr int MostBricks = 32;
constexpr std::int64_t CellsAtOnce = 16384;
/// Places of the finest lattice are so far apart, in edges of the index space, or further: there
/// are at most so many of them per cell, and MostPlaces, 128 MB, in all. LeastMostPlaces are never
/// too many.
constexpr double FinestEdge = 0.5;
constexpr std::size_t PlacesPerCell = 32;
constexpr std::size_t LeastMostPlaces = std::size_t{ 1 } << 20;
constexpr std::size_t MostPlaces = std::size_t{ 1 } << 25;
/// Lattices with fewer places along the longest axis say nothing.
constexpr int LeastPlaces = 16;

/// Cells of a mesh are no boxes: nobody draws a part of the index space.
void CheckDrawsAll(const RayScene& scene, const Box& cells)
{
  if (!(Intersection(cells, scene.DomainCells) == scene.DomainCells))
  {
    throw Error("A mesh of cells is drawn as a whole");
  }
}

/// A coarser level of a mesh.
class LatticeSource final : public BrickSource
{
public:
  LatticeSource(CellSource& source, int level)
    : Source(source)
    , LatticeLevel(level)
  {
  }

  glm::ivec3 Bricks() const override { return this->Source.Bricks(); }
  Box CellsOf(std::int64_t brick) const override { return this->Source.CellsOf(brick); }
  ValueRange RangeOf(std::int64_t brick) const override { return this->Source.RangeOf(brick); }
  ValueMask MaskOf(std::int64_t brick) const override { return this->Source.MaskOf(brick); }
  MaskRange MasksAreOver() const override { return this->Source.MasksAreOver(); }
  std::size_t LoadBytes(std::int64_t) const override { return 0; }
  /// Positions are those of the index space at all levels.
  glm::ivec3 CellEdges() const override { return glm::ivec3(1); }
  BrickView Load(std::int64_t brick) override { return this->Source.Load(brick); }
  std::unique_ptr<PictureCaster> MakeCaster(
    const RayScene& scene, const Box& cells, ThreadPool& pool, RayStatistics& statistics) override
  {
    CheckDrawsAll(scene, cells);
    const bool shaded = scene.Shading.On && scene.Blend.Mode == BlendMode::Composite;
    return std::make_unique<CellCaster>(scene, this->Source, *this,
      this->Source.LatticeOf(this->LatticeLevel, shaded, pool), pool, statistics);
  }

private:
  CellSource& Source;
  int LatticeLevel;
};

} // namespace

CellSource::CellSource(CellField field, ThreadPool& pool)
  : Field(std::move(field))
  , Size(this->Field.Cells->Lattice.Size)
{
  const int longest = std::max({ this->Size.x, this->Size.y, this->Size.z });
  while ((longest - 1) / this->Edge + 1 > MostBricks)
  {
    this->Edge *= 2;
  }
  this->Counts = (this->Size - 1) / this->Edge + 1;
  this->FindRanges(pool);
}

const CellField& CellSource::WithGradients(ThreadPool& pool)
{
  std::call_once(this->GradientsMade,
    [&]
    {
      CellField& field = this->Field;
      const DrawnCells& cells = *field.Cells;
      field.Gradients = PointGradients(
        cells, field.OfCells ? PointMeans(cells, field.Values, pool) : field.Values, pool);
    });
  return this->Field;
}

void CellSource::GiveGradients(std::vector<float> gradients)
{
  std::call_once(this->GradientsMade, [&] { this->Field.Gradients = std::move(gradients); });
}

std::shared_ptr<const SeenCells> CellSource::SeenIn(
  const RayScene& scene, std::shared_ptr<const VisibleValues> visible, ThreadPool& pool)
{
  return this->Seen(this->LastSeen, scene, std::move(visible), pool);
}

std::shared_ptr<const SeenCells> CellSource::BordersIn(const RayScene& scene, ThreadPool& pool)
{
  return this->Seen(this->LastBorders, scene, nullptr, pool);
}

/// @param last LastSeen or LastBorders
std::shared_ptr<const SeenCells> CellSource::Seen(std::shared_ptr<const SeenCells>& last,
  const RayScene& scene, std::shared_ptr<const VisibleValues> visible, ThreadPool& pool)
{
  {
    const std::lock_guard<std::mutex> lock(this->SeenMutex);
    if (last && last->AreOf(scene, visible.get()))
    {
      return last;
    }
    last = nullptr; // its memory is there for the next one
  }
  const bool all = &last == &this->LastSeen;
  this->Looks += all ? 1 : 0;
  auto seen =
    std::make_shared<const SeenCells>(scene, all || !this->Border ? this->Field : *this->Border,
      all ? SeenCells::Kind::All : SeenCells::Kind::Borders, std::move(visible), pool);
  const std::lock_guard<std::mutex> lock(this->SeenMutex);
  last = seen;
  return seen;
}

std::size_t CellSource::SeenBytes() const
{
  const std::lock_guard<std::mutex> lock(this->SeenMutex);
  return (this->LastSeen ? this->LastSeen->Bytes() : 0) +
         (this->LastBorders ? this->LastBorders->Bytes() : 0);
}

/// Of the lattice of a level, in edges of the index space.
double CellSource::EdgeOf(int level)
{
  std::call_once(this->EdgeFound,
    [&]
    {
      const DrawnCells& cells = *this->Field.Cells;
      const std::size_t most = std::clamp(
        PlacesPerCell * static_cast<std::size_t>(cells.Count), LeastMostPlaces, MostPlaces);
      this->FinestLatticeEdge = FinestEdge;
      while (MeshLattice::PlacesFor(cells, this->FinestLatticeEdge).Size() > most)
      {
        this->FinestLatticeEdge *= 2.0;
      }
    });
  return std::ldexp(this->FinestLatticeEdge, level - 1);
}

std::shared_ptr<const MeshLattice> CellSource::LatticeOf(int level, bool shaded, ThreadPool& pool)
{
  const CellField& field = this->WithBorder(shaded, pool);
  const std::lock_guard<std::mutex> lock(this->LatticesMutex);
  // Coarser ones take an eighth of the time from the finest, which most plans come to.
  for (const int each : { 1, level })
  {
    std::shared_ptr<const MeshLattice>& lattice = this->Lattices[each];
    const MeshLattice* const finer = each > 1 ? this->Lattices[1].get() : nullptr;
    if (!lattice)
    {
      lattice = std::make_shared<MeshLattice>(field, this->EdgeOf(each), finer, pool);
    }
    if (shaded && !lattice->HasGradients())
    {
      // Others may be drawing with the one without.
      auto with = std::make_shared<MeshLattice>(*lattice);
      with->AddGradients(field, finer, pool);
      lattice = with;
    }
  }
  return this->Lattices[level];
}

std::size_t CellSource::LatticeBytes() const
{
  const std::lock_guard<std::mutex> lock(this->LatticesMutex);
  std::size_t bytes = 0;
  for (const auto& [level, lattice] : this->Lattices)
  {
    bytes += lattice->Bytes();
  }
  if (this->Border)
  {
    const CellMesh& mesh = this->Border->Cells->Mesh;
    bytes +=
      this->Border->Cells->Bytes() +
      static_cast<std::size_t>(mesh.PointCount) * sizeof(glm::dvec3) +
      static_cast<std::size_t>(mesh.ConnectivityCount + mesh.CellCount) * sizeof(std::int64_t) +
      (this->Border->Values.size() + this->Border->Gradients.size()) * sizeof(float);
  }
  return bytes;
}

bool CellSource::HasLattice(bool shaded) const
{
  const std::lock_guard<std::mutex> lock(this->LatticesMutex);
  const auto found = this->Lattices.find(1);
  return found != this->Lattices.end() && (!shaded || found->second->HasGradients());
}

void CellSource::GiveLattice(
  std::shared_ptr<const CellField> border, std::shared_ptr<MeshLattice> finest)
{
  const std::scoped_lock lock(this->LatticesMutex, this->SeenMutex);
  this->Border = std::move(border);
  this->LastBorders = nullptr;
  this->Lattices.clear();
  this->Lattices[1] = std::move(finest);
}

const CellField& CellSource::WithBorder(bool shaded, ThreadPool& pool)
{
  if (!this->Field.Cells->IsPiece)
  {
    return shaded ? this->WithGradients(pool) : this->Field;
  }
  if (!this->HasLattice(shaded))
  {
    throw Error("Lattices of a piece of a mesh take values of all pieces");
  }
  return *this->Border;
}

std::unique_ptr<BrickSource> CellSource::MakeLevel(int level, const Box&)
{
  const int longest = std::max({ this->Size.x, this->Size.y, this->Size.z });
  return longest < LeastPlaces * this->EdgeOf(level)
           ? nullptr
           : std::make_unique<LatticeSource>(*this, level);
}

Box CellSource::CellsOf(std::int64_t brick) const
{
  const glm::ivec3 at(brick % this->Counts.x, brick / this->Counts.x % this->Counts.y,
    brick / this->Counts.x / this->Counts.y);
  return { at * this->Edge, glm::min((at + 1) * this->Edge, this->Size) };
}

ValueMask CellSource::MaskOf(std::int64_t brick) const
{
  const ValueRange& range = this->Ranges[static_cast<std::size_t>(brick)];
  return range.Empty() ? 0
                       : MaskOfBins(this->Masks.BinOf(range.Low), this->Masks.BinOf(range.High));
}

std::unique_ptr<PictureCaster> CellSource::MakeCaster(
  const RayScene& scene, const Box& cells, ThreadPool& pool, RayStatistics& statistics)
{
  CheckDrawsAll(scene, cells);
  return std::make_unique<CellCaster>(scene, *this, *this, nullptr, pool, statistics);
}

BrickView CellSource::Load(std::int64_t)
{
  throw Error("Cells of a mesh have no samples on a grid that could be loaded");
}

/// The box around a cell in index space, and the range of its values.
/// @return false when the cell is not drawn for its values
bool CellSource::BoundsOf(
  std::uint32_t number, glm::dvec3& low, glm::dvec3& high, ValueRange& range) const
{
  const DrawnCells& cells = *this->Field.Cells;
  const MeshCell cell = cells.Mesh.Cell(number);
  float values[8] = {};
  this->Field.CornerValues(number, cell, values);
  bool finite = true;
  range = ValueRange();
  for (int corner = 0; corner < CornersOf(cell.Shape); ++corner)
  {
    const glm::dvec3 point =
      cells.ToIndex(cells.Mesh.Point(cell.Points[static_cast<std::size_t>(corner)]));
    low = corner == 0 ? point : glm::min(low, point);
    high = corner == 0 ? point : glm::max(high, point);
    finite = finite && std::isfinite(values[corner]);
    range.Include(values[corner] + this->Field.Base);
  }
  return finite;
}

/// Finds the values of the cells that reach into each brick.
void CellSource::FindRanges(ThreadPool& pool)
{
  const std::vector<std::uint32_t>& order = this->Field.Cells->Order;
  const auto count = static_cast<std::int64_t>(order.size());
  const auto bricks = static_cast<std::size_t>(this->Counts.x) *
                      static_cast<std::size_t>(this->Counts.y) *
                      static_cast<std::size_t>(this->Counts.z);
  std::vector<std::vector<ValueRange>> parts(static_cast<std::size_t>(pool.Width()));
  const std::function<void(std::int64_t, int)> look = [&](std::int64_t chunk, int worker)
  {
    std::vector<ValueRange>& ranges = parts[static_cast<std::size_t>(worker)];
    ranges.resize(bricks);
    const std::int64_t end = std::min(count, (chunk + 1) * CellsAtOnce);
    for (std::int64_t i = chunk * CellsAtOnce; i < end; ++i)
    {
      glm::dvec3 low;
      glm::dvec3 high;
      ValueRange range;
      if (!this->BoundsOf(order[static_cast<std::size_t>(i)], low, high, range))
      {
        continue;
      }
      // Samples somewhat beyond a cell's faces are its own.
      const glm::dvec3 margin = 0.001 * (high - low);
      const auto brickAt = [&](const glm::dvec3& place) {
        return glm::clamp(
          glm::ivec3(glm::floor(place)) / this->Edge, glm::ivec3(0), this->Counts - 1);
      };
      const glm::ivec3 first = brickAt(low - margin);
      const glm::ivec3 last = brickAt(high + margin);
      for (glm::ivec3 at = first; at.z <= last.z; ++at.z)
      {
        for (at.y = first.y; at.y <= last.y; ++at.y)
        {
          for (at.x = first.x; at.x <= last.x; ++at.x)
          {
            ranges[static_cast<std::size_t>(NumberOf(at, this->Counts))].Include(range);
          }
        }
      }
    }
  };
  pool.ParallelFor((count + CellsAtOnce - 1) / CellsAtOnce, look);
  this->Ranges.resize(bricks);
  ValueRange all;
  for (const std::vector<ValueRange>& part : parts)
  {
    for (std::size_t i = 0; i < part.size(); ++i)
    {
      this->Ranges[i].Include(part[i]);
      all.Include(part[i]);
    }
  }
  this->Masks = all.Empty() ? MaskRange{} : MaskRange{ all.Low, all.High };
}

} // namespace banyan
