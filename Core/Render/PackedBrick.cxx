#include "Render/PackedBrick.h"

#include "Render/Interpolators.h"

#include <algorithm>
#include <array>
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

void Interleave(const float* first, const float* second, int count, float* out)
{
  const float* const __restrict a = first;
  const float* const __restrict b = second;
  float* const __restrict to = out;
  for (int x = 0; x < count; ++x)
  {
    to[2 * x] = a[x];
    to[2 * x + 1] = b[x];
  }
}

} // namespace

bool PackedBrick::CanPack(const Box& cells)
{
  const glm::ivec3 size = cells.Size();
  return !cells.Empty() && std::max({ size.x, size.y, size.z }) <= LargestEdge;
}

std::size_t PackedBrick::BytesFor(const Box& cells)
{
  const glm::i64vec3 samples = glm::i64vec3(cells.Size()) + std::int64_t{ 1 };
  return static_cast<std::size_t>(samples.x * samples.y * samples.z) * 2 * sizeof(float) +
         sizeof(PackedBrick);
}

template <class T>
void PackedBrick::Copy(const BrickView& view, const glm::ivec3& corner)
{
  const glm::ivec3 samples = this->Whole.Size() + 1;
  const glm::ivec3 first = this->Whole.Lo - corner;
  const T* values = static_cast<const T*>(view.Values) + first.x * view.Stride[0] +
                    first.y * view.Stride[1] + first.z * view.Stride[2];
  std::array<float, LargestEdge + 1> rows[2];
  int special = 0;
  for (int z = 0; z < samples.z; ++z)
  {
    float* out = this->Samples.get() + z * this->Slice;
    for (int y = 0; y < samples.y; ++y)
    {
      const T* row = values + z * view.Stride[2] + y * view.Stride[1];
      std::array<float, LargestEdge + 1>& now = rows[y & 1];
      special |= ConvertRow(row, view.Stride[0], samples.x, this->RelativeTo, now.data());
      if (y > 0)
      {
        Interleave(rows[1 - (y & 1)].data(), now.data(), samples.x, out);
        out += this->Row;
      }
    }
    // So that the last row can be read as the others are, one value after the other.
    const float* last = rows[(samples.y - 1) & 1].data();
    Interleave(last, last, samples.x, out);
  }
  this->HasSpecial = special != 0;
}

PackedBrick::PackedBrick(
  const BrickView& view, const glm::ivec3& corner, const Box& cells, double low)
  : Whole(cells)
{
  const glm::ivec3 samples = cells.Size() + 1;
  this->Row = 2 * std::ptrdiff_t{ samples.x };
  this->Slice = this->Row * samples.y;
  while (std::max({ samples.x, samples.y, samples.z }) - 1 > MacroEdge << this->Shift)
  {
    ++this->Shift;
  }
  this->Samples.reset(new float[static_cast<std::size_t>(this->Slice * samples.z)]);
  Dispatch(view.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      this->IsRelativeToLow = IsRelative<T>;
      this->RelativeTo = IsRelative<T> ? low : 0.0;
      this->Copy<T>(view, corner);
    });
  this->FindExtremes();
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

void PackedBrick::FindExtremes()
{
  const glm::ivec3 cells = this->Whole.Size();
  const int edge = 1 << this->Shift;
  const glm::ivec3 macros = this->Macros();
  std::array<float, 2 * LargestEdge + 2> lowest;
  std::array<float, 2 * LargestEdge + 2> highest;
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
        // A row holds the next one, too.
        for (int i = begin.x; i < end.x; i += 2)
        {
          const float* row = this->Samples.get() + j * this->Slice + i * this->Row;
          Widen(row, this->Row, lowest.data(), highest.data());
        }
        const float* row = this->Samples.get() + j * this->Slice + (end.x - 1) * this->Row;
        Widen(row, this->Row, lowest.data(), highest.data());
      }
      for (int x = 0; x < macros.x; ++x)
      {
        const int first = 2 * x * edge;
        const int last = 2 * std::min((x + 1) * edge, cells.x) + 2;
        const int number = MacroNumber({ x, y, z });
        this->Lowest[number] = *std::min_element(lowest.data() + first, lowest.data() + last);
        this->Highest[number] = *std::max_element(highest.data() + first, highest.data() + last);
      }
    }
  }
}

BrickView PackedBrick::View() const
{
  BrickView view;
  view.Values = this->Samples.get();
  view.Type = ScalarType::Float32;
  view.Stride[0] = 2;
  view.Stride[1] = this->Row;
  view.Stride[2] = this->Slice;
  return view;
}

BrickVisibility::BrickVisibility(
  const PackedBrick& brick, const ValueRange& range, const VisibleValues& visible)
  : Cells(brick.Cells())
{
  if (visible.All(range.Low, range.High))
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

} // namespace banyan
