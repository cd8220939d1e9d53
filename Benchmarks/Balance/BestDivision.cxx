// SPDX-License-Identifier: BSD-3-Clause
#include "BestDivision.h"

#include "BalanceFrames.h"
#include "CameraPath.h"

#include "Base/ThreadPool.h"
#include "Parallel/Balance/ScreenCuts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace banyan::bench
{
namespace
{

constexpr int Every = 10;     ///< frames
constexpr int MostTries = 8;  ///< of a plane, with the planes under it
constexpr double Even = 0.01; ///< of the larger side, by which the two of a plane may differ

/// Counts what zones of a view take; each one once.
class ZoneWork
{
public:
  ZoneWork(const BenchScene& scene, const BalanceOptions& options, int frame)
    : Scene(SceneOnPath(scene, options.Path, frame, options.Frames))
    , Source(scene.Data->Array(), BenchBrickCells, MaskRange{ scene.Low, scene.High }, this->Pool)
  {
  }

  double Of(const Box& zone)
  {
    const auto key =
      std::make_tuple(zone.Lo.x, zone.Lo.y, zone.Lo.z, zone.Hi.x, zone.Hi.y, zone.Hi.z);
    const auto known = this->Known.find(key);
    if (known != this->Known.end())
    {
      return known->second;
    }
    const double work = WorkOf(this->Draw(zone).Total());
    this->Known.emplace(key, work);
    return work;
  }

  /// A tree for the ranks with the axes that the balancer chooses if it knows all blocks.
  ZoneTree Tree(const glm::ivec3& cells, int ranks)
  {
    const int edge = BlockEdgeFor(cells);
    const BrickCosts view =
      ViewCosts(this->Scene, cells, edge, VisibleParts(this->Scene, this->Source, cells, edge));
    const FrameCost all = SumCost({ this->Draw({ glm::ivec3(0), cells }) }, view);
    const std::vector<double> alike(static_cast<std::size_t>(ranks), 1.0);
    return TurnedTree(EqualZoneTree(cells, ranks), CostSums(all.Blocks), alike, 1,
      ScreenCuts(this->Scene), WorkPerCutRay);
  }

  std::size_t Drawn() const { return this->Known.size(); }

private:
  BrickWork Draw(const Box& zone)
  {
    BrickWork work;
    RayScene drawn = this->Scene;
    drawn.Work = &work;
    RayStatistics statistics;
    CastRays(drawn, this->Source, zone, ~std::uint64_t{ 0 }, this->Pool, statistics);
    return work;
  }

  ThreadPool Pool{ 1 };
  RayScene Scene;
  ArrayBrickSource Source;
  std::map<std::tuple<int, int, int, int, int, int>, double> Known;
};

/// Puts the planes of a tree where the slowest ranks on both sides take as long, from the leaves
/// up: for each place of a plane that is tried, those under it are put in their best places first.
class Divider
{
public:
  Divider(ZoneTree tree, ZoneWork& work)
    : Tree(std::move(tree))
    , Work(work)
  {
  }

  std::vector<double> Best() { return this->BestOf(0, this->Tree.Whole()); }

private:
  std::vector<double> BestOf(int number, const Box& zone)
  {
    const ZoneTree::Node node = this->Tree.Nodes[static_cast<std::size_t>(number)];
    if (node.IsLeaf())
    {
      return { zone.Empty() ? 0.0 : this->Work.Of(zone) };
    }
    int low = zone.Lo[node.Axis];
    int high = zone.Hi[node.Axis];
    int plane = std::clamp(node.Plane, low, high); // where it was best in another zone
    std::vector<double> best;
    int bestPlane = plane;
    for (int tries = 0; tries < MostTries; ++tries)
    {
      Box sides[2] = { zone, zone };
      sides[0].Hi[node.Axis] = plane;
      sides[1].Lo[node.Axis] = plane;
      std::vector<double> works = this->BestOf(node.Below, sides[0]);
      const double below = Largest(works);
      const std::vector<double> others = this->BestOf(node.Above, sides[1]);
      const double above = Largest(others);
      works.insert(works.end(), others.begin(), others.end());
      if (best.empty() || Largest(works) < Largest(best))
      {
        best = works;
        bestPlane = plane;
      }
      if (std::abs(below - above) <= Even * std::max(below, above))
      {
        break;
      }
      (below > above ? high : low) = plane;
      if (high - low <= 1)
      {
        break;
      }
      plane = Between(low, high, plane, below, above, tries);
    }
    this->Tree.Nodes[static_cast<std::size_t>(number)].Plane = bestPlane;
    return best;
  }

  /// The first tries go as far as the difference says, later ones to the middle.
  static int Between(int low, int high, int plane, double below, double above, int tries)
  {
    const double off = (above - below) / std::max(1.0, above + below);
    const int length = below > above ? plane - low : high - plane;
    const auto step = static_cast<int>(std::lround(off * length));
    const int wanted = tries < 3 && step != 0 ? plane + step : (low + high) / 2;
    return std::clamp(wanted, low + 1, high - 1);
  }

  static double Largest(const std::vector<double>& works)
  {
    return *std::max_element(works.begin(), works.end());
  }

  ZoneTree Tree;
  ZoneWork& Work;
};

} // namespace

void WriteBestDivisions(const BenchScene& scene, const BalanceOptions& options, std::FILE* file)
{
  for (int frame = 0; frame < options.Frames; frame += Every)
  {
    ZoneWork work(scene, options, frame);
    for (const int ranks : options.Ranks)
    {
      const std::vector<double> best =
        Divider(work.Tree(scene.Data->Samples - 1, ranks), work).Best();
      std::fprintf(file, "%d,%d,%.4f,%.3f,%zu\n", frame, ranks, ImbalanceOf(best),
        1e3 * CountedSeconds(*std::max_element(best.begin(), best.end())), work.Drawn());
      std::fflush(file);
    }
  }
}

} // namespace banyan::bench
