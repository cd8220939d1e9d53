// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_Frame_PlainSteps_h
#define banyan_Testing_Core_Parallel_Frame_PlainSteps_h

#include "Parallel/Fields/Pieces.h"
#include "Parallel/Frame/PlayedSeries.h"

namespace banyan::played
{

/// The steps of FewChanges as arrays: a slab of each on every rank. All steps are written to the
/// same memory, as some simulations do.
class PlainInput final : public StepsInMemory
{
public:
  static constexpr int OtherRange = 5; ///< a step with a larger value
  static constexpr int SomeHidden = 7; ///< this step and the next one have hidden cells

  const Communicator* Ranks = nullptr;

  PieceFacts Facts() const override
  {
    PieceFacts facts;
    const Box samples = this->Slab();
    facts.Has = PieceFacts::Kind::Image;
    facts.Components = 1;
    facts.HiddenCells = this->HiddenHere().Empty() ? 0 : 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      facts.Lo[axis] = samples.Lo[axis];
      facts.Hi[axis] = samples.Hi[axis];
    }
    return facts;
  }
  SampleArray Samples(const glm::ivec3&) const override
  {
    std::vector<float> whole = ValuesOf(this->Step);
    whole.front() = this->Step == OtherRange ? 2.5f : 1.0f;
    if (this->Changed.x >= 0)
    {
      const glm::ivec3& at = this->Changed;
      whole[static_cast<std::size_t>(at.x + Grid.x * (at.y + Grid.y * at.z))] += 0.01f;
    }
    const pieces::Piece<float> piece(whole, Grid, this->Slab());
    this->Memory.resize(piece.Values.size());
    std::copy(piece.Values.begin(), piece.Values.end(), this->Memory.begin());
    SampleArray array = piece.Array;
    array.Values = this->Memory.data();
    return array;
  }
  void HideCells(const glm::ivec3& first, HiddenCells& hidden) const override
  {
    const Box here = this->HiddenHere();
    const std::vector<std::uint8_t> flags(static_cast<std::size_t>(here.Count()), 1);
    hidden.Hide({ here.Lo - first, here.Hi - first }, flags.data(), 1);
  }
  double MeshTolerance() const override { return 0.0; }
  CellsField::Piece Cells() override { return {}; }
  MeshField::Piece Mesh(Communicator&, bool) override { return {}; }

private:
  static inline const glm::ivec3& Grid = played::Samples;

  static const std::vector<float>& ValuesOf(int step)
  {
    static const std::vector<std::vector<float>> steps = []
    {
      std::vector<std::vector<float>> made;
      for (int i = 0; i < Steps; ++i)
      {
        made.push_back(FewChanges(i));
      }
      return made;
    }();
    return steps[static_cast<std::size_t>(step)];
  }
  Box Slab() const
  {
    return pieces::Dealt(pieces::Deal::Slabs, Grid,
      this->Ranks->Size())[static_cast<std::size_t>(this->Ranks->Rank())];
  }
  Box HiddenHere() const
  {
    const int late = this->Step - SomeHidden;
    const Box slab = this->Slab();
    const Box hidden{ { 20, 10 + 4 * late, 20 }, { 40, 30 + 4 * late, 50 } };
    return late == 0 || late == 1 ? Intersection(hidden, { slab.Lo, slab.Hi - 1 }) : Box{};
  }

  mutable std::vector<float> Memory;
};

inline void Join(PlainInput& input, const Communicator& communicator)
{
  input.Ranks = &communicator;
}

/// A field of a rank in memory, and its frames.
struct PlainPlayer : PlayerOf<PlainInput>
{
  explicit PlainPlayer(Communicator& communicator, std::int64_t = -1)
    : PlayerOf<PlainInput>(communicator, PlainInput())
  {
  }
};

} // namespace banyan::played

#endif
