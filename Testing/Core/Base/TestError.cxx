// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/ScalarType.h"
#include "Base/Timer.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

namespace
{

using namespace banyan;

TEST(Error, SentenceAloneStaysAsItIs)
{
  EXPECT_STREQ(Error("The disk is full").what(), "The disk is full");
}

TEST(Error, PlaceIsPartOfTheMessage)
{
  const Error error("A brick is damaged", { "a.banyan", 16, 7, 9 });
  EXPECT_STREQ(error.what(),
    "A brick is damaged (file 'a.banyan', offset 16, found 7, expected or allowed 9)");
  EXPECT_EQ(error.Place().File, "a.banyan");
  EXPECT_EQ(error.Place().Offset, 16u);
  EXPECT_EQ(error.Place().Found, 7u);
  EXPECT_EQ(error.Place().Allowed, 9u);
}

TEST(Error, ZeroesAreShown)
{
  const Error error("Nothing there", { {}, {}, 0, {} });
  EXPECT_STREQ(error.what(), "Nothing there (found 0)");
  EXPECT_FALSE(error.Place().Offset.has_value());
}

TEST(Error, SurvivesItsPlace)
{
  std::string text;
  try
  {
    const std::string name = "temporary";
    throw Error("Gone", { name, {}, {}, {} });
  }
  catch (const std::runtime_error& error)
  {
    text = error.what();
  }
  EXPECT_EQ(text, "Gone (file 'temporary')");
}

TEST(ScalarType, NamesAndSizesRoundTrip)
{
  for (int i = 0; i < 10; ++i)
  {
    const auto type = static_cast<ScalarType>(i);
    EXPECT_EQ(ScalarTypeFromName(NameOf(type)), type);
    const auto size = Dispatch(type, [](auto tag) { return sizeof(typename decltype(tag)::Type); });
    EXPECT_EQ(SizeOf(type), size);
    const auto same =
      Dispatch(type, [](auto tag) { return ScalarTypeOf<typename decltype(tag)::Type>(); });
    EXPECT_EQ(same, type);
  }
  EXPECT_EQ(ScalarTypeOf<long>(), ScalarTypeOf<long long>());
  EXPECT_THROW(ScalarTypeFromName("float16"), Error);
  EXPECT_THROW(ScalarTypeFromName(""), Error);
  EXPECT_THROW(Dispatch(static_cast<ScalarType>(10), [](auto) { return 0; }), Error);
}

TEST(Timer, RunsForwardAndRestarts)
{
  Timer timer;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const Timer sinceThen;
  EXPECT_GE(timer.Seconds(), 0.02);
  timer.Restart();
  const double restarted = timer.Seconds();
  EXPECT_LE(restarted, sinceThen.Seconds());
}

} // namespace
