// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellBins.h"

#include "Base/ThreadPool.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

namespace banyan
{
namespace
{

constexpr std::size_t CellsAtOnce = 4096;
constexpr std::size_t Ahead = 12; ///< cells that caches are asked for meanwhile

/// Brings cells to the screen.
class CellPlacer
{
public:
  CellPlacer(const RayScene& scene, const CellField& field, SeenCells::Kind kind,
    const VisibleValues* visible)
    : Scene(scene)
    , Field(field)
    , Kind(kind)
    , Cells(*field.Cells)
    , Visible(visible)
  {
    const double edge = this->Cells.Lattice.Edge;
    glm::dmat4 toIndex(1.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      toIndex[axis][axis] = 1.0 / edge;
      toIndex[3][axis] = -this->Cells.Lattice.Origin[axis] / edge;
    }
    this->ToWorld = scene.IndexToWorld * toIndex;
    this->ToClip = scene.Camera.WorldToClipMatrix() * this->ToWorld;
  }

  /// Adds a cell, and its faces at the border, if they can be seen.
  /// @param face the first one of this cell or a later one; goes to that of the next cell
  void Place(std::uint32_t place, std::size_t& face, PlacedCells& placed)
  {
    const std::vector<BorderFace>& border = this->Cells.Border;
    const std::size_t first = face;
    if (this->Kind == SeenCells::Kind::Borders &&
        (face == border.size() || border[face].Cell != place))
    {
      return;
    }
    while (face < border.size() && border[face].Cell == place)
    {
      ++face;
    }
    const std::int64_t number = this->Cells.Order[place];
    const MeshCell cell = this->Cells.Mesh.Cell(number);
    if (!this->CanBeSeen(number, cell))
    {
      return;
    }
    const int corners = CornersOf(cell.Shape);
    int all[8];
    for (int i = 0; i < corners; ++i)
    {
      all[i] = i;
      this->Project(i, this->Cells.Mesh.Point(cell.Points[static_cast<std::size_t>(i)]));
    }
    PlacedCell found;
    found.Place = place;
    found.Border = this->Cells.BorderBits.empty() ? 0 : this->Cells.BorderBits[place];
    if (!this->Cover(all, corners, found))
    {
      return;
    }
    if (this->Kind == SeenCells::Kind::All)
    {
      placed.push_back(found);
    }
    for (std::size_t i = first; i < face; ++i)
    {
      const CellFace& part = FacesOf(cell.Shape).Faces[border[i].Face];
      found.Face = border[i].Face;
      if (this->Cover(part.Corners.data(), part.Count, found))
      {
        placed.push_back(found);
      }
    }
  }

private:
  bool CanBeSeen(std::int64_t number, const MeshCell& cell) const
  {
    float values[8] = {};
    this->Field.CornerValues(number, cell, values);
    float low = values[0];
    float high = values[0];
    bool finite = true;
    for (int i = 0; i < CornersOf(cell.Shape); ++i)
    {
      finite = finite && std::isfinite(values[i]);
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    return finite &&
           (!this->Visible || this->Visible->Any(low + this->Field.Base, high + this->Field.Base));
  }

  void Project(int corner, const glm::dvec3& point)
  {
    const glm::dvec4 clip = this->ToClip * glm::dvec4(point, 1.0);
    // Before the near plane, where it still has a place.
    this->Before[corner] = clip.z + clip.w > 0.0 && clip.w > 0.0;
    this->Picture[corner] = glm::dvec2(clip) / clip.w * 0.5 + 0.5;
    this->World[corner] = glm::dvec3(this->ToWorld * glm::dvec4(point, 1.0));
  }

  /// Finds the part of the picture, and distances, of some corners together.
  /// @return false where they are off screen
  bool Cover(const int* corners, int count, PlacedCell& found) const
  {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high(-std::numeric_limits<double>::infinity());
    glm::dvec3 middle(0.0);
    bool whole = true;
    bool any = false;
    for (int i = 0; i < count; ++i)
    {
      const int corner = corners[i];
      low = glm::min(low, this->Picture[corner]);
      high = glm::max(high, this->Picture[corner]);
      whole = whole && this->Before[corner];
      any = any || this->Before[corner];
      middle += this->World[corner] / static_cast<double>(count);
    }
    const bool beside = low.x > 1.0 || low.y > 1.0 || high.x < 0.0 || high.y < 0.0;
    if (!any || (whole && beside))
    {
      return false;
    }
    // Rounding to float is far less than the slack of pixels.
    found.Low = whole ? glm::vec2(low) : glm::vec2(-infinity);
    found.High = whole ? glm::vec2(high) : glm::vec2(infinity);
    this->SetDistances(corners, count, middle, found);
    return true;
  }

  /// A cell lies within the hull of its corners: none of its points is further than they are, nor
  /// nearer than along the direction to their middle.
  void SetDistances(
    const int* corners, int count, const glm::dvec3& middle, PlacedCell& found) const
  {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const RayCamera& camera = this->Scene.Camera;
    const bool parallel = camera.Parallel();
    const glm::dvec3 from = parallel ? camera.AnchorPoint() : camera.Eye();
    const glm::dvec3 away = middle - from;
    const double far = glm::length(away);
    const glm::dvec3 along = parallel || far == 0.0 ? camera.ViewDirection() : away * (1.0 / far);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (int i = 0; i < count; ++i)
    {
      const glm::dvec3 off = this->World[corners[i]] - from;
      const double t = glm::dot(off, along);
      least = std::min(least, t);
      most = std::max(most, parallel ? t : glm::dot(off, off));
    }
    most = parallel ? most : std::sqrt(most);
    // Samples count as those of a cell somewhat beyond its faces.
    const double slack = 0.001 * (most - least) + 1e-6 * (std::abs(most) + std::abs(least));
    found.Near = std::nextafter(static_cast<float>(least - slack), -infinity);
    found.Far = std::nextafter(static_cast<float>(most + slack), infinity);
  }

  const RayScene& Scene;
  const CellField& Field;
  const SeenCells::Kind Kind;
  const DrawnCells& Cells;
  const VisibleValues* Visible;
  glm::dmat4 ToWorld{ 1.0 };
  glm::dmat4 ToClip{ 1.0 };
  // Of the corners of a cell.
  bool Before[8] = {};
  glm::dvec2 Picture[8];
  glm::dvec3 World[8];
};

} // namespace

SeenCells::SeenCells(const RayScene& scene, const CellField& field, Kind kind,
  std::shared_ptr<const VisibleValues> visible, ThreadPool& pool)
  : WorldToClip(scene.Camera.WorldToClipMatrix())
  , Anchor(scene.Camera.AnchorPoint())
  , IndexToWorld(scene.IndexToWorld)
  , Visible(std::move(visible))
{
  const DrawnCells& cells = *field.Cells;
  const std::size_t count = cells.Order.size();
  const std::size_t chunks = (count + CellsAtOnce - 1) / CellsAtOnce;
  std::vector<PlacedCells> parts(chunks);
  pool.ParallelFor(static_cast<std::int64_t>(chunks),
    [&](std::int64_t chunk)
    {
      CellPlacer placer(scene, field, kind, this->Visible.get());
      const std::size_t begin = static_cast<std::size_t>(chunk) * CellsAtOnce;
      const std::size_t end = std::min(begin + CellsAtOnce, count);
      const auto from = std::lower_bound(cells.Border.begin(), cells.Border.end(), begin,
        [](const BorderFace& face, std::size_t place) { return face.Cell < place; });
      auto face = static_cast<std::size_t>(from - cells.Border.begin());
      PlacedCells& part = parts[static_cast<std::size_t>(chunk)];
      part.reserve(kind == Kind::All ? end - begin : 0);
      for (std::size_t place = begin; place < end; ++place)
      {
        if (kind == Kind::All)
        {
          cells.Mesh.PrefetchPlace(cells.Order[std::min(place + 2 * Ahead, count - 1)]);
          cells.Mesh.PrefetchCell(cells.Order[std::min(place + Ahead, count - 1)]);
        }
        placer.Place(static_cast<std::uint32_t>(place), face, part);
      }
    });
  std::size_t all = 0;
  for (const PlacedCells& part : parts)
  {
    all += part.size();
  }
  this->All.reserve(all);
  this->Bounds.Low = glm::vec2(std::numeric_limits<float>::infinity());
  this->Bounds.High = -this->Bounds.Low;
  std::int64_t whole = 0;
  for (PlacedCells& part : parts)
  {
    for (const PlacedCell& placed : part)
    {
      this->Bounds.Low = glm::min(this->Bounds.Low, placed.Low);
      this->Bounds.High = glm::max(this->Bounds.High, placed.High);
      whole += placed.Face == PlacedCell::Whole ? 1 : 0;
    }
    this->All.insert(this->All.end(), part.begin(), part.end());
    part = {};
  }
  this->NotSeen = static_cast<std::int64_t>(count) - whole;
}

bool SeenCells::AreOf(const RayScene& scene, const VisibleValues* visible) const
{
  return this->Visible.get() == visible && this->WorldToClip == scene.Camera.WorldToClipMatrix() &&
         this->Anchor == scene.Camera.AnchorPoint() && this->IndexToWorld == scene.IndexToWorld;
}

CellBins::CellBins(const RayScene& scene, std::shared_ptr<const SeenCells> cells)
  : Cells(std::move(cells))
  , Size(scene.Camera.ImageSize())
{
  if (!this->Cells->Placed().empty())
  {
    this->Touched =
      Intersection(this->Cells->Around().PixelsIn(this->Size, scene.Viewport), scene.Viewport);
  }
}

void CellBins::Sort(const TileGrid& grid, ThreadPool& pool)
{
  // Chunks are counted first, so that each knows where its items begin.
  const std::size_t tiles = grid.Count();
  const PlacedCells& all = this->Cells->Placed();
  const std::size_t count = all.size();
  const auto chunks = static_cast<std::size_t>(
    std::min<std::int64_t>(16 * pool.Width(), static_cast<std::int64_t>(count / 1024 + 1)));
  std::vector<std::uint32_t> counts(tiles * chunks, 0);
  std::atomic<std::int64_t> between{ 0 };
  const auto forChunks = [&](auto&& function)
  {
    pool.ParallelFor(static_cast<std::int64_t>(chunks),
      [&](std::int64_t number)
      {
        const auto chunk = static_cast<std::size_t>(number);
        std::uint32_t* const mine = counts.data() + tiles * chunk;
        std::int64_t without = 0;
        for (std::size_t i = count * chunk / chunks; i < count * (chunk + 1) / chunks; ++i)
        {
          const PixelRect pixels = all[i].PixelsIn(this->Size, this->Touched);
          if (!pixels.Empty())
          {
            grid.ForEachUnder(pixels, [&](std::size_t tile) { function(i, mine[tile]); });
          }
          without += pixels.Empty() && all[i].Face == PlacedCell::Whole ? 1 : 0;
        }
        between += without;
      });
  };
  forChunks([](std::size_t, std::uint32_t& number) { ++number; });
  this->NotDrawn = this->Cells->Skipped() + between;
  this->Begins.assign(tiles + 1, 0);
  std::size_t sum = 0;
  std::vector<std::size_t> offsets(tiles * chunks);
  for (std::size_t tile = 0; tile < tiles; ++tile)
  {
    this->Begins[tile] = sum;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk)
    {
      offsets[tiles * chunk + tile] = sum;
      sum += counts[tiles * chunk + tile];
      counts[tiles * chunk + tile] = 0;
    }
  }
  this->Begins[tiles] = sum;
  this->Items.resize(sum);
  forChunks(
    [&](std::size_t item, std::uint32_t& number)
    {
      const auto slot = static_cast<std::size_t>(&number - counts.data());
      this->Items[offsets[slot] + number++] = static_cast<std::uint32_t>(item);
    });
}

} // namespace banyan
