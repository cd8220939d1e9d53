// SPDX-License-Identifier: BSD-3-Clause
// A sample in a hidden cell has no colour; its neighbours are drawn as ever.
#include "Base/Error.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Scenes.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

using Flags = std::vector<std::uint8_t>;
constexpr std::uint8_t HiddenBit = 32;

std::size_t At(const glm::ivec3& p, const glm::ivec3& n)
{
  return p.x + std::size_t(n.x) * (p.y + std::size_t(n.y) * p.z);
}

/// Calls function(cell) for all of some.
template <class Function>
void ForAll(const glm::ivec3& cells, Function&& function)
{
  for (int z = 0; z < cells.z; ++z)
  {
    for (int y = 0; y < cells.y; ++y)
    {
      for (int x = 0; x < cells.x; ++x)
      {
        function(glm::ivec3(x, y, z));
      }
    }
  }
}

int Between(std::mt19937& random, int low, int high)
{
  return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
}

/// Single cells, boxes, walls, everything but a little, or everything; other flags among them.
Flags RandomFlags(std::mt19937& random, const glm::ivec3& cells)
{
  Flags flags(At({ 0, 0, cells.z }, cells), 0);
  const int kind = Between(random, 0, 5);
  const glm::ivec3 low(Between(random, 0, cells.x - 1), Between(random, 0, cells.y - 1),
    Between(random, 0, cells.z - 1));
  const glm::ivec3 high(Between(random, low.x, cells.x), Between(random, low.y, cells.y),
    Between(random, low.z, cells.z));
  const int axis = Between(random, 0, 2);
  const auto share = static_cast<unsigned>(Between(random, 1, 99));
  ForAll(cells,
    [&](const glm::ivec3& p)
    {
      const bool inside = Box{ low, high }.Contains(p);
      const bool some = random() % 100 < share;
      const bool hide[] = { some, inside, !inside, p[axis] == low[axis], some && inside, true };
      flags[At(p, cells)] = static_cast<std::uint8_t>((hide[kind] ? HiddenBit : 0) | random() % 2);
    });
  return flags;
}

std::shared_ptr<const HiddenCells> Hidden(const Flags& flags, const glm::ivec3& cells)
{
  const auto hidden = std::make_shared<HiddenCells>(cells);
  hidden->Hide({ glm::ivec3(0), cells }, flags.data(), HiddenBit);
  return hidden;
}

FloatImage Draw(const RayScene& scene, const SampleArray& array,
  std::shared_ptr<const HiddenCells> hidden, const Box& cells, int brickCells,
  RayStatistics* statistics = nullptr)
{
  ThreadPool pool(1);
  const ValueRange range = FiniteRange(array, pool);
  const MaskRange masks = range.Empty() ? MaskRange{} : MaskRange{ range.Low, range.High };
  ArrayBrickSource source(array, brickCells, masks, pool);
  source.Hide(std::move(hidden));
  RayStatistics here;
  FloatImage image =
    CastRays(scene, source, cells, std::uint64_t{ 1 } << 30, pool, statistics ? *statistics : here);
  FinishPicture(scene, image);
  return image;
}

/// A scene of any kind but shaded.
RayScene RandomScene(std::mt19937& random, const glm::ivec3& n)
{
  const double distances[] = { 0.2, 1.2, 1.4 };
  RayScene scene =
    scenes::Scene(n, { 24, 20 }, glm::dmat4(1.0), distances[random() % 3], random() % 2 == 0);
  const BlendMode modes[] = { BlendMode::Composite, BlendMode::Composite, BlendMode::Maximum,
    BlendMode::Minimum, BlendMode::Average };
  scene.Blend.Mode = modes[random() % 5];
  scene.Interpolation =
    random() % 3 == 0 ? SampleInterpolation::Nearest : SampleInterpolation::Linear;
  const double steps[] = { 0.3, 1.0, 1.0, 2.3 };
  scene.SampleDistance = steps[random() % 4];
  if (random() % 3 == 0)
  {
    scene.ClipPlanes = { { { 0.3, -1.0, 0.2 }, 0.4 * n.y } };
  }
  return scene;
}

/// Pixels that differ by more.
int PixelsOff(const FloatImage& image, const FloatImage& reference, double tolerance)
{
  int off = 0;
  for (int y = reference.Rect.Lo.y; y < reference.Rect.Hi.y; ++y)
  {
    for (int x = reference.Rect.Lo.x; x < reference.Rect.Hi.x; ++x)
    {
      const PixelRect pixel{ { x, y }, { x + 1, y + 1 } };
      const bool drawn = !Intersection(image.Rect, pixel).Empty();
      const glm::vec4 is = drawn ? image.At(x, y) : glm::vec4(0.0f);
      const glm::vec4 away = glm::abs(is - reference.At(x, y));
      off += std::max({ away.r, away.g, away.b, away.a }) > tolerance ? 1 : 0;
    }
  }
  return off;
}

/// @return pixels that are not those of the reference
template <class T>
int PixelsOffOf(unsigned seed, double scale, double tolerance)
{
  std::mt19937 random(seed);
  const glm::ivec3 n(Between(random, 2, 21), Between(random, 2, 21), Between(random, 2, 21));
  const bool uniform = random() % 4 == 0;
  const std::vector<T> values = scenes::Sampled<T>(
    [&](const glm::dvec3& p) { return uniform ? 0.75 : scenes::Standard(p); }, n, scale);
  const Flags flags = RandomFlags(random, n - 1);
  Flags points(values.size(), 0);
  const bool somePoints = random() % 3 == 0;
  for (std::uint8_t& point : points)
  {
    point = somePoints && random() % 40 == 0 ? 2 : 0;
  }
  RayScene scene = RandomScene(random, n);
  scene.Transfer.High = scale;
  scene.Blend.White = scale;
  SampleArray array = scenes::ArrayOf(values, n);
  array.Flags = somePoints ? points.data() : nullptr;
  const FloatImage reference = ReferenceImage(
    scene,
    [&](const glm::ivec3& p)
    { return points[At(p, n)] ? NAN : static_cast<double>(values[At(p, n)]); },
    scenes::NearestEntry(scene.Transfer),
    [&](const glm::ivec3& p) { return (flags[At(p, n - 1)] & HiddenBit) != 0; });
  const int brickCells[] = { 5, 8, 16, 32 };
  const FloatImage image =
    Draw(scene, array, Hidden(flags, n - 1), scene.DomainCells, brickCells[random() % 4]);
  return PixelsOff(image, reference, tolerance);
}

/// 160 masks. The tolerance is a neighbouring entry of the table, where values round apart. Of
/// 77000 pixels one has a sample so near the face of a hidden cell that positions round apart, too.
TEST(HiddenCells, AreLeftOutAsByTheReference)
{
  constexpr double tolerance = 1e-3;
  int off = 0;
  for (unsigned seed = 0; seed < 160; seed += 4)
  {
    off += PixelsOffOf<float>(seed, 1.0, tolerance);
    off += PixelsOffOf<double>(seed + 1, 1.0, tolerance);
    off += PixelsOffOf<std::uint8_t>(seed + 2, 200.0, tolerance);
    off += PixelsOffOf<std::int32_t>(seed + 3, 1000.0, tolerance);
  }
  EXPECT_LE(off, 2);
}

/// All but a box is hidden: the picture is that of the box alone, bit for bit.
void ExpectOnlyTheBox(
  const RayScene& scene, const SampleArray& array, const Box& box, int brickCells)
{
  const glm::ivec3 cells = array.Samples.Size() - 1;
  Flags flags(At({ 0, 0, cells.z }, cells), HiddenBit);
  ForAll(cells, [&](const glm::ivec3& p)
    { flags[At(p, cells)] = box.Contains(p) ? std::uint8_t{ 1 } : HiddenBit; });
  const auto hidden = std::make_shared<HiddenCells>(scene.DomainCells.Hi);
  hidden->Hide({ glm::ivec3(0), cells }, flags.data(), HiddenBit);
  const FloatImage alone = Draw(scene, array, nullptr, box, brickCells);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    const targets::OnlyTarget only(target);
    EXPECT_EQ(
      MaxDifference(Draw(scene, array, hidden, { glm::ivec3(0), cells }, brickCells), alone), 0.0)
      << hwy::TargetName(target) << " mode " << static_cast<int>(scene.Blend.Mode);
  }
}

TEST(HiddenCells, AroundABoxLeaveItsPicture)
{
  const glm::ivec3 n(40, 27, 35);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  for (const BlendMode mode :
    { BlendMode::Composite, BlendMode::Maximum, BlendMode::Minimum, BlendMode::Average })
  {
    for (const int kind : { 0, 1, 2, 3 }) // 2: of single rays; 3: shaded
    {
      RayScene scene = scenes::Scene(n, { 45, 40 });
      scene.Blend.Mode = mode;
      scene.Interpolation = kind == 1 ? SampleInterpolation::Nearest : SampleInterpolation::Linear;
      scene.SampleDistance = kind == 2 ? 17.0 : 1.0;
      scene.Shading.On = kind == 3;
      scene.Shading.Specular = 0.4f;
      ExpectOnlyTheBox(scene, scenes::ArrayOf(values, n), { { 3, 8, 11 }, { 37, 22, 30 } }, 16);
    }
  }
}

TEST(HiddenCells, AroundABoxLeaveItsPictureOfSmallIntegersInALargeVolume)
{
  const glm::ivec3 n(40, 27, 35);
  const std::vector<std::uint8_t> values =
    scenes::Sampled<std::uint8_t>(scenes::Standard, n, 200.0);
  for (const BlendMode mode : { BlendMode::Composite, BlendMode::Average })
  {
    RayScene scene = scenes::Scene(n, { 45, 40 });
    scene.Transfer.High = 200.0;
    scene.Blend.Mode = mode;
    scene.Blend.White = 200.0;
    scene.DomainCells.Hi = glm::ivec3(336); // its numbers have 2 bytes
    ExpectOnlyTheBox(scene, scenes::ArrayOf(values, n), { { 3, 8, 11 }, { 37, 22, 30 } }, 16);
  }
}

TEST(HiddenCells, AroundABoxLeaveItsPictureOfBricksTooLargeToPack)
{
  const glm::ivec3 n(150, 9, 12);
  const std::vector<std::int16_t> values =
    scenes::Sampled<std::int16_t>(scenes::Standard, n, 1000.0);
  for (const BlendMode mode : { BlendMode::Composite, BlendMode::Maximum, BlendMode::Average })
  {
    RayScene scene = scenes::Scene(n, { 60, 30 });
    scene.Transfer.High = 1000.0;
    scene.Blend.White = 1000.0;
    scene.Blend.Mode = mode;
    ExpectOnlyTheBox(scene, scenes::ArrayOf(values, n), { { 31, 1, 2 }, { 140, 7, 9 } }, 200);
  }
}

/// Whatever brick a cell is in, whole groups of bricks among them.
TEST(HiddenCells, ChangeWithNoBrickSize)
{
  const glm::ivec3 n(70, 66, 41);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  std::mt19937 random(3);
  for (const bool shaded : { false, true })
  {
    const auto hidden = Hidden(RandomFlags(random, n - 1), n - 1);
    RayScene scene = scenes::Scene(n, { 60, 50 });
    scene.Shading.On = shaded;
    const FloatImage image = Draw(scene, scenes::ArrayOf(values, n), hidden, scene.DomainCells, 16);
    for (const int brickCells : { 7, 32, 64 })
    {
      EXPECT_EQ(MaxDifference(image,
                  Draw(scene, scenes::ArrayOf(values, n), hidden, scene.DomainCells, brickCells)),
        0.0);
    }
  }
}

TEST(HiddenCells, AreNeitherLoadedNorSampledWhereABrickHasNoOthers)
{
  const glm::ivec3 n(33, 17, 17);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  const RayScene scene = scenes::Scene(n, { 40, 30 });
  Flags flags(32 * 16 * 16, 0);
  ForAll(n - 1, [&](const glm::ivec3& p) { flags[At(p, n - 1)] = p.x < 16 ? HiddenBit : 0; });
  ThreadPool pool(1);
  ArrayBrickSource source(scenes::ArrayOf(values, n), 16, { 0.0, 1.0 }, pool);
  source.Hide(Hidden(flags, n - 1));
  EXPECT_EQ(BricksToLoad(scene, source, scene.DomainCells), (std::vector<std::int64_t>{ 1 }));
  RayStatistics statistics;
  RayStatistics all;
  (void)Draw(
    scene, scenes::ArrayOf(values, n), Hidden(flags, n - 1), scene.DomainCells, 16, &statistics);
  (void)Draw(scene, scenes::ArrayOf(values, n), nullptr, scene.DomainCells, 16, &all);
  EXPECT_EQ(statistics.BricksDrawn, 1);
  EXPECT_EQ(statistics.BricksSkipped, 1);
  EXPECT_LT(statistics.SamplesTaken, 0.6 * static_cast<double>(all.SamplesTaken));
}

TEST(HiddenCells, OfABrickOfOneValueHaveNoColour)
{
  const glm::ivec3 n(17);
  const std::vector<float> values(17 * 17 * 17, 0.75f);
  const RayScene scene = scenes::Scene(n, { 30, 30 });
  const auto middle = [&](const Flags& flags)
  {
    RayStatistics statistics;
    const FloatImage image = Draw(
      scene, scenes::ArrayOf(values, n), Hidden(flags, n - 1), scene.DomainCells, 16, &statistics);
    return std::make_pair(image.Rect.Empty() ? 0.0f : image.At(15, 15).a, statistics.BricksUniform);
  };
  const float whole = middle(Flags(4096, 0)).first;
  EXPECT_EQ(middle(Flags(4096, 0)).second, 1);
  EXPECT_EQ(middle(Flags(4096, HiddenBit)).first, 0.0f);
  Flags one(4096, 0);
  one[At({ 0, 0, 0 }, n - 1)] = HiddenBit; // far from the middle
  EXPECT_EQ(middle(one).first, whole);
  EXPECT_EQ(middle(one).second, 0);
  Flags half(4096, 0);
  ForAll(n - 1, [&](const glm::ivec3& p) { half[At(p, n - 1)] = p.z < 8 ? HiddenBit : 0; });
  EXPECT_GT(middle(half).first, 0.2f * whole);
  EXPECT_LT(middle(half).first, 0.9f * whole);
}

/// Coarse cells of which at least half is hidden; bits, counts and messages against the flags.
TEST(HiddenCells, AreCountedAndToldCellByCell)
{
  for (unsigned seed = 0; seed < 100; ++seed)
  {
    std::mt19937 random(seed);
    const glm::ivec3 cells(Between(random, 1, 40), Between(random, 1, 40), Between(random, 1, 20));
    const Flags flags = RandomFlags(random, cells);
    const auto isHidden = [&](const glm::ivec3& p)
    { return (flags[At(p, cells)] & HiddenBit) != 0; };
    const auto countIn = [&](const Box& box)
    {
      std::int64_t count = 0;
      const Box inside = Intersection(box, { glm::ivec3(0), cells });
      ForAll(inside.Size(), [&](const glm::ivec3& p) { count += isHidden(inside.Lo + p) ? 1 : 0; });
      return count;
    };
    const auto hidden = Hidden(flags, cells);
    HiddenCells told(cells);
    told.Add(hidden->ToBytes());
    told.Add(HiddenCells(cells).ToBytes());
    Box box{ glm::ivec3(Between(random, 0, 9)), {} };
    box.Hi = box.Lo + glm::ivec3(Between(random, 1, 37), Between(random, 1, 20), 9);
    EXPECT_EQ(hidden->CountIn(box), countIn(box));
    EXPECT_EQ(told.CountIn({ glm::ivec3(-3), cells + 5 }), countIn({ glm::ivec3(0), cells }));
    const HiddenInBrick bits(&told, box);
    ForAll(box.Size(),
      [&](const glm::ivec3& p)
      {
        const bool inside = Box{ glm::ivec3(0), cells }.Contains(box.Lo + p);
        ASSERT_EQ(bits.At(p), inside && isHidden(box.Lo + p)) << seed;
      });
    const glm::ivec3 edges(
      1 << Between(random, 0, 3), 1 << Between(random, 0, 3), 1 << Between(random, 1, 3));
    const HiddenCells coarse = hidden->Coarser(edges);
    ForAll((cells + (edges - 1)) / edges,
      [&](const glm::ivec3& p)
      {
        const Box fine =
          Intersection(Box{ p * edges, (p + 1) * edges }, Box{ glm::ivec3(0), cells });
        ASSERT_EQ(coarse.Any({ p, p + 1 }), 2 * countIn(fine) >= fine.Count()) << seed;
      });
  }
}

TEST(HiddenCells, OfAnotherGridAreRefused)
{
  const glm::ivec3 cells(40, 30, 20);
  std::mt19937 random(1);
  const std::string bytes = Hidden(Flags(40 * 30 * 20, HiddenBit), cells)->ToBytes();
  HiddenCells small(glm::ivec3(5));
  EXPECT_THROW(small.Add(bytes), Error);
  HiddenCells same(cells);
  EXPECT_THROW(same.Add(bytes.substr(0, bytes.size() - 3)), Error);
}

} // namespace
