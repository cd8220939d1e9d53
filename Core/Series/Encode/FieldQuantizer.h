// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_FieldQuantizer_h
#define banyan_Series_Encode_FieldQuantizer_h

#include "Codec/BlockEncoder.h"
#include "Series/Decode/LatticeDecoder.h"
#include "Series/Encode/FieldGroup.h"
#include "Series/Encode/InvisibleBlocks.h"
#include "Series/Format/Exceptions.h"
#include "Series/Quantize/FillValues.h"
#include "Series/Quantize/QuantizeRows.h"

#include <array>
#include <memory>
#include <vector>

namespace banyan
{

/// Distances of the values of a component along the axes of the data.
glm::i64vec3 StridesOf(const FieldGroup& field);

/// The axes of a field in the order that predicts best: predictions run along the last axis last,
/// where half of all samples are, so that is the smoothest one. Axes that hardly differ stay in
/// order.
/// @param step values of one step, as FieldGroup has them
template <class T>
std::array<std::uint8_t, 3> SmoothestLast(const FieldGroup& field, const void* step);

/// The way of values to lattice numbers and the comparison on the way back.
template <class T>
class FieldQuantizer
{
public:
  /// Axes are those of the key frame, the last step.
  FieldQuantizer(const FieldGroup& field, const group::FieldHead& head, ThreadPool& pool);

  const std::array<std::uint8_t, 3>& Axes() const { return this->AxisOrder; }
  /// Samples of each plane, axes in that order.
  const std::vector<glm::ivec3>& Planes() const { return this->PlaneSamples; }

  /// Memory for the lattice numbers of a step on all planes.
  std::vector<PlaneNumbers> NewPlanes() const;

  /// The lattice numbers of a step on all planes. Values that the lattice cannot hold get a number
  /// of their neighbourhood; blocks that nobody can see (InvisibleBlocks) get one number.
  /// @param planes as NewPlanes makes them; whatever they hold is replaced
  void Make(std::size_t step, std::vector<PlaneNumbers>& planes) const;

  /// Does the same as Make, but leaves the finest plane out where its values may well wait: its
  /// blocks follow by MakeBlock, so that their values come from memory once for that and to be
  /// compared.
  /// @return whether they have to; if not, all is made
  bool MakeCoarser(std::size_t step, std::vector<PlaneNumbers>& planes) const;
  /// @param plane the finest one, whose numbers of a block are replaced
  void MakeBlock(std::size_t step, std::int64_t block, PlaneNumbers& plane) const;

  /// Decodes the samples of a block and compares them with the originals: within the bound, or both
  /// in one invisible interval where the sample is of an invisible block. Fill values must be the
  /// same bits. Hidden samples are always listed.
  /// @param list receives those that are not within the bound
  /// @param errors of the block; decoded values include exceptions
  /// @param squares if not null, of all voxels: the square of what each decodes to is added
  void Verify(std::size_t step, const PlaneNumbers& decoded, int plane, std::int64_t block,
    ExceptionList<T>& list, FieldErrors& errors, std::vector<double>* squares) const;

private:
  /// Whether values are on the lattice as they are, and all of them may be.
  bool Plain() const;
  LatticeScale Scale() const;
  const T* ValuesAt(std::size_t step) const
  {
    return static_cast<const T*>(this->Field.Steps[step]);
  }
  std::int64_t OffsetOf(const glm::ivec3& sample) const
  {
    return sample.x * this->Stride.x + sample.y * this->Stride.y + sample.z * this->Stride.z;
  }
  template <class Number>
  void FillTile(
    std::size_t step, const glm::ivec3& low, const glm::ivec3& next, PlaneNumbers& plane) const;
  template <class Number>
  bool FillTileFast(const T* values, const glm::ivec3& low, const glm::ivec3& next,
    const glm::ivec3& n, PlaneNumbers& plane) const;
  template <class Number>
  bool FillCoarser(const T* values, PlaneNumbers& coarse) const;
  template <class Number>
  void FillRow(const T* values, const std::uint8_t* hidden, int count, Number* numbers) const;
  template <class Number>
  void HideBlocks(const T* values, PlaneNumbers& plane) const;

  const FieldGroup& Field;
  const group::FieldHead& Head;
  ThreadPool& Pool;
  std::array<std::uint8_t, 3> AxisOrder;
  std::vector<glm::ivec3> PlaneSamples;
  glm::i64vec3 Stride; ///< of values, along the axes in order
  LatticeDecoder<T> Decoder;
  FillSet<T> Fills;
  std::unique_ptr<InvisibleBlocks<T>> Hidden; ///< null: every value counts
  double Nearest, Furthest; ///< transformed values outside are not put on the lattice
};

} // namespace banyan

#endif
