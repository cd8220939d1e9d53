// SPDX-License-Identifier: BSD-3-Clause
#include "BalanceFrames.h"

#include "Base/Error.h"

namespace banyan::bench
{

void DrawOnMpiRanks(const std::function<BenchScene()>&, const BalanceOptions&, const TakeFrame&)
{
  throw Error("This program was built without MPI.");
}

} // namespace banyan::bench
