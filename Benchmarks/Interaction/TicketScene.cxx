// SPDX-License-Identifier: BSD-3-Clause
#include "TicketScene.h"

#include "StandardScenes.h"

#include "Base/Error.h"
#include "Parallel/Balance/ZoneTree.h"
#include "Parallel/Communicate/Communicator.h"

#include <glm/gtc/matrix_transform.hpp>

namespace banyan::bench
{

BenchScene TicketScene(std::shared_ptr<const Volume> volume, const std::string& name, int pixels)
{
  if (name != "S1" && name != "S2" && name != "opaque" && name != "nothing")
  {
    throw Error("There is no scene '" + name + "'; --help lists them.");
  }
  const StandardFunction function = name == "S2" ? StandardFunction::S2 : StandardFunction::S1;
  BenchScene scene = StandardScene(std::move(volume), function, /*shaded=*/false, pixels);
  scene.Name = name;
  for (glm::dvec4& node : scene.Nodes)
  {
    node.a = name == "opaque" ? 1.0 : name == "nothing" ? 0.0 : node.a;
  }
  return scene;
}

RayScene Turned(BenchScene scene, double degrees)
{
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), glm::radians(degrees), scene.Up);
  scene.Eye = scene.Center + glm::dvec3(turn * glm::dvec4(scene.Eye - scene.Center, 0.0));
  return ToRayScene(scene, 1.0, 1.0f - 1.0f / 255.0f);
}

VolumePiece::VolumePiece(const Volume& volume, const Communicator& ranks)
  : Whole(volume)
{
  const std::vector<Box> zones = ZonesOf(EqualZoneTree(volume.Samples - 1, ranks.Size()));
  const Box& zone = zones[static_cast<std::size_t>(ranks.Rank())];
  this->Own = zone.Empty() ? Box{} : Box{ zone.Lo, zone.Hi + 1 };
}

InputStamp VolumePiece::Stamp() const
{
  InputStamp stamp;
  stamp.Add(this->Whole.Values());
  return stamp;
}

PieceFacts VolumePiece::Facts() const
{
  PieceFacts facts;
  facts.Has = this->Own.Empty() ? PieceFacts::Kind::Nothing : PieceFacts::Kind::Image;
  facts.Components = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    facts.Lo[axis] = this->Own.Lo[axis];
    facts.Hi[axis] = this->Own.Hi[axis];
    facts.Spacing[axis] = this->Whole.Spacing[axis];
  }
  return facts;
}

SampleArray VolumePiece::Samples(const glm::ivec3&) const
{
  return PartOf(this->Whole.Array(), this->Own);
}

} // namespace banyan::bench
