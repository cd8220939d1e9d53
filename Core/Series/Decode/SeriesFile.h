// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Decode_SeriesFile_h
#define banyan_Series_Decode_SeriesFile_h

#include "Base/Hash.h"
#include "Series/Format/SeriesIndex.h"
#include "Series/Grid/ValueMask.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

class CacheContext;

/// Names one field of scalars: a component of an array at a step and level.
struct FieldKey
{
  int Step = 0;
  int Array = 0;
  int Component = 0;
  int Level = 0;
};

/// 128-bit hash of a payload and of what is needed to decode it: equal identities decode to equal
/// values.
struct PayloadIdentity
{
  std::uint64_t Low = 0;
  std::uint64_t High = 0;
  friend bool operator==(const PayloadIdentity& a, const PayloadIdentity& b)
  {
    return a.Low == b.Low && a.High == b.High;
  }
};

/// Holds what the tree knows of a brick without its payload.
struct BrickNode
{
  ValueRange Range;          ///< extremes of the decoded finite samples; empty if there is none
  ValueMask Mask = 0;        ///< over the component's series range; 0 when nothing finite
  bool Uniform = false;      ///< a macro voxel: every sample has the value Range.Low, bit-exact
  bool HasNonFinite = false; ///< some sample is NaN or infinite
  PayloadIdentity Identity;  ///< equal to the step before's: unchanged
  /// In the file; 0 for a macro voxel, for a brick that is the same as another one or as predicted,
  /// and for levels that are part of the next finer one.
  std::uint32_t PayloadBytes = 0;
};

/// An open series. All methods may be called from any thread.
///
/// Opening reads the index, finds the folder (see FindSeriesFolder) and checks that segments exist
/// with their right sizes. Node tables and payloads are read and checked against their checksums
/// when they are needed: what becomes of the files while they are open is an error, or does not
/// matter.
/// Everything that does not fit throws Error: never garbage, never a crash.
class SeriesFile
{
public:
  /// @param path of the index file; where it is a symbolic link, segments may lie beside what it
  /// leads to
  /// @param caches that it uses; null: those of the process
  static std::shared_ptr<SeriesFile> Open(
    const std::string& path, std::shared_ptr<CacheContext> caches = nullptr);
  ~SeriesFile();

  const std::string& Path() const;
  /// Where the segments are: see FindSeriesFolder.
  const std::string& Folder() const;
  const SeriesIndex& Index() const;
  /// The caches that it was opened with.
  const std::shared_ptr<CacheContext>& Caches() const;
  /// A number that no other open series of this process has.
  std::uint64_t Id() const;
  /// A hash of the index, which names all segments by their content: a series that replaces another
  /// one has another fingerprint, and so have files of one name that are not the same.
  Hash128 Fingerprint() const;

  BrickLayout Layout(int level) const;
  /// The range that the masks of a component are made over (the promised range of the
  /// index where there is one, its Range otherwise).
  MaskRange MaskRangeOf(int array, int component) const;

  /// All bricks of a field, in the order of `BrickLayout::IndexOf`. Kept for the most recently used
  /// fields only; hold the pointer as long as it is needed.
  std::shared_ptr<const std::vector<BrickNode>> Nodes(const FieldKey& field) const;

  /// Decodes one brick.
  /// @param values receives `Layout(level).SamplesOf(brick).Count()` values of the array's own
  /// type, `[z][y][x]`, x fastest.
  /// Throws Error when the payload is damaged.
  void DecodeBrick(const FieldKey& field, std::int64_t brick, void* values) const;

  /// Decodes a part of a brick to where the caller wants it.
  /// @param part not empty, inside the brick's samples
  /// @param stride distances in values between neighbours in x, y, z
  /// @param first receives the part's first sample; values of the array's own type
  void DecodePart(const FieldKey& field, std::int64_t brick, const Box& part,
    const glm::i64vec3& stride, void* first) const;

  /// The same of bricks that follow each other along x, which takes less time than one after the
  /// other. A sample that two of them hold comes from the latter.
  /// @param brick the first one, of `count`
  /// @param part not empty, inside their samples; each of them holds some of it that those behind
  /// it do not
  void DecodeRow(const FieldKey& field, std::int64_t brick, int count, const Box& part,
    const glm::i64vec3& stride, void* first) const;

  /// Returns the step of values that are whole multiples of it, each rounded to the array's type.
  /// Some values may be no multiples (exceptions, and all where the lattice does not go through 0).
  /// 0 where none is known.
  double StepOfValues(const FieldKey& field) const;

  /// Checks the checksums of the bricks' payloads without decoding them.
  void VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks) const;

  /// Bytes of tables and payloads read so far, and number of bricks decoded so far.
  std::uint64_t BytesRead() const;
  std::uint64_t BricksDecoded() const;

private:
  SeriesFile();
  struct Internals;
  std::unique_ptr<Internals> Self;
};

} // namespace banyan

#endif
