// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Base/Varint.h"
#include "Mesh/CellSeries/StoredCells.h"

/// The input are the sections of the file of a mesh of any cells, each behind its size (a varint),
/// none of them compressed. What is accepted must come back when written again, as must its points
/// as moved ones.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace banyan;
  constexpr std::size_t head = 24;
  constexpr std::uint32_t sections = 7;
  Bytes file{ 'B', 'a', 'n', 'y', 'a', 'n', 'C', 'e' };
  file.resize(head);
  StoreNumber(file.data() + 8, std::uint32_t{ 1 });
  StoreNumber(file.data() + 12, sections);
  try
  {
    ByteReader reader(data, size);
    for (std::uint32_t i = 0; i < sections; ++i)
    {
      const std::uint64_t bytes = reader.Varint();
      const std::uint8_t* part = reader.Skip(bytes);
      PutVarint(file, bytes);
      PutVarint(file, bytes);
      file.insert(file.end(), part, part + bytes);
    }
    StoreNumber(file.data() + 16, ShortHashOf(file.data() + head, file.size() - head));
    const auto mesh = CellsFromBytes(file);
    CheckCells(*mesh);
    const auto again = CellsFromBytes(CellsToBytes(*mesh));
    const Bytes moved = MovedPointsToBytes(*mesh, mesh->Points.data());
    if (again->Connectivity != mesh->Connectivity || again->Points != mesh->Points ||
        again->Faces != mesh->Faces || MovedPointsFromBytes(*mesh, moved) != mesh->Points)
    {
      __builtin_trap();
    }
  }
  catch (const Error&)
  {
  }
  return 0;
}
