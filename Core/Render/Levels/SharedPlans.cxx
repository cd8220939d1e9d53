// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/SharedPlans.h"

#include "Base/Digest.h"
#include "Render/Scene/SceneDigest.h"

namespace banyan
{

std::shared_ptr<const BrickPlan> SharedPlans::PlanOf(
  const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, ThreadPool& pool)
{
  Digest digest;
  digest.Add(DigestOf(level.Scene));
  digest.Add(reinterpret_cast<std::uintptr_t>(&level.Source));
  digest.Add(cells);
  digest.Add(budgetBytes);
  const Hash128 name = digest.Get();
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    if (this->Last && this->Name == name)
    {
      return this->Last;
    }
    this->Last = nullptr; // its memory is there for the next one
  }
  auto plan = std::make_shared<const BrickPlan>(PlanBricks(level, cells, budgetBytes, pool));
  const std::lock_guard<std::mutex> lock(this->Mutex);
  this->Name = name;
  this->Last = plan;
  return plan;
}

} // namespace banyan
