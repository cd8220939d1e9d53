// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ForEachScalarType.h"
#include "Series/Encode/LatticeCheck.h"
#include "Series/Quantize/GatherTile.h"
#include "Series/Quantize/LatticeRows.h"
#include "Series/Quantize/TransposedRows.h"

#include <algorithm>
#include <type_traits>

namespace banyan
{

template <class T>
template <class Number>
bool LatticeCheck<T>::WholeBlockOf(const PlaneNumbers& decoded, const glm::ivec3& low,
  const glm::ivec3& n, FieldErrors& errors) const
{
  if constexpr (std::is_floating_point_v<T>)
  {
    const int edge = decoded.Edge;
    const MemoryOrder order(this->Stride);
    const auto [u, v, w] = order.Axes;
    const Number* const numbers = decoded.Data<Number>();
    const glm::i64vec3 gaps{ 1, decoded.Padded.x,
      std::int64_t{ decoded.Padded.x } * decoded.Padded.y };
    thread_local std::vector<Number> tile;
    if (u != 0)
    {
      tile.resize(static_cast<std::size_t>(edge) * edge * edge);
      const int third = 3 - u;
      for (int i = 0; i < n[third]; ++i)
      {
        glm::ivec3 slice(0);
        slice[third] = i;
        CopyTransposed<Number>(numbers + decoded.IndexOf(low + slice), gaps[u], n[u], n.x,
          tile.data() + order.PlaceOf(edge, slice), order.PlaceOf(edge, { 1, 0, 0 }));
      }
    }
    const LatticeScale scale{ this->Head.Origin, this->Head.Step };
    LatticeRows<T, const Number> rows;
    rows.Values =
      this->Values + low.x * this->Stride.x + low.y * this->Stride.y + low.z * this->Stride.z;
    rows.Gap = this->Stride[u];
    rows.ValueRow = this->Stride[v];
    rows.ValueSlice = this->Stride[w];
    rows.Numbers = u == 0 ? numbers + decoded.IndexOf(low) : tile.data();
    rows.NumberRow = u == 0 ? gaps[v] : edge;
    rows.NumberSlice = u == 0 ? gaps[w] : edge * edge;
    rows.Count = n[u];
    rows.Rows = n[v];
    rows.Slices = n[w];
    const glm::i64vec3 next = decoded.BlockBefore(low / edge) * edge - low;
    rows.Next = next.x * this->Stride.x + next.y * this->Stride.y + next.z * this->Stride.z;
    RowErrors sums;
    if (!ErrorsOnLattice(rows, scale, this->Field.Bound, sums))
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
bool LatticeCheck<T>::WholeBlock(const PlaneNumbers& decoded, const glm::ivec3& low,
  const glm::ivec3& n, FieldErrors& errors) const
{
  bool whole = false;
  decoded.With(
    [&](const auto* numbers)
    {
      using Number = std::remove_const_t<std::remove_pointer_t<decltype(numbers)>>;
      whole = this->WholeBlockOf<Number>(decoded, low, n, errors);
    });
  return whole;
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template bool LatticeCheck<T>::WholeBlock(                                                       \
    const PlaneNumbers&, const glm::ivec3&, const glm::ivec3&, FieldErrors&) const
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
