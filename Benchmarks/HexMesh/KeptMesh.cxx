// SPDX-License-Identifier: BSD-3-Clause
#include "KeptMesh.h"

#include "Base/Error.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

namespace banyan::bench
{
namespace
{

/// Also the order of bytes: files stay on the machine that wrote them.
constexpr std::uint64_t Magic = 0x314853454d4e4142; // "BANMESH1"

struct Head
{
  std::uint64_t Begin = Magic;
  std::uint64_t Points = 0;
  std::uint64_t Ids = 0;
  std::uint64_t Values = 0;
  std::uint64_t Voxels = 0;

  std::uint64_t Bytes() const
  {
    return sizeof(Head) + (this->Points + this->Values) * sizeof(float) +
           this->Ids * sizeof(std::int64_t);
  }
};

template <class T>
void ReadAll(std::ifstream& file, std::vector<T>& numbers, std::uint64_t count)
{
  numbers.resize(count);
  file.read(
    reinterpret_cast<char*>(numbers.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

template <class T>
void WriteAll(std::ofstream& file, const std::vector<T>& numbers)
{
  file.write(reinterpret_cast<const char*>(numbers.data()),
    static_cast<std::streamsize>(numbers.size() * sizeof(T)));
}

bool ReadMesh(const std::string& path, BenchMesh& mesh)
{
  std::ifstream file(path, std::ios::binary);
  Head head;
  std::error_code problem;
  if (!file.read(reinterpret_cast<char*>(&head), sizeof(head)) || head.Begin != Magic ||
      std::filesystem::file_size(path, problem) != head.Bytes() || problem)
  {
    return false;
  }
  ReadAll(file, mesh.Points, head.Points);
  ReadAll(file, mesh.Ids, head.Ids);
  ReadAll(file, mesh.Values, head.Values);
  mesh.Voxels = head.Voxels != 0;
  return bool(file);
}

void WriteMesh(const std::string& path, const BenchMesh& mesh)
{
  // Under another name first: whoever finds the file finds all of it.
  const std::string unfinished = path + ".partial";
  std::ofstream file(unfinished, std::ios::binary);
  Head head;
  head.Points = mesh.Points.size();
  head.Ids = mesh.Ids.size();
  head.Values = mesh.Values.size();
  head.Voxels = mesh.Voxels ? 1 : 0;
  file.write(reinterpret_cast<const char*>(&head), sizeof(head));
  WriteAll(file, mesh.Points);
  WriteAll(file, mesh.Ids);
  WriteAll(file, mesh.Values);
  file.close();
  std::error_code problem;
  std::filesystem::rename(unfinished, path, problem);
  if (!file || problem)
  {
    throw Error("The mesh cannot be kept.", { path });
  }
}

} // namespace

BenchMesh KeptMesh(const std::string& path, const std::function<BenchMesh()>& make)
{
  BenchMesh mesh;
  if (path.empty())
  {
    return make();
  }
  if (!ReadMesh(path, mesh))
  {
    mesh = make();
    WriteMesh(path, mesh);
  }
  return mesh;
}

} // namespace banyan::bench
