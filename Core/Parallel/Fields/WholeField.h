// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_WholeField_h
#define banyan_Parallel_Fields_WholeField_h

#include "Parallel/Fields/DrawnField.h"

#include <memory>
#include <utility>

namespace banyan
{

/// Plain data that one rank has and draws alone.
class WholeField final : public DrawnField
{
public:
  /// @param cells of the grid
  void Take(std::unique_ptr<BrickSource> bricks, const Box& cells)
  {
    this->Drawn = std::move(bricks);
    this->ZoneCells = { cells };
  }

  void Clear() override { this->Drawn.reset(); }
  BrickSource* Source() override { return this->Drawn.get(); }
  const std::vector<Box>& Zones() const override { return this->ZoneCells; }

private:
  std::unique_ptr<BrickSource> Drawn;
  std::vector<Box> ZoneCells;
};

} // namespace banyan

#endif
