// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_PacketMarcher_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_PacketMarcher_inl_h
#undef banyan_Render_Raycast_PacketMarcher_inl_h
#else
#define banyan_Render_Raycast_PacketMarcher_inl_h
#endif

#include "Render/Bricks/PackedBrick.h"
#include "Render/Raycast/NoteSteps-inl.h"
#include "Render/Raycast/PacketIntervals-inl.h"
#include "Render/Raycast/PacketSamples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Draws through one brick as many rays at a time as a vector has lanes. Rays of a packet walk side
/// by side, each from where it enters the brick.
/// @tparam Values PacketSamples, or what stands in for them
/// @tparam Holes whether macro cells are to be skipped
template <class Values, bool Holes>
class PacketMarcher
{
public:
  /// @param cells those to draw
  /// @param corner of the brick
  PacketMarcher(const Values& samples, const Box& cells, const glm::ivec3& corner, RayTile& tile)
    : Intervals(tile, cells)
    , Samples(samples)
    , Tile(tile)
  {
    const int larger = tile.CellShift - tile.BrickShift;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::int64_t low = ToFixed(corner[axis]);
      this->ToBrick[axis] = static_cast<std::uint32_t>(-low);
      this->Offset[axis] = static_cast<std::uint32_t>((ToFixed(cells.Lo[axis]) >> larger) - low);
    }
  }

  /// For Holes.
  void SkipMacros(const PackedBrick& brick, const BrickVisibility& seen)
  {
    this->MacroMask = seen.Mask;
    this->MacroShift = FractionBits + brick.MacroShift();
  }

  /// All packets under some pixels of the tile.
  void March(const PixelRect& pixels)
  {
    this->Tile.Log ? this->template MarchAll<true>(pixels) : this->template MarchAll<false>(pixels);
  }

private:
  /// @tparam Notes whether samples are noted. Code that does beside code that does not would slow
  /// that down by 4 to 9 %, as vectors no longer stay in registers: it is made twice.
  template <bool Notes>
  HWY_NOINLINE void MarchAll(const PixelRect& pixels)
  {
    ForPacketsUnder(pixels, this->Tile,
      [this](int packet) HWY_ATTR
      {
        this->Tile.Ahead.Ask();
        this->template MarchPacket<Notes>(packet);
      });
  }

  template <bool Notes>
  HWY_INLINE void MarchPacket(int packet)
  {
    for (int i = 0; i < RayTile::PacketSize; i += static_cast<int>(hn::Lanes(D())))
    {
      this->template MarchLanes<Notes>(packet * RayTile::PacketSize + i);
    }
  }

  template <bool Notes>
  HWY_INLINE void MarchLanes(int slot)
  {
    const D d;
    const auto open = this->OpenAt(slot);
    if (hn::AllFalse(d, open))
    {
      return;
    }
    const Estimate estimate = this->Intervals.EstimateAt(slot);
    if (estimate.MayHaveHead)
    {
      this->template MarchEnds<Notes>(slot, this->Tile.Head);
    }
    const Whole whole = this->Intervals.FindAt(slot, estimate);
    const auto active =
      hn::And(this->OpenAt(slot), hn::RebindMask(d, hn::Gt(whole.Count, hn::Zero(DI()))));
    if (!hn::AllFalse(d, active))
    {
      this->template MarchWhole<Notes>(slot, whole, active);
    }
    if (estimate.MayHaveTail)
    {
      this->template MarchEnds<Notes>(slot, this->Tile.Tail);
    }
    const std::size_t stillOpen = hn::CountTrue(d, this->OpenAt(slot));
    this->Tile.ActiveRays -= static_cast<std::int64_t>(hn::CountTrue(d, open) - stillOpen);
  }

  HWY_INLINE hn::Mask<D> OpenAt(int slot) const
  {
    const D d;
    return hn::Gt(
      hn::Load(d, this->Tile.Transmittance + slot), hn::Set(d, this->Tile.TransmittanceLimit));
  }

  using Place = typename Values::Place;
  using Found = typename Values::Found;
  using Lanes = hn::Mask<D>;

  /// What a vector of rays has met, and where it goes.
  struct Walk
  {
    VF R;
    VF G;
    VF B;
    VF T;
    Lanes Open; ///< rays that have not ended
    Position At;
    Position Step;
    Direction Ray; ///< set if shaded
    VI Left;       ///< samples from At on
    std::size_t Taken = 0;
  };

  template <bool Notes>
  HWY_INLINE void MarchWhole(int slot, const Whole& whole, Lanes open)
  {
    const DU du;
    Walk walk = this->WalkAt(slot, open);
    walk.Left = whole.Count;
    walk.At = { hn::Add(whole.First[0], hn::Set(du, this->Offset[0])),
      hn::Add(whole.First[1], hn::Set(du, this->Offset[1])),
      hn::Add(whole.First[2], hn::Set(du, this->Offset[2])) };
    walk.Step = { this->Intervals.InBrickCells(this->Tile.Step[0] + slot),
      this->Intervals.InBrickCells(this->Tile.Step[1] + slot),
      this->Intervals.InBrickCells(this->Tile.Step[2] + slot) };
    if (Notes)
    {
      this->FollowNoting(slot, walk, whole);
    }
    else
    {
      this->Follow(walk);
    }
    this->Keep(slot, walk);
    this->Tile.SamplesTaken += static_cast<std::int64_t>(walk.Taken);
  }

  /// @param open the rays that are to go on
  HWY_INLINE Walk WalkAt(int slot, Lanes open) const
  {
    const D d;
    Walk walk;
    walk.R = hn::Load(d, this->Tile.Color[0] + slot);
    walk.G = hn::Load(d, this->Tile.Color[1] + slot);
    walk.B = hn::Load(d, this->Tile.Color[2] + slot);
    walk.T = hn::Load(d, this->Tile.Transmittance + slot);
    walk.Open = open;
    if (Values::IsShaded)
    {
      walk.Ray = { hn::Load(d, this->Tile.Direction[0] + slot),
        hn::Load(d, this->Tile.Direction[1] + slot), hn::Load(d, this->Tile.Direction[2] + slot) };
    }
    return walk;
  }

  HWY_INLINE void Keep(int slot, const Walk& walk)
  {
    const D d;
    hn::Store(walk.R, d, this->Tile.Color[0] + slot);
    hn::Store(walk.G, d, this->Tile.Color[1] + slot);
    hn::Store(walk.B, d, this->Tile.Color[2] + slot);
    hn::Store(walk.T, d, this->Tile.Transmittance + slot);
  }

  /// While a sample is blended the next one is interpolated, and the one after that is located.
  HWY_INLINE void Follow(Walk& walk) const
  {
    const D d;
    Place even;
    Place odd;
    Found evenFound;
    Found oddFound;
    Lanes first = this->Next(walk, even);
    this->Samples.Interpolate(even, walk.Ray, evenFound);
    Lanes second = this->Next(walk, odd);
    while (!hn::AllFalse(d, first))
    {
      const Lanes third = this->Next(walk, even);
      this->Samples.Interpolate(odd, walk.Ray, oddFound);
      this->Blend(walk, first, evenFound);
      if (hn::AllFalse(d, second) || hn::AllFalse(d, walk.Open))
      {
        break;
      }
      first = third;
      const Lanes fourth = this->Next(walk, odd);
      this->Samples.Interpolate(even, walk.Ray, evenFound);
      this->Blend(walk, second, oddFound);
      second = fourth;
      if (hn::AllFalse(d, walk.Open))
      {
        break;
      }
    }
  }

  /// The same samples, which are noted.
  HWY_INLINE void FollowNoting(int slot, Walk& walk, const Whole& whole) const
  {
    const D d;
    const DI di;
    const VI end = hn::Add(whole.Begin, whole.Count);
    Place place;
    Found found;
    for (Lanes lanes = this->Next(walk, place); !hn::AllFalse(d, lanes);
         lanes = this->Next(walk, place))
    {
      this->Samples.Interpolate(place, walk.Ray, found);
      const Steps steps = this->Samples.LookUp(found);
      // Next has gone one further.
      const VI number = hn::Sub(hn::Sub(end, walk.Left), hn::Set(di, 1));
      NoteSteps(*this->Tile.Log, slot, number, lanes, steps);
      this->BlendSteps(walk, lanes, steps);
    }
  }

  /// Locates the next sample that may be seen in some lane. @return these lanes; none at the end
  HWY_INLINE Lanes Next(Walk& walk, Place& place) const
  {
    const D d;
    const DI di;
    Lanes lanes = hn::And(walk.Open, hn::RebindMask(d, hn::Gt(walk.Left, hn::Zero(di))));
    if (Holes)
    {
      Lanes seen = this->Visible(walk.At, lanes);
      while (hn::AllFalse(d, seen) && !hn::AllFalse(d, lanes))
      {
        Advance(walk);
        lanes = hn::And(lanes, hn::RebindMask(d, hn::Gt(walk.Left, hn::Zero(di))));
        seen = this->Visible(walk.At, lanes);
      }
      lanes = seen;
    }
    this->Samples.Locate(walk.At, lanes, place);
    Advance(walk);
    return lanes;
  }

  static HWY_INLINE void Advance(Walk& walk)
  {
    walk.At = { hn::Add(walk.At.X, walk.Step.X), hn::Add(walk.At.Y, walk.Step.Y),
      hn::Add(walk.At.Z, walk.Step.Z) };
    walk.Left = hn::Sub(walk.Left, hn::Set(DI(), 1));
  }

  HWY_INLINE void Blend(Walk& walk, Lanes lanes, const Found& found) const
  {
    lanes = hn::And(lanes, walk.Open);
    this->BlendSteps(walk, lanes, this->Samples.LookUp(found));
  }

  HWY_INLINE void BlendSteps(Walk& walk, Lanes lanes, const Steps& steps) const
  {
    const D d;
    Add(walk, lanes, steps);
    walk.Open = hn::And(walk.Open, hn::Gt(walk.T, hn::Set(d, this->Tile.TransmittanceLimit)));
    walk.Taken += hn::CountTrue(d, lanes);
  }

  static HWY_INLINE void Add(Walk& walk, Lanes lanes, const Steps& steps)
  {
    const VF weight = hn::IfThenElseZero(lanes, walk.T);
    walk.R = hn::Add(walk.R, hn::Mul(weight, steps.R));
    walk.G = hn::Add(walk.G, hn::Mul(weight, steps.G));
    walk.B = hn::Add(walk.B, hn::Mul(weight, steps.B));
    walk.T = hn::IfThenElse(lanes, hn::Mul(walk.T, steps.Transmittance), walk.T);
  }

  /// The lanes whose macro cell can be seen. Samples in others would change no bit.
  HWY_INLINE hn::Mask<D> Visible(const Position& at, hn::Mask<D> active) const
  {
    static_assert(PackedBrick::MacroEdge == 8, "three bits per axis");
    const DU d;
    const VU x = hn::ShiftRightSame(at.X, this->MacroShift);
    const VU y = hn::ShiftRightSame(at.Y, this->MacroShift);
    const VU z = hn::ShiftRightSame(at.Z, this->MacroShift);
    const VU macro = hn::Or(x, hn::Or(hn::ShiftLeft<3>(y), hn::ShiftLeft<6>(z)));
    // Lanes that have left the brick look at some other macro cell.
    const VU number = hn::And(hn::ShiftRight<5>(macro), hn::Set(d, 15u));
    constexpr unsigned lanes = static_cast<unsigned>(hn::MaxLanes(DU()));
    const auto lane = hn::IndicesFromVec(d, hn::And(number, hn::Set(d, lanes - 1)));
    VU word = hn::TableLookupLanes(hn::LoadU(d, this->MacroMask), lane);
    for (unsigned i = lanes; i < 16; i += lanes)
    {
      const VU other = hn::TableLookupLanes(hn::LoadU(d, this->MacroMask + i), lane);
      word =
        hn::IfThenElse(hn::Eq(hn::And(number, hn::Set(d, 16 - lanes)), hn::Set(d, i)), other, word);
    }
    const VU bit = hn::Shl(hn::Set(d, 1u), hn::And(macro, hn::Set(d, 31u)));
    const auto shown = hn::TestBit(word, bit);
    return hn::And(active, hn::RebindMask(D(), shown));
  }

  /// Heads or tails of a vector's rays, where they lie in the cells. Few bricks have any.
  template <bool Notes>
  HWY_INLINE void MarchEnds(int slot, const RayTile::Ends& ends)
  {
    const D d;
    const DU du;
    const VF fraction = hn::Load(d, ends.Fraction + slot);
    const Lanes here = hn::And(this->OpenAt(slot), this->Intervals.EndsInside(slot, ends));
    if (hn::AllFalse(d, here))
    {
      return;
    }
    VU position[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      position[axis] = hn::Add(
        this->Intervals.InBrickCells(ends.Position[axis] + slot), hn::Set(du, this->ToBrick[axis]));
    }
    Place place;
    Found found;
    Walk walk = this->WalkAt(slot, here);
    this->Samples.Locate({ position[0], position[1], position[2] }, here, place);
    this->Samples.Interpolate(place, walk.Ray, found);
    const Steps steps = this->Samples.LookUp(found, fraction);
    if (Notes)
    {
      const bool isHead = &ends == &this->Tile.Head;
      const VI number = hn::Set(DI(), isHead ? SegmentLog::Head : SegmentLog::Tail);
      NoteSteps(*this->Tile.Log, slot, number, here, steps);
    }
    Add(walk, here, steps);
    this->Keep(slot, walk);
    this->Tile.SamplesTaken += static_cast<std::int64_t>(hn::CountTrue(d, here));
  }

  PacketIntervals Intervals;
  Values Samples;
  RayTile& Tile;
  const std::uint32_t* MacroMask = nullptr;
  int MacroShift = 0;
  std::uint32_t ToBrick[3]; ///< to positions in the brick, modulo 256 cells
  std::uint32_t Offset[3];  ///< from the cells' low corner to the brick's
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
