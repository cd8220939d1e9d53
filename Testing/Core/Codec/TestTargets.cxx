// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/CodecTesting.h"
#include "Targets.h"

namespace banyan::testing
{
namespace
{

TEST(Targets, AllOfThemGiveTheSameBits)
{
  const std::vector<std::int64_t> supported = targets::OfThisMachine();
  ASSERT_GE(supported.size(), 1u);
  RecordProperty("Targets", static_cast<int>(supported.size()));
  std::vector<block::Mode> modes;
  for (int mode = 0; mode < block::ModeCount; ++mode)
  {
    modes.push_back(block::ModeOf(mode));
  }
  for (const int edge : { 16, 32, -16, -32 })
  {
    const bool narrow = edge < 0;
    const int size = std::abs(edge);
    MixedPlanes planes({ size + 5, size + 1, 2 * size }, size, 11);
    const PlaneToEncode plane = narrow ? planes.NarrowWith(modes, true) : planes.With(modes, true);
    EncodedPlane first;
    for (const std::int64_t target : supported)
    {
      SCOPED_TRACE(std::string(hwy::TargetName(target)) + ", edge " + std::to_string(edge));
      const targets::OnlyTarget only(target);
      ASSERT_EQ(hwy::SupportedTargets() & target, target);
      const EncodedPlane encoded = EncodeWhole(plane);
      for (std::int64_t i = 0; i < planes.Target.BlockCount(); ++i)
      {
        const glm::ivec3 block = BlockAt(planes.Target, i);
        ASSERT_EQ(DecodeFast(encoded, MakeBox(encoded, block)), BoxNumbers(encoded.Decoded, block));
      }
      if (first.Payloads.empty())
      {
        first = encoded;
      }
      EXPECT_EQ(encoded.Payloads, first.Payloads);
      EXPECT_TRUE(encoded.Decoded == first.Decoded);
    }
  }
}

} // namespace
} // namespace banyan::testing
