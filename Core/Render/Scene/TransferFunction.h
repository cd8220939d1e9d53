// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_TransferFunction_h
#define banyan_Render_Scene_TransferFunction_h

#include "Series/Grid/ValueMask.h"

#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace banyan
{

/// Where one entry of a table ends and the next one begins.
struct FunctionEdge
{
  double Value = 0.0;
  bool Below = false; ///< whether Value itself takes the entry below

  bool operator==(const FunctionEdge& other) const
  {
    return this->Value == other.Value && this->Below == other.Below;
  }
};

/// A transfer function as a table of colour (not premultiplied) and opacity per unit distance.
/// TabulateFunction makes one that is as fine as its function demands.
///
/// Without Edges, entries are equally spaced over [Low, High]; values outside take the first or
/// last entry, and look-ups take the nearest one. When High <= Low, values up to Low take the first
/// entry and those above the last. With Edges, entry i holds the values from edge i - 1 to edge i,
/// and the first and last entries all values beyond: look-ups are exact, and take somewhat longer.
struct TransferFunction
{
  double Low = 0.0;
  double High = 1.0;
  std::vector<glm::vec4> Entries;  ///< at least 2: r, g, b, opacity in [0, 1] over UnitDistance
  double UnitDistance = 1.0;       ///< world length over which an entry's opacity applies; > 0
  std::vector<FunctionEdge> Edges; ///< none, or one fewer than entries; rising

  bool operator==(const TransferFunction& other) const
  {
    return this->Low == other.Low && this->High == other.High &&
           this->UnitDistance == other.UnitDistance && this->Entries == other.Entries &&
           this->Edges == other.Edges;
  }

  /// Values of the series range's bins that may be visible (opacity > 0 somewhere in the bin).
  /// Conservative, as VisibleValues.
  ValueMask VisibleBins(const MaskRange& range) const;

  /// Whether some value in [low, high] has an opacity above 0. Conservative: a neighbouring entry
  /// counts too, so that rounding in an interpolation never loses a sample. Takes time in
  /// proportion to the entries; ask a VisibleValues when there are many intervals.
  bool AnyVisible(double low, double high) const;

  /// Throws Error when there are fewer than two entries, when the range, the edges or the unit
  /// distance are not usable, or when a colour or opacity is not finite or an opacity outside [0,
  /// 1].
  void Check() const;
};

/// Answers "can any value in this interval be seen" in constant time.
class VisibleValues
{
public:
  explicit VisibleValues(const TransferFunction& function);

  /// As TransferFunction::AnyVisible; an empty interval (low > high) shows nothing.
  bool Any(double low, double high) const;

  /// As TransferFunction::VisibleBins.
  ValueMask Bins(const MaskRange& range) const;

  /// Whether every value in [low, high] can be seen. Conservative too: false when in doubt.
  bool All(double low, double high) const;

  /// The same for functions that show the same values; hardly ever the same for others.
  std::uint64_t Number() const { return this->Hash; }

  struct Span
  {
    std::size_t First;
    std::size_t Last; ///< inclusive
  };
  /// The entries that values in [low, high] may take. Conservative: a neighbour counts too.
  Span EntriesOf(double low, double high) const;

private:
  std::vector<int> VisibleBefore; ///< entries with opacity > 0 before entry i
  std::vector<double> Edges;      ///< of the function, if it has any
  double Low = 0.0;
  double Scale = 0.0;
  double Margin = 1.0; ///< entries
  std::uint64_t Hash = 0;
};

/// How values find their entry in a table: (value - Low) * Scale + Bias, clamped to [0, Last],
/// rounded down; what is not finite takes the entry Transparent. Where there are Edges, that is the
/// number of a bucket, and the entry is the number of edges up to the value: First of the bucket,
/// and as many more as a search in a number of Steps finds.
struct TableLookup
{
  float Low = 0;
  float Scale = 0;
  float Bias = 0.5f;
  float Last = 0;
  int Transparent = 0;
  int Steps = 0;
  const float* Edges = nullptr; ///< rising; 2^Steps infinite ones at the end
  const std::int32_t* First = nullptr;

  int IndexOf(float value) const
  {
    constexpr float largest = std::numeric_limits<float>::max();
    if (!(value <= largest && value >= -largest))
    {
      return this->Transparent;
    }
    const int position = this->PositionOf(value);
    return this->Edges ? this->EntryFrom(this->First[position], value) : position;
  }

  /// The entry, or the bucket; of numbers alone.
  int PositionOf(float value) const
  {
    const float position = (value - this->Low) * this->Scale + this->Bias;
    const float notBelow = position > 0.0f ? position : 0.0f;
    return static_cast<int>(notBelow < this->Last ? notBelow : this->Last);
  }

private:
  int EntryFrom(int entry, float value) const
  {
    for (int step = 1 << this->Steps >> 1; step > 0; step >>= 1)
    {
      entry += value >= this->Edges[entry + step - 1] ? step : 0;
    }
    return entry;
  }
};

/// Edges of a function in float, and how they are found.
class EdgeTable
{
public:
  /// @param edges not empty
  /// @param relativeTo what is subtracted from values in double before they become float; 0 where
  ///   values are floats from the beginning
  EdgeTable(const std::vector<FunctionEdge>& edges, double relativeTo, bool relative);

  /// Sets what of a look-up is about edges.
  void Complete(TableLookup& lookup) const;

private:
  TableLookup Lookup;
  std::vector<float> Edges;
  std::vector<std::int32_t> First;
};

/// Opacity of an optical depth, 1 - exp(-depth), for depths from 0 to infinity: within 3e-7 of the
/// result. Only operations that every processor rounds alike, so that vectors do the same.
struct OpacityOfDepth
{
  static constexpr float Largest = 80.0f;         ///< deeper is as opaque
  static constexpr float PerOctave = 1.44269504f; ///< 1 / ln 2
  static constexpr float Round = 12582912.0f;     ///< 1.5 * 2^23: adding it rounds to whole numbers
  static constexpr float OctaveHigh = 0.693359375f; ///< ln 2 in two parts; the first is short
  static constexpr float OctaveLow = -2.12194440e-4f;
  /// (exp(r) - 1 - r) / r^2 for abs(r) below half an octave.
  static constexpr float Terms[6] = { 1.0f / 5040, 1.0f / 720, 1.0f / 120, 1.0f / 24, 1.0f / 6,
    0.5f };

  static float Of(float depth);
};

/// The table of a transfer function for one sample distance: premultiplied colour and opacity,
/// opacity = 1 - (1 - a)^(distance / UnitDistance).
///
/// How values find their entry without losing precision: positions in the table are computed in
/// float, so types that float cannot hold (64-bit, 32-bit integers) must subtract `Low()` in double
/// first and use `RelativeLookup`; data around 1e6 that varies by 0.1 then uses the whole table.
class StepTable
{
public:
  /// Throws Error as TransferFunction::Check does, and for a distance that is not above 0.
  StepTable(const TransferFunction& function, double sampleDistance);

  /// Premultiplied colour and opacity of a value: of the nearest entry; NaN and infinities are
  /// fully transparent.
  glm::vec4 At(float value) const { return this->Partial(this->Lookup().IndexOf(value), 1.0f); }

  /// Premultiplied colour and opacity of entry `index` over a fraction of the sample distance, in
  /// (0, 1]: exact even where the opacity of the whole distance rounds to 1.
  glm::vec4 Partial(int index, float fraction) const
  {
    const glm::vec4& entry = this->Extinctions[index];
    const float opacity = OpacityOfDepth::Of(entry.a * fraction);
    return { entry.r * opacity, entry.g * opacity, entry.b * opacity, opacity };
  }

  double Low() const { return this->LowDouble; }
  const TableLookup& Lookup() const { return this->Absolute; }
  /// For values from which Low() was subtracted in double.
  const TableLookup& RelativeLookup() const { return this->Relative; }

  /// Per entry, for the whole sample distance: premultiplied colour and the *transmittance*
  /// (1 - opacity), which is what blending front to back multiplies by.
  const glm::vec4* Steps() const { return this->Entries.data(); }
  /// Per entry: colour, not premultiplied, and optical depth of the whole sample distance.
  const glm::vec4* Depths() const { return this->Extinctions.data(); }

private:
  std::vector<glm::vec4> Entries; ///< one more than the function's: the transparent one
  /// Colour, not premultiplied, and optical depth of the sample distance; infinite for opacity 1.
  std::vector<glm::vec4> Extinctions;
  double LowDouble = 0;
  TableLookup Absolute;
  TableLookup Relative;
  std::shared_ptr<const EdgeTable> AbsoluteEdges; ///< null without
  std::shared_ptr<const EdgeTable> RelativeEdges;
};

} // namespace banyan

#endif
