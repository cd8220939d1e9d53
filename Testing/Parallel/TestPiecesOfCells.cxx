// SPDX-License-Identifier: BSD-3-Clause
// Meshes of cells whose cells lie on real MPI ranks, against one rank that has all of them.
#include "MpiProgram.h"
#include "Parallel/PieceCases.h"

#include <string>
#include <vector>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using piececases::Deal;

/// Seconds after which a rank that hangs ends itself; below the TIMEOUT of the test.
constexpr unsigned WatchdogSeconds = 75;

std::string DrawAll(Communicator& communicator)
{
  std::string wrong;
  for (const double offset : { 0.1, 0.6 }) // cells that match, and cells that overlap
  {
    for (const BlendMode mode : { BlendMode::Composite, BlendMode::Maximum })
    {
      piececases::Case is(piececases::Cube(6, Cut::Mixed, offset));
      is.Scene.Blend.Mode = mode;
      const double step = is.Scene.SampleDistance;
      auto samplings = std::make_shared<TileSamplings>(
        is.Scene.Camera.ImageSize(), std::vector{ RaySampling{ 0, step }, RaySampling{ 1, step } });
      samplings->SetNumber({ 1, 1 }, 1); // in the middle
      is.Scene.Samplings = samplings;
      const FloatImage whole = is.Whole();
      for (const Deal deal : { Deal::OneByOne, Deal::Jagged, Deal::Morton, Deal::Slabs })
      {
        PieceStatistics statistics;
        const FloatImage picture = is.Together(
          communicator, piececases::Dealt(is.Mesh, deal, communicator.Size()), statistics);
        if (communicator.Rank() == 0 && !(MaxDifference(picture, whole) <= 1e-5))
        {
          wrong += "another picture with offsets of " + std::to_string(offset) + ", mode " +
                   std::to_string(int(mode)) + ", deal " + std::to_string(int(deal)) + "; ";
        }
      }
    }
  }
  return wrong;
}

} // namespace

int main(int argc, char** argv)
{
  return banyan::testing::RunOnMpiRanks(argc, argv, WatchdogSeconds,
    [&](Communicator& communicator)
    { return banyan::testing::CheckRankCount(communicator, argc, argv) + DrawAll(communicator); });
}
