// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_BoundVerifier_h
#define banyan_Series_Encode_BoundVerifier_h

#include "Codec/BlockEncoder.h"
#include "Series/Decode/LatticeDecoder.h"
#include "Series/Encode/FieldGroup.h"
#include "Series/Encode/InvisibleBlocks.h"
#include "Series/Encode/WholeBlockVerifier.h"
#include "Series/Format/Exceptions.h"
#include "Series/Quantize/FillValues.h"

#include <map>
#include <vector>

namespace banyan
{

/// Compares a block of a decoded plane with the original values: one use per block.
template <class T>
class BoundVerifier
{
public:
  /// @param values of the step, as FieldGroup has them
  /// @param stride of values along the codec's axes, and @param last sample of the finest plane
  /// @param invisible null: every value counts
  /// @param hidden of the step, as FieldGroup has them; may be null
  BoundVerifier(const FieldGroup& field, const group::FieldHead& head,
    const LatticeDecoder<T>& decoder, const FillSet<T>& fills, const InvisibleBlocks<T>* invisible,
    const glm::i64vec3& stride, const glm::ivec3& last, const T* values,
    const std::uint8_t* hidden);

  /// See FieldQuantizer::Verify.
  void Block(const PlaneNumbers& decoded, int plane, std::int64_t block, ExceptionList<T>& list,
    FieldErrors& errors, std::vector<double>* squares);

private:
  /// One row of the block along the codec's first axis.
  struct Row
  {
    glm::ivec3 Sample{ 0 }; ///< of the plane: the first one
    std::int64_t At = 0;    ///< of the finest plane's sample (0, y, z) among the values
    int Count = 0;
    const T* Values = nullptr; ///< its originals one after the other; null: take them by Columns
  };

  void LoadBlock(int plane, int edge, const glm::ivec3& low, const glm::ivec3& n);
  void LoadRow(const PlaneNumbers& decoded, const Row& row);
  bool AllWithin(int count, FieldErrors& errors);
  bool Needs(const Row& row, std::size_t x) const;
  bool IsHidden(const Row& row, std::size_t x) const;
  void AddSquares(const Row& row, std::vector<double>& squares) const;
  void EachSample(const Row& row, int plane, const glm::ivec3& low, int edge,
    ExceptionList<T>& list, FieldErrors& errors);
  bool Within(T original, T decoded, double& error, double& transformed) const;
  bool BothInvisible(const glm::ivec3& sample, T original, T decoded);
  bool MayStay(const glm::ivec3& sample, T original, T decoded, FieldErrors& errors);

  const FieldGroup& Field;
  const group::FieldHead& Head;
  const LatticeDecoder<T>& Decoder;
  const FillSet<T>& Fills;
  const InvisibleBlocks<T>* Invisible;
  glm::i64vec3 Stride;
  glm::ivec3 Last;
  const T* Values;
  const std::uint8_t* Hidden; ///< by tuple; may be null
  bool Plain;                 ///< rows may be taken as a whole
  WholeBlockVerifier<T> Whole;

  /// The offsets of the block's samples along a row, among the values, and among tuples of them.
  std::vector<std::int64_t> Columns, Tuples;
  std::vector<T> Tile;                               ///< originals of a block of the finest plane
  std::vector<T> Originals, Decoded;                 ///< of a row
  std::vector<double> OriginalImages, DecodedImages; ///< transformed
  std::map<std::int64_t, int> Intervals;             ///< of blocks that were looked at before
};

} // namespace banyan

#endif
