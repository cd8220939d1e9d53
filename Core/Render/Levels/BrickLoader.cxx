// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/BrickLoader.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace banyan
{
namespace
{

float GradientScaleOf(const MaskRange& range)
{
  const double width = range.High - range.Low;
  const int exponent = width > 0.0 && std::isfinite(width) ? std::ilogb(width) : 0;
  return static_cast<float>(std::exp2(-std::clamp(exponent, -100, 100)));
}

} // namespace

BrickLoader::BrickLoader(const LevelScene& level)
  : Level(level)
  , Source(level.Source)
  , GradientScale(GradientScaleOf(level.Source.MasksAreOver()))
{
}

void BrickLoader::Load(LoadedBrick& loaded) const
{
  const PlannedBrick& brick = *loaded.Planned;
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
    this->Source.Kept().Keep(brick.KeptNumber(this->Source), loaded.Packed);
  }
  loaded.Footprint = brick.Footprint;
  if (this->Level.Projection())
  {
    return;
  }
  loaded.Seen = loaded.Known ? *loaded.Known : this->LookAt(brick, *loaded.Packed);
  Box& seen = loaded.Seen.Cells;
  const int size = 1 << brick.Level;
  seen = Intersection({ seen.Lo * size, seen.Hi * size }, brick.Drawn);
  loaded.Footprint = seen == brick.Drawn ? brick.Footprint : this->Level.FootprintOf(seen);
}

/// Finds out how much of a brick can be seen, and notes it if the brick is kept.
BrickVisibility BrickLoader::LookAt(const PlannedBrick& brick, const PackedBrick& packed) const
{
  const VisibleValues& visible = *this->Level.Visible;
  const BrickVisibility seen(packed, brick.RangeIn(this->Source), visible);
  this->Source.Kept().KeepVisibility(brick.KeptNumber(this->Source), visible.Number(), seen);
  return seen;
}

PackedBrickCache::Pointer BrickLoader::Pack(const PlannedBrick& brick) const
{
  const double low = this->Level.Low();
  const bool shaded = this->Level.IsShaded();
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
  const bool colours = this->Source.HasColours();
  const double step = hidden.Any() || colours ? 0.0 : this->StepToPack(view.Type);
  const std::shared_ptr<PackedBrick> packed =
    shaded
      ? std::make_shared<PackedBrick>(view, samples, brick.Cells, low, this->GradientScale, colours)
      : std::make_shared<PackedBrick>(view, samples.Lo, brick.Cells, low, step, colours);
  if (hidden.Any())
  {
    packed->Hide(std::move(hidden));
  }
  return packed;
}

/// The step of values for which 16-bit numbers are to be packed; 0 for none. Frames of volumes that
/// the processor's caches hold nearly as a whole take longer with numbers, those of larger ones
/// less time.
double BrickLoader::StepToPack(ScalarType type) const
{
  if (!this->Level.IsLarge())
  {
    return 0.0;
  }
  const bool small = type == ScalarType::Int8 || type == ScalarType::UInt8 ||
                     type == ScalarType::Int16 || type == ScalarType::UInt16;
  return small ? 1.0 : this->Source.StepOfValues();
}

BrickView BrickLoader::LoadLarge(const PlannedBrick& brick) const
{
  if (this->Level.IsShaded() || this->Source.HasColours())
  {
    throw Error("Bricks of so many cells per axis cannot be shaded, and have no colours; cut the "
                "data into smaller ones",
      { {}, {}, static_cast<std::uint64_t>(brick.Cells.Size().x),
        static_cast<std::uint64_t>(PackedBrick::LargestEdge) });
  }
  return this->Source.Load(brick.Number);
}

} // namespace banyan
