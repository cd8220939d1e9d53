// SPDX-License-Identifier: BSD-3-Clause
// Transfer functions with steps, and shells thinner than a cell: is the error still below the
// estimate?
#include "ConvergedImage.h"
#include "Picture.h"
#include "PlanTesting.h"
#include "StandardScenes.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace banyan;
using namespace banyan::bench;
using namespace banyan::plan_testing;

namespace
{

using Opacity = double (*)(int entry); // of 256

struct Function
{
  const char* Name;
  Opacity Of;
};

const Function Functions[] = {
  { "a step of one code", [](int entry) { return entry < 80 ? 0.0 : 0.3; } },
  { "a step to nearly opaque", [](int entry) { return entry < 80 ? 0.0 : 0.999999; } },
  { "nearly opaque", [](int) { return 0.999; } },
  { "a shell", [](int entry) { return entry >= 100 && entry < 104 ? 0.5 : 0.0; } },
  { "a shell of one code", [](int entry) { return entry == 100 ? 0.9 : 0.0; } },
  { "many shells", [](int entry) { return entry % 32 == 0 ? 0.6 : 0.0; } },
};

class HardFunctionsPlan : public testing::TestWithParam<int>
{
};

TEST_P(HardFunctionsPlan, TheErrorStaysBelowTheEstimate)
{
  const Function& function = Functions[GetParam()];
  ThreadPool pool(2);
  BenchScene scene = StandardScene(StandardVolume(64, pool), StandardFunction::S1, false, 192);
  for (std::size_t i = 0; i < scene.Nodes.size(); ++i)
  {
    scene.Nodes[i].a = function.Of(static_cast<int>(i));
  }
  scene.UnitDistance = 1.0;
  const FloatImage converged = Drawer(scene).Converged();
  for (const double tolerance : { 0.5, 2.0, 8.0, 32.0 })
  {
    Drawer drawer(scene);
    const SamplingPlan plan = drawer.Plan(tolerance, 2);
    const double error = ErrorOf(drawer.Draw(plan), converged).Largest;
    EXPECT_LE(error, plan.EstimatedError) << function.Name << " at a tolerance of " << tolerance;
  }
}

INSTANTIATE_TEST_SUITE_P(
  SamplingPlan, HardFunctionsPlan, testing::Range(0, static_cast<int>(std::size(Functions))));

} // namespace
