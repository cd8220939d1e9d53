// SPDX-License-Identifier: BSD-3-Clause
#include "CodecSeeds.h"
#include "GroupFiles.h"

#include "Base/ThreadPool.h"
#include "Base/Varint.h"
#include "Mesh/CellSeries/StoredCells.h"
#include "Mesh/Series/StoredMesh.h"
#include "Series/Format/Exceptions.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Format/IndexText.h"
#include "Series/Format/Zstd.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

namespace
{

using banyan::fuzz::Bytes;

void Write(const std::string& path, const Bytes& bytes)
{
  std::ofstream(path, std::ios::binary)
    .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// The JSON of an index.
Bytes BodyOf(const std::string& text)
{
  return { text.begin() + static_cast<std::ptrdiff_t>(text.find('\n') + 1), text.end() };
}

/// Seeds from series that are there: the indices of all.
void CopyGolden(const std::filesystem::path& golden, const std::filesystem::path& folder)
{
  for (const auto& entry : std::filesystem::recursive_directory_iterator(golden))
  {
    if (entry.is_regular_file() && entry.path().extension() == ".banyan")
    {
      std::ifstream stream(entry.path(), std::ios::binary);
      const std::string content{ std::istreambuf_iterator<char>(stream), {} };
      Write((folder / "Index" / entry.path().filename()).string(), BodyOf(content));
    }
  }
}

/// The sections of the file of a mesh without compression, as FuzzMesh and FuzzCells take them.
Bytes SectionsOf(const Bytes& file)
{
  Bytes input;
  banyan::ByteReader reader(file.data() + 24, file.size() - 24);
  while (reader.Left() > 0)
  {
    Bytes part(reader.Varint());
    const std::uint64_t stored = reader.Varint();
    const std::uint8_t* from = reader.Skip(stored);
    if (stored < part.size())
    {
      banyan::Decompress(from, stored, part.data(), part.size());
    }
    else
    {
      part.assign(from, from + stored);
    }
    banyan::PutVarint(input, part.size());
    input.insert(input.end(), part.begin(), part.end());
  }
  return input;
}

/// A large cell, and beside it eight small ones, in any order; with own points for each if wanted.
Bytes SmallMesh(bool shared)
{
  std::vector<float> points;
  std::vector<std::int64_t> ids;
  const auto add = [&](const glm::ivec3& low, int edge)
  {
    for (int c = 7; c >= 0; --c)
    {
      const glm::ivec3 p = low + edge * glm::ivec3(c & 1, c >> 1 & 1, c >> 2);
      std::size_t found = shared ? 0 : points.size();
      while (found < points.size() && (points[found] != 0.1f * static_cast<float>(p.x) ||
                                        points[found + 1] != static_cast<float>(p.y) ||
                                        points[found + 2] != static_cast<float>(p.z)))
      {
        found += 3;
      }
      if (found == points.size())
      {
        points.insert(points.end(),
          { 0.1f * static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z) });
      }
      ids.push_back(static_cast<std::int64_t>(found / 3));
    }
  };
  for (int c = 0; c < 8; ++c)
  {
    add({ c & 1, c >> 1 & 1, c >> 2 }, 1);
  }
  add({ 2, 0, 0 }, 2);
  points.insert(points.end(), { 1.0f, 2.0f, 3.0f });
  banyan::HexMesh mesh;
  mesh.Points = points.data();
  mesh.PointCount = static_cast<std::int64_t>(points.size() / 3);
  mesh.Connectivity = ids.data();
  mesh.CellCount = 9;
  banyan::ThreadPool pool(1);
  return banyan::MeshToBytes(*banyan::StoreMesh(*banyan::ElementOctree::Find(mesh, pool), nullptr));
}

/// A hexahedron, a tetrahedron, a cell without points and a polyhedron that share points, or the
/// first one alone, with coordinates of double.
Bytes SmallCells(bool mixed)
{
  banyan::StoredCells cells;
  cells.PointType = mixed ? banyan::ScalarType::Float32 : banyan::ScalarType::Float64;
  for (int i = 0; i < 3 * 9; ++i)
  {
    const double at = 0.5 * (i / 3 >> i % 3 & 1) + 0.01 * i;
    const std::size_t end = cells.Points.size();
    cells.Points.resize(end + SizeOf(cells.PointType));
    mixed ? banyan::StoreNumber(cells.Points.data() + end, static_cast<float>(at))
          : banyan::StoreNumber(cells.Points.data() + end, at);
  }
  cells.Types = { 12 };
  cells.Offsets = { 0, 8 };
  cells.Connectivity = { 0, 1, 3, 2, 4, 5, 7, 6 };
  if (mixed)
  {
    cells.Types.insert(cells.Types.end(), { 10, 0, banyan::PolyhedronType });
    cells.Offsets.insert(cells.Offsets.end(), { 12, 12, 16 });
    cells.Connectivity.insert(cells.Connectivity.end(), { 7, 6, 5, 8, 0, 1, 2, 4 });
    cells.Faces = { 4, 3, 0, 1, 2, 3, 0, 4, 1, 3, 1, 4, 2, 3, 2, 4, 8 };
  }
  return banyan::CellsToBytes(*banyan::StoreCells(std::move(cells), {}));
}

} // namespace

/// Writes the seeds of Testing/Fuzz/Seeds: MakeSeeds FOLDER. With a second folder, of golden files,
/// more of them.
int main(int argc, char** argv)
{
  namespace fs = std::filesystem;
  if (argc != 2 && argc != 3)
  {
    std::cerr << "MakeSeeds FOLDER [GOLDEN]\n";
    return 1;
  }
  const fs::path folder = argv[1];
  const fs::path scratch = folder / "scratch";
  for (const fs::path& part : { folder / "Group", folder / "Exceptions", folder / "Index",
         folder / "Block", folder / "Mesh", folder / "Cells", scratch })
  {
    fs::create_directories(part);
  }
  for (int kind = 0; kind < banyan::fuzz::SeriesKinds; ++kind)
  {
    banyan::fuzz::SmallSeries series(scratch.string(), kind);
    const std::string name = std::to_string(kind);
    Write((folder / "Group" / name).string(), banyan::fuzz::ToInput(kind, series.Parts));
    if (series.Number > 0)
    {
      banyan::group::FieldHead head =
        banyan::group::UnpackHead(series.Parts.Sections[0].data(), series.Parts.Sections[0].size());
      head.Exact = false;
      head.Open = false;
      head.Static = true;
      series.Parts.Sections[0] = banyan::group::PackHead(head);
      Write((folder / "Group" / (name + "-resting")).string(),
        banyan::fuzz::ToInput(kind, series.Parts));
    }
    else
    {
      Write((folder / "Index" / name).string(), BodyOf(banyan::IndexToText(series.Index)));
    }
  }
  constexpr std::uint32_t samples = 16 * 16 * 16;
  for (std::uint32_t share = 1; share <= samples; share *= 16)
  {
    banyan::ExceptionList<float> list;
    for (std::uint32_t i = 0; i < samples; i += samples / share)
    {
      list.Positions.push_back(i);
      list.Values.push_back(static_cast<float>(i * i));
    }
    Bytes input{ static_cast<std::uint8_t>(banyan::ScalarType::Float32), 0 };
    const Bytes payload = banyan::PackExceptions(list, samples, 3);
    input.insert(input.end(), payload.begin(), payload.end());
    Write((folder / "Exceptions" / std::to_string(share)).string(), input);
  }
  Write((folder / "Mesh" / "shared").string(), SectionsOf(SmallMesh(true)));
  Write((folder / "Mesh" / "own").string(), SectionsOf(SmallMesh(false)));
  Write((folder / "Cells" / "mixed").string(), SectionsOf(SmallCells(true)));
  Write((folder / "Cells" / "single").string(), SectionsOf(SmallCells(false)));
  int number = 0;
  for (const Bytes& block : banyan::fuzz::BlockSeeds())
  {
    Write((folder / "Block" / std::to_string(number++)).string(), block);
  }
  if (argc == 3)
  {
    CopyGolden(argv[2], folder);
  }
  fs::remove_all(scratch);
  return 0;
}
