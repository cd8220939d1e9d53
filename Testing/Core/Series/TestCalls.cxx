// SPDX-License-Identifier: BSD-3-Clause
// What is asked for in a wrong way, or interrupted, is an error.
#include "Series/ContainerTesting.h"

namespace banyan::testing
{
namespace
{

TEST(Calls, BadCallsAreRejected)
{
  const TemporaryFolder folder;
  ThreadPool pool(1);
  const auto steps = SmallSteps(2);
  const ArrayDescription good = Describe(steps);
  const auto make =
    [&](const Grid& grid, std::vector<ArrayDescription> arrays, const EncodeOptions& options)
  { SeriesEncoder encoder(folder / "bad.banyan", grid, arrays, options, pool); };
  const auto with = [](auto&& change)
  {
    EncodeOptions options;
    change(options);
    return options;
  };
  EXPECT_THROW(make(Small, {}, {}), Error);
  EXPECT_THROW(make(GridOf(0, 1, 1), { good }, {}), Error);
  EXPECT_THROW(make(Small, { good, good }, {}), Error);
  EXPECT_THROW(make(Small, { good }, with([](auto& o) { o.ErrorBound = -1; })), Error);
  EXPECT_THROW(make(Small, { good }, with([](auto& o) { o.ErrorBound = NAN; })), Error);
  EXPECT_THROW(make(Small, { good }, with([](auto& o) { o.KeyframeInterval = 0; })), Error);
  for (const int cells : { 8, 12, 64 })
  {
    EXPECT_THROW(make(Small, { good }, with([cells](auto& o) { o.BrickCells = cells; })), Error);
  }
  EXPECT_THROW(make(Small, { good }, with([](auto& o) { o.CompressionLevel = 20; })), Error);
  ArrayDescription bad = good;
  bad.SeriesRanges.clear();
  EXPECT_THROW(make(Small, { bad }, {}), Error);
  bad.SeriesRanges = { { 0, INFINITY } };
  EXPECT_THROW(make(Small, { bad }, {}), Error);
  bad = good;
  bad.ComponentNames.clear();
  EXPECT_THROW(make(Small, { bad }, {}), Error);
  EXPECT_TRUE(folder.Empty()) << "rejected before anything was written";
  EXPECT_THROW(SeriesEncoder(folder / "no/folder/s.banyan", Small, { good }, {}, pool), Error);

  SeriesEncoder late(folder / "s.banyan", Small, { good }, {}, pool);
  late.AddStep(1, { { steps[0].data() } });
  EXPECT_THROW(late.AddStep(1, { { steps[1].data() } }), Error);
  EXPECT_THROW(late.Finish(), Error);
  SeriesEncoder empty(folder / "e.banyan", Small, { good }, {}, pool);
  EXPECT_THROW(empty.Finish(), Error);
  SeriesEncoder few(folder / "f.banyan", Small, { good }, {}, pool);
  EXPECT_THROW(few.AddStep(0, {}), Error);
  SeriesEncoder null(folder / "n.banyan", Small, { good }, {}, pool);
  EXPECT_THROW(null.AddStep(0, { { nullptr } }), Error);
}

TEST(Calls, ProgressRisesAndInterrupts)
{
  const TemporaryFolder folder;
  ThreadPool pool(2);
  const auto steps = SmallSteps(1);
  SeriesEncoder encoder(folder / "s.banyan", Small, { Describe(steps) }, {}, pool);
  double last = 0;
  int calls = 0;
  encoder.SetProgress(
    [&](double done)
    {
      EXPECT_GT(done, last);
      EXPECT_LT(done, 1);
      last = done;
      return ++calls < 2;
    });
  ExpectError(
    [&]
    {
      encoder.AddStep(0, { { steps[0].data() } });
      encoder.Finish();
    },
    "interrupted");
  EXPECT_EQ(calls, 2);
}

TEST(Calls, QuestionsBeyondTheSeriesAreErrors)
{
  const TemporaryFolder folder;
  Encode(folder / "s.banyan", Small, SmallSteps(3), TwoPerSegment());
  const auto file = SeriesFile::Open(folder / "s.banyan");
  std::vector<float> room(17 * 17 * 17);
  for (const FieldKey& field : { FieldKey{ 3, 0, 0, 0 }, FieldKey{ -1, 0, 0, 0 },
         FieldKey{ 0, 1, 0, 0 }, FieldKey{ 0, -1, 0, 0 }, FieldKey{ 0, 0, 1, 0 },
         FieldKey{ 0, 0, -1, 0 }, FieldKey{ 0, 0, 0, 9 }, FieldKey{ 0, 0, 0, -1 } })
  {
    EXPECT_THROW((void)file->Nodes(field), Error);
    EXPECT_THROW(file->DecodeBrick(field, 0, room.data()), Error);
  }
  EXPECT_THROW(file->DecodeBrick({}, -1, room.data()), Error);
  EXPECT_THROW(file->DecodeBrick({}, file->Layout(0).BrickCount(), room.data()), Error);
  EXPECT_THROW(file->VerifyBricks({}, { 0, 99 }), Error);
  EXPECT_THROW((void)file->Layout(9), Error);
  EXPECT_THROW((void)file->MaskRangeOf(0, 1), Error);
}

} // namespace
} // namespace banyan::testing
