// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeshFile_h
#define banyan_Mesh_Series_MeshFile_h

#include "Mesh/Series/StoredMesh.h"
#include "Series/Encode/SeriesEncoder.h"

#include <memory>

namespace banyan
{

class SegmentFolder;
class SeriesFile;

/// Writes the file of a mesh into the folder of its series, and says what encoding must know of it.
/// Throws Error when the file cannot be written.
std::shared_ptr<MeshPlan> WriteMesh(const StoredMesh& mesh, SegmentFolder& folder);

/// The grid of the images that values of a mesh become.
Grid GridOfImages(const StoredMesh& mesh);

/// The mesh of an open series. Throws Error that names the file when it is missing or damaged, or
/// is not what the index says.
std::shared_ptr<const StoredMesh> ReadMesh(const SeriesFile& series);

} // namespace banyan

#endif
