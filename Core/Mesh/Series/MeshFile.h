// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeshFile_h
#define banyan_Mesh_Series_MeshFile_h

#include "Base/Hash.h"
#include "Mesh/Series/StoredMesh.h"
#include "Series/Encode/SeriesEncoder.h"

#include <memory>
#include <string>
#include <vector>

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

/// What files of octrees and of cells of any type have in common.
namespace mesh_file
{

/// Writes the file of a mesh, and says all of it but its counts of points and cells.
/// Throws Error when the file cannot be written.
std::shared_ptr<MeshPlan> WriteFile(const Bytes& bytes, SegmentFolder& folder);

/// Writes a file at its final place.
/// Throws Error when the file cannot be written.
void WriteFile(const Bytes& bytes, const std::string& path);

/// A whole file. Throws Error that names the file when it is missing, or has not the size and hash
/// that the index says.
Bytes ReadFile(const std::string& path, std::uint64_t bytes, const Hash128& hash);

/// By sample of an image, whether a point or a cell has it.
/// @param count of samples
std::shared_ptr<const std::vector<std::uint8_t>> Marked(
  std::size_t count, const std::vector<std::uint32_t>& samples);

} // namespace mesh_file

} // namespace banyan

#endif
