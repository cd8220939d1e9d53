// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_WholeField_h
#define banyan_Parallel_Fields_WholeField_h

#include "Parallel/Fields/DrawnField.h"
#include "Render/Bricks/ArrayBrickSource.h"
#include "Render/Bricks/VisibleContent.h"

#include <memory>
#include <utility>

namespace banyan
{

/// Plain data that one rank has and draws alone.
class WholeField final : public DrawnField
{
public:
  /// @param cells of the grid
  void Take(std::unique_ptr<ArrayBrickSource> bricks, const Box& cells)
  {
    this->Drawn = std::move(bricks);
    this->ZoneCells = { cells };
    if (this->Before)
    {
      this->Drawn->TakeKept(*this->Before, cells);
      this->Before.reset();
    }
  }

  /// Drops the values. The next Take looks at bricks that a picture wanted to know, and goes on
  /// with what is packed of those that are the same.
  void LetGoOfValues()
  {
    this->Before = this->Looked ? std::move(this->Drawn) : nullptr;
    this->Drawn.reset();
    this->Looked = false;
    if (this->Before)
    {
      this->Before->LetGoOfValues();
    }
  }

  void Clear() override
  {
    this->Drawn.reset();
    this->Before.reset();
  }
  std::vector<Hash128> VisibleContent(const RayScene& scene) override
  {
    this->Looked = true;
    return this->Drawn ? banyan::VisibleContent(
                           scene, *this->Drawn, CoarsestLevelOf(scene.DomainCells.Size()))
                       : std::vector<Hash128>();
  }
  BrickSource* Source() override { return this->Drawn.get(); }
  const std::vector<Box>& Zones() const override { return this->ZoneCells; }

private:
  std::unique_ptr<ArrayBrickSource> Drawn;
  std::unique_ptr<ArrayBrickSource> Before; ///< without values, while others are taken
  bool Looked = false;                      ///< whether pictures wanted to know what Drawn holds
  std::vector<Box> ZoneCells;
};

} // namespace banyan

#endif
