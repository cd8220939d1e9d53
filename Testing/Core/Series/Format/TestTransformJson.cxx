// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Bytes.h"
#include "Base/Error.h"
#include "Series/Format/TransformJson.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace banyan
{
namespace
{

Transform ThroughText(const Transform& transform)
{
  return TransformFromJson(Json::parse(TransformToJson(transform).dump(1)));
}

void ExpectSame(const Transform& a, const Transform& b)
{
  EXPECT_EQ(a.Kind(), b.Kind());
  EXPECT_EQ(BitCast<std::uint64_t>(a.Scale()), BitCast<std::uint64_t>(b.Scale()));
  ASSERT_EQ(a.Knots().size(), b.Knots().size());
  for (std::size_t i = 0; i < a.Knots().size(); ++i)
  {
    for (const auto column : { &TransformKnot::X, &TransformKnot::Y })
    {
      EXPECT_EQ(
        BitCast<std::uint64_t>(a.Knots()[i].*column), BitCast<std::uint64_t>(b.Knots()[i].*column));
    }
  }
  EXPECT_TRUE(a == b);
}

TEST(TransformJson, ComesBackBitExact)
{
  std::mt19937_64 random(41);
  ExpectSame(Transform(), ThroughText(Transform()));
  ExpectSame(Transform::Table({ { -0.0, 1e-310 }, { 1e-250, 0.1 } }),
    ThroughText(Transform::Table({ { -0.0, 1e-310 }, { 1e-250, 0.1 } })));
  for (int i = 0; i < 200; ++i)
  {
    const double scale = std::exp2(std::uniform_real_distribution<>(-1000, 1000)(random));
    ExpectSame(Transform::Asinh(scale), ThroughText(Transform::Asinh(scale)));
    std::vector<TransformKnot> knots = { { -scale, std::sqrt(scale) } };
    for (int k = 0; k < 20; ++k)
    {
      const auto more = [&](double from)
      { return from + std::abs(from) * std::uniform_real_distribution<>(0.1, 1.1)(random); };
      knots.push_back({ more(knots.back().X), more(knots.back().Y) });
    }
    const double magnitude = std::abs(std::log2(scale));
    if (magnitude < 800)
    {
      ExpectSame(Transform::Table(knots), ThroughText(Transform::Table(knots)));
    }
  }
  EXPECT_FALSE(Transform::Asinh(1.0) == Transform::Asinh(2.0));
  EXPECT_TRUE(Transform::Asinh(1.0) != Transform());
  EXPECT_FALSE(
    Transform::Table({ { 0, 0 }, { 1, 1 } }) == Transform::Table({ { 0, 0 }, { 1, 2 } }));
}

void ExpectRejected(const std::string& text, const std::string& word)
{
  try
  {
    (void)TransformFromJson(Json::parse(text));
    ADD_FAILURE() << "accepted: " << text;
  }
  catch (const Error& failure)
  {
    EXPECT_NE(std::string(failure.what()).find(word), std::string::npos) << failure.what();
  }
}

TEST(TransformJson, SaysWhatIsWrong)
{
  ExpectRejected("null", "'transform'");
  ExpectRejected("[]", "'transform'");
  ExpectRejected("{}", "'kind' is missing");
  ExpectRejected(R"({"kind": 3})", "'kind'");
  ExpectRejected(R"({"kind": "cubic"})", "'cubic' is not known");
  ExpectRejected(R"({"kind": "asinh"})", "'scale' is missing");
  ExpectRejected(R"({"kind": "asinh", "scale": "1"})", "'scale'");
  ExpectRejected(R"({"kind": "asinh", "scale": 0})", "scale of an asinh");
  ExpectRejected(R"({"kind": "asinh", "scale": -1.5})", "scale of an asinh");
  ExpectRejected(R"({"kind": "asinh", "scale": 1e305})", "scale of an asinh");
  ExpectRejected(R"({"kind": "table", "x": [0, 1]})", "'y' is missing");
  ExpectRejected(R"({"kind": "table", "x": 0, "y": [0, 1]})", "'x'");
  ExpectRejected(R"({"kind": "table", "x": [0, 1], "y": [0, 1, 2]})", "'y'");
  ExpectRejected(R"({"kind": "table", "x": [0, null], "y": [0, 1]})", "'x'");
  ExpectRejected(R"({"kind": "table", "x": [0], "y": [0]})", "2 to 4096");
  ExpectRejected(R"({"kind": "table", "x": [0, 0], "y": [0, 1]})", "increase strictly");
  ExpectRejected(R"({"kind": "table", "x": [0, 1], "y": [1, 0]})", "increase strictly");
  ExpectRejected(R"({"kind": "table", "x": [0, 1e302], "y": [0, 1]})", "beyond 2^1000");
  Json many;
  many["kind"] = "table";
  for (int i = 0; i < 4097; ++i)
  {
    many["x"].push_back(i);
    many["y"].push_back(i);
  }
  ExpectRejected(many.dump(), "too many knots");
}

/// Whatever is accepted must be a transform that works.
TEST(TransformJson, NonsenseIsRejectedOrWorks)
{
  std::mt19937 random(42);
  const std::string good[] = { R"({"kind": "asinh", "scale": 0.125})",
    R"({"kind": "table", "x": [-1.5, 0, 3e2, 4e2], "y": [0.25, 1, 2, 70]})" };
  int accepted = 0;
  for (int i = 0; i < 4000; ++i)
  {
    std::string text = good[i % 2];
    for (unsigned k = 0; k <= random() % 3; ++k)
    {
      const char* const parts[] = { "0", "-", "9", "\"", "[", "]", "{", "}", ",", "null", "1e308",
        "e", ".", "\xff", "99999999999999999999" };
      text.replace(random() % text.size(), random() % 3, parts[random() % 15]);
    }
    try
    {
      const Transform transform = TransformFromJson(Json::parse(text));
      EXPECT_LE(transform.Inverse(-1.0), transform.Inverse(1.0)) << text;
      EXPECT_TRUE(std::isfinite(transform.Inverse(0.5))) << text;
      ++accepted;
    }
    catch (const Error&)
    {
    }
    catch (const Json::exception&)
    {
    }
  }
  EXPECT_GT(accepted, 20);
  EXPECT_LT(accepted, 3000);
}

} // namespace
} // namespace banyan
