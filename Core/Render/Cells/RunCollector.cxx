// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/RunCollector.h"

#include "Render/Cells/CellField.h"

#include <algorithm>

namespace banyan
{
namespace
{

const AskedIntervals* FirstOf(const AskedTile& asked, std::uint16_t pixel)
{
  const auto found = std::lower_bound(asked.Intervals.begin(), asked.Intervals.end(), pixel,
    [](const AskedIntervals& a, std::uint16_t b) { return a.Pixel < b; });
  return asked.Intervals.data() + (found - asked.Intervals.begin());
}

template <class Element>
void AppendByPixel(std::vector<Element>& from, std::vector<Element>& to)
{
  // Along each ray they are sorted.
  std::stable_sort(
    from.begin(), from.end(), [](const Element& a, const Element& b) { return a.Pixel < b.Pixel; });
  to.insert(to.end(), from.begin(), from.end());
  from.clear();
}

} // namespace

void RunCollector::Begin(const TileRows& rows, const AskedTile* asked, bool single)
{
  this->Single = single;
  this->FirstNumber = static_cast<std::int64_t>(rows.FirstNumber);
  this->Asked = asked;
  std::fill_n(this->First, RayTile::Slots, None);
  std::fill_n(this->Last, RayTile::Slots, None);
  std::fill_n(this->Through, RayTile::Slots, 1.0f);
}

bool RunCollector::AsksFor(const RayTile& tile, int slot, int row) const
{
  const std::uint16_t pixel = TileRuns::PixelAt(tile.PixelAt(slot));
  const std::int64_t number = this->FirstNumber + row;
  const AskedIntervals* const end = this->Asked->Intervals.data() + this->Asked->Intervals.size();
  for (const AskedIntervals* i = FirstOf(*this->Asked, pixel); i < end && i->Pixel == pixel; ++i)
  {
    if (number >= i->First && number <= i->Last)
    {
      return true;
    }
  }
  return false;
}

bool RunCollector::Wants(std::uint16_t pixel) const
{
  if (!this->Asked)
  {
    return true;
  }
  const AskedIntervals* const found = FirstOf(*this->Asked, pixel);
  return found < this->Asked->Intervals.data() + this->Asked->Intervals.size() &&
         found->Pixel == pixel;
}

void RunCollector::Close(std::uint64_t lanes, int slot, RayTile& tile)
{
  for (; lanes != 0; lanes &= lanes - 1)
  {
    const int at = slot + __builtin_ctzll(lanes);
    RayRun run;
    run.First = this->FirstNumber + this->First[at];
    run.Last = this->FirstNumber + this->Last[at];
    run.Pixel = TileRuns::PixelAt(tile.PixelAt(at));
    for (int i = 0; i < 3; ++i)
    {
      run.Color[i] = tile.Color[i][at];
    }
    run.Transmittance = tile.Transmittance[at];
    if (this->Wants(run.Pixel))
    {
      this->Runs.push_back(run);
    }
    this->Through[at] *= run.Transmittance;
    this->Last[at] = None;
    tile.SetPixel(at, { 0.0f, 0.0f, 0.0f, 1.0f });
  }
}

void RunCollector::AddRaw(const SampleSlab& slab, const SlabOwners& owners, const TileRows& rows,
  int firstRow, int slot, int row, bool shaded, const RayTile& tile)
{
  const int index = SampleSlab::IndexOf(slot, row);
  RawInterval raw;
  raw.Pixel = TileRuns::PixelAt(tile.PixelAt(slot));
  if (!this->Wants(raw.Pixel))
  {
    return;
  }
  const int inTile = firstRow + row;
  raw.Number = this->FirstNumber + inTile;
  raw.Length = inTile == rows.Head[slot]   ? tile.Head.Fraction[slot]
               : inTile == rows.Tail[slot] ? tile.Tail.Fraction[slot]
                                           : 1.0f;
  raw.Claimed = slab.Value[index] == slab.Value[index];
  if (raw.Claimed)
  {
    raw.Value = slab.Value[index];
    raw.Cosine = shaded ? slab.Cosine[index] : 0.0f;
    raw.Key.Place = owners.Of[index] & ~SlabOwners::Contested;
  }
  if ((slab.Borders[slot / SampleSlab::Lanes] >> row & 1) != 0 && slab.Crossings[index] > 0.0f)
  {
    raw.Crossed = { slab.Change[index], slab.AtBorder[index],
      shaded ? slab.CosineAtBorder[index] : 0.0f, slab.Crossings[index], slab.Before[index],
      slab.Behind[index], slab.Nearest[index], 0.0f };
    // Not set where all crossings are further away than any interval reaches.
    raw.Crossed.NearestEnters = raw.Crossed.Nearest < 1.0f ? slab.NearestEnters[index] : 0.0f;
  }
  this->Raw.push_back(raw);
}

void RunCollector::Finish(RayTile& tile, const DrawnCells& cells, TileRuns& found)
{
  for (int slot = 0; slot < RayTile::Slots; ++slot)
  {
    if (this->Last[slot] != None)
    {
      this->Close(1, slot, tile);
    }
  }
  const CellKeys keys(cells.Mesh, cells.OrderedBy);
  for (RawInterval& raw : this->Raw)
  {
    if (raw.Claimed)
    {
      raw.Key = keys.Of(cells.Order[raw.Key.Place]);
    }
  }
  AppendByPixel(this->Runs, found.Runs);
  AppendByPixel(this->Raw, found.Raw);
}

} // namespace banyan
