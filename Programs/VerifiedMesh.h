// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_VerifiedMesh_h
#define banyan_Programs_VerifiedMesh_h

#include "SourceSteps.h"

#include "Base/Bytes.h"
#include "Series/Decode/SeriesFile.h"

#include <memory>

namespace banyan
{

struct StoredCells;
struct StoredMesh;

/// The mesh of a series, to be compared with that of a source.
class VerifiedMesh
{
public:
  /// @param series must outlive this. Throws Error.
  explicit VerifiedMesh(const SeriesFile& series);

  /// Points and cells must be the same bits in the same order; throws Error where they are not.
  /// @param array one of the mesh's, with its type and values
  void Compare(int step, const SourceMesh& mesh, int array, ScalarType type,
    const std::vector<std::uint8_t>& values) const;

  /// Throws Error where the source has not all parts of the mesh.
  void CheckParts(int step, const SourceMesh& mesh) const;

  /// Values of one component by point, or by cell, from the image that they are encoded as.
  Bytes ValuesOf(const ArrayIndex& array, const Bytes& image) const;

private:
  Bytes PointsAt(int step) const;

  const SeriesFile& Series;
  std::shared_ptr<const StoredMesh> Octree; ///< or
  std::shared_ptr<const StoredCells> Cells;
};

} // namespace banyan

#endif
