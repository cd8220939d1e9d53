// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/SceneDigest.h"

#include "Base/Digest.h"

namespace banyan
{
namespace
{

void AddFunction(Digest& digest, const TransferFunction& function)
{
  digest.Add(function.Low);
  digest.Add(function.High);
  digest.Add(function.Entries.size());
  digest.Add(function.UnitDistance);
  digest.Add(function.Edges.size());
  for (const FunctionEdge& edge : function.Edges)
  {
    digest.Add(edge.Value);
    digest.Add(edge.Below);
  }
}

void AddShading(Digest& digest, const RayShading& shading)
{
  digest.Add(shading.On);
  if (shading.On)
  {
    digest.Add(shading.Ambient);
    digest.Add(shading.Diffuse);
    digest.Add(shading.Specular);
    digest.Add(shading.SpecularPower);
  }
}

void AddBlend(Digest& digest, const RayBlend& blend)
{
  digest.Add(blend.Mode);
  if (blend.Mode == BlendMode::Average)
  {
    digest.Add(blend.AveragedLow);
    digest.Add(blend.AveragedHigh);
    digest.Add(blend.Black);
    digest.Add(blend.White);
  }
}

} // namespace

Hash128 DigestOf(const RayScene& scene)
{
  Digest digest;
  digest.Add(DigestWithoutEntries(scene));
  digest.Add(scene.Transfer.Entries);
  return digest.Get();
}

Hash128 DigestWithoutEntries(const RayScene& scene)
{
  Digest digest;
  digest.Add(scene.Camera.ClipToWorldMatrix());
  digest.Add(scene.Camera.ImageSize());
  digest.Add(scene.Camera.AnchorPoint());
  digest.Add(scene.Viewport);
  digest.Add(scene.IndexToWorld);
  digest.Add(scene.DomainCells);
  digest.Add(scene.SampleDistance);
  AddFunction(digest, scene.Transfer);
  digest.Add(scene.Depth);
  AddShading(digest, scene.Shading);
  digest.Add(scene.ClipPlanes.size());
  for (const ClipPlane& plane : scene.ClipPlanes)
  {
    digest.Add(plane.Normal);
    digest.Add(plane.Offset);
  }
  digest.Add(scene.Interpolation);
  AddBlend(digest, scene.Blend);
  return digest.Get();
}

} // namespace banyan
