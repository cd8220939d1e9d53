// SPDX-License-Identifier: BSD-3-Clause
// Draws the pictures of the zones of 2 to many ranks with the ray caster, for the simulation of
// compositing.
//
//   banyan-record-frames --output DIR [--ranks LIST] [--cameras LIST] [--picture N] [--threads N]
//                        (S1|S2|SERIES.json)
//
// Writes DIR/SCENE_CAMERA_RANKS.frame and prints these names. S1 and S2 are the standard scenes of
// 128^3 samples; SERIES.json describes a raw series (see banyan-bench-raycast). Cameras:
// perspective and parallel, each full (all of the volume) and zoom (the middle of it fills the
// picture).
#include "FrameFile.h"
#include "RealScenes.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Parallel/Balance/Zones.h"
#include "Parallel/Composite/Compositing.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>

namespace
{

using namespace banyan;
using namespace banyan::bench;

struct Options
{
  std::string Output;
  std::string Scene;
  std::vector<std::string> Ranks{ "2", "3", "4", "8", "16", "32", "64" };
  std::vector<std::string> Cameras{ "perspective-full", "perspective-zoom", "parallel-full",
    "parallel-zoom" };
  int Picture = 1024;
  int Threads = 0;
};

std::vector<std::string> Listed(const std::string& text)
{
  std::vector<std::string> items;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');)
  {
    items.push_back(item);
  }
  return items;
}

Options Parse(int argc, char** argv)
{
  Options options;
  for (int i = 1; i < argc; ++i)
  {
    const std::string option = argv[i];
    if (option.rfind("--", 0) != 0)
    {
      options.Scene = option;
      continue;
    }
    if (i + 1 == argc)
    {
      throw Error("The option " + option + " needs a value.");
    }
    const std::string value = argv[++i];
    if (option == "--output")
    {
      options.Output = value;
    }
    else if (option == "--ranks")
    {
      options.Ranks = Listed(value);
    }
    else if (option == "--cameras")
    {
      options.Cameras = Listed(value);
    }
    else if (option == "--picture" || option == "--threads")
    {
      (option == "--picture" ? options.Picture : options.Threads) = std::atoi(value.c_str());
    }
    else
    {
      throw Error("There is no option " + option + ".");
    }
  }
  if (options.Scene.empty() || options.Output.empty() || options.Picture < 1)
  {
    throw Error("A scene, --output and a picture of at least one pixel are needed.");
  }
  return options;
}

BenchScene SceneOf(const Options& options, ThreadPool& pool)
{
  if (options.Scene == "S1" || options.Scene == "S2")
  {
    BenchScene scene = StandardScene(StandardVolume(128, pool),
      options.Scene == "S1" ? StandardFunction::S1 : StandardFunction::S2, false, options.Picture);
    scene.Name = options.Scene;
    return scene;
  }
  return RealScene(options.Scene, options.Picture);
}

/// The scene's camera, as `name` wants it.
RayScene Seen(const BenchScene& scene, const std::string& name)
{
  RayScene seen = ToRayScene(scene, 1.0, 1.0f - 1.0f / 255.0f);
  const bool zoomed = name.find("zoom") != std::string::npos;
  const double distance = glm::length(scene.Eye - scene.Center);
  const double diagonal = glm::length(scene.Data->Size());
  const glm::dmat4 view = glm::lookAt(scene.Eye, scene.Center, scene.Up);
  glm::dmat4 projection;
  if (name.rfind("parallel", 0) == 0)
  {
    const double half = zoomed ? 0.2 * diagonal : 0.5 * diagonal;
    projection = glm::ortho(-half, half, -half, half, 0.01 * distance, distance + diagonal);
  }
  else
  {
    const double half = std::atan((zoomed ? 0.2 : 0.5) * diagonal / distance);
    projection = glm::perspective(2.0 * half, 1.0, 0.01 * distance, distance + diagonal);
  }
  seen.Camera = RayCamera(projection * view, glm::ivec2(scene.Picture), scene.Center);
  return seen;
}

/// Without the background around what is drawn.
FloatImage Trimmed(const FloatImage& image)
{
  FloatImage part{ ActiveRect(image, image.Rect), {} };
  for (int y = part.Rect.Lo.y; y < part.Rect.Hi.y; ++y)
  {
    const glm::vec4* row = &image.At(part.Rect.Lo.x, y);
    part.Pixels.insert(part.Pixels.end(), row, row + part.Rect.Size().x);
  }
  return part;
}

void Record(const Options& options)
{
  ThreadPool pool(options.Threads > 0 ? options.Threads : ThreadPool::DefaultWidth());
  const BenchScene scene = SceneOf(options, pool);
  constexpr int brickCells = 32;
  ArrayBrickSource source(
    scene.Data->Array(), brickCells, MaskRange{ scene.Low, scene.High }, pool);
  const glm::ivec3 cells = scene.Data->Samples - 1;
  for (const std::string& camera : options.Cameras)
  {
    const RayScene seen = Seen(scene, camera);
    for (const std::string& count : options.Ranks)
    {
      const int ranks = std::atoi(count.c_str());
      // Zones of small bricks, so that many ranks have some too.
      constexpr int zoneCells = 4;
      std::vector<Box> zones;
      for (const Box& bricks : StaticZones((cells + (zoneCells - 1)) / zoneCells, ranks))
      {
        zones.push_back(CellsOfBricks(bricks, zoneCells, cells));
      }
      FrameHead head{ seen.Viewport,
        FrontToBack(InIndexSpace(seen.Camera, seen.IndexToWorld), zones),
        FootprintsOfZones(seen.Camera, seen.IndexToWorld, zones, seen.Viewport) };
      std::vector<FloatImage> images;
      for (const Box& zone : zones)
      {
        RayStatistics statistics;
        images.push_back(Trimmed(
          zone.Empty() ? FloatImage{}
                       : CastRays(seen, source, zone, ~std::uint64_t{ 0 }, pool, statistics)));
      }
      const std::string path =
        options.Output + "/" + scene.Name + "_" + camera + "_" + std::to_string(ranks) + ".frame";
      WriteFrame(path, head, images);
      std::printf("%s\n", path.c_str());
      std::fflush(stdout);
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    Record(Parse(argc, argv));
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
