// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_PackedBrick_h
#define banyan_Render_Bricks_PackedBrick_h

#include "Base/Box.h"
#include "Base/RecycledMemory.h"
#include "Render/Bricks/BrickView.h"
#include "Render/Bricks/HiddenInBrick.h"
#include "Render/Bricks/PackedNumbers.h"
#include "Render/Scene/TransferFunction.h"
#include "Series/Quantize/ValueRange.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

/// A brick laid out for packets of rays, in float32, and the extremes of its macro cells.
///
/// Without gradients, values lie one after the other, and a sample takes four loads of two: a brick
/// takes no more of the processor's caches than it must, which is what samples that are far apart
/// wait for. With gradients, a sample is its value and its gradient, and takes eight loads, or four
/// wider ones.
///
/// Exactness: each value is the float that an interpolation of the brick itself works with
/// (CornerValue), so that packing changes no bit of the picture. Gradients are differences of these
/// floats, the same ones whatever brick a sample is in. Where all values are whole multiples of a
/// step that is known, as those of integers and of encoded series are, 16-bit numbers stand for
/// them and give the same bits: half of the memory again.
///
/// Colours are values, those that the opacity function is asked for, and four bytes more a sample.
class PackedBrick
{
public:
  /// Cells per axis: positions in a brick, and some steps before and after it, have 32 bits.
  static constexpr int LargestEdge = 128;
  /// Macro cells per axis at most; each has 4^3 cells, or 8^3 or 16^3 in bricks above 32 or 64.
  static constexpr int MacroEdge = 8;
  static constexpr int MacroCells = MacroEdge * MacroEdge * MacroEdge;

  static bool CanPack(const Box& cells);
  /// At most.
  static std::size_t BytesFor(const Box& cells, bool gradients, bool colours = false);
  std::size_t Bytes() const;

  /// @param view the brick
  /// @param corner the sample (index space) that view.Values points at
  /// @param cells those to pack, inside the brick; CanPack
  /// @param low what values of types that float cannot hold are relative to (see IsRelative)
  /// @param step numbers are taken if all values are whole multiples of it, each rounded to
  /// float32; 0: no numbers
  /// @param colours whether the view has colours (ColourNumber)
  PackedBrick(const BrickView& view, const glm::ivec3& corner, const Box& cells, double low,
    double step = 0.0, bool colours = false);

  /// With gradients.
  /// @param around samples that the view has: where there is one, a layer more than the brick's
  /// @param scale of gradients: a power of two, the same for all bricks of a volume
  PackedBrick(const BrickView& view, const Box& around, const Box& cells, double low, float scale,
    bool colours = false);

  /// The packed values as a view of Cells(), whose corner is Corner(). Takes memory and time if
  /// HasNumbers.
  BrickView View() const;
  const glm::ivec3& Corner() const { return this->Whole.Lo; }
  const Box& Cells() const { return this->Whole; }

  /// Of the gradient along an axis, at the same samples. HasGradients.
  BrickView GradientView(int axis) const;

  /// Red (0), green or blue of the same samples, 0 to 255. HasColours.
  BrickView ColourView(int channel) const;

  /// Says which cells are not drawn. Not for a brick that HasNumbers.
  void Hide(HiddenInBrick hidden);
  const HiddenInBrick& Hidden() const { return this->HiddenHere; }

  /// Unless HasNumbers.
  const float* Values() const { return this->Samples.data(); }
  bool HasNumbers() const { return !this->Numbers.empty(); }
  const std::int16_t* NumbersOfSamples() const { return this->Numbers.data(); }
  const NumberScale& Scale() const { return this->ScaleOfNumbers; }
  std::ptrdiff_t StrideY() const { return this->Row; }
  std::ptrdiff_t StrideZ() const { return this->Slice; }

  bool HasGradients() const { return this->PerSample == 4; }
  bool HasColours() const { return !this->Colours.empty(); }
  /// Four bytes a sample, red in the lowest, `[z][y][x]` without gaps.
  const std::uint32_t* ColoursOfSamples() const { return this->Colours.data(); }
  bool Relative() const { return this->IsRelativeToLow; }
  double Low() const { return this->RelativeTo; } ///< 0 unless Relative
  /// Whether a value is not finite, or so large that interpolating might give such a value; or some
  /// cell is hidden.
  bool Special() const { return this->HasSpecial; }

  int MacroShift() const { return this->Shift; } ///< a macro cell has 2^shift cells per axis
  glm::ivec3 Macros() const;
  /// Extremes of the values at the corners of a macro cell's cells, NaN apart; empty: low > high,
  /// as it is where all of them are hidden.
  ValueRange RangeOfMacro(const glm::ivec3& macro) const;

private:
  /// Bricks that are packed for one picture come and go by thousands.
  template <class T>
  using Many = std::vector<T, RecycledMemory<T, LargeMemory::Smallest>>;
  using Floats = Many<float>;

  /// Values as interpolations take them, one after the other.
  struct Dense
  {
    Box Samples;
    Floats Values;

    const float* At(int x, int y, int z) const
    {
      const glm::ivec3 size = this->Samples.Size();
      const glm::ivec3 p = glm::ivec3(x, y, z) - this->Samples.Lo;
      return &this->Values[(static_cast<std::size_t>(p.z) * size.y + p.y) * size.x + p.x];
    }
  };

  Dense Convert(const BrickView& view, const glm::ivec3& corner, const Box& samples, double low);
  Dense ConvertColours(const BrickView& view, const glm::ivec3& corner, const Box& samples);
  void Lay(int perSample);
  bool TakeNumbers(const Floats& values, double step);
  void PlaceGradients(const Dense& dense, float scale);
  void PlaceGradientRow(const Dense& dense, int y, int z, float scale, float* out) const;
  void FindExtremes(const Dense& dense);

  Box Whole;
  std::ptrdiff_t Row = 0;
  std::ptrdiff_t Slice = 0;
  int Shift = 2;
  int PerSample = 1;
  bool IsRelativeToLow = false;
  bool HasSpecial = false;
  double RelativeTo = 0.0;
  Floats Samples;
  Many<std::int16_t> Numbers;  ///< in place of Samples
  Many<std::uint32_t> Colours; ///< empty for none
  HiddenInBrick HiddenHere;
  NumberScale ScaleOfNumbers;
  float Lowest[MacroCells];
  float Highest[MacroCells];
};

/// What can be seen of a packed brick under a transfer function.
struct BrickVisibility
{
  BrickVisibility() = default;
  /// @param range of the brick's finite values
  BrickVisibility(const PackedBrick& brick, const ValueRange& range, const VisibleValues& visible);

  /// How many macro cells can be seen whose middle lies in some cells.
  /// @param corner of the brick
  int MacrosIn(const Box& cells, const glm::ivec3& corner) const;

  /// A box of macro cells around all that can be seen; empty when there are none.
  Box Cells;
  /// Whether some macro cells in Cells cannot be seen.
  bool Holes = false;
  /// A bit per macro cell of the brick that can be seen: `[8][8][8]`, x fastest.
  std::uint32_t Mask[PackedBrick::MacroCells / 32] = {};
  int MacroEdge = 4; ///< cells per axis of a macro cell
};

} // namespace banyan

#endif
