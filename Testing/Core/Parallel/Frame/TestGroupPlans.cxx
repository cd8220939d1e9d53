// SPDX-License-Identifier: BSD-3-Clause
// Which steps of a series that plays are planned, and which take the plans of others.
#include "Parallel/Frame/GroupPlans.h"
#include "Render/Sampling/FinestPlan.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr int Steps = 21;
constexpr Hash128 View{ 1, 2 };
const glm::ivec2 ImageSize{ 64, 32 }; // two tiles

SamplingPlan PlanOf(const RaySampling& left, const RaySampling& right, double error)
{
  SamplingPlan plan;
  auto tiles = std::make_shared<TileSamplings>(ImageSize, std::vector<RaySampling>{ left, right });
  tiles->SetNumber({ 1, 0 }, 1);
  plan.Samplings = tiles;
  plan.EstimatedError = error;
  plan.Probes = 7;
  return plan;
}

RaySampling At(const SamplingPlan& plan, int tile)
{
  return plan.Samplings
    ->Samplings()[static_cast<std::size_t>(plan.Samplings->NumberAt({ tile, 0 }))];
}

TEST(FinestPlan, IsAsFineAsBothInEachTile)
{
  const SamplingPlan a = PlanOf({ 1, 2.0, 4 }, { 0, 0.5, 1 }, 3.0);
  const SamplingPlan b = PlanOf({ 2, 1.0, 2 }, { 1, 4.0, 8 }, 5.0);
  const SamplingPlan finest = FinestPlan(ImageSize, a, b);
  EXPECT_TRUE((At(finest, 0) == RaySampling{ 1, 1.0, 2 }));
  EXPECT_TRUE((At(finest, 1) == RaySampling{ 0, 0.5, 1 }));
  EXPECT_EQ(finest.EstimatedError, 5.0);
  EXPECT_EQ(finest.Probes, 0);
  const SamplingPlan blank;
  EXPECT_EQ(FinestPlan(ImageSize, blank, b).Samplings, b.Samplings);
  EXPECT_EQ(FinestPlan(ImageSize, a, blank).Samplings, a.Samplings);
  EXPECT_EQ(FinestPlan(ImageSize, blank, blank).Samplings, nullptr);
}

/// Plans whose distance is the step's number plus one.
struct Series
{
  GroupPlans Plans;
  std::vector<double> Made;

  static VisibleSigns SignsAt(double step)
  {
    // Step 3 shows other values, and step 13 many more bricks.
    return { step == 13 ? 400 : 100 + static_cast<std::int64_t>(step),
      step == 3 ? ValueMask{ 8 } : ValueMask{ 3 } };
  }

  SamplingPlan At(double step, const Hash128& view = View)
  {
    return this->Plans.Of(view, ImageSize, step, Steps, SignsAt(step),
      [&](double planned) -> GroupPlans::End
      {
        this->Made.push_back(planned);
        const double distance = planned + 1.0;
        return { PlanOf({ 0, distance, 1 }, { 0, distance, 1 }, 0.1 * planned), SignsAt(planned) };
      });
  }

  double DistanceAt(double step) { return ::At(this->At(step), 0).Distance; }
};

TEST(GroupPlans, TheFirstPictureOfAViewHasAPlanOfItsOwn)
{
  Series series;
  EXPECT_EQ(series.DistanceAt(5), 6.0);
  EXPECT_EQ(series.DistanceAt(5), 6.0) << "nobody plays it yet";
  EXPECT_EQ(series.Made, std::vector<double>{ 5 });
  EXPECT_EQ(::At(series.At(6, { 3, 4 }), 0).Distance, 7.0) << "another view";
  EXPECT_EQ(series.DistanceAt(6), 7.0) << "and the first one again";
}

TEST(GroupPlans, StepsTakeThoseOfTheEndsOfTheirGroup)
{
  Series series;
  series.At(0);
  const SamplingPlan second = series.At(1);
  EXPECT_EQ(::At(second, 0).Distance, 1.0);
  EXPECT_DOUBLE_EQ(second.EstimatedError, 0.8);
  EXPECT_EQ(second.Probes, 7) << "of the next group's first step";
  EXPECT_EQ(series.Made, (std::vector<double>{ 0, 8 }));
  EXPECT_EQ(series.At(2).Probes, 0);
  EXPECT_EQ(series.DistanceAt(7), 1.0);
  EXPECT_EQ(series.DistanceAt(8), 9.0);
  EXPECT_EQ(series.DistanceAt(9), 9.0);
  EXPECT_EQ(series.DistanceAt(17), 17.0);
  EXPECT_EQ(series.DistanceAt(20), 21.0);
  EXPECT_EQ(series.Made, (std::vector<double>{ 0, 8, 16, 20 }));
}

TEST(GroupPlans, DoNotDependOnTheWay)
{
  Series forwards;
  Series backwards;
  forwards.At(0);
  backwards.At(20);
  std::vector<double> there;
  std::vector<double> back;
  for (int step = 1; step < Steps - 1; ++step)
  {
    there.push_back(forwards.DistanceAt(step));
    back.push_back(backwards.DistanceAt(Steps - 1 - step));
  }
  std::reverse(back.begin(), back.end());
  EXPECT_EQ(there, back);
}

TEST(GroupPlans, AStepThatIsNotLikeTheEndsIsPlannedByItself)
{
  Series series;
  series.At(0);
  EXPECT_EQ(series.DistanceAt(3), 4.0) << "values that neither end has";
  EXPECT_EQ(series.DistanceAt(13), 14.0) << "many more bricks";
  EXPECT_EQ(series.DistanceAt(12), 9.0);
}

/// A picture between two steps belongs to their group, and never stands for one of them.
TEST(GroupPlans, TimesBetweenStepsTakeThoseOfTheGroup)
{
  Series series;
  EXPECT_EQ(series.DistanceAt(7.5), 8.5) << "the first picture of the view";
  EXPECT_EQ(series.DistanceAt(7.25), 1.0);
  EXPECT_EQ(series.DistanceAt(8.0), 9.0);
  EXPECT_EQ(series.DistanceAt(8.5), 9.0);
  EXPECT_EQ(series.DistanceAt(19.5), 17.0);
  EXPECT_EQ(series.Made, (std::vector<double>{ 7.5, 0, 8, 16, 20 }));
}

} // namespace
