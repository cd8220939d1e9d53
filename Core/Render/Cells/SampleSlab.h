// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_SampleSlab_h
#define banyan_Render_Cells_SampleSlab_h

#include "Render/Raycast/RayTile.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace banyan
{

/// Where a ray crosses the border of a mesh.
struct BorderCrossing
{
  bool Enters = false; ///< whether it comes into the mesh, or leaves it
  float Value = 0.0f;
  float Cosine = 0.0f; ///< set if shaded
};

/// Values of the samples of a tile's rays, over as many intervals as it has rows: what cells are
/// drawn into, in any order along the rays, before it is blended front to back. Its values (256 kB)
/// stay in the second cache.
///
/// Rows without a mark hold no value: blending leaves all of them so.
struct SampleSlab
{
  static constexpr int Rows = 64; ///< one bit of a mark each
  static constexpr int Packets = RayTile::Slots / RayTile::PacketSize;
  static constexpr int Lanes = RayTile::PacketSize;
  static constexpr float Nothing = std::numeric_limits<float>::quiet_NaN();

  /// Where a sample stands in Value, Change and AtBorder.
  static constexpr int IndexOf(int slot, int row)
  {
    return slot / Lanes * (Rows * Lanes) + row * Lanes + slot % Lanes;
  }

  SampleSlab()
  {
    for (float& value : this->Value)
    {
      value = Nothing;
    }
    for (int packet = 0; packet < Packets; ++packet)
    {
      this->Marks[packet] = 0;
      this->Borders[packet] = 0;
    }
  }

  /// How near to a sample, in intervals, the nearest crossing may be so that it counts as before or
  /// behind it as the sample's own cell says, where crossings contradict that: cells hold samples
  /// somewhat outside of themselves, too.
  static constexpr float NearSample = 1.0f / 8;

  /// Takes a crossing of the mesh's border into account.
  /// @param before from the beginning of what is left of the sample's interval to the crossing, in
  /// intervals
  /// @param length of what is left of the interval
  void Cross(int slot, int row, const BorderCrossing& crossing, float before, float length)
  {
    std::uint64_t& borders = this->Borders[slot / Lanes];
    const int first = IndexOf(slot, row) / Lanes * Lanes;
    if ((borders >> row & 1) == 0)
    {
      borders |= std::uint64_t{ 1 } << row;
      for (int lane = 0; lane < Lanes; ++lane)
      {
        this->Change[first + lane] = 0.0f;
        this->AtBorder[first + lane] = 0.0f;
        this->CosineAtBorder[first + lane] = 0.0f;
        this->Crossings[first + lane] = 0.0f;
        this->Before[first + lane] = 0.0f;
        this->Behind[first + lane] = 0.0f;
        this->Nearest[first + lane] = 1.0f; // and none
      }
    }
    const int index = first + slot % Lanes;
    const float fromSample = before - 0.5f * length;
    const float change = (length - before) - (fromSample < 0.0f ? length : 0.0f);
    this->Change[index] += crossing.Enters ? change : -change;
    (fromSample < 0.0f ? this->Before : this->Behind)[index] += crossing.Enters ? 1.0f : -1.0f;
    if (std::abs(fromSample) < std::abs(this->Nearest[index]))
    {
      this->Nearest[index] = fromSample;
      this->NearestEnters[index] = crossing.Enters ? 1.0f : -1.0f;
    }
    this->AtBorder[index] += crossing.Value;
    this->CosineAtBorder[index] += crossing.Cosine;
    this->Crossings[index] += 1.0f;
  }

  /// Nothing where a sample is in no cell.
  alignas(64) float Value[RayTile::Slots * Rows];
  /// Of the angle between gradients and rays; set where there is a value, if shaded.
  alignas(64) float Cosine[RayTile::Slots * Rows];
  // Set where rows have a bit in Borders.
  alignas(64) float Change[RayTile::Slots * Rows];
  alignas(64) float AtBorder[RayTile::Slots * Rows]; ///< sum of the values where it was crossed
  alignas(64) float CosineAtBorder[RayTile::Slots * Rows];
  alignas(64) float Crossings[RayTile::Slots * Rows];
  // Entries less exits, on both sides of the sample.
  alignas(64) float Before[RayTile::Slots * Rows];
  alignas(64) float Behind[RayTile::Slots * Rows];
  /// From the sample to the nearest crossing, in intervals.
  alignas(64) float Nearest[RayTile::Slots * Rows];
  alignas(64) float NearestEnters[RayTile::Slots * Rows]; ///< 1 or -1
  // By packet: a bit for each row.
  alignas(64) std::uint64_t Marks[Packets];   ///< rows that may have values
  alignas(64) std::uint64_t Borders[Packets]; ///< rows in which rays cross the border
};

} // namespace banyan

#endif
