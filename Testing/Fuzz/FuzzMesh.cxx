// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Mesh/Series/StoredMesh.h"
#include "SectionsFile.h"

/// The input are the sections of the file of a mesh, each behind its size (a varint), none of them
/// compressed. What is accepted must come back when written again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  using namespace banyan;
  try
  {
    const auto mesh = MeshFromBytes(fuzz::FileOfSections("BanyanMe", 13, data, size));
    const Bytes again = MeshToBytes(*mesh);
    if (MeshFromBytes(again)->Connectivity != mesh->Connectivity)
    {
      __builtin_trap();
    }
  }
  catch (const Error&)
  {
  }
  return 0;
}
