// SPDX-License-Identifier: BSD-3-Clause
#include "ImageSeriesWriter.h"
#include "MeshSeriesWriter.h"
#include "OctreeMesh.h"

#include "Base/Error.h"
#include "Series/Format/AtomicFile.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>

namespace banyan
{

namespace
{

/// Shortest text that reads back as the same number.
std::string Exact(double value)
{
  return nlohmann::json(value).dump();
}

class VtuWriter : public MeshSeriesWriter
{
public:
  VtuWriter(const std::string& folder, const std::string& name, const OctreeMesh& mesh, bool voxels)
    : Folder(folder)
    , Name(name)
    , Mesh(mesh)
    , Voxels(voxels)
  {
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (!std::filesystem::is_directory(folder))
    {
      throw Error("The output folder could not be made.", { folder, {}, {}, {} });
    }
  }

  void AddStep(double time, const std::vector<NodeArray>& arrays) override
  {
    AtomicFile file((this->Folder / this->FileName(this->Times.size())).string());
    const std::size_t nodes = this->Mesh.NodeCount(), cells = this->Mesh.CellCount();
    Text(file, "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
               "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n"
               "    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" "
               "NumberOfTuples=\"1\" format=\"ascii\">" +
                 Exact(time) + "</DataArray>\n    </FieldData>\n    <Piece NumberOfPoints=\"" +
                 std::to_string(nodes) + "\" NumberOfCells=\"" + std::to_string(cells) +
                 "\">\n      <PointData Vectors=\"" + arrays.at(0).Name + "\">\n");
    for (const NodeArray& array : arrays)
    {
      Array<float>(file, "Float32", array.Name, 3, 3 * nodes,
        [&](std::size_t i) { return (*array.Values)[i]; });
    }
    Text(file, "      </PointData>\n      <Points>\n");
    Array<float>(file, "Float32", "Points", 3, 3 * nodes,
      [this](std::size_t i) { return static_cast<float>(this->Mesh.Point(i / 3)[i % 3]); });
    Text(file, "      </Points>\n      <Cells>\n");
    Array<std::int64_t>(file, "Int64", "connectivity", 1, 8 * cells,
      [this](std::size_t i)
      {
        const int corner = static_cast<int>(i % 8);
        return this->Mesh.Corners(i / 8)[this->Voxels ? corner : HexahedronOrder[corner]];
      });
    Array<std::int64_t>(file, "Int64", "offsets", 1, cells,
      [](std::size_t i) { return static_cast<std::int64_t>(8 * (i + 1)); });
    const std::uint8_t type = this->Voxels ? 11 : 12; // VTK_VOXEL, VTK_HEXAHEDRON
    Array<std::uint8_t>(file, "UInt8", "types", 1, cells, [type](std::size_t) { return type; });
    Text(file, "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n");
    file.Commit();
    this->Times.push_back(time);
  }

  void Finish() override
  {
    nlohmann::ordered_json files = nlohmann::ordered_json::array();
    for (std::size_t step = 0; step < this->Times.size(); ++step)
    {
      files.push_back({ { "name", this->FileName(step) }, { "time", this->Times[step] } });
    }
    const nlohmann::ordered_json series = { { "file-series-version", "1.0" }, { "files", files } };
    WriteFileAtomically(
      (this->Folder / (this->Name + ".vtu.series")).string(), series.dump(2) + "\n");
  }

private:
  std::string FileName(std::size_t step) const
  {
    char number[32];
    std::snprintf(number, sizeof number, "%04zu", step);
    return this->Name + "_" + number + ".vtu";
  }

  static void Text(AtomicFile& file, const std::string& text)
  {
    file.Append(text.data(), text.size());
  }

  /// An array of `count` numbers, made and written piece by piece: the number of its bytes and the
  /// bytes themselves are one run of base64.
  template <typename Number, typename ValueAt>
  static void Array(AtomicFile& file, const std::string& type, const std::string& name,
    int components, std::size_t count, const ValueAt& valueAt)
  {
    Text(file, "        <DataArray type=\"" + type + "\" Name=\"" + name +
                 "\" NumberOfComponents=\"" + std::to_string(components) +
                 "\" format=\"binary\">\n");
    // Base64 takes three bytes at a time; only the end is padded.
    constexpr std::size_t Piece = 3u << 18;
    std::vector<unsigned char> bytes;
    bytes.reserve(Piece + 16);
    const auto append = [&](const auto& value)
    {
      const std::size_t size = bytes.size();
      bytes.resize(size + sizeof value);
      std::memcpy(bytes.data() + size, &value, sizeof value);
    };
    append(static_cast<std::uint64_t>(count * sizeof(Number)));
    for (std::size_t i = 0; i < count; ++i)
    {
      append(static_cast<Number>(valueAt(i)));
      if (bytes.size() >= Piece)
      {
        Text(file, EncodeBase64(bytes.data(), Piece));
        bytes.erase(bytes.begin(), bytes.begin() + Piece);
      }
    }
    Text(file, EncodeBase64(bytes.data(), bytes.size()) + "\n        </DataArray>\n");
  }

  std::filesystem::path Folder;
  std::string Name;
  const OctreeMesh& Mesh;
  bool Voxels;
  std::vector<double> Times;
};

} // namespace

std::unique_ptr<MeshSeriesWriter> MakeVtuWriter(
  const std::string& folder, const std::string& name, const OctreeMesh& mesh, bool voxels)
{
  return std::make_unique<VtuWriter>(folder, name, mesh, voxels);
}

} // namespace banyan
