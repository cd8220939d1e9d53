// SPDX-License-Identifier: BSD-3-Clause
// What makes inputs differ, and who hears of it.
#include "Parallel/Fields/InputStamp.h"

#include "Parallel/Communicate/Communicator.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace banyan;

struct Object
{
  unsigned long Time = 1;
  unsigned long GetMTime() const { return this->Time; }
};

InputStamp StampOf(const Object* object, double number = 0.5, const std::string& text = "array")
{
  InputStamp stamp;
  stamp.AddObject(object);
  stamp.Add(number);
  stamp.Add(text);
  return stamp;
}

TEST(InputStamp, TellsObjectsTimesNumbersAndTextsApart)
{
  Object object;
  const Object other;
  const InputStamp first = StampOf(&object);
  EXPECT_EQ(first, StampOf(&object));
  EXPECT_NE(first, StampOf(&other));
  EXPECT_NE(first, StampOf(nullptr));
  EXPECT_NE(first, StampOf(&object, 0.25));
  EXPECT_NE(first, StampOf(&object, 0.5, "arrays"));
  EXPECT_NE(first, InputStamp());
  object.Time = 2;
  EXPECT_NE(first, StampOf(&object));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(StampOf(&object, nan), StampOf(&object, nan));
  InputStamp together;
  together.Add(std::string("ab"));
  together.Add(std::string("c"));
  InputStamp apart;
  apart.Add(std::string("a"));
  apart.Add(std::string("bc"));
  EXPECT_NE(together, apart);
}

TEST(InputStamp, AllRanksHearThatOneHasChanged)
{
  RunOnSimulatedRanks(3,
    [](Communicator& communicator)
    {
      Object object;
      InputStamp stamp;
      EXPECT_TRUE(stamp.Become(communicator, StampOf(&object))) << "nothing was known";
      EXPECT_FALSE(stamp.Become(communicator, StampOf(&object)));
      object.Time += communicator.Rank() == 1 ? 1 : 0;
      EXPECT_TRUE(stamp.Become(communicator, StampOf(&object)));
      EXPECT_FALSE(stamp.Become(communicator, StampOf(&object)));
      stamp = communicator.Rank() == 2 ? InputStamp() : stamp;
      EXPECT_TRUE(stamp.Become(communicator, StampOf(&object)));
    });
}

} // namespace
