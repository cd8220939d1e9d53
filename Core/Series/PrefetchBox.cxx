#include "Codec/BlockModes.h"
#include "Codec/DecodeStages.h"
#include "Codec/GroupOrder.h"
#include "Series/GroupReader.h"

namespace banyan
{

void GroupField::Prefetch(int step, int plane, const glm::ivec3& block)
{
  const stages::In stage(stages::Prefetch);
  const group::BlockEntry& entry =
    this->Step(step).Planes[static_cast<std::size_t>(plane)][this->IndexOf(plane, block)];
  const auto fetch = [&](int from)
  {
    if (const LatticeCache::Box box = LatticeCache::Process().Find(this->KeyOf(from, plane, block)))
    {
      box->Prefetch();
      return true;
    }
    return false;
  };
  const bool refers =
    entry.Same || (!entry.Uniform && block::ModeOf(entry.Mode).From != block::Reference::None);
  if (fetch(step) || !refers)
  {
    return;
  }
  const StepReferences references =
    ReferencesOfStep(step, this->File.Steps(), this->FieldHead.Open);
  if (references.Any())
  {
    fetch(references.A);
    if (references.B != references.A && !entry.Same)
    {
      fetch(references.B);
    }
  }
}

} // namespace banyan
