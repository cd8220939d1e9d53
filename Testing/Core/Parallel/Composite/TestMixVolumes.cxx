// SPDX-License-Identifier: BSD-3-Clause
// Volumes that share space. What one volume has along rays is its own picture; two volumes of half
// the density are one of the whole; media of one colour are what a formula says.
#include "Parallel/Balance/Zones.h"
#include "Parallel/Composite/MixVolumes.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Parallel/PieceCases.h"
#include "Render/Raycast/SegmentMixer.h"
#include "Render/Raycast/SegmentsToWorld.h"
#include "Render/Scenes.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr std::uint64_t Budget = 1u << 20;
const glm::ivec3 Samples{ 41, 33, 37 };

RayScene SceneOf(bool parallel = false, double distance = 1.4)
{
  RayScene scene = scenes::Scene(Samples, { 75, 70 }, glm::dmat4(1.0), distance, parallel);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  scene.Transfer.UnitDistance = 0.2;
  return scene;
}

/// Grid data of all ranks.
struct Field
{
  explicit Field(const scenes::Field& field = scenes::Standard)
    : Values(scenes::Sampled<float>(field, Samples))
  {
  }

  /// Collective: what this rank has along rays.
  /// @param byPicture whether ranks divide the picture, in slabs that cut tiles; else the cells
  std::vector<TileSegments> Segments(
    Communicator& ranks, RayScene scene, bool byPicture = false) const
  {
    ThreadPool pool(2);
    ArrayBrickSource source(scenes::ArrayOf(this->Values, Samples), 16, { 0.0, 1.0 }, pool);
    const BrickLayout layout(Samples, 16, 0);
    std::vector<Box> zones;
    for (const Box& bricks : StaticZones(layout.Bricks(), ranks.Size()))
    {
      zones.push_back(CellsOfBricks(bricks, 16, scene.DomainCells.Hi));
    }
    SegmentPicture segments;
    scene.Segments = &segments;
    FrameStatistics statistics;
    RankShare share{ &source, zones, Budget, pool };
    for (int rank = 0; byPicture && rank < ranks.Size(); ++rank)
    {
      const glm::ivec2 size = scene.Viewport.Size();
      share.Regions.push_back(
        { { 0, size.y * rank / ranks.Size() }, { size.x, size.y * (rank + 1) / ranks.Size() } });
    }
    const FloatImage none = DrawDistributed(ranks, scene, share, statistics);
    EXPECT_TRUE(none.Pixels.empty());
    return segments.Take();
  }

  FloatImage Alone(const RayScene& scene) const
  {
    FloatImage picture = scenes::Draw(scene, scenes::ArrayOf(this->Values, Samples)).Image;
    FloatImage whole{ scene.Viewport,
      PixelVector(static_cast<std::size_t>(scene.Viewport.Count()), glm::vec4(0.0f)) };
    for (int y = picture.Rect.Lo.y; y < picture.Rect.Hi.y; ++y)
    {
      for (int x = picture.Rect.Lo.x; x < picture.Rect.Hi.x; ++x)
      {
        whole.At(x, y) = picture.At(x, y);
      }
    }
    return whole;
  }

  std::vector<float> Values;
};

using SegmentsOf = std::function<std::vector<TileSegments>(Communicator&)>;

FloatImage Mixed(
  int ranks, const RayScene& scene, const std::vector<SegmentsOf>& volumes, float limit = -1.0f)
{
  FloatImage picture;
  const int root = ranks / 2;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(2);
      MixedVolumes mixed;
      mixed.Viewport = scene.Viewport;
      mixed.TransmittanceLimit = limit;
      for (const SegmentsOf& volume : volumes)
      {
        mixed.Segments.push_back(volume(communicator));
      }
      SentBytes sent;
      FloatImage mine = MixVolumes(communicator, std::move(mixed), pool, root, {}, sent);
      if (communicator.Rank() == root)
      {
        picture = std::move(mine);
      }
      else
      {
        EXPECT_TRUE(mine.Pixels.empty());
      }
    });
  return picture;
}

std::int64_t SeenIn(const FloatImage& picture)
{
  return std::count_if(picture.Pixels.begin(), picture.Pixels.end(),
    [](const glm::vec4& pixel) { return pixel.a > 0.02f; });
}

void ExpectItsOwnPicture(const Field& field, const RayScene& scene, const std::string& name)
{
  const FloatImage alone = field.Alone(scene);
  EXPECT_GT(SeenIn(alone), 100) << name;
  for (const int ranks : { 1, 3 })
  {
    const FloatImage mixed =
      Mixed(ranks, scene, { [&](Communicator& all) { return field.Segments(all, scene); } });
    EXPECT_LE(MaxDifference(mixed, alone), 1e-5) << name << " on " << ranks;
  }
}

TEST(MixVolumes, OneVolumeIsItsOwnPicture)
{
  const Field field;
  ExpectItsOwnPicture(field, SceneOf(), "perspective");
  ExpectItsOwnPicture(field, SceneOf(true), "parallel");
  ExpectItsOwnPicture(field, SceneOf(false, 0.1), "inside");
  RayScene scene = SceneOf();
  scene.SampleDistance = 0.3;
  ExpectItsOwnPicture(field, scene, "short steps");
  scene.SampleDistance = 40.0; // longer than packets are drawn with
  scene.Transfer.UnitDistance = 2.0;
  ExpectItsOwnPicture(field, scene, "long steps");
  scene = SceneOf();
  scene.Shading = { true, 0.3f, 0.7f, 0.4f, 12.0f };
  ExpectItsOwnPicture(field, scene, "shaded");
  scene = SceneOf();
  scene.Interpolation = SampleInterpolation::Nearest;
  ExpectItsOwnPicture(field, scene, "nearest");
  scene = SceneOf();
  scene.ClipPlanes.push_back({ { 0.6, 0.0, 0.8 }, -20.0 });
  ExpectItsOwnPicture(field, scene, "clipped");
  scene = SceneOf();
  for (int i = 0; i < scene.Viewport.Count(); ++i)
  {
    scene.Depth.push_back(i % 7 == 0 ? 1.0f : 0.1f + 0.8f * static_cast<float>(i % 13) / 13.0f);
  }
  ExpectItsOwnPicture(field, scene, "before opaque geometry");
}

TEST(MixVolumes, BricksOfOneValue)
{
  const Field field([](const glm::dvec3& p) { return p.x < 0.6 ? 0.8 : 0.9 * p.y; });
  ExpectItsOwnPicture(field, SceneOf(), "bricks of one value");
}

TEST(MixVolumes, CellsAreTheirOwnPicture)
{
  for (const bool lattice : { false, true })
  {
    piececases::Case is(piececases::Cube(6, cellmeshes::Cut::Mixed));
    if (lattice)
    {
      is.Scene.Samplings = std::make_shared<const TileSamplings>(
        is.Scene.Camera.ImageSize(), std::vector<RaySampling>{ { 1, is.Scene.SampleDistance, 1 } });
    }
    const FloatImage whole = is.Whole();
    EXPECT_GT(SeenIn(whole), 1000);
    for (const int ranks : { 1, 3, 8 })
    {
      const std::vector<int> rankOf = piececases::Dealt(is.Mesh, piececases::Deal::OneByOne, ranks);
      const FloatImage mixed = Mixed(ranks, is.Scene,
        { [&](Communicator& all)
          {
            SegmentPicture segments;
            piececases::Case own = is;
            own.Scene.Segments = &segments;
            PieceStatistics statistics;
            own.Together(all, rankOf, statistics);
            return segments.Take();
          } });
      EXPECT_LE(MaxDifference(mixed, whole), 1e-5) << lattice << " on " << ranks;
    }
  }
}

/// Of a volume whose densities are parts of those of the standard one.
RayScene WithPartOfDensity(const RayScene& scene, double part)
{
  RayScene thin = scene;
  for (glm::vec4& entry : thin.Transfer.Entries)
  {
    entry.a = static_cast<float>(-std::expm1(part * std::log1p(-double(entry.a))));
  }
  return thin;
}

TEST(MixVolumes, PartsOfDensityAddUp)
{
  const Field field;
  for (const bool parallel : { false, true })
  {
    const RayScene scene = SceneOf(parallel);
    const FloatImage whole = field.Alone(scene);
    const auto part = [&](double density)
    {
      return [&field, thin = WithPartOfDensity(scene, density)](Communicator& all)
      { return field.Segments(all, thin); };
    };
    for (const int ranks : { 1, 3, 8 })
    {
      const FloatImage mixed = Mixed(ranks, scene, { part(0.5), part(0.2), part(0.3) });
      EXPECT_LE(MaxDifference(mixed, whole), 2e-5) << ranks;
    }
  }
}

TEST(MixVolumes, AnyNumberOfRanks)
{
  const Field field;
  const Field other([](const glm::dvec3& p) { return scenes::Standard({ p.z, p.x, p.y }); });
  const RayScene scene = SceneOf();
  RayScene turned = SceneOf();
  turned.IndexToWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(20.0, 3.0, -2.0)) *
                        glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.2, 1.0, 0.3));
  turned.SampleDistance = 0.73;
  const auto draw = [&](int ranks)
  {
    return Mixed(ranks, scene,
      { [&](Communicator& all) { return field.Segments(all, scene); },
        [&](Communicator& all) { return other.Segments(all, turned); } });
  };
  const FloatImage alone = draw(1);
  EXPECT_GT(SeenIn(alone), 700);
  EXPECT_GT(MaxDifference(alone, field.Alone(scene)), 0.1) << "the other one is seen";
  for (const int ranks : { 2, 3, 8, 64 })
  {
    EXPECT_LE(MaxDifference(draw(ranks), alone), 1e-5) << ranks;
  }
}

TEST(MixVolumes, RanksThatDivideThePicture)
{
  const Field field;
  const RayScene scene = SceneOf();
  const FloatImage alone = field.Alone(scene);
  const FloatImage mixed = Mixed(5, scene,
    { [&](Communicator& all) { return field.Segments(all, scene, /*byPicture=*/true); } });
  EXPECT_LE(MaxDifference(mixed, alone), 1e-5);
}

TEST(MixVolumes, BlocksAreOnePicture)
{
  const Field field;
  const RayScene scene = SceneOf();
  const FloatImage alone = field.Alone(scene);
  const PixelRect part{ { 5, 9 }, { 71, 68 } }; // cuts tiles
  RunOnSimulatedRanks(3,
    [&](Communicator& ranks)
    {
      ThreadPool pool(1);
      SentBytes sent;
      int blocks = 0;
      const auto cast = [&](std::size_t, const PixelRect& block, SegmentPicture& segments)
      {
        ++blocks;
        RayScene ofBlock = scene;
        ofBlock.Viewport = block;
        for (TileSegments& tile : field.Segments(ranks, ofBlock))
        {
          segments.Add(std::move(tile));
        }
        return 0.0f;
      };
      const auto picture = MixInBlocks(ranks, 1, part, 2, pool, cast, sent);
      EXPECT_GT(blocks, 1);
      ASSERT_EQ(picture != nullptr, ranks.Rank() == 2);
      for (int y = part.Lo.y; picture && y < part.Hi.y; ++y)
      {
        for (int x = part.Lo.x; x < part.Hi.x; ++x)
        {
          ASSERT_LE(glm::length(picture->At(x, y) - alone.At(x, y)), 1e-5f) << x << " " << y;
        }
      }
    });
}

TEST(MixVolumes, AFailureIsOneOfAll)
{
  for (const int ranks : { 1, 3 })
  {
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        ThreadPool pool(1);
        SentBytes sent;
        MixedVolumes mixed;
        mixed.Segments.resize(2);
        mixed.Viewport = { glm::ivec2(0), glm::ivec2(10) };
        EXPECT_THROW(MixVolumes(communicator, std::move(mixed), pool, 0,
                       communicator.Rank() == 0 ? "It is broken" : "", sent),
          Error);
      });
  }
}

/// Points of a ray are the same ones, wherever the volume's space has its middle and however it is
/// scaled.
TEST(SegmentsToWorld, PointsStayWhereTheyAre)
{
  const glm::dmat4 toWorld =
    glm::scale(glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(20.0, 3.0, -2.0)), 0.7,
                 glm::dvec3(0.2, 1.0, 0.3)),
      glm::dvec3(0.25, 3.0, 1.5));
  for (const bool parallel : { false, true })
  {
    const RayCamera seen = SceneOf(parallel).Camera;
    const RayCamera world(seen.WorldToClipMatrix(), seen.ImageSize(), glm::dvec3(0.0));
    const RayCamera camera =
      RayCamera(seen.WorldToClipMatrix(), seen.ImageSize(), glm::dvec3(5.0, -7.0, 30.0))
        .InSpace(toWorld);
    RaySegment segment;
    segment.Begin = 3.5;
    segment.Length = 2.0f;
    segment.Pixel = 5 * RayTile::Edge + 9;
    std::vector<TileSegments> tiles{ { glm::ivec2(1, 0), { segment, segment } } };
    tiles[0].Segments[1].Pixel = 7;
    SegmentsToWorld(tiles, camera, toWorld);
    for (const RaySegment& moved : tiles[0].Segments)
    {
      const glm::ivec2 at(RayTile::Edge + moved.Pixel % RayTile::Edge, moved.Pixel / RayTile::Edge);
      const Ray own = camera.RayOf(at.x, at.y);
      const Ray ray = world.RayOf(at.x, at.y);
      for (const double part : { 0.0, 1.0 })
      {
        const glm::dvec4 point(own.Origin + (3.5 + part * 2.0) * own.Direction, 1.0);
        const double t = moved.Begin + part * static_cast<double>(moved.Length);
        const glm::dvec3 off = glm::dvec3(toWorld * point) - (ray.Origin + t * ray.Direction);
        EXPECT_LE(glm::length(off), 1e-6) << parallel << " " << part;
      }
    }
  }
}

} // namespace
