// SPDX-License-Identifier: BSD-3-Clause
#include "StandardScenes.h"

#include "StandardField.h"

#include "Base/ThreadPool.h"

#include <cmath>

namespace banyan::bench
{

std::shared_ptr<const Volume> StandardVolume(int n, ThreadPool& pool, int thinner)
{
  auto volume = std::make_shared<Volume>();
  volume->Samples = { n, n, n / thinner };
  const std::size_t slice = static_cast<std::size_t>(n) * n;
  volume->Floats.resize(slice * static_cast<std::size_t>(volume->Samples.z));
  const StandardFieldSlices field(n);
  pool.ParallelFor(volume->Samples.z, [&](std::int64_t z)
    { field.Slice(static_cast<int>(z) * thinner, volume->Floats.data() + slice * z); });
  return volume;
}

BenchScene StandardScene(
  std::shared_ptr<const Volume> volume, StandardFunction function, bool shaded, int picture)
{
  BenchScene scene;
  scene.Name = function == StandardFunction::S1 ? "S1-" : "S2-";
  scene.Name += std::to_string(volume->Samples.x) + (shaded ? "-shaded" : "");
  const double edge = volume->Size().x;
  scene.Center = 0.5 * volume->Size();
  scene.Name += volume->Samples.z < volume->Samples.x ? "-flat" : "";
  scene.Data = std::move(volume);
  scene.Picture = picture;
  scene.Shaded = shaded;
  scene.HasGoals = true;
  scene.UnitDistance = edge / 255.0; // a voxel of 256^3
  scene.Eye = scene.Center + 1.9 * edge * glm::dvec3(0.48, 0.36, 0.80);

  constexpr int nodes = 256;
  constexpr int firstVisible = 64; // of S2
  constexpr double threshold = firstVisible / (nodes - 1.0);
  const double turn = 2.0 * std::acos(-1.0);
  for (int i = 0; i < nodes; ++i)
  {
    const double x = i / (nodes - 1.0);
    const double faint = 0.001 + 0.019 * x;
    const double strong =
      i < firstVisible ? 0.0 : 0.02 + 0.28 * (x - threshold) / (1.0 - threshold);
    scene.Nodes.emplace_back(0.5 + 0.5 * std::cos(turn * (0.9 * x)),
      0.5 + 0.5 * std::cos(turn * (0.9 * x + 0.33)), 0.5 + 0.5 * std::cos(turn * (0.9 * x + 0.67)),
      function == StandardFunction::S1 ? faint : strong);
  }
  return scene;
}

} // namespace banyan::bench
