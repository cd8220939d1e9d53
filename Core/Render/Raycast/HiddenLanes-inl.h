// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see PacketMarcher.cxx.
#if defined(banyan_Render_Raycast_HiddenLanes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Render_Raycast_HiddenLanes_inl_h
#undef banyan_Render_Raycast_HiddenLanes_inl_h
#else
#define banyan_Render_Raycast_HiddenLanes_inl_h
#endif

#include "Render/Bricks/HiddenInBrick.h"
#include "Render/Bricks/PacketVectors-inl.h"
#include "Render/Scene/RayLattice.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// HiddenInBrick for a vector of positions.
class HiddenLanes
{
public:
  explicit HiddenLanes(const HiddenInBrick& hidden)
    : Words(reinterpret_cast<const std::int32_t*>(hidden.Words()))
    , WordsPerRow(hidden.WordsPerRow())
    , RowsPerSlice(hidden.RowsPerSlice())
  {
  }

  bool Any() const { return this->Words != nullptr; }

  /// Any().
  /// @param mask lanes whose position is inside the brick
  /// @return not 0 where the cell is hidden
  HWY_INLINE VI At(VU x, VU y, VU z, hn::Mask<DI> mask) const
  {
    const DI d;
    const DU du;
    const auto cell = [](VU along) HWY_ATTR
    { return hn::BitCast(DI(), hn::ShiftRight<FractionBits>(along)); };
    const VI row = hn::Add(cell(y), hn::Mul(cell(z), hn::Set(d, this->RowsPerSlice)));
    const VI word =
      hn::Add(hn::Mul(row, hn::Set(d, this->WordsPerRow)), hn::ShiftRight<5>(cell(x)));
    const VI words = hn::GatherIndex(d, this->Words, hn::IfThenElseZero(mask, word));
    const VU place = hn::BitCast(du, hn::And(cell(x), hn::Set(d, 31)));
    return hn::And(words, hn::BitCast(d, hn::Shl(hn::Set(du, 1u), place)));
  }

private:
  const std::int32_t* Words; ///< null where no cell is hidden
  std::int32_t WordsPerRow;
  std::int32_t RowsPerSlice;
};

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
