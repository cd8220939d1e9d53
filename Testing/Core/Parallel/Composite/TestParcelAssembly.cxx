// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/ParcelAssembly.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

namespace
{

using namespace banyan;

Bytes Content(std::size_t bytes)
{
  Bytes content(bytes);
  std::iota(content.begin(), content.end(), std::uint8_t{ 3 });
  return content;
}

Bytes MessageOf(const Bytes& content, std::size_t begin, std::size_t end, int scene = 7)
{
  PictureParcel head;
  head.Scene = scene;
  head.Begin = static_cast<std::uint32_t>(begin);
  head.Bytes = static_cast<std::uint32_t>(content.size());
  Bytes message(sizeof(head) + end - begin);
  std::memcpy(message.data(), &head, sizeof(head));
  std::copy(content.data() + begin, content.data() + end, message.data() + sizeof(head));
  return message;
}

TEST(ParcelAssembly, PartsBecomeTheWhole)
{
  ParcelAssembly assembly;
  const auto take = [&](const Bytes& message)
  { return assembly.Take(message.data(), message.size()); };
  const Bytes content = Content(1000);
  EXPECT_FALSE(take(MessageOf(content, 0, 400)));
  EXPECT_FALSE(take(MessageOf(content, 400, 999)));
  const auto whole = take(MessageOf(content, 999, 1000, 8));
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->Content, content);
  EXPECT_EQ(whole->Head.Scene, 8) << "the last part says which scene it is";
  EXPECT_TRUE(take(MessageOf({}, 0, 0))) << "nothing is whole at once";
}

TEST(ParcelAssembly, ABeginningForgetsWhatWasBegun)
{
  ParcelAssembly assembly;
  const Bytes old = Content(900);
  const Bytes first = MessageOf(old, 0, 100);
  EXPECT_FALSE(assembly.Take(first.data(), first.size()));
  const Bytes content = Content(50);
  const Bytes all = MessageOf(content, 0, 50);
  const auto whole = assembly.Take(all.data(), all.size());
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->Content, content);
}

TEST(ParcelAssembly, WhatDoesNotFitIsAnError)
{
  const Bytes content = Content(100);
  for (const Bytes& wrong : { MessageOf(content, 50, 100), MessageOf(content, 30, 40) })
  {
    ParcelAssembly assembly;
    const Bytes first = MessageOf(content, 0, 20);
    EXPECT_FALSE(assembly.Take(first.data(), first.size()));
    EXPECT_THROW(assembly.Take(wrong.data(), wrong.size()), Error);
  }
  ParcelAssembly assembly;
  Bytes tooLong = MessageOf(content, 0, 100);
  tooLong.push_back(0);
  EXPECT_THROW(assembly.Take(tooLong.data(), tooLong.size()), Error);
}

TEST(ParcelAssembly, KnowsItsOwnMessages)
{
  Bytes message = MessageOf(Content(5), 0, 5);
  EXPECT_TRUE(ParcelAssembly::HeadOf(message.data(), message.size()));
  EXPECT_FALSE(ParcelAssembly::HeadOf(message.data(), sizeof(PictureParcel) - 1));
  message[0] = 9; // another version
  EXPECT_FALSE(ParcelAssembly::HeadOf(message.data(), message.size()));
}

} // namespace
