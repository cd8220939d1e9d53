// SPDX-License-Identifier: BSD-3-Clause
#include "BenchScene.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace banyan::bench
{

const void* Volume::Values() const
{
  return this->Codes.empty() ? static_cast<const void*>(this->Floats.data()) : this->Codes.data();
}

double Volume::VoxelLength() const
{
  return std::min({ this->Spacing.x, this->Spacing.y, this->Spacing.z });
}

SampleArray Volume::Array() const
{
  SampleArray array;
  array.Values = this->Values();
  array.Type = this->Type();
  array.Stride[1] = this->Samples.x;
  array.Stride[2] = std::ptrdiff_t{ this->Samples.x } * this->Samples.y;
  array.Samples = { glm::ivec3(0), this->Samples };
  return array;
}

SampleArray PartOf(const SampleArray& whole, const Box& samples)
{
  SampleArray part = whole;
  std::ptrdiff_t offset = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    offset += samples.Lo[axis] * whole.Stride[axis];
  }
  part.Values = static_cast<const char*>(whole.Values) +
                offset * static_cast<std::ptrdiff_t>(SizeOf(whole.Type));
  part.Samples = samples;
  return part;
}

glm::dvec4 BenchScene::At(double value) const
{
  const auto last = static_cast<double>(this->Nodes.size() - 1);
  const double position =
    std::clamp((value - this->Low) / (this->High - this->Low), 0.0, 1.0) * last;
  const double before = std::min(std::floor(position), last - 1.0);
  const glm::dvec4* node = this->Nodes.data() + static_cast<std::size_t>(before);
  return node[0] + (position - before) * (node[1] - node[0]);
}

void BenchScene::LookFromAfar(double distance)
{
  const glm::dvec3 size = this->Data->Size();
  this->Center = 0.5 * size;
  this->Eye = this->Center + distance * glm::length(size) * glm::dvec3(0.48, 0.36, 0.80);
}

RayScene ToRayScene(
  const BenchScene& scene, double sampleDistance, float opacityLimit, int tableEntries)
{
  const glm::dvec3 size = scene.Data->Size();
  // The planes only have to leave the volume alone; rays begin and end at its faces.
  const double away = glm::length(scene.Eye - scene.Center);
  const double radius = 0.5 * glm::length(size);
  const double nearPlane = std::max(away - 1.1 * radius, 1e-3 * away);
  const glm::dmat4 projection =
    glm::perspective(glm::radians(scene.ViewAngleDegrees), 1.0, nearPlane, away + 1.1 * radius);
  const glm::dmat4 view = glm::lookAt(scene.Eye, scene.Center, scene.Up);
  const glm::ivec2 picture(scene.Picture);
  TransferFunction transfer;
  transfer.Low = scene.Low;
  transfer.High = scene.High;
  transfer.UnitDistance = scene.UnitDistance;
  for (int i = 0; i < tableEntries; ++i)
  {
    const double part = i / (tableEntries - 1.0);
    transfer.Entries.emplace_back(scene.At(scene.Low + part * (scene.High - scene.Low)));
  }
  RayScene drawn{ RayCamera(projection * view, picture, scene.Center), { glm::ivec2(0), picture },
    glm::scale(glm::dmat4(1.0), scene.Data->Spacing), { glm::ivec3(0), scene.Data->Samples - 1 },
    std::move(transfer), sampleDistance * scene.Data->VoxelLength(), opacityLimit, {} };
  drawn.Shading.On = scene.Shaded; // its coefficients are the scene's
  drawn.Levels = LevelEdges::Following(drawn.DomainCells.Size());
  return drawn;
}

} // namespace banyan::bench
