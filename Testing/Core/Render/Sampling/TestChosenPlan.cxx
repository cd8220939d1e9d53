// SPDX-License-Identifier: BSD-3-Clause
// Which sampling tiles get that one scene, or two, may be drawn with.
#include "Render/Sampling/ChosenPlan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{

using namespace banyan;

constexpr double Tolerance = 8.0; // 7 are allowed
const glm::ivec2 ImageSize{ 64, 32 };

/// Values, and the errors of both tiles.
struct Row
{
  double Value;
  double Left;
  double Right;
};

std::vector<Choice> ChoicesOf(const std::vector<Row>& rows)
{
  std::vector<Choice> choices;
  for (const Row& row : rows)
  {
    choices.push_back({ row.Value, { { row.Left, row.Right } } });
  }
  return choices;
}

std::shared_ptr<PlanBasis> BasisOf(const std::vector<Row>& levels,
  const std::vector<Row>& distances, const std::vector<Row>& strides = { { 1, 0, 0 } })
{
  auto basis = std::make_shared<PlanBasis>(
    PlanBasis{ SamplingChoices(1.0), { Tolerance, 1.0, 3 }, ImageSize });
  basis->Choices.Levels = ChoicesOf(levels);
  basis->Choices.Distances = ChoicesOf(distances);
  basis->Choices.Strides = ChoicesOf(strides);
  return basis;
}

SamplingPlan PlanOf(const std::shared_ptr<PlanBasis>& basis)
{
  return ChoosePlan({ basis });
}

RaySampling At(const SamplingPlan& plan, int tile)
{
  return plan.Samplings->At({ tile, 0 });
}

TEST(ChosenPlan, GivesEachTileTheCheapestThatIsAllowed)
{
  const auto basis = BasisOf({ { 1, 5, 9 }, { 0, 0, 0 } }, { { 4, 4, 6 }, { 2, 2, 1 } });
  const SamplingPlan plan = PlanOf(basis);
  EXPECT_TRUE((At(plan, 0) == RaySampling{ 0, 4.0, 1 })) << "5 and 4 would be too much";
  EXPECT_TRUE((At(plan, 1) == RaySampling{ 0, 4.0, 1 }));
  EXPECT_DOUBLE_EQ(plan.EstimatedError, 6.0 + Tolerance * ShareOfEnds);
  EXPECT_EQ(plan.Limit, SamplingLimit::None);
  EXPECT_EQ(plan.Basis, basis);
}

TEST(ChosenPlan, SaysWhereNothingIsGoodEnough)
{
  const SamplingPlan plan = PlanOf(BasisOf({ { 0, 0, 0 } }, { { 2, 1, 30 }, { 1, 0, 20 } }));
  EXPECT_TRUE((At(plan, 1) == RaySampling{ 0, 1.0, 1 })) << "the smallest error";
  EXPECT_DOUBLE_EQ(plan.EstimatedError, 21.0);
  EXPECT_EQ(plan.Limit, SamplingLimit::Distance);
}

/// One scene takes a coarse level and close samples, the other one a fine level and few. Both may
/// be drawn with the second: none needs a fine level and close samples.
TEST(SharedPlan, IsNotAsFineAsBothWhereOneOfThemWillDo)
{
  const SamplingPlan a =
    PlanOf(BasisOf({ { 3, 0, 0 }, { 0, 0, 0 } }, { { 2, 6, 9 }, { 1, 0, 0 } }));
  const SamplingPlan b =
    PlanOf(BasisOf({ { 3, 9, 9 }, { 0, 0, 0 } }, { { 2, 0, 0 }, { 1, 0, 0 } }));
  EXPECT_TRUE((At(a, 0) == RaySampling{ 3, 2.0, 1 }));
  EXPECT_TRUE((At(a, 1) == RaySampling{ 3, 1.0, 1 }));
  EXPECT_TRUE((At(b, 0) == RaySampling{ 0, 2.0, 1 }));
  const SamplingPlan shared = SharedPlan(a, b);
  EXPECT_TRUE((At(shared, 0) == RaySampling{ 0, 2.0, 1 })) << "6 is allowed in the first scene";
  EXPECT_TRUE((At(shared, 1) == RaySampling{ 0, 1.0, 1 }));
  EXPECT_DOUBLE_EQ(shared.EstimatedError, 7.0);
}

/// A scene that was content with a value says nothing of finer ones, and nothing of longer ones.
TEST(SharedPlan, KnowsValuesThatOneSceneDidNotTry)
{
  const SamplingPlan a = PlanOf(BasisOf(
    { { 2, 0, 1 } }, { { 4, 0, 5 }, { 2, 0, 3 } }, { { 1, 0, 0 }, { 2, 0, 0 }, { 4, 0, 0 } }));
  const SamplingPlan b = PlanOf(BasisOf({ { 3, 0, 9 }, { 2, 0, 8 }, { 1, 0, 2 } },
    { { 8, 0, 9 }, { 1, 0, 0 } }, { { 1, 0, 0 }, { 2, 0, 0 } }));
  const SamplingPlan shared = SharedPlan(a, b);
  EXPECT_TRUE((At(shared, 0) == RaySampling{ 2, 4.0, 2 })) << "as far as both say something";
  EXPECT_TRUE((At(shared, 1) == RaySampling{ 1, 1.0, 2 }));
  EXPECT_DOUBLE_EQ(shared.EstimatedError, 5.0) << "that of the first scene's level 2, distance 2";
}

TEST(SharedPlan, IsTheOtherOneWhereNothingWasSeen)
{
  const SamplingPlan plan = PlanOf(BasisOf({ { 0, 0, 0 } }, { { 1, 0, 0 } }));
  SamplingPlan blank;
  blank.OpacityLimit = 0.9995f;
  blank.Probes = 3;
  EXPECT_EQ(SharedPlan(plan, blank).Samplings, plan.Samplings);
  EXPECT_EQ(SharedPlan(blank, plan).Samplings, plan.Samplings);
  EXPECT_EQ(SharedPlan(blank, plan).OpacityLimit, blank.OpacityLimit);
  EXPECT_EQ(SharedPlan(blank, blank).Samplings, nullptr);
  EXPECT_EQ(SharedPlan(blank, blank).Probes, 0);
}

/// Errors that fall from one value to the next; the last has none.
std::vector<Row> RandomRows(std::mt19937& random, std::vector<double> values)
{
  std::uniform_real_distribution<double> part(0.2, 1.0);
  std::uniform_real_distribution<double> first(0.0, 20.0);
  std::vector<Row> rows;
  Row row{ 0.0, first(random), first(random) };
  for (const double value : values)
  {
    row.Value = value;
    rows.push_back(row);
    row.Left *= part(random);
    row.Right *= part(random);
  }
  rows.back().Left = rows.back().Right = 0.0;
  return rows;
}

std::shared_ptr<PlanBasis> RandomBasis(std::mt19937& random)
{
  return BasisOf(RandomRows(random, { 3, 2, 1, 0 }), RandomRows(random, { 8, 4, 2, 1, 0.5 }),
    { { 1, 0, 0 }, { 2, 1, 2 }, { 4, 5, 9 } });
}

double ErrorIn(const SamplingPlan& plan, const RaySampling& sampling, int tile)
{
  return plan.Basis->Choices.ErrorOf(
    *plan.Basis->Choices.NoFinerThan(sampling), static_cast<std::size_t>(tile));
}

RaySampling AsFineAsBoth(const RaySampling& a, const RaySampling& b)
{
  return { std::min(a.Level, b.Level), std::min(a.Distance, b.Distance),
    std::min(a.PixelStride, b.PixelStride) };
}

TEST(SharedPlan, IsTheCheapestThatIsAllowedInBoth)
{
  std::mt19937 random(3);
  int cheaper = 0;
  for (int trial = 0; trial < 200; ++trial)
  {
    const SamplingPlan a = PlanOf(RandomBasis(random));
    const SamplingPlan b = PlanOf(RandomBasis(random));
    const SamplingPlan shared = SharedPlan(a, b);
    const SamplingChoices& choices = a.Basis->Choices;
    for (int tile = 0; tile < 2; ++tile)
    {
      const auto errorOf = [&](const RaySampling& sampling)
      { return std::max(ErrorIn(a, sampling, tile), ErrorIn(b, sampling, tile)); };
      const std::vector<SamplingChoices::Chosen> order = choices.CheapestFirst();
      const auto best = std::find_if(order.begin(), order.end(),
        [&](const SamplingChoices::Chosen& chosen)
        { return errorOf(choices.SamplingOf(chosen)) <= AllowedError(a.Basis->Wish); });
      ASSERT_NE(best, order.end());
      EXPECT_TRUE(At(shared, tile) == choices.SamplingOf(*best)) << trial;
      const RaySampling finest = AsFineAsBoth(At(a, tile), At(b, tile));
      EXPECT_LE(errorOf(finest), AllowedError(a.Basis->Wish)) << "it is among them";
      cheaper += At(shared, tile) == finest ? 0 : 1;
    }
    EXPECT_LE(shared.EstimatedError, Tolerance);
  }
  EXPECT_GT(cheaper, 40);
}

} // namespace
