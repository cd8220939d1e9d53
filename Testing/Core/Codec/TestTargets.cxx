#include "Codec/CodecTesting.h"

#include <hwy/targets.h>

namespace banyan::testing
{
namespace
{

/// Dispatches to one set of instructions only, until it goes.
class OnlyTarget
{
public:
  explicit OnlyTarget(std::int64_t target)
  {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ~OnlyTarget()
  {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;
};

/// All that this machine can run, the poorest included.
std::vector<std::int64_t> TargetsOfThisMachine()
{
  std::vector<std::int64_t> targets;
  const std::int64_t supported = hwy::SupportedTargets();
  for (int bit = 0; bit < 63; ++bit)
  {
    if ((supported >> bit & 1) != 0)
    {
      targets.push_back(std::int64_t{ 1 } << bit);
    }
  }
  return targets;
}

TEST(Targets, AllOfThemGiveTheSameBits)
{
  const std::vector<std::int64_t> targets = TargetsOfThisMachine();
  ASSERT_GE(targets.size(), 1u);
  RecordProperty("Targets", static_cast<int>(targets.size()));
  std::vector<block::Mode> modes;
  for (int mode = 0; mode < block::ModeCount; ++mode)
  {
    modes.push_back(block::ModeOf(mode));
  }
  for (const int edge : { 8, 16, 32, 64, -16, -32 })
  {
    const bool narrow = edge < 0;
    const int size = std::abs(edge);
    MixedPlanes planes({ size + 5, size + 1, size == 64 ? 9 : 2 * size }, size, 11);
    const PlaneToEncode plane = narrow ? planes.NarrowWith(modes, true) : planes.With(modes, true);
    EncodedPlane first;
    for (const std::int64_t target : targets)
    {
      SCOPED_TRACE(std::string(hwy::TargetName(target)) + ", edge " + std::to_string(edge));
      const OnlyTarget only(target);
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
      EXPECT_EQ(encoded.Decoded.Numbers, first.Decoded.Numbers);
    }
  }
}

} // namespace
} // namespace banyan::testing
