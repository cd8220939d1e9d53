// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/LevelCaster.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace banyan
{

void LevelCaster::Load(const PlannedBrick& brick, LoadedBrick& loaded) const
{
  if (brick.Entry)
  {
    return;
  }
  if (!loaded.Packed)
  {
    if (!PackedBrick::CanPack(brick.Cells))
    {
      loaded.View = this->LoadLarge(brick);
      loaded.Hidden =
        HiddenInBrick(this->Source.Hidden().get(), this->Source.CellsOf(brick.Number));
      return;
    }
    loaded.Packed = this->Pack(brick);
    this->Source.Kept().Keep(this->KeptNumberOf(brick), loaded.Packed);
  }
  loaded.Footprint = brick.Footprint;
  if (this->AnySampling->Projection)
  {
    return;
  }
  loaded.Seen = loaded.Known ? *loaded.Known : this->LookAt(brick, *loaded.Packed);
  Box& seen = loaded.Seen.Cells;
  const int size = 1 << brick.Level;
  seen = Intersection({ seen.Lo * size, seen.Hi * size }, brick.Drawn);
  loaded.Footprint = seen == brick.Drawn ? brick.Footprint : this->FootprintOf(seen);
}

/// What can be seen of a brick, which is noted if the brick is kept.
BrickVisibility LevelCaster::LookAt(const PlannedBrick& brick, const PackedBrick& packed) const
{
  const BrickVisibility seen(packed, this->RangeOf(brick), this->Visible);
  this->Source.Kept().KeepVisibility(this->KeptNumberOf(brick), this->Visible.Number(), seen);
  return seen;
}

KeptBricks::Pointer LevelCaster::Pack(const PlannedBrick& brick) const
{
  const double low = this->AnySampling->Table.Low();
  const bool shaded = this->Shading != nullptr;
  Box samples;
  BrickView view;
  if (!brick.Together.Empty())
  {
    view = this->Source.LoadTogether(brick.Together, shaded, samples);
  }
  else if (shaded)
  {
    view = this->Source.LoadAround(brick.Number, samples);
  }
  else
  {
    view = this->Source.Load(brick.Number);
    samples.Lo = this->Source.CellsOf(brick.Number).Lo;
  }
  HiddenInBrick hidden(this->Source.Hidden().get(), brick.Cells);
  const double step = hidden.Any() ? 0.0 : this->StepToPack(view.Type);
  const std::shared_ptr<PackedBrick> packed =
    shaded ? std::make_shared<PackedBrick>(view, samples, brick.Cells, low, this->GradientScale())
           : std::make_shared<PackedBrick>(view, samples.Lo, brick.Cells, low, step);
  if (hidden.Any())
  {
    packed->Hide(std::move(hidden));
  }
  return packed;
}

/// Whether the level is much larger than the processor's caches: samples wait for memory then, and
/// rays meet many bricks.
bool LevelCaster::IsLarge() const
{
  constexpr std::int64_t many = std::int64_t{ 1 } << 25; // cells
  return this->Scene.DomainCells.Count() >> 3 * this->Source.Level() >= many;
}

/// Of values for which numbers are to be packed; 0 for none. Frames of volumes that the processor's
/// caches hold nearly as a whole take longer with numbers, those of larger ones less time.
double LevelCaster::StepToPack(ScalarType type) const
{
  if (!this->IsLarge())
  {
    return 0.0;
  }
  const bool small = type == ScalarType::Int8 || type == ScalarType::UInt8 ||
                     type == ScalarType::Int16 || type == ScalarType::UInt16;
  return small ? 1.0 : this->Source.StepOfValues();
}

/// Brings gradients near 1, so that their squares neither overflow nor vanish.
float LevelCaster::GradientScale() const
{
  const MaskRange range = this->Source.MasksAreOver();
  const double width = range.High - range.Low;
  const int exponent = width > 0.0 && std::isfinite(width) ? std::ilogb(width) : 0;
  return static_cast<float>(std::exp2(-std::clamp(exponent, -100, 100)));
}

BrickView LevelCaster::LoadLarge(const PlannedBrick& brick) const
{
  if (this->Shading)
  {
    throw Error("Bricks of so many cells per axis cannot be shaded; cut the data into smaller ones",
      { {}, {}, static_cast<std::uint64_t>(brick.Cells.Size().x),
        static_cast<std::uint64_t>(PackedBrick::LargestEdge) });
  }
  return this->Source.Load(brick.Number);
}

} // namespace banyan
