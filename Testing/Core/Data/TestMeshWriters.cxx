// SPDX-License-Identifier: BSD-3-Clause
// What the writers of series on meshes write, read back; and the program with the series
// earthquake.
#include "GenerateFixture.h"
#include "MeshSeriesWriter.h"
#include "WaveMesh.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>
#include <netcdf.h>
#include <nlohmann/json.hpp>

#include <cstring>

using banyan::NodeArray;
using banyan::OctreeMesh;
using banyan::ThreadPool;
using banyan::WaveMesh;

namespace
{

/// Corners of a hexahedron as VTK and Exodus count them.
constexpr int Corner[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

std::vector<float> Values(const OctreeMesh& mesh, int step)
{
  std::vector<float> values(3 * mesh.NodeCount());
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = static_cast<float>(i % 1013) - 0.125f * static_cast<float>(step);
  }
  return values;
}

std::string Decode(const std::string& text)
{
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : text)
  {
    const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char* found = c == '\0' ? nullptr : std::strchr(letters, c);
    if (found == nullptr)
    {
      continue; // the padding
    }
    bits = bits << 6 | static_cast<unsigned>(found - letters);
    count += 6;
    if (count >= 8)
    {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255);
    }
  }
  return bytes;
}

/// The numbers of an array of a .vtu file, as its XML has them.
template <typename Number>
std::vector<Number> ArrayOf(const std::string& file, const std::string& name)
{
  const std::size_t element = file.find("Name=\"" + name + "\"");
  EXPECT_NE(element, std::string::npos) << name;
  const std::size_t begin = file.find(">\n", element) + 2, end = file.find('\n', begin);
  const std::string bytes = Decode(file.substr(begin, end - begin));
  std::uint64_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof length);
  EXPECT_EQ(length, bytes.size() - sizeof length) << name;
  std::vector<Number> numbers(length / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data() + sizeof length, length);
  return numbers;
}

class MeshWriters : public Generate
{
protected:
  OctreeMesh Mesh() const
  {
    ThreadPool pool(2);
    return WaveMesh::Random({ 2, 3, 2 }, 3, pool);
  }

  /// Cell i has its corners in the order of hexahedra.
  static void ExpectHexahedron(const OctreeMesh& mesh, std::size_t cell,
    const std::vector<float>& points, const std::int64_t* corners)
  {
    const auto low = mesh.CornerPoint(mesh.Cell(cell));
    const double edge = mesh.EdgeOfLevel(mesh.Cell(cell).Level);
    for (int corner = 0; corner < 8; ++corner)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        ASSERT_EQ(points.at(3 * static_cast<std::size_t>(corners[corner]) + axis),
          low[axis] + Corner[corner][axis] * edge);
      }
    }
  }
};

} // namespace

TEST_F(MeshWriters, AVtuFileHoldsTheMeshAndItsValues)
{
  const OctreeMesh mesh = this->Mesh();
  const auto folder = this->Folder / "series";
  const auto writer = banyan::MakeVtuWriter(folder.string(), "quake", mesh, false);
  for (int step = 0; step < 2; ++step)
  {
    const auto values = Values(mesh, step);
    writer->AddStep(0.5 * step, { { "velocity", &values } });
  }
  writer->Finish();
  const auto series = nlohmann::json::parse(this->Text("series/quake.vtu.series"));
  ASSERT_EQ(series["files"].size(), 2u);
  EXPECT_EQ(series["files"][1]["time"], 0.5);
  const std::string name = series["files"][1]["name"], file = this->Text("series/" + name);
  EXPECT_EQ(file.find("appended"), std::string::npos);
  EXPECT_NE(
    file.find("NumberOfCells=\"" + std::to_string(mesh.CellCount()) + "\""), std::string::npos);
  EXPECT_TRUE(ArrayOf<float>(file, "velocity") == Values(mesh, 1));
  const auto points = ArrayOf<float>(file, "Points");
  const auto corners = ArrayOf<std::int64_t>(file, "connectivity");
  const auto offsets = ArrayOf<std::int64_t>(file, "offsets");
  ASSERT_EQ(points.size(), 3 * mesh.NodeCount());
  ASSERT_EQ(corners.size(), 8 * mesh.CellCount());
  ASSERT_EQ(offsets.size(), mesh.CellCount());
  EXPECT_EQ(ArrayOf<std::uint8_t>(file, "types"), std::vector<std::uint8_t>(offsets.size(), 12));
  for (std::size_t cell = 0; cell < mesh.CellCount(); ++cell)
  {
    ASSERT_EQ(offsets[cell], static_cast<std::int64_t>(8 * cell + 8));
    ExpectHexahedron(mesh, cell, points, &corners[8 * cell]);
  }
}

TEST_F(MeshWriters, VoxelsCountTheirCornersAlongX)
{
  const OctreeMesh mesh = this->Mesh();
  const auto writer = banyan::MakeVtuWriter(this->Folder.string(), "quake", mesh, true);
  const auto values = Values(mesh, 0);
  writer->AddStep(0.0, { { "velocity", &values } });
  const std::string file = this->Text("quake_0000.vtu");
  EXPECT_EQ(ArrayOf<std::uint8_t>(file, "types"), std::vector<std::uint8_t>(mesh.CellCount(), 11));
  const auto corners = ArrayOf<std::int64_t>(file, "connectivity");
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    ASSERT_EQ(corners[i], mesh.Corners(i / 8)[i % 8]);
  }
}

TEST_F(MeshWriters, AnExodusFileHoldsTheMeshOnceAndAllSteps)
{
  const OctreeMesh mesh = this->Mesh();
  const std::string path = (this->Folder / "quake.exo").string();
  {
    const auto writer = banyan::MakeExodusWriter(this->Folder.string(), "quake", mesh);
    for (int step = 0; step < 3; ++step)
    {
      const auto first = Values(mesh, step), second = Values(mesh, step + 10);
      writer->AddStep(0.5 * step, { { "velocity", &first }, { "offset", &second } });
      EXPECT_FALSE(std::filesystem::exists(path));
    }
    writer->Finish();
  }
  EXPECT_FALSE(std::filesystem::exists(path + ".partial"));
  int file = -1;
  ASSERT_EQ(nc_open(path.c_str(), NC_NOWRITE, &file), NC_NOERR);
  const auto length = [file](const char* name)
  {
    int id = -1;
    std::size_t found = 0;
    EXPECT_EQ(nc_inq_dimid(file, name, &id), NC_NOERR) << name;
    EXPECT_EQ(nc_inq_dimlen(file, id, &found), NC_NOERR) << name;
    return found;
  };
  const auto numbers = [file](const std::string& name, std::size_t count)
  {
    int id = -1;
    std::vector<double> values(count);
    EXPECT_EQ(nc_inq_varid(file, name.c_str(), &id), NC_NOERR) << name;
    EXPECT_EQ(nc_get_var_double(file, id, values.data()), NC_NOERR) << name;
    return values;
  };
  const std::size_t nodes = mesh.NodeCount(), cells = mesh.CellCount();
  ASSERT_EQ(length("num_nodes"), nodes);
  ASSERT_EQ(length("num_elem"), cells);
  ASSERT_EQ(length("num_el_in_blk1"), cells);
  ASSERT_EQ(length("time_step"), 3u);
  ASSERT_EQ(length("num_nod_var"), 6u);
  EXPECT_EQ(numbers("time_whole", 3), (std::vector<double>{ 0.0, 0.5, 1.0 }));
  std::vector<float> points(3 * nodes);
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto values = numbers(std::string("coord") + "xyz"[axis], nodes);
    for (std::size_t node = 0; node < nodes; ++node)
    {
      points[3 * node + axis] = static_cast<float>(values[node]);
    }
  }
  const auto connect = numbers("connect1", 8 * cells);
  for (std::size_t cell = 0; cell < cells; ++cell)
  {
    std::int64_t corners[8];
    std::transform(connect.begin() + static_cast<std::ptrdiff_t>(8 * cell),
      connect.begin() + static_cast<std::ptrdiff_t>(8 * cell + 8), corners,
      [](double node) { return static_cast<std::int64_t>(node) - 1; });
    ExpectHexahedron(mesh, cell, points, corners);
  }
  for (int k = 0; k < 6; ++k)
  {
    const auto values = numbers("vals_nod_var" + std::to_string(k + 1), 3 * nodes);
    for (int step = 0; step < 3; ++step)
    {
      const auto expected = Values(mesh, step + (k < 3 ? 0 : 10));
      for (std::size_t node = 0; node < nodes; ++node)
      {
        ASSERT_EQ(values[step * nodes + node], expected[3 * node + k % 3]);
      }
    }
  }
  nc_close(file);
}

TEST_F(MeshWriters, FailuresLeaveNothingHalfWritten)
{
  const OctreeMesh mesh = this->Mesh();
  const auto values = Values(mesh, 0);
  {
    const auto writer = banyan::MakeExodusWriter(this->Folder.string(), "quake", mesh);
    writer->AddStep(0.0, { { "velocity", &values } });
  }
  EXPECT_TRUE(std::filesystem::is_empty(this->Folder));
  EXPECT_THROW(banyan::MakeExodusWriter("/dev/null/folder", "quake", mesh), banyan::Error);
  EXPECT_THROW(banyan::MakeVtuWriter("/dev/null/folder", "quake", mesh, false), banyan::Error);
  std::filesystem::create_directories(this->Folder / "quake.exo" / "in the way");
  {
    const auto writer = banyan::MakeExodusWriter(this->Folder.string(), "quake", mesh);
    writer->AddStep(0.0, { { "velocity", &values } });
    EXPECT_THROW(writer->Finish(), banyan::Error);
  }
  EXPECT_FALSE(std::filesystem::exists(this->Folder / "quake.exo.partial"));
}

TEST_F(MeshWriters, TheProgramWritesEarthquakes)
{
  const std::string common = "--series earthquake --cells 2000 --steps 2 --duration 1 --output ";
  ASSERT_TRUE(this->Run(
    common + this->Folder.string() + " --raw " + (this->Folder / "velocity.raw").string()))
    << this->Messages();
  EXPECT_NE(this->Messages().find("step 2 of 2"), std::string::npos);
  EXPECT_EQ(this->Text("earthquake.exo").substr(0, 4), std::string("CDF\2"));
  const std::string vtu = (this->Folder / "vtu").string();
  ASSERT_TRUE(this->Run(common + vtu + " --format vtu --threads 1")) << this->Messages();
  const std::string file = this->Text("vtu/earthquake_0001.vtu");
  const auto velocity = ArrayOf<float>(file, "velocity");
  EXPECT_EQ(ArrayOf<float>(file, "ground_displacement").size(), velocity.size());
  const std::string raw = this->Text("velocity.raw");
  ASSERT_EQ(raw.size(), 2 * sizeof(float) * velocity.size());
  EXPECT_EQ(std::memcmp(raw.data() + raw.size() / 2, velocity.data(), raw.size() / 2), 0);
  EXPECT_FALSE(this->Run(common + "/dev/null/folder"));
  EXPECT_NE(this->Messages().find("banyan-generate: "), std::string::npos);
}
