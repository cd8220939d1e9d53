// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/PackedBrick.h"

#include "Render/Bricks/Interpolators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

/// Differences of values up to here are finite.
constexpr float LargestOrdinary = 1e37f;

int MacroNumber(const glm::ivec3& macro)
{
  return (macro.z * PackedBrick::MacroEdge + macro.y) * PackedBrick::MacroEdge + macro.x;
}

/// Widens the extremes of rows by those of another row.
void Widen(const float* row, std::ptrdiff_t count, float* low, float* high)
{
  const float* const __restrict values = row;
  float* const __restrict lowest = low;
  float* const __restrict highest = high;
  for (std::ptrdiff_t x = 0; x < count; ++x)
  {
    // Comparisons with NaN change nothing.
    lowest[x] = values[x] < lowest[x] ? values[x] : lowest[x];
    highest[x] = values[x] > highest[x] ? values[x] : highest[x];
  }
}

/// Values of a row as interpolations take them. @return not 0 when one is not ordinary
template <class T>
int ConvertRow(const T* values, std::ptrdiff_t stride, int count, double low, float* out)
{
  const T* const __restrict row = values;
  float* const __restrict to = out;
  if (stride == 1)
  {
    for (int x = 0; x < count; ++x)
    {
      to[x] = CornerValue(row[x], low);
    }
  }
  else
  {
    for (int x = 0; x < count; ++x)
    {
      to[x] = CornerValue(row[x * stride], low);
    }
  }
  int special = 0;
  for (int x = 0; x < count; ++x)
  {
    special |= std::abs(to[x]) <= LargestOrdinary ? 0 : 1;
  }
  return special;
}

/// The difference over the neighbours on both sides, or over the one that is usable.
/// @param before, after null where there is none
float Difference(const float* before, float here, const float* after)
{
  const bool hasBefore = before && std::isfinite(*before);
  const bool hasAfter = after && std::isfinite(*after);
  const float low = hasBefore ? *before : here;
  const float high = hasAfter ? *after : here;
  return (high - low) * (hasBefore && hasAfter ? 0.5f : 1.0f);
}

} // namespace

bool PackedBrick::CanPack(const Box& cells)
{
  const glm::ivec3 size = cells.Size();
  return !cells.Empty() && std::max({ size.x, size.y, size.z }) <= LargestEdge;
}

std::size_t PackedBrick::BytesFor(const Box& cells, bool gradients, bool colours)
{
  const glm::i64vec3 samples = glm::i64vec3(cells.Size()) + std::int64_t{ 1 };
  return static_cast<std::size_t>(samples.x * samples.y * samples.z) *
           ((gradients ? 4 : 1) * sizeof(float) + (colours ? sizeof(std::uint32_t) : 0)) +
         sizeof(PackedBrick);
}

PackedBrick::Dense PackedBrick::Convert(
  const BrickView& view, const glm::ivec3& corner, const Box& samples, double low)
{
  Dense dense;
  dense.Samples = samples;
  dense.Values.resize(static_cast<std::size_t>(samples.Count()));
  const glm::ivec3 size = samples.Size();
  const glm::ivec3 first = samples.Lo - corner;
  Dispatch(view.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      this->IsRelativeToLow = IsRelative<T>;
      this->RelativeTo = IsRelative<T> ? low : 0.0;
      const T* values = static_cast<const T*>(view.Values) + first.x * view.Stride[0] +
                        first.y * view.Stride[1] + first.z * view.Stride[2];
      float* out = dense.Values.data();
      int special = 0;
      for (int z = 0; z < size.z; ++z)
      {
        for (int y = 0; y < size.y; ++y, out += size.x)
        {
          const T* row = values + z * view.Stride[2] + y * view.Stride[1];
          special |= ConvertRow(row, view.Stride[0], size.x, this->RelativeTo, out);
        }
      }
      this->HasSpecial = special != 0;
    });
  return dense;
}

/// @param perSample floats
void PackedBrick::Lay(int perSample)
{
  const glm::ivec3 samples = this->Whole.Size() + 1;
  this->PerSample = perSample;
  this->Row = std::ptrdiff_t{ perSample } * samples.x;
  this->Slice = this->Row * samples.y;
  while (std::max({ samples.x, samples.y, samples.z }) - 1 > MacroEdge << this->Shift)
  {
    ++this->Shift;
  }
}

PackedBrick::PackedBrick(const BrickView& view, const glm::ivec3& corner, const Box& cells,
  double low, double step, bool colours)
  : Whole(cells)
{
  this->Lay(1);
  const Box samples{ cells.Lo, cells.Hi + 1 };
  Dense dense = colours ? this->ConvertColours(view, corner, samples)
                        : this->Convert(view, corner, samples, low);
  this->FindExtremes(dense);
  if (!this->TakeNumbers(dense.Values, step))
  {
    this->Samples = std::move(dense.Values);
  }
}

/// @return false: there are no numbers for these values
bool PackedBrick::TakeNumbers(const Floats& values, double step)
{
  if (!(step > 0.0) || this->HasSpecial || this->IsRelativeToLow)
  {
    return false;
  }
  // The last one may be read with one behind it.
  this->Numbers.resize(values.size() + 1);
  this->Numbers.back() = 0;
  if (!NumbersOfValues(
        values.data(), values.size(), step, this->ScaleOfNumbers, this->Numbers.data()))
  {
    this->Numbers = {};
    return false;
  }
  return true;
}

std::size_t PackedBrick::Bytes() const
{
  return sizeof(PackedBrick) + this->Samples.size() * sizeof(float) +
         this->Numbers.size() * sizeof(std::int16_t) +
         this->Colours.size() * sizeof(std::uint32_t) + this->HiddenHere.Bytes();
}

void PackedBrick::Hide(HiddenInBrick hidden)
{
  this->HiddenHere = std::move(hidden);
  this->HasSpecial = this->HasSpecial || this->HiddenHere.Any();
  const glm::ivec3 macros = this->Macros();
  const int edge = 1 << this->Shift;
  for (int z = 0; z < macros.z; ++z)
  {
    for (int y = 0; y < macros.y; ++y)
    {
      for (int x = 0; x < macros.x; ++x)
      {
        const glm::ivec3 first = glm::ivec3(x, y, z) * edge;
        if (this->HiddenHere.All({ first, glm::min(first + edge, this->Whole.Size()) }))
        {
          const int number = MacroNumber({ x, y, z });
          this->Lowest[number] = std::numeric_limits<float>::infinity();
          this->Highest[number] = -std::numeric_limits<float>::infinity();
        }
      }
    }
  }
}

PackedBrick::PackedBrick(
  const BrickView& view, const Box& around, const Box& cells, double low, float scale, bool colours)
  : Whole(cells)
{
  this->Lay(4);
  const Box samples = Intersection(around, { cells.Lo - 1, cells.Hi + 2 });
  const Dense dense = colours ? this->ConvertColours(view, around.Lo, samples)
                              : this->Convert(view, around.Lo, samples, low);
  this->FindExtremes(dense);
  this->Samples.resize(static_cast<std::size_t>(this->Slice) * (cells.Size().z + 1));
  this->PlaceGradients(dense, scale);
}

glm::ivec3 PackedBrick::Macros() const
{
  const int edge = 1 << this->Shift;
  return (this->Whole.Size() + edge - 1) / edge;
}

ValueRange PackedBrick::RangeOfMacro(const glm::ivec3& macro) const
{
  const int number = MacroNumber(macro);
  return { this->Lowest[number], this->Highest[number] };
}

void PackedBrick::FindExtremes(const Dense& dense)
{
  const glm::ivec3 cells = this->Whole.Size();
  const glm::ivec3 corner = this->Whole.Lo;
  const int edge = 1 << this->Shift;
  const glm::ivec3 macros = this->Macros();
  std::array<float, LargestEdge + 1> lowest;
  std::array<float, LargestEdge + 1> highest;
  for (int z = 0; z < macros.z; ++z)
  {
    for (int y = 0; y < macros.y; ++y)
    {
      lowest.fill(std::numeric_limits<float>::infinity());
      highest.fill(-std::numeric_limits<float>::infinity());
      const glm::ivec2 begin(y * edge, z * edge);
      const glm::ivec2 end = glm::min(begin + edge, glm::ivec2(cells.y, cells.z));
      for (int j = begin.y; j <= end.y; ++j)
      {
        for (int i = begin.x; i <= end.x; ++i)
        {
          const float* row = dense.At(corner.x, corner.y + i, corner.z + j);
          Widen(row, cells.x + 1, lowest.data(), highest.data());
        }
      }
      for (int x = 0; x < macros.x; ++x)
      {
        const int first = x * edge;
        const int last = std::min((x + 1) * edge, cells.x) + 1;
        const int number = MacroNumber({ x, y, z });
        this->Lowest[number] = *std::min_element(lowest.data() + first, lowest.data() + last);
        this->Highest[number] = *std::max_element(highest.data() + first, highest.data() + last);
      }
    }
  }
}

void PackedBrick::PlaceGradientRow(const Dense& dense, int y, int z, float scale, float* out) const
{
  const Box& have = dense.Samples;
  const int first = this->Whole.Lo.x;
  const int count = this->Whole.Size().x + 1;
  const float* row = dense.At(first, y, z);
  const float* below = y > have.Lo.y ? dense.At(first, y - 1, z) : nullptr;
  const float* above = y + 1 < have.Hi.y ? dense.At(first, y + 1, z) : nullptr;
  const float* before = z > have.Lo.z ? dense.At(first, y, z - 1) : nullptr;
  const float* behind = z + 1 < have.Hi.z ? dense.At(first, y, z + 1) : nullptr;
  const auto place = [&](int x)
  {
    const float* left = first + x > have.Lo.x ? row + x - 1 : nullptr;
    const float* right = first + x + 1 < have.Hi.x ? row + x + 1 : nullptr;
    out[4 * x] = row[x];
    out[4 * x + 1] = Difference(left, row[x], right) * scale;
    out[4 * x + 2] =
      Difference(below ? below + x : nullptr, row[x], above ? above + x : nullptr) * scale;
    out[4 * x + 3] =
      Difference(before ? before + x : nullptr, row[x], behind ? behind + x : nullptr) * scale;
  };
  if (this->HasSpecial || !below || !above || !before || !behind)
  {
    for (int x = 0; x < count; ++x)
    {
      place(x);
    }
    return;
  }
  // The same without questions.
  place(0);
  const float half = 0.5f;
  for (int x = 1; x + 1 < count; ++x)
  {
    out[4 * x] = row[x];
    out[4 * x + 1] = (row[x + 1] - row[x - 1]) * half * scale;
    out[4 * x + 2] = (above[x] - below[x]) * half * scale;
    out[4 * x + 3] = (behind[x] - before[x]) * half * scale;
  }
  place(count - 1);
}

void PackedBrick::PlaceGradients(const Dense& dense, float scale)
{
  for (int z = 0; z <= this->Whole.Size().z; ++z)
  {
    for (int y = 0; y <= this->Whole.Size().y; ++y)
    {
      this->PlaceGradientRow(dense, this->Whole.Lo.y + y, this->Whole.Lo.z + z, scale,
        this->Samples.data() + z * this->Slice + y * this->Row);
    }
  }
}

BrickView PackedBrick::View() const
{
  BrickView view;
  view.Values = this->Samples.data();
  if (this->HasNumbers())
  {
    const auto values = std::make_shared<Floats>(this->Numbers.size());
    std::transform(this->Numbers.begin(), this->Numbers.end(), values->begin(),
      [this](std::int16_t number) { return ValueOfNumber(number, this->ScaleOfNumbers); });
    view.Values = values->data();
    view.Owner = values;
  }
  view.Type = ScalarType::Float32;
  view.Stride[0] = this->PerSample;
  view.Stride[1] = this->Row;
  view.Stride[2] = this->Slice;
  return view;
}

BrickView PackedBrick::GradientView(int axis) const
{
  BrickView view = this->View();
  view.Values = this->Samples.data() + 1 + axis;
  return view;
}

BrickVisibility::BrickVisibility(
  const PackedBrick& brick, const ValueRange& range, const VisibleValues& visible)
  : Cells(brick.Cells())
  , MacroEdge(1 << brick.MacroShift())
{
  if (visible.All(range.Low, range.High) && !brick.Hidden().Any())
  {
    return;
  }
  const glm::ivec3 macros = brick.Macros();
  Box seen;
  std::int64_t shown = 0;
  for (int z = 0; z < macros.z; ++z)
  {
    for (int y = 0; y < macros.y; ++y)
    {
      for (int x = 0; x < macros.x; ++x)
      {
        const glm::ivec3 macro(x, y, z);
        const ValueRange values = brick.RangeOfMacro(macro);
        // Interpolating rounds in float.
        const double slack = 4e-7 * std::max(std::abs(values.Low), std::abs(values.High));
        if (!values.Empty() &&
            visible.Any(values.Low + brick.Low() - slack, values.High + brick.Low() + slack))
        {
          const int number = MacroNumber(macro);
          this->Mask[number / 32] |= 1u << number % 32;
          seen = Union(seen, Box{ macro, macro + 1 });
          ++shown;
        }
      }
    }
  }
  this->Holes = shown < seen.Count();
  const int edge = 1 << brick.MacroShift();
  this->Cells = Intersection(
    { brick.Corner() + seen.Lo * edge, brick.Corner() + seen.Hi * edge }, brick.Cells());
}

int BrickVisibility::MacrosIn(const Box& cells, const glm::ivec3& corner) const
{
  // The first macro cell whose middle is not before a cell.
  const int toMiddle = this->MacroEdge / 2;
  const auto firstFrom = [&](const glm::ivec3& cell)
  { return glm::min((cell - corner + toMiddle - 1) / this->MacroEdge, PackedBrick::MacroEdge); };
  const glm::ivec3 low = firstFrom(cells.Lo);
  const glm::ivec3 high = firstFrom(cells.Hi);
  int count = 0;
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      for (int x = low.x; x < high.x; ++x)
      {
        const int number = MacroNumber({ x, y, z });
        count += static_cast<int>(this->Mask[number / 32] >> number % 32 & 1u);
      }
    }
  }
  return count;
}

} // namespace banyan
