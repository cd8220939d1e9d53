// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSeriesWriter.h"
#include "OctreeMesh.h"

#include "Base/Error.h"

#include <netcdf.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <functional>

namespace banyan
{

namespace
{

constexpr std::size_t NameLength = 32; ///< of Exodus' names, without the null behind them

/// Exodus II is a convention on names of dimensions, variables and attributes of a netCDF file:
/// Schoof, Yarberry (1994), EXODUS II: a finite element data model, SAND92-2137, appendix.
class ExodusWriter : public MeshSeriesWriter
{
public:
  ExodusWriter(const std::string& folder, const std::string& name, const OctreeMesh& mesh)
    : Mesh(mesh)
  {
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (!std::filesystem::is_directory(folder))
    {
      throw Error("The output folder could not be made.", { folder, {}, {}, {} });
    }
    this->Path = (std::filesystem::path(folder) / (name + ".exo")).string();
    this->Check(nc_create(this->Unfinished().c_str(), NC_CLOBBER | NC_64BIT_OFFSET, &this->File));
    this->Open = true;
  }

  ~ExodusWriter() override
  {
    if (this->Open)
    {
      nc_close(this->File);
    }
    if (!this->Finished)
    {
      std::error_code ignored;
      std::filesystem::remove(this->Unfinished(), ignored);
    }
  }

  void AddStep(double time, const std::vector<NodeArray>& arrays) override
  {
    if (this->Steps == 0)
    {
      this->Define(arrays);
      this->WriteMesh(arrays);
    }
    const std::size_t nodes = this->Mesh.NodeCount();
    this->Check(nc_put_var1_double(this->File, this->Time, &this->Steps, &time));
    std::vector<float> values(nodes);
    for (std::size_t k = 0; k < this->Variables.size(); ++k)
    {
      const std::vector<float>& from = *arrays.at(k / 3).Values;
      for (std::size_t node = 0; node < nodes; ++node)
      {
        values[node] = from[3 * node + k % 3];
      }
      const std::size_t start[2] = { this->Steps, 0 }, count[2] = { 1, nodes };
      this->Check(nc_put_vara_float(this->File, this->Variables[k], start, count, values.data()));
    }
    // A reader may look at what is there so far.
    this->Check(nc_sync(this->File));
    ++this->Steps;
  }

  void Finish() override
  {
    this->Open = false;
    this->Check(nc_close(this->File));
    std::error_code problem;
    std::filesystem::rename(this->Unfinished(), this->Path, problem);
    if (problem)
    {
      throw Error(
        "The file could not get its name: " + problem.message() + ".", { this->Path, {}, {}, {} });
    }
  }

private:
  std::string Unfinished() const { return this->Path + ".partial"; }

  void Check(int status) const
  {
    if (status != NC_NOERR)
    {
      throw Error(std::string("The file could not be written (") + nc_strerror(status) +
                    "); is the disk full or the folder read-only?",
        { this->Path, {}, {}, {} });
    }
  }

  int Dimension(const char* name, std::size_t length) const
  {
    int id;
    this->Check(nc_def_dim(this->File, name, length, &id));
    return id;
  }

  int Variable(const std::string& name, int type, const std::vector<int>& dimensions) const
  {
    int id;
    this->Check(nc_def_var(
      this->File, name.c_str(), type, static_cast<int>(dimensions.size()), dimensions.data(), &id));
    return id;
  }

  void Define(const std::vector<NodeArray>& arrays)
  {
    const float version = 5.14f;
    const int floatBytes = 4, large = 1, nameLength = NameLength;
    const auto attribute = [this](const char* name, const auto& value)
    {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, float>)
      {
        this->Check(nc_put_att_float(this->File, NC_GLOBAL, name, NC_FLOAT, 1, &value));
      }
      else
      {
        this->Check(nc_put_att_int(this->File, NC_GLOBAL, name, NC_INT, 1, &value));
      }
    };
    attribute("api_version", version);
    attribute("version", version);
    attribute("floating_point_word_size", floatBytes);
    attribute("file_size", large);
    attribute("maximum_name_length", nameLength);
    const std::string title = "banyan-generate";
    this->Check(nc_put_att_text(this->File, NC_GLOBAL, "title", title.size(), title.c_str()));

    const std::size_t nodes = this->Mesh.NodeCount(), cells = this->Mesh.CellCount();
    const int text = this->Dimension("len_string", NameLength + 1);
    const int names = this->Dimension("len_name", NameLength + 1);
    this->Dimension("len_line", 81);
    this->Dimension("four", 4);
    const int time = this->Dimension("time_step", NC_UNLIMITED);
    const int axes = this->Dimension("num_dim", 3);
    const int node = this->Dimension("num_nodes", nodes);
    this->Dimension("num_elem", cells);
    const int blocks = this->Dimension("num_el_blk", 1);
    const int cell = this->Dimension("num_el_in_blk1", cells);
    const int corner = this->Dimension("num_nod_per_el1", 8);
    const int variables = this->Dimension("num_nod_var", 3 * arrays.size());

    this->Time = this->Variable("time_whole", NC_DOUBLE, { time });
    this->Status = this->Variable("eb_status", NC_INT, { blocks });
    this->Property = this->Variable("eb_prop1", NC_INT, { blocks });
    this->Check(nc_put_att_text(this->File, this->Property, "name", 2, "ID"));
    this->BlockNames = this->Variable("eb_names", NC_CHAR, { blocks, names });
    for (const char axis : { 'x', 'y', 'z' })
    {
      this->Coordinates.push_back(this->Variable(std::string("coord") + axis, NC_FLOAT, { node }));
    }
    this->AxisNames = this->Variable("coor_names", NC_CHAR, { axes, names });
    this->Connectivity = this->Variable("connect1", NC_INT, { cell, corner });
    this->Check(nc_put_att_text(this->File, this->Connectivity, "elem_type", 4, "HEX8"));
    this->VariableNames = this->Variable("name_nod_var", NC_CHAR, { variables, text });
    for (std::size_t k = 0; k < 3 * arrays.size(); ++k)
    {
      this->Variables.push_back(
        this->Variable("vals_nod_var" + std::to_string(k + 1), NC_FLOAT, { time, node }));
    }
    int before;
    this->Check(nc_set_fill(this->File, NC_NOFILL, &before));
    this->Check(nc_enddef(this->File));
  }

  void WriteMesh(const std::vector<NodeArray>& arrays)
  {
    const int one = 1;
    this->Check(nc_put_var_int(this->File, this->Status, &one));
    this->Check(nc_put_var_int(this->File, this->Property, &one));
    this->PutName(this->BlockNames, 0, "ground");
    const std::size_t nodes = this->Mesh.NodeCount(), cells = this->Mesh.CellCount();
    std::vector<float> coordinates(nodes);
    for (int axis = 0; axis < 3; ++axis)
    {
      const char letter[2] = { static_cast<char>('x' + axis), '\0' };
      this->PutName(this->AxisNames, axis, letter);
      for (std::size_t node = 0; node < nodes; ++node)
      {
        coordinates[node] = static_cast<float>(this->Mesh.Point(node)[axis]);
      }
      this->Check(nc_put_var_float(this->File, this->Coordinates[axis], coordinates.data()));
      for (std::size_t a = 0; a < arrays.size(); ++a)
      {
        this->PutName(this->VariableNames, 3 * a + axis, arrays[a].Name + letter);
      }
    }
    // Nodes are counted from 1.
    constexpr std::size_t Batch = 1 << 16;
    std::vector<int> corners(8 * Batch);
    for (std::size_t first = 0; first < cells; first += Batch)
    {
      const std::size_t count = std::min(Batch, cells - first);
      for (std::size_t i = 0; i < 8 * count; ++i)
      {
        corners[i] =
          static_cast<int>(this->Mesh.Corners(first + i / 8)[HexahedronOrder[i % 8]] + 1);
      }
      const std::size_t start[2] = { first, 0 }, counts[2] = { count, 8 };
      this->Check(nc_put_vara_int(this->File, this->Connectivity, start, counts, corners.data()));
    }
  }

  void PutName(int variable, std::size_t place, const std::string& name) const
  {
    char text[NameLength + 1] = {};
    std::strncpy(text, name.c_str(), NameLength);
    const std::size_t start[2] = { place, 0 }, count[2] = { 1, sizeof text };
    this->Check(nc_put_vara_text(this->File, variable, start, count, text));
  }

  std::string Path;
  const OctreeMesh& Mesh;
  int File = -1;
  bool Open = false, Finished = false;
  std::size_t Steps = 0;
  int Time = -1, Status = -1, Property = -1, BlockNames = -1, AxisNames = -1, Connectivity = -1,
      VariableNames = -1;
  std::vector<int> Coordinates, Variables;
};

} // namespace

std::unique_ptr<MeshSeriesWriter> MakeExodusWriter(
  const std::string& folder, const std::string& name, const OctreeMesh& mesh)
{
  return std::make_unique<ExodusWriter>(folder, name, mesh);
}

} // namespace banyan
