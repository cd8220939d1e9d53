// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/WholeBlockVerifier.h"

#include "Base/ForEachScalarType.h"
#include "Series/Quantize/GatherTile.h"
#include "Series/Quantize/QuantizeRows.h"
#include "Series/Quantize/TransposedRows.h"

#include <algorithm>
#include <type_traits>

namespace banyan
{

namespace
{

/// A block's numbers with its rows in the order in which values lie in memory.
/// @param tile receives them, where they have to be transposed for that
/// @return rows with numbers alone
template <class T, class Number>
QuantizedRows<T, const Number> NumbersInOrder(const PlaneNumbers& decoded, const MemoryOrder& order,
  const glm::ivec3& low, const glm::ivec3& n, std::vector<Number>& tile)
{
  const int edge = decoded.Edge;
  const auto [u, v, w] = order.Axes;
  const Number* const numbers = decoded.Data<Number>();
  const glm::i64vec3 gaps{ 1, decoded.Padded.x,
    std::int64_t{ decoded.Padded.x } * decoded.Padded.y };
  QuantizedRows<T, const Number> rows;
  rows.Count = n[u];
  rows.Rows = n[v];
  rows.Slices = n[w];
  if (u == 0)
  {
    rows.Numbers = numbers + decoded.IndexOf(low);
    rows.NumberRow = gaps[v];
    rows.NumberSlice = gaps[w];
    return rows;
  }
  tile.resize(static_cast<std::size_t>(edge) * edge * edge);
  const int third = 3 - u;
  for (int i = 0; i < n[third]; ++i)
  {
    glm::ivec3 slice(0);
    slice[third] = i;
    CopyTransposed<Number>(numbers + decoded.IndexOf(low + slice), gaps[u], n[u], n.x,
      tile.data() + order.PlaceOf(edge, slice), order.PlaceOf(edge, { 1, 0, 0 }));
  }
  rows.Numbers = tile.data();
  rows.NumberRow = edge;
  rows.NumberSlice = edge * edge;
  return rows;
}

} // namespace

template <class T>
template <class Number>
bool WholeBlockVerifier<T>::VerifyAs(const PlaneNumbers& decoded, const glm::ivec3& low,
  const glm::ivec3& n, FieldErrors& errors) const
{
  if constexpr (std::is_floating_point_v<T>)
  {
    const MemoryOrder order(this->Stride);
    const auto [u, v, w] = order.Axes;
    thread_local std::vector<Number> tile;
    QuantizedRows<T, const Number> rows = NumbersInOrder<T>(decoded, order, low, n, tile);
    rows.Values =
      this->Values + low.x * this->Stride.x + low.y * this->Stride.y + low.z * this->Stride.z;
    rows.Gap = this->Stride[u];
    rows.ValueRow = this->Stride[v];
    rows.ValueSlice = this->Stride[w];
    const LatticeScale scale{ this->Head.Origin, this->Head.Step };
    const glm::i64vec3 next = decoded.BlockBefore(low / decoded.Edge) * decoded.Edge - low;
    rows.Next = next.x * this->Stride.x + next.y * this->Stride.y + next.z * this->Stride.z;
    RowErrors sums;
    if (!ErrorsOnLattice(rows, scale, this->Bound, sums))
    {
      return false;
    }
    // Decoded values grow with their numbers.
    errors.Range.Include({ static_cast<double>(this->Decoder.ValueOf(sums.Low)),
      static_cast<double>(this->Decoder.ValueOf(sums.High)) });
    const double greatest = *std::max_element(std::begin(sums.Greatest), std::end(sums.Greatest));
    errors.Maximum = std::max(errors.Maximum, greatest);
    errors.MaximumTransformed = std::max(errors.MaximumTransformed, greatest);
    for (const double squares : sums.Squares)
    {
      errors.SumSquared += squares;
    }
    errors.Finite += std::int64_t{ n.x } * n.y * n.z;
    return true;
  }
  else
  {
    return false;
  }
}

/// Row by row in the order in which values lie in memory.
template <class T>
bool WholeBlockVerifier<T>::Verify(const PlaneNumbers& decoded, const glm::ivec3& low,
  const glm::ivec3& n, FieldErrors& errors) const
{
  bool whole = false;
  decoded.With(
    [&](const auto* numbers)
    {
      using Number = std::remove_const_t<std::remove_pointer_t<decltype(numbers)>>;
      whole = this->VerifyAs<Number>(decoded, low, n, errors);
    });
  return whole;
}

#define BANYAN_INSTANTIATE(T) template class WholeBlockVerifier<T>
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
