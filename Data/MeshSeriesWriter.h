// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_MeshSeriesWriter_h
#define banyan_Data_MeshSeriesWriter_h

#include <memory>
#include <string>
#include <vector>

namespace banyan
{

class OctreeMesh;

/// A single-precision vector at each node of a mesh.
struct NodeArray
{
  std::string Name;
  const std::vector<float>* Values; ///< `[node][3]`
};

/// Writes a time series on a mesh that does not change.
class MeshSeriesWriter
{
public:
  virtual ~MeshSeriesWriter() = default;
  /// The same arrays each time. Throws Error when the disk is full and the like.
  virtual void AddStep(double time, const std::vector<NodeArray>& arrays) = 0;
  /// What has been written gets its name. A writer that is destroyed before leaves no half file.
  virtual void Finish() = 0;
};

/// Writes `NAME.exo`: one file of Exodus II, the format of Sandia's finite-element codes, with the
/// mesh once and the nodal variables of all steps (netCDF, 64-bit offsets). ParaView opens it with
/// time values; x, y and z of a vector become one array there.
///
/// An array must not be called dis...: ParaView's reader would move the nodes by it.
/// @param folder is made when it does not exist
std::unique_ptr<MeshSeriesWriter> MakeExodusWriter(
  const std::string& folder, const std::string& name, const OctreeMesh& mesh);

/// Writes `NAME_0000.vtu`, ..., and in the end `NAME.vtu.series`, which ParaView opens as one
/// series with its time values. Each file has the whole mesh again. Values are inline base64, never
/// appended: some XML parsers that VTK is built with lose appended data.
/// @param voxels cells are VTK_VOXEL, not VTK_HEXAHEDRON
std::unique_ptr<MeshSeriesWriter> MakeVtuWriter(
  const std::string& folder, const std::string& name, const OctreeMesh& mesh, bool voxels);

/// The nodes of a cell in the order of VTK_HEXAHEDRON and of Exodus' HEX8, from that of VTK_VOXEL.
constexpr int HexahedronOrder[8] = { 0, 1, 3, 2, 4, 5, 7, 6 };

} // namespace banyan

#endif
