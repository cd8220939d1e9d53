// SPDX-License-Identifier: BSD-3-Clause
// Frames that threads draw while the main threads of MPI ranks serve them, leave, come back, and
// break them off.
#include "MpiProgram.h"

#include "Parallel/Frame/MeshSteps.h"
#include "Parallel/Frame/PlainSteps.h"
#include "Parallel/Frame/ServedFrames.h"

namespace
{

using namespace banyan;
using namespace banyan::played;

template <class Player>
void DrawFrames(Communicator& communicator, unsigned seed)
{
  ServedPlayer<Player> player(communicator);
  EXPECT_GT(DrawAndBreakOff(player, 40, seed), 5);
}

} // namespace

/// @param argv[1] the number of ranks there must be
int main(int argc, char** argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  return banyan::testing::RunOnMpiRanks(argc, argv, 80,
    [&](Communicator& communicator) -> std::string
    {
      const std::string wrong = banyan::testing::CheckRankCount(communicator, argc, argv);
      if (!wrong.empty())
      {
        return wrong;
      }
      DrawFrames<PlainPlayer>(communicator, 1);
      DrawFrames<MeshPlayer>(communicator, 2);
      return ::testing::UnitTest::GetInstance()->Passed() ? "" : "see above";
    });
}
