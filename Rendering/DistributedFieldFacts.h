// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_DistributedFieldFacts_h
#define banyan_Rendering_DistributedFieldFacts_h

#include "DistributedField.h"

#include "Series/Grid/Grid.h"

#include <cstdint>

namespace banyan
{

/// Facts that a rank tells the others about its piece. Plain memory: it is sent as it is.
struct DistributedField::Facts
{
  std::int32_t HasData = 0;
  std::int32_t Deferred = 0; ///< drawn from the file, if all ranks can
  std::int32_t Components = 0;
  std::int32_t Lo[3] = { 0, 0, 0 }; ///< samples, half-open
  std::int32_t Hi[3] = { 0, 0, 0 };
  std::int32_t HiddenCells = 0; ///< whether there are some
  double Origin[3] = { 0, 0, 0 };
  double Spacing[3] = { 1, 1, 1 };
  double Direction[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 }; ///< row by row
  double EncodingError = 0.0;
  std::int32_t Step = 0;
  std::int32_t Array = 0;
  std::int32_t Component = 0;
  std::int32_t Level = 0;

  Box Samples() const
  {
    return { { this->Lo[0], this->Lo[1], this->Lo[2] }, { this->Hi[0], this->Hi[1], this->Hi[2] } };
  }

  Grid Geometry() const
  {
    Grid grid;
    grid.Extent = this->Samples();
    for (int i = 0; i < 3; ++i)
    {
      grid.Origin[i] = this->Origin[i];
      grid.Spacing[i] = this->Spacing[i];
      for (int j = 0; j < 3; ++j)
      {
        grid.Direction[j][i] = this->Direction[3 * i + j];
      }
    }
    return grid;
  }
};

} // namespace banyan

#endif
