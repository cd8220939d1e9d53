// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/BoundVerifier.h"

#include "Base/ForEachScalarType.h"
#include "Series/Quantize/GatherTile.h"
#include "Series/Quantize/ValueArithmetic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace banyan
{
namespace
{

/// Sums and extremes are taken over every eighth sample, so that they need not wait for each other.
constexpr int Lanes = 8;

int RoundUp(int count)
{
  return (count + Lanes - 1) / Lanes * Lanes;
}

/// |a - b| of two rows of a multiple of `Lanes` values: greatest, and sum of squares.
struct RowDifference
{
  bool Within = false;
  double Greatest = 0;
  double SumSquared = 0;
};

// Compiled for newer processors, too; no operation is fused, so that results are the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
  !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BANYAN_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define BANYAN_CLONES
#endif

template <class V>
BANYAN_CLONES RowDifference DifferenceOfRows(const V* a, const V* b, int count, double bound)
{
  std::array<double, Lanes> greatest{}, squares{};
  std::array<int, Lanes> beyond{};
  for (int x = 0; x < count; x += Lanes)
  {
    for (int l = 0; l < Lanes; ++l)
    {
      const auto i = static_cast<std::size_t>(l);
      const double difference = Difference(a[x + l], b[x + l]);
      beyond[i] |= difference <= bound ? 0 : 1; // NaN is beyond, too
      greatest[i] = greatest[i] < difference ? difference : greatest[i];
      squares[i] += difference * difference;
    }
  }
  RowDifference row;
  row.Within = true;
  for (std::size_t i = 0; i < Lanes; ++i)
  {
    row.Within = row.Within && beyond[i] == 0;
    row.Greatest = std::max(row.Greatest, greatest[i]);
    row.SumSquared += squares[i];
  }
  return row;
}

template <class T>
ValueRange RangeOfRow(const T* values, int count)
{
  std::array<T, Lanes> low, high;
  low.fill(values[0]);
  high.fill(values[0]);
  for (int x = 0; x < count; x += Lanes)
  {
    for (int l = 0; l < Lanes; ++l)
    {
      const auto i = static_cast<std::size_t>(l);
      low[i] = values[x + l] < low[i] ? values[x + l] : low[i];
      high[i] = high[i] < values[x + l] ? values[x + l] : high[i];
    }
  }
  return { DoubleNotAbove(*std::min_element(low.begin(), low.end())),
    DoubleNotBelow(*std::max_element(high.begin(), high.end())) };
}

} // namespace

template <class T>
BoundVerifier<T>::BoundVerifier(const FieldGroup& field, const group::FieldHead& head,
  const LatticeDecoder<T>& decoder, const FillSet<T>& fills, const InvisibleBlocks<T>* invisible,
  const glm::i64vec3& stride, const glm::ivec3& last, const T* values, const std::uint8_t* hidden)
  : Field(field)
  , Head(head)
  , Decoder(decoder)
  , Fills(fills)
  , Invisible(invisible)
  , Stride(stride)
  , Last(last)
  , Values(values)
  , Hidden(hidden)
  , Plain(!head.Exact && field.Bound > 0 && fills.Empty() && !field.Opacity && hidden == nullptr)
  , Whole(head, decoder, field.Bound, stride, values)
{
}

/// Decodes a row and collects its originals; behind its end both repeat one pair of equal values.
template <class T>
void BoundVerifier<T>::LoadRow(const PlaneNumbers& decoded, const Row& row)
{
  const std::size_t count = static_cast<std::size_t>(row.Count);
  decoded.With([&](const auto* numbers)
    { this->Decoder.Decode(numbers + decoded.IndexOf(row.Sample), count, this->Decoded.data()); });
  if (row.Values != nullptr)
  {
    std::copy(row.Values, row.Values + count, this->Originals.begin());
  }
  else
  {
    const T* from = this->Values + row.At;
    for (std::size_t x = 0; x < count; ++x)
    {
      this->Originals[x] = from[this->Columns[x]];
    }
  }
  const std::size_t end = static_cast<std::size_t>(RoundUp(row.Count));
  std::fill(this->Decoded.begin() + row.Count, this->Decoded.begin() + end, this->Decoded[0]);
  std::fill(this->Originals.begin() + row.Count, this->Originals.begin() + end, this->Decoded[0]);
}

/// Whether a whole row is within the bound, all its values being ordinary ones; adds to `errors` if
/// so.
template <class T>
bool BoundVerifier<T>::AllWithin(int count, FieldErrors& errors)
{
  const int whole = RoundUp(count);
  const bool mapped = !this->Field.Map.IsIdentity();
  // The decoded values are finite: what differs from them by a finite amount is so too.
  const RowDifference row = DifferenceOfRows(this->Originals.data(), this->Decoded.data(), whole,
    mapped ? std::numeric_limits<double>::max() : this->Field.Bound);
  if (!row.Within)
  {
    return false;
  }
  double transformed = row.Greatest;
  if (mapped)
  {
    const std::size_t n = static_cast<std::size_t>(whole);
    this->Field.Map.ForwardValues(this->Originals.data(), n, this->OriginalImages.data());
    this->Field.Map.ForwardValues(this->Decoded.data(), n, this->DecodedImages.data());
    const RowDifference images = DifferenceOfRows(
      this->OriginalImages.data(), this->DecodedImages.data(), whole, this->Field.Bound);
    if (!images.Within)
    {
      return false;
    }
    transformed = images.Greatest;
  }
  errors.Maximum = std::max(errors.Maximum, row.Greatest);
  errors.MaximumTransformed = std::max(errors.MaximumTransformed, transformed);
  errors.SumSquared += row.SumSquared;
  errors.Range.Include(RangeOfRow(this->Decoded.data(), whole));
  errors.Finite += count;
  return true;
}

template <class T>
bool BoundVerifier<T>::Within(T original, T decoded, double& error, double& transformed) const
{
  if (this->Head.Exact || this->Field.Bound == 0)
  {
    error = 0;
    transformed = 0;
    return std::memcmp(&original, &decoded, sizeof(T)) == 0;
  }
  error = Difference(original, decoded);
  transformed = error;
  if (!this->Field.Map.IsIdentity())
  {
    transformed = std::abs(this->Field.Map.Forward(static_cast<double>(original)) -
                           this->Field.Map.Forward(static_cast<double>(decoded)));
  }
  return transformed <= this->Field.Bound;
}

/// @param sample of the finest plane
template <class T>
bool BoundVerifier<T>::BothInvisible(const glm::ivec3& sample, T original, T decoded)
{
  if (!this->Invisible)
  {
    return false;
  }
  const glm::ivec3 block = sample / this->Field.BrickCells;
  const std::int64_t key =
    (std::int64_t{ block.z } << 42) | (std::int64_t{ block.y } << 21) | block.x;
  auto found = this->Intervals.find(key);
  if (found == this->Intervals.end())
  {
    found = this->Intervals.emplace(key, this->Invisible->IntervalOf(this->Values, block)).first;
  }
  return found->second >= 0 && this->Invisible->Holds(found->second, original) &&
         this->Invisible->Holds(found->second, decoded);
}

/// Whether a sample may decode to that; adds to `errors` if so.
template <class T>
bool BoundVerifier<T>::MayStay(const glm::ivec3& sample, T original, T decoded, FieldErrors& errors)
{
  if (!std::isfinite(static_cast<double>(original)))
  {
    return false;
  }
  if (this->Fills.Holds(original))
  {
    ++errors.Fill;
    return std::memcmp(&original, &decoded, sizeof(T)) == 0;
  }
  double error = 0;
  double transformed = 0;
  if (this->Within(original, decoded, error, transformed))
  {
    errors.Maximum = std::max(errors.Maximum, error);
    errors.MaximumTransformed = std::max(errors.MaximumTransformed, transformed);
  }
  else if (this->BothInvisible(sample, original, decoded))
  {
    error = Difference(original, decoded);
    ++errors.Invisible;
  }
  else
  {
    return false;
  }
  errors.SumSquared += error * error;
  if (this->Field.Opacity && error > 0)
  {
    errors.SumWeighted += (*this->Field.Opacity)(static_cast<double>(original)) * error * error;
  }
  return true;
}

/// Whether a sample of a row has to be within the bound.
template <class T>
bool BoundVerifier<T>::Needs(const Row& row, std::size_t x) const
{
  return !this->Field.Needed ||
         this->Field.Needed[row.At / this->Field.Components + this->Tuples[x]] != 0;
}

/// Whether a sample of a row is hidden.
template <class T>
bool BoundVerifier<T>::IsHidden(const Row& row, std::size_t x) const
{
  return this->Hidden != nullptr &&
         this->Hidden[row.At / this->Field.Components + this->Tuples[x]] != 0;
}

/// Sample by sample; `Decoded` becomes what decoding gives with the exceptions.
template <class T>
void BoundVerifier<T>::EachSample(const Row& row, int plane, const glm::ivec3& low, int edge,
  ExceptionList<T>& list, FieldErrors& errors)
{
  const glm::ivec3 place = row.Sample - low;
  const std::uint32_t first = static_cast<std::uint32_t>((place.z * edge + place.y) * edge);
  const int shift = 2 * plane;
  const int y = std::min(row.Sample.y << shift, this->Last.y);
  const int z = std::min(row.Sample.z << shift, this->Last.z);
  for (int x = 0; x < row.Count; ++x)
  {
    const T original = this->Originals[static_cast<std::size_t>(x)];
    T& decoded = this->Decoded[static_cast<std::size_t>(x)];
    const int column = std::min((row.Sample.x + x) << shift, this->Last.x);
    if (!this->Needs(row, static_cast<std::size_t>(x)))
    {
      continue;
    }
    const bool hidden = this->IsHidden(row, static_cast<std::size_t>(x));
    if (hidden || !this->MayStay({ column, y, z }, original, decoded, errors))
    {
      ++errors.Exceptions;
      list.Positions.push_back(first + static_cast<std::uint32_t>(x));
      list.Values.push_back(original);
      decoded = original;
    }
    if (!hidden && std::isfinite(static_cast<double>(original)))
    {
      errors.Range.Include({ DoubleNotAbove(decoded), DoubleNotBelow(decoded) });
      ++errors.Finite;
    }
    else
    {
      ++errors.NonFinite;
    }
  }
}

/// Makes room for rows of a block, and gathers its values if it is one of the finest plane.
template <class T>
void BoundVerifier<T>::LoadBlock(int plane, int edge, const glm::ivec3& low, const glm::ivec3& n)
{
  const std::size_t room = static_cast<std::size_t>(RoundUp(edge));
  this->Columns.resize(room);
  this->Originals.resize(room);
  this->Decoded.resize(room);
  this->OriginalImages.resize(room);
  this->DecodedImages.resize(room);
  this->Tuples.resize(room);
  for (int x = 0; x < n.x; ++x)
  {
    const std::size_t i = static_cast<std::size_t>(x);
    this->Columns[i] = std::min((low.x + x) << (2 * plane), this->Last.x) * this->Stride.x;
    this->Tuples[i] = this->Columns[i] / this->Field.Components;
  }
  if (plane == 0)
  {
    this->Tile.resize(static_cast<std::size_t>(edge) * edge * edge);
    GatherTile(
      this->Values + low.x * this->Stride.x + low.y * this->Stride.y + low.z * this->Stride.z,
      this->Stride, n, glm::i64vec3{ 1, edge, edge * edge }, this->Tile.data());
  }
}

/// Adds the squares of a row's decoded values to those of their tuples.
template <class T>
void BoundVerifier<T>::AddSquares(const Row& row, std::vector<double>& squares) const
{
  const std::int64_t tuple = row.At / this->Field.Components;
  for (int x = 0; x < row.Count; ++x)
  {
    // A vector with a fill value, or a hidden one, has no length.
    const std::size_t i = static_cast<std::size_t>(x);
    const double value =
      this->Fills.Holds(this->Originals[i]) || !this->Needs(row, i) || this->IsHidden(row, i)
        ? std::numeric_limits<double>::quiet_NaN()
        : static_cast<double>(this->Decoded[i]);
    squares[static_cast<std::size_t>(tuple + this->Tuples[i])] += value * value;
  }
}

template <class T>
void BoundVerifier<T>::Block(const PlaneNumbers& decoded, int plane, std::int64_t block,
  ExceptionList<T>& list, FieldErrors& errors, std::vector<double>* squares)
{
  const int edge = decoded.Edge;
  const glm::ivec3 position = { static_cast<int>(block % decoded.Blocks.x),
    static_cast<int>(block / decoded.Blocks.x % decoded.Blocks.y),
    static_cast<int>(block / decoded.Blocks.x / decoded.Blocks.y) };
  const glm::ivec3 low = position * edge;
  const glm::ivec3 high = glm::min(low + edge, decoded.Samples);
  if (plane == 0 && this->Plain && !this->Field.Needed && this->Field.Map.IsIdentity() &&
      squares == nullptr && this->Whole.Verify(decoded, low, high - low, errors))
  {
    return;
  }
  this->LoadBlock(plane, edge, low, high - low);
  const int shift = 2 * plane;
  Row row;
  row.Count = high.x - low.x;
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      row.Sample = { low.x, y, z };
      row.At = std::min(y << shift, this->Last.y) * this->Stride.y +
               std::min(z << shift, this->Last.z) * this->Stride.z;
      row.Values =
        plane == 0 ? this->Tile.data() + ((z - low.z) * edge + (y - low.y)) * edge : nullptr;
      this->LoadRow(decoded, row);
      if (!this->Plain || this->Field.Needed || !this->AllWithin(row.Count, errors))
      {
        this->EachSample(row, plane, low, edge, list, errors);
      }
      if (squares != nullptr)
      {
        this->AddSquares(row, *squares);
      }
    }
  }
}

#define BANYAN_INSTANTIATE(T) template class BoundVerifier<T>
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
