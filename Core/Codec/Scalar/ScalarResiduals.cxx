// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/Scalar/ScalarResiduals.h"

#include "Codec/Scalar/ScalarSymbols.h"

#include <algorithm>
#include <cstddef>

namespace banyan::scalar
{
namespace
{

/// The magnitude of a residual is the number of the last of these that it reaches, plus 2, or 0.
int MagnitudeOf(std::int32_t residual)
{
  const std::int64_t size = residual < 0 ? -std::int64_t{ residual } : residual;
  int magnitude = 0;
  for (const int limit : { 1, 2, 3, 4, 6, 9, 13 })
  {
    magnitude += size >= limit ? (magnitude == 0 ? 2 : 1) : 0;
  }
  return magnitude;
}

/// The residuals of one block: all samples that it owns, whatever unit they belong to.
class Block
{
public:
  Block(int edge, bool narrow)
    : Edge(edge)
    , Narrow(narrow)
    , Residuals(static_cast<std::size_t>(edge * edge * edge), 0)
    , Large(Residuals.size(), false)
  {
  }

  std::int32_t& At(const Position& p) { return this->Residuals[this->IndexOf(p)]; }

  void Read(const glm::ivec3& limit, Symbols& symbols)
  {
    ForEachSlice(this->Edge, [&](int stride, int axis, const std::vector<RowToRead>& rows, int step)
      { this->ReadSlice(rows, limit, stride, axis, step, symbols); });
  }

  const std::vector<std::int32_t>& All() const { return this->Residuals; }

private:
  std::size_t IndexOf(const Position& p) const
  {
    return static_cast<std::size_t>((p[2] * this->Edge + p[1]) * this->Edge + p[0]);
  }

  static Position InBlock(const std::vector<int>& axes, const Position& inUnit)
  {
    Position p{ 0, 0, 0 };
    for (std::size_t a = 0; a < axes.size(); ++a)
    {
      p[static_cast<std::size_t>(axes[a])] = inUnit[a];
    }
    return p;
  }

  struct Sample
  {
    Position Where; ///< in the block
    int Context;
    bool Opposite; ///< what is coded has the other sign
  };

  static int BandOf(int dimensions, int stride, int axis)
  {
    return dimensions == 1   ? 2 - stride
           : dimensions == 2 ? (stride == 2 ? 2 : 3 + axis)
                             : (stride == 2 ? 5 : 8) + axis;
  }

  /// The samples of a row within the field.
  std::vector<Sample> SamplesOf(
    const RowToRead& row, const glm::ivec3& limit, int stride, int axis, int step)
  {
    const int band = BandOf(static_cast<int>(row.Axes.size()), stride, axis);
    std::vector<Sample> samples;
    for (Position at = row.First; at[0] < this->Edge && Inside(row.Axes, at, limit); at[0] += step)
    {
      const int activity = this->Activity(row.Axes, stride, axis, at);
      int contextClass = 0;
      for (const int limitOfClass : { 0, 5, 12, 22, 36, 56, 90 })
      {
        contextClass += activity > limitOfClass ? 1 : 0;
      }
      const int hint = contextClass > 0 ? this->Hint(row.Axes, stride, at) : 0;
      samples.push_back(
        { InBlock(row.Axes, at), 16 * band + contextClass + (hint != 0 ? 8 : 0), hint < 0 });
    }
    return samples;
  }

  /// How likely a row has residuals, 0 to 12.
  int RowClass(const RowToRead& row, int stride, int axis)
  {
    const int weight = this->RowWeight(row.Axes, stride, axis, row.First);
    int rowClass = 0;
    for (const int limitOfClass : { 0, 8, 16, 28, 44, 64, 90, 125, 170, 230, 310, 420 })
    {
      rowClass += weight > limitOfClass ? 1 : 0;
    }
    return rowClass;
  }

  /// Residuals of a slice are no context for the same slice: all of it is read, and then set.
  void ReadSlice(const std::vector<RowToRead>& rows, const glm::ivec3& limit, int stride, int axis,
    int step, Symbols& symbols)
  {
    const int band = BandOf(static_cast<int>(rows[0].Axes.size()), stride, axis);
    std::size_t flag = 0;
    std::vector<Sample> run;
    for (const RowToRead& row : rows)
    {
      const std::vector<Sample> samples = this->SamplesOf(row, limit, stride, axis, step);
      if (samples.empty())
      {
        continue;
      }
      const int rowClass = this->RowClass(row, stride, axis);
      if (rowClass == 12 || symbols.Next(176 + 12 * band + rowClass, flag++) == 0)
      {
        run.insert(run.end(), samples.begin(), samples.end());
      }
    }
    std::vector<int> read;
    for (const Sample& sample : run)
    {
      read.push_back(symbols.Next(sample.Context, read.size()));
    }
    for (std::size_t i = 0; i < run.size(); ++i)
    {
      const std::int32_t residual = symbols.Residual(read[i]);
      const std::int32_t value =
        run[i].Opposite ? static_cast<std::int32_t>(0u - static_cast<std::uint32_t>(residual))
                        : residual;
      this->At(run[i].Where) = this->Narrow ? static_cast<std::int16_t>(value) : value;
      this->Large[this->IndexOf(run[i].Where)] = read[i] >= 40;
    }
  }

  /// Twice the residual of the slice before, and that of the one before it, each from -15 to 15.
  int Hint(const std::vector<int>& axes, int s, const Position& at)
  {
    const auto residual = [&](int before)
    {
      Position p = at;
      p[axes.size() - 1] -= before;
      return p[axes.size() - 1] > 0
               ? std::clamp(this->At(InBlock(axes, p)), std::int32_t{ -15 }, std::int32_t{ 15 })
               : 0;
    };
    return axes.size() == 1 ? 0 : 2 * residual(2 * s) + residual(4 * s);
  }

  static bool Inside(const std::vector<int>& axes, const Position& inUnit, const glm::ivec3& limit)
  {
    const Position p = InBlock(axes, inUnit);
    bool inside = true;
    for (const int real : axes)
    {
      inside = inside && p[static_cast<std::size_t>(real)] <= limit[real];
    }
    return inside;
  }

  /// The next row or slice along an axis, or the one before where there is none.
  int Next(int position, int step) const
  {
    return position + step < this->Edge ? position + step : position - step;
  }

  int MagnitudeAt(const std::vector<int>& axes, int x, int y, int z)
  {
    return x < 0 || x >= this->Edge ? 0 : this->Magnitude(axes, { x, y, z });
  }

  /// Weighted sum of magnitudes around a sample of a unit.
  int Activity(const std::vector<int>& axes, int s, int axis, const Position& at)
  {
    const int dimensions = static_cast<int>(axes.size());
    const int sum = this->ActivityAtEnds(axes, s, axis, at);
    if (dimensions == 1)
    {
      return sum;
    }
    // The slice before, of the same pass.
    const auto m = [&](int x, int y, int z) { return this->MagnitudeAt(axes, x, y, z); };
    const auto [x, y, z] = at;
    const int across = axis == 0 ? 2 * s : s;
    if (dimensions == 2)
    {
      const int e = y - 2 * s;
      return y < 2 * s ? 2 * sum
                       : sum + 6 * m(x, e, z) + 2 * (m(x - across, e, z) + m(x + across, e, z));
    }
    if (z < 2 * s)
    {
      return 2 * sum;
    }
    const int e = z - 2 * s;
    const int up = axis == 2 ? s : 2 * s;
    const int after = this->Next(y, up);
    const int before = y >= up ? y - up : after;
    return sum + 6 * m(x, y, e) +
           2 * (m(x - across, y, e) + m(x + across, y, e) + m(x, before, e) + m(x, after, e));
  }

  /// The same of what is at and beside both ends of the interpolation.
  int ActivityAtEnds(const std::vector<int>& axes, int s, int axis, const Position& at)
  {
    const int dimensions = static_cast<int>(axes.size());
    const auto m = [&](int x, int y, int z) { return this->MagnitudeAt(axes, x, y, z); };
    const auto [x, y, z] = at;
    int sum = 0;
    if (axis == 0)
    {
      sum += 2 * (m(x - s, y, z) + m(x + s, y, z));
      if (dimensions > 1)
      {
        for (const int e : { y - 2 * s, this->Next(y, 2 * s) })
        {
          sum += m(x - s, e, z) + m(x + s, e, z);
        }
      }
      if (dimensions > 2)
      {
        for (const int e : { z - 2 * s, this->Next(z, 2 * s) })
        {
          sum += m(x - s, y, e) + m(x + s, y, e);
        }
      }
    }
    else if (axis == 1)
    {
      for (const int end : { y - s, this->Next(y, s) })
      {
        sum += 2 * m(x, end, z) + m(x - s, end, z) + m(x + s, end, z);
        sum += dimensions > 2 ? m(x, end, z - 2 * s) + m(x, end, this->Next(z, 2 * s)) : 0;
      }
    }
    else
    {
      for (const int end : { z - s, this->Next(z, s) })
      {
        sum += 2 * m(x, y, end) + m(x - s, y, end) + m(x + s, y, end);
        sum += m(x, y - s, end) + m(x, this->Next(y, s), end);
      }
    }
    return sum;
  }

  /// Weighted sum of the magnitudes in the rows around a row of a unit.
  int RowWeight(const std::vector<int>& axes, int s, int axis, const Position& first)
  {
    const int dimensions = static_cast<int>(axes.size());
    const auto sum = [&](int y, int z)
    {
      int all = 0;
      for (int x = 0; x < this->Edge; ++x)
      {
        all += this->Magnitude(axes, { x, y, z });
      }
      return all;
    };
    const int y = first[1];
    const int z = first[2];
    int weight = 0;
    if (axis == 0)
    {
      weight = 4 * sum(y, z);
      weight += dimensions > 1 ? 2 * (sum(y - 2 * s, z) + sum(this->Next(y, 2 * s), z)) : 0;
      weight += dimensions > 2 ? 2 * (sum(y, z - 2 * s) + sum(y, this->Next(z, 2 * s))) : 0;
    }
    else if (axis == 1)
    {
      for (const int end : { y - s, this->Next(y, s) })
      {
        weight += 4 * sum(end, z);
        weight += dimensions > 2 ? sum(end, z - 2 * s) + sum(end, this->Next(z, 2 * s)) : 0;
      }
    }
    else
    {
      for (const int end : { z - s, this->Next(z, s) })
      {
        weight += 4 * sum(y, end) + sum(y - s, end) + sum(this->Next(y, s), end);
      }
    }
    if (dimensions == 1)
    {
      return weight;
    }
    const int slice = dimensions == 2 ? y : z;
    if (slice < 2 * s)
    {
      return 2 * weight;
    }
    if (dimensions == 2)
    {
      return weight + 10 * sum(y - 2 * s, z);
    }
    const int e = z - 2 * s;
    const int step = axis == 2 ? s : 2 * s;
    const int after = this->Next(y, step);
    const int before = y >= step ? y - step : after;
    return weight + 10 * sum(y, e) + 2 * (sum(before, e) + sum(after, e));
  }

  int Magnitude(const std::vector<int>& axes, const Position& inUnit)
  {
    const Position p = InBlock(axes, inUnit);
    return this->Large[this->IndexOf(p)] ? 8 : MagnitudeOf(this->At(p));
  }

  int Edge;
  bool Narrow;
  std::vector<std::int32_t> Residuals;
  std::vector<bool> Large; ///< their symbols have extra bits
};

} // namespace

std::vector<std::int32_t> ReadResiduals(int edge, const StateOf& stateOf, const glm::ivec3& limit,
  bool narrow, const std::uint8_t* data, std::size_t bytes)
{
  Block block(edge, narrow);
  Symbols symbols(stateOf, data, bytes);
  block.Read(limit, symbols);
  symbols.MustBeAtEnd();
  return block.All();
}

} // namespace banyan::scalar
