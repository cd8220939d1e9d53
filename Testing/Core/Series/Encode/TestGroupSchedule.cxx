// SPDX-License-Identifier: BSD-3-Clause
// How many steps each rank receives that encodes groups of a series.
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Encode/EncodePlan.h"
#include "Series/Encode/GroupSchedule.h"

namespace banyan::testing
{
namespace
{

constexpr int Interval = 4;
const Grid Domain = GridOf(9, 7, 8);

EncodeOptions Options(bool closed)
{
  EncodeOptions options;
  options.KeyframeInterval = Interval;
  options.ClosedGroups = closed;
  return options;
}

/// A series with ranges; without them where the bound is absolute.
SeriesIndex Plan(const EncodeOptions& options)
{
  ArrayDescription array{ "a", ScalarType::Float32, { "" }, {} };
  if (options.Mode == ErrorBoundMode::RelativeToSeriesRange)
  {
    array.SeriesRanges.assign(1, ValueRange{ -40.0, 90.0 });
  }
  return PlanSeries(Domain, { array }, options);
}

/// By rank: the steps of its groups, and those before them.
std::vector<int> StepsReceived(const EncodeOptions& options, int steps, int ranks)
{
  const GroupSchedule deal(Plan(options), options, steps, ranks);
  std::vector<int> received(static_cast<std::size_t>(ranks), 0);
  for (int step = 0; step < steps; ++step)
  {
    ++received[static_cast<std::size_t>(deal.OwnerOf(deal.GroupOf(step)))];
    if (deal.NeedsBefore(step) >= 0)
    {
      ++received[static_cast<std::size_t>(deal.NeedsBefore(step))];
    }
  }
  return received;
}

using Counts = std::vector<int>;

TEST(GroupSchedule, RanksReceiveOneStepMoreForEachGroupThatRefersBefore)
{
  // Groups of steps 0-3, 4-7, 8-11, 12-15, 16-17.
  EXPECT_EQ(StepsReceived(Options(false), 18, 1), Counts({ 18 }));
  EXPECT_EQ(StepsReceived(Options(false), 18, 2), Counts({ 10 + 2, 8 + 2 }));
  EXPECT_EQ(StepsReceived(Options(false), 18, 3), Counts({ 8 + 1, 6 + 2, 4 + 1 }));
  EXPECT_EQ(StepsReceived(Options(false), 18, 6), Counts({ 4, 5, 5, 5, 3, 0 }));
  // The group of step 16 is a key frame alone.
  EXPECT_EQ(StepsReceived(Options(false), 17, 2), Counts({ 9 + 1, 8 + 2 }));
}

TEST(GroupSchedule, RanksReceiveTheirOwnStepsAloneWhereGroupsAreClosed)
{
  EXPECT_EQ(StepsReceived(Options(true), 18, 1), Counts({ 18 }));
  EXPECT_EQ(StepsReceived(Options(true), 18, 2), Counts({ 10, 8 }));
  EXPECT_EQ(StepsReceived(Options(true), 18, 3), Counts({ 8, 6, 4 }));
  EXPECT_EQ(StepsReceived(Options(true), 18, 6), Counts({ 4, 4, 4, 4, 2, 0 }));
}

TEST(GroupSchedule, RanksReceiveTheirOwnStepsAloneWhereNoLatticeIsFixed)
{
  EncodeOptions options = Options(false);
  options.Mode = ErrorBoundMode::Absolute;
  options.ErrorBound = 0.1;
  EXPECT_EQ(StepsReceived(options, 18, 3), Counts({ 8, 6, 4 }));
  options = Options(false);
  options.KeyframeInterval = 1;
  EXPECT_EQ(StepsReceived(options, 7, 3), Counts({ 3, 2, 2 }));
}

/// The reference: a group that is encoded without the step before it asks for that, or does not.
TEST(GroupSchedule, AgreesWithTheEncoder)
{
  for (const bool closed : { false, true })
  {
    for (const int count : { 9, 10, 12 })
    {
      const EncodeOptions options = Options(closed);
      const SeriesIndex plan = Plan(options);
      const auto values = Sample<float>(Domain, count, Wavy<float>);
      const GroupSchedule deal(plan, options, count, count);
      const TemporaryFolder folder;
      SegmentFolder segments(folder / "s.banyan");
      ThreadPool pool(1);
      for (int first = Interval; first < count; first += Interval)
      {
        std::vector<double> times;
        std::vector<std::vector<ArrayValues>> steps;
        for (int s = first; s < std::min(first + Interval, count); ++s)
        {
          times.push_back(s);
          steps.push_back({ { values[static_cast<std::size_t>(s)].data() } });
        }
        const int group = deal.GroupOf(first);
        const auto encode = [&] {
          EncodeGroup(plan, options, segments, { group, times, steps, {} }, nullptr, pool, nullptr);
        };
        if (deal.NeedsBefore(first - 1) >= 0)
        {
          EXPECT_EQ(deal.NeedsBefore(first - 1), deal.OwnerOf(group));
          EXPECT_THROW(encode(), Error) << group << " of " << count << " steps";
        }
        else
        {
          EXPECT_NO_THROW(encode()) << group << " of " << count << " steps";
        }
      }
    }
  }
}

} // namespace
} // namespace banyan::testing
