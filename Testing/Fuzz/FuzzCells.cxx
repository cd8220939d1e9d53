// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Mesh/CellSeries/StoredCells.h"
#include "SectionsFile.h"

/// The input are the sections of the file of a mesh of any cells, each behind its size (a varint),
/// none of them compressed. What is accepted must come back when written again, as must its points
/// as moved ones.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace banyan;
  try
  {
    const auto mesh = CellsFromBytes(fuzz::FileOfSections("BanyanCe", 7, data, size));
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
