// SPDX-License-Identifier: BSD-3-Clause
#include "RealWall.h"

#include "Base/Error.h"

namespace banyan::bench
{

void DrawRealWall(const BenchScene&, const WallColumn&, const std::string&, const std::string&)
{
  throw Error("--real needs MPI, which this program was built without.");
}

} // namespace banyan::bench
