// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PiecesField_h
#define banyan_Parallel_Fields_PiecesField_h

#include "Parallel/Fields/DrawnField.h"
#include "Parallel/Fields/PieceField.h"

#include <memory>

namespace banyan
{

/// Plain data in pieces on several ranks: a PieceField with the cache and the threads of the
/// process.
class PiecesField final : public DrawnField
{
public:
  /// Collective: see PieceField::Take. Zones stand where they stood, if pieces lie as before.
  /// Throws CollectiveError when one cannot; the field is empty then.
  void Take(Communicator& communicator, const std::vector<Box>& samples, const SampleArray& mine,
    const glm::ivec3& cells, int brickCells, LoadBalancing mode);

  void BeginFrame(Communicator& communicator, RayScene& scene) override;
  void BringLevels(Communicator& communicator, const RayScene& scene, int coarsest) override;
  void EndFrame(Communicator& communicator) override;
  void Clear() override { this->Pieces.reset(); }
  BrickSource* Source() override { return this->Pieces ? this->Pieces->Source() : nullptr; }
  const std::vector<Box>& Zones() const override;
  /// Of values that were looked at when they were taken: where the frames before wanted to know.
  std::vector<Hash128> VisibleContent(const RayScene& scene) override;
  Movement Moved() const override;

private:
  std::unique_ptr<PieceField> Pieces; ///< null when empty
  bool Wanted = true;                 ///< whether frames want to know what the next values are
};

} // namespace banyan

#endif
