// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_GroupFormat_h
#define banyan_Series_Format_GroupFormat_h

#include "Base/Bytes.h"
#include "Codec/Tans.h"
#include "Series/Grid/Grid.h"

#include <array>
#include <cstdint>
#include <vector>

/// The sections of a segment: see Documentation/format.md, "A segment".
namespace banyan::group
{

constexpr std::size_t EntryBytes = 24;
constexpr int GreatestPlanes = 16;
constexpr int ContentBits = 48;

/// An entry of the directory: where a section lies.
struct Section
{
  std::uint64_t Offset = 0;
  std::uint32_t StoredBytes = 0; ///< one zstd frame
  std::uint32_t RawBytes = 0;
  std::uint64_t Hash = 0; ///< XXH3-64 of the stored bytes
};

/// Holds what all steps of a component share in a segment.
struct FieldHead
{
  /// Real axis (0 to 2) of each axis of the codec; predictions run along the last one last.
  std::array<std::uint8_t, 3> Axes{ 0, 1, 2 };
  bool Exact = false; ///< no lattice: every sample is an exception
  bool Open = false;  ///< refers to the last step of the segment before, on the same lattice
  /// All steps are what the last step of the segment before is, and nothing of them is stored here.
  bool Static = false;
  double Origin = 0;
  double Step = 1;
  std::int32_t Bin = 31;
  std::int32_t Least = 0, Greatest = 0;
  /// The tables of the finest plane, and of all coarser ones.
  std::vector<tans::Frequencies> Frequencies[2];
};

/// Whether lattice numbers of both mean the same, in the same order of axes.
bool SameLattice(const FieldHead& a, const FieldHead& b);

Bytes PackHead(const FieldHead& head);
/// Whether a packed head says so; nothing else of it is looked at.
bool IsStatic(const Bytes& head);
/// Throws Error when a field is out of range.
FieldHead UnpackHead(const std::uint8_t* data, std::size_t bytes);

/// Where bytes lie in the segment file.
struct Place
{
  std::uint64_t Offset = 0;
  std::uint32_t Bytes = 0; ///< 0: nowhere
};

/// A block of a plane.
struct BlockEntry
{
  std::uint8_t Mode = 0;
  bool Uniform = false;
  bool Same = false;      ///< as in reference A
  std::int32_t Value = 0; ///< of a uniform block
  Place Payload;          ///< none: all residuals are zero
  Place Exceptions;
};

/// Holds what is known of a brick without decoding it.
struct NodeEntry
{
  bool HasNonFinite = false;
  bool NothingFinite = false;
  bool Uniform = false;
  bool Explicit = false; ///< LowValue and HighValue hold, not Low and High
  /// How many steps ago (in time) the brick last changed; at most the step's place in its group.
  std::uint32_t Age = 0;
  std::int32_t Low = 0, High = 0; ///< extremes, in lattice numbers
  double LowValue = 0, HighValue = 0;
  /// Hash of the decoded samples, ContentBits of it, by which bricks of different segments are
  /// known to be the same; only some bricks of the first and of the last step have it. 0: none.
  std::uint64_t Content = 0;
};

/// All of one component at one step.
struct StepTable
{
  std::uint64_t FirstPayload = 0; ///< where its payloads begin
  std::vector<std::vector<BlockEntry>> Planes;
  std::vector<std::int32_t> Top; ///< lattice numbers of the coarsest plane, x fastest
  std::vector<std::vector<NodeEntry>> Levels;

  std::uint64_t MemoryBytes() const;
};

/// Samples per axis of each plane of a field, in the order of the codec's axes: each keeps every
/// fourth sample of the one before, until no axis has more than 2; at least two planes. The last
/// one is not cut into blocks.
std::vector<glm::ivec3> PlanesOf(glm::ivec3 samples);

/// Describes the tables of a component, the same in all steps.
struct TableShape
{
  std::vector<glm::ivec3> Planes; ///< samples; see PlanesOf
  std::vector<glm::ivec3> Blocks; ///< of all planes but the last, in the codec's order of axes
  std::vector<glm::ivec3> Bricks; ///< of each level, in the data's order of axes
};

TableShape ShapeOf(
  const glm::ivec3& samples, const std::array<std::uint8_t, 3>& axes, int brickCells, int levels);

/// The table that another one is coded relative to.
struct TableReference
{
  int Step = -1;                    ///< of the segment
  const StepTable* Table = nullptr; ///< null: there is none
};

/// Keeps the contents of nodes in the first step and in steps without reference only, and none of
/// uniform bricks.
/// @param step of the segment, whose first is 0
Bytes PackStep(
  const StepTable& table, const TableShape& shape, int step, const TableReference& reference);

/// The same step, shape and reference as when it was packed.
/// @param payloadEnd all places must lie before it
/// Throws Error when anything does not fit.
StepTable UnpackStep(const std::uint8_t* data, std::size_t bytes, const TableShape& shape, int step,
  const TableReference& reference, std::uint64_t payloadEnd);

} // namespace banyan::group

namespace banyan
{

/// Size of the pages that payloads are checked by: 4 KiB, more in large segments so that their
/// hashes stay few.
std::uint64_t PageBytesOf(std::uint64_t payloadEnd);

} // namespace banyan

#endif
