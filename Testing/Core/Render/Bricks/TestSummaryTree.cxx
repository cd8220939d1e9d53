// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/SummaryTree.h"

#include "Render/Dice.h"
#include "Render/MadeUpBricks.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

constexpr int Nothing = 0; // a state that says nothing

/// All single bricks in the order of the descent, which must meet each once.
std::vector<std::int64_t> OrderOf(const Viewpoint& view, const BrickSource& source)
{
  std::vector<std::int64_t> order;
  source.Summaries()->Descend(view, Nothing,
    [&](const SummaryTree::Place& place, int&)
    {
      if (place.Height == 0)
      {
        EXPECT_EQ(place.Bricks.Count(), 1);
        order.push_back(BrickSource::NumberOf(place.Bricks.Lo, source.Bricks()));
        EXPECT_EQ(place.Cells, source.CellsOf(order.back()));
      }
      return true;
    });
  return order;
}

/// Every ray from the viewer must meet the bricks in the order given.
void ExpectOrder(
  const Viewpoint& view, const BrickSource& source, const Box& cells, std::mt19937& random)
{
  const std::vector<std::int64_t> order = OrderOf(view, source);
  std::vector<int> rank(source.Bricks().x * source.Bricks().y * source.Bricks().z, -1);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    EXPECT_EQ(rank[order[i]], -1);
    rank[order[i]] = static_cast<int>(i);
  }
  EXPECT_EQ(order.size(), rank.size());
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto point = [&]
  {
    return glm::dvec3(cells.Lo) +
           glm::dvec3(unit(random), unit(random), unit(random)) * glm::dvec3(cells.Size());
  };
  const auto brickAt = [&](const glm::dvec3& p)
  {
    for (const std::int64_t brick : order)
    {
      if (source.CellsOf(brick).Contains(glm::ivec3(glm::floor(p))))
      {
        return brick;
      }
    }
    return std::int64_t{ -1 };
  };
  for (int i = 0; i < 200; ++i)
  {
    const glm::dvec3 target = point();
    const glm::dvec3 origin = view.Parallel ? target - 100.0 * view.Direction : view.Eye;
    int last = -1;
    for (int step = 1; step <= 300; ++step) // at the eye itself no brick hides another
    {
      const std::int64_t brick = brickAt(origin + (target - origin) * (step / 300.0));
      if (brick >= 0)
      {
        EXPECT_GE(rank[brick], last);
        last = rank[brick];
      }
    }
    EXPECT_GE(last, 0);
  }
}

TEST(SummaryTree, GoesFrontToBackFromAnywhere)
{
  ThreadPool pool(1);
  const glm::ivec3 n(14, 11, 9);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  const ArrayBrickSource source(scenes::ArrayOf(values, n), 3, { 0, 1 }, pool);
  const Box cells{ glm::ivec3(0), n - 1 };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20; ++i)
  {
    Viewpoint view;
    const glm::dvec3 away(unit(random), unit(random), unit(random));
    view.Eye = glm::dvec3(7, 5, 4) + away * (i % 2 ? 6.0 : 40.0); // inside and outside
    ExpectOrder(view, source, cells, random);
    view.Parallel = true;
    view.Direction = away;
    ExpectOrder(view, source, cells, random);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    Viewpoint view;
    view.Parallel = true;
    view.Direction = glm::dvec3(0.0);
    view.Direction[axis] = axis == 1 ? -1.0 : 1.0;
    ExpectOrder(view, source, cells, random);
    view.Parallel = false;
    view.Eye = glm::dvec3(6, 6, 3); // on brick faces
    ExpectOrder(view, source, cells, random);
  }
}

TEST(SummaryTree, KnowsAllThatIsInABox)
{
  Dice dice(1);
  int nodes = 0;
  for (const glm::ivec3& cells :
    { glm::ivec3(1), glm::ivec3(64), glm::ivec3(65, 1, 200), glm::ivec3(131, 70, 150) })
  {
    for (const int edge : { 5, 16, 32, 64, 100 })
    {
      const scenes::MadeUpBricks source(dice, cells, edge);
      source.Summaries()->Descend(Viewpoint(), Nothing,
        [&](const SummaryTree::Place& place, int&)
        {
          SummaryNode all;
          ForPositions(place.Bricks,
            [&](const glm::ivec3& at)
            {
              const std::int64_t brick = BrickSource::NumberOf(at, source.Bricks());
              const ValueRange range = source.RangeOf(brick);
              all.Range.Include(range);
              all.Mask |= source.MaskOf(brick);
              all.Full = all.Full && !range.Empty();
            });
          if (place.Node)
          {
            ++nodes;
            EXPECT_EQ(place.Node->Range.Low, all.Range.Low);
            EXPECT_EQ(place.Node->Range.High, all.Range.High);
            EXPECT_EQ(place.Node->Mask, all.Mask);
            EXPECT_EQ(place.Node->Full, all.Full);
          }
          return !place.Lowest;
        });
    }
  }
  EXPECT_GT(nodes, 100);
}

TEST(SummaryTree, FindsBricksByCells)
{
  Dice dice(2);
  for (int i = 0; i < 50; ++i)
  {
    const scenes::MadeUpBricks source(dice, { 40, 1, 33 }, dice.Whole(1, 12));
    const glm::ivec3 low(dice.Whole(-3, 41), dice.Whole(0, 1), dice.Whole(-3, 34));
    const Box cells{ low,
      low + glm::ivec3(dice.Whole(0, 30), dice.Whole(0, 2), dice.Whole(0, 30)) };
    Box expected;
    ForPositions({ glm::ivec3(0), source.Bricks() },
      [&](const glm::ivec3& at)
      {
        const Box own = source.CellsOf(BrickSource::NumberOf(at, source.Bricks()));
        expected = Union(expected, Intersection(own, cells).Empty() ? Box{} : Box{ at, at + 1 });
      });
    EXPECT_EQ(source.Summaries()->BricksIn(cells), expected);
  }
}

} // namespace
