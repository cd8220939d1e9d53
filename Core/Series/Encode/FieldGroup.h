// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_FieldGroup_h
#define banyan_Series_Encode_FieldGroup_h

#include "Codec/BlockEncoder.h"
#include "Series/Encode/SeriesEncoder.h"
#include "Series/Format/GroupFormat.h"

#include <optional>
#include <vector>

namespace banyan
{

/// Holds what the key frame of a group, its last step, decodes to: the group after it may refer to
/// it.
struct KeyFrame
{
  group::FieldHead Head; ///< the lattice, without tables
  std::vector<PlaneNumbers> Planes;
};

/// Planes of steps that nobody needs any more. New memory takes time, much more than its use.
using SparePlanes = std::vector<std::vector<PlaneNumbers>>;

/// One component of one array over the steps of a group.
struct FieldGroup
{
  ScalarType Type = ScalarType::Float32;
  std::vector<const void*> Steps; ///< first component of the first tuple
  int Components = 1;             ///< per tuple
  int Component = 0;
  glm::ivec3 Samples{ 1 };
  int BrickCells = 16;
  int Levels = 1;
  Transform Map;
  double Bound = 0;    ///< in the transformed domain
  ValueRange Expected; ///< may be empty
  bool Beyond = false; ///< values may well lie outside of Expected
  std::vector<double> FillValues;
  std::optional<OpacityFunction> Opacity; ///< nothing: every value counts
  /// By sample, x fastest: 0 where any value will do. Null: all are needed.
  const std::uint8_t* Needed = nullptr;
  /// By step: of each sample, x fastest, not 0 where it is hidden: it keeps its bits, and counts as
  /// one that is not finite. Null for a step without such samples; may be empty.
  std::vector<const std::uint8_t*> Hidden;
  const std::uint8_t* HiddenAt(std::size_t step) const
  {
    return this->Hidden.empty() ? nullptr : this->Hidden[step];
  }
  EncodeProfile Profile = EncodeProfile::Balanced;
  AblationSwitches Ablation;
  int CompressionLevel = 3;
  /// The key frame of the group before; null: do not refer to it. Used where its lattice is the
  /// same.
  const KeyFrame* Before = nullptr;
  SparePlanes* Spare = nullptr; ///< if not null, planes are taken from there, and put there
};

/// A block ready to be written.
struct EncodedBlock
{
  std::uint8_t Mode = 0;
  bool Uniform = false;
  bool Same = false;
  std::int32_t Value = 0;
  Bytes Payload;    ///< empty: all residuals are zero
  Bytes Exceptions; ///< empty: none
};

struct EncodedStep
{
  std::vector<std::vector<EncodedBlock>> Planes;
  std::vector<std::int32_t> Top;
  std::vector<std::vector<group::NodeEntry>> Levels;
};

/// Holds what was measured over the voxels of all steps.
struct FieldErrors
{
  ValueRange Range; ///< of the decoded finite values
  double Maximum = 0;
  double SumSquared = 0;
  double MaximumTransformed = 0;
  std::int64_t Finite = 0;
  std::int64_t NonFinite = 0;
  std::int64_t Exceptions = 0; ///< voxels kept beside the lattice, non-finite ones included
  std::int64_t Fill = 0;       ///< voxels with fill values
  std::int64_t Invisible = 0;  ///< out of bound, invisible before and after; not in the maxima
  double SumWeighted = 0;      ///< of opacity times squared error
};

struct EncodedField
{
  group::FieldHead Head;
  std::vector<EncodedStep> Steps;
  FieldErrors Errors;
  std::vector<double> StepRmse; ///< root of the mean squared error of each step
  KeyFrame Last;
  /// Steps that must be decoded for a brick of the finest level: sum over so many bricks of all
  /// steps, and most; see ChainLengths.h.
  std::int64_t ChainSum = 0;
  std::int64_t ChainBricks = 0;
  int ChainMost = 0;
};

} // namespace banyan

#endif
