// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Box.h"

#include <gtest/gtest.h>

namespace
{

using banyan::Box;

TEST(Box, CountsIn64Bits)
{
  const Box box{ { 0, 0, 0 }, { 4096, 4096, 4096 } };
  EXPECT_EQ(box.Count(), std::int64_t{ 1 } << 36);
  EXPECT_FALSE(box.Empty());
}

TEST(Box, EmptyAlongOneAxisIsEmpty)
{
  const Box flat{ { 0, 0, 3 }, { 5, 5, 3 } };
  EXPECT_TRUE(flat.Empty());
  EXPECT_EQ(flat.Count(), 0);
  EXPECT_EQ(flat.Size(), glm::ivec3(5, 5, 0));
  const Box inverted{ { 2, 2, 2 }, { 1, 3, 3 } };
  EXPECT_TRUE(inverted.Empty());
  EXPECT_EQ(inverted.Size(), glm::ivec3(0, 1, 1));
}

TEST(Box, ContainsIsHalfOpen)
{
  const Box box{ { 1, 2, 3 }, { 4, 5, 6 } };
  EXPECT_TRUE(box.Contains(glm::ivec3(1, 2, 3)));
  EXPECT_TRUE(box.Contains(glm::ivec3(3, 4, 5)));
  EXPECT_FALSE(box.Contains(glm::ivec3(4, 4, 5)));
  EXPECT_FALSE(box.Contains(glm::ivec3(0, 4, 5)));
  EXPECT_TRUE(box.Contains(box));
  EXPECT_TRUE(box.Contains(Box{ { 9, 9, 9 }, { 9, 9, 9 } })); // nothing is in everything
  EXPECT_FALSE(box.Contains(Box{ { 1, 2, 3 }, { 4, 5, 7 } }));
}

TEST(Box, IntersectionAndUnion)
{
  const Box a{ { 0, 0, 0 }, { 4, 4, 4 } };
  const Box b{ { 2, 3, 1 }, { 6, 6, 2 } };
  EXPECT_EQ(Intersection(a, b), (Box{ { 2, 3, 1 }, { 4, 4, 2 } }));
  EXPECT_EQ(Union(a, b), (Box{ { 0, 0, 0 }, { 6, 6, 4 } }));
  const Box nothing{ { 9, 9, 9 }, { 9, 10, 10 } };
  EXPECT_TRUE(Intersection(a, nothing).Empty());
  EXPECT_EQ(Union(a, nothing), a);
  EXPECT_EQ(Union(nothing, b), b);
  EXPECT_TRUE(a != b);
}

} // namespace
