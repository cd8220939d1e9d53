// SPDX-License-Identifier: BSD-3-Clause
// Which steps of a series that plays are planned, and which take the plans of others.
#include "Parallel/Frame/GroupPlans.h"
#include "Render/Sampling/ChosenPlan.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr int Steps = 21;
constexpr Hash128 View{ 1, 2 };
constexpr double Tolerance = 8.0;

/// A plan with that distance: longer ones are not allowed.
SamplingPlan PlanOf(double distance, double error)
{
  auto basis = std::make_shared<PlanBasis>(
    PlanBasis{ SamplingChoices(2.0), { Tolerance, 2.0 }, glm::ivec2(32) });
  basis->Choices.Levels = { { 0.0, { { error } } } };
  for (double longer = Steps; longer >= 1.0; longer -= 0.5)
  {
    basis->Choices.Distances.push_back({ longer, { { longer > distance ? Tolerance : 0.0 } } });
  }
  basis->Choices.Strides = { { 1.0, { { 0.0 } } } };
  SamplingPlan plan = ChoosePlan({ basis });
  plan.Probes = 7;
  return plan;
}

double DistanceOf(const SamplingPlan& plan)
{
  return plan.Samplings->At({ 0, 0 }).Distance;
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
    return this->Plans.Of(view, step, Steps, SignsAt(step),
      [&](double planned) -> GroupPlans::End
      {
        this->Made.push_back(planned);
        return { PlanOf(planned + 1.0, 0.1 * planned), SignsAt(planned) };
      });
  }

  double DistanceAt(double step) { return DistanceOf(this->At(step)); }
};

TEST(GroupPlans, TheFirstPictureOfAViewHasAPlanOfItsOwn)
{
  Series series;
  EXPECT_EQ(series.DistanceAt(5), 6.0);
  EXPECT_EQ(series.DistanceAt(5), 6.0) << "nobody plays it yet";
  EXPECT_EQ(series.Made, std::vector<double>{ 5 });
  EXPECT_EQ(DistanceOf(series.At(6, { 3, 4 })), 7.0) << "another view";
  EXPECT_EQ(series.DistanceAt(6), 7.0) << "and the first one again";
}

TEST(GroupPlans, StepsTakeThoseOfTheEndsOfTheirGroup)
{
  Series series;
  series.At(0);
  const SamplingPlan second = series.At(1);
  EXPECT_EQ(DistanceOf(second), 1.0);
  EXPECT_DOUBLE_EQ(second.EstimatedError, 0.8 + Tolerance * ShareOfEnds);
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
