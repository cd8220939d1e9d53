// Zones of an encoded series from frame to frame.
#include "DistributedField.h"

namespace banyan
{

void DistributedField::SetLoadBalancing(LoadBalancing mode)
{
  if (mode != this->Balancing)
  {
    this->Balancing = mode;
    this->Reset();
  }
}

void DistributedField::BeginFrame(RayScene& scene)
{
  if (this->Encoded() && this->Bricks)
  {
    this->Balancer.BeginFrame(scene, *this->Bricks);
    this->ZoneCells = this->Balancer.Zones();
  }
}

void DistributedField::EndFrame(Communicator& communicator)
{
  if (this->Encoded())
  {
    this->Balancer.EndFrame(communicator);
  }
}

} // namespace banyan
