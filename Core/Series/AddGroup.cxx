// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GroupEncoder.h"

#include <algorithm>

namespace banyan
{

void AddGroup(const EncodedGroup& group, SeriesIndex& index)
{
  index.Segments.push_back(group.Segment);
  index.Times.insert(index.Times.end(), group.Times.begin(), group.Times.end());
  for (std::size_t a = 0; a < index.Arrays.size(); ++a)
  {
    ArrayIndex& array = index.Arrays[a];
    array.Magnitudes.insert(
      array.Magnitudes.end(), group.Magnitudes[a].begin(), group.Magnitudes[a].end());
    for (std::size_t c = 0; c < array.Components.size(); ++c)
    {
      ComponentIndex& to = array.Components[c];
      const ComponentIndex& from = group.Measured[a][c];
      to.Range.Include(from.Range);
      to.MeasuredMaxError = std::max(to.MeasuredMaxError, from.MeasuredMaxError);
      to.MeasuredMaxErrorTransformed =
        std::max(to.MeasuredMaxErrorTransformed, from.MeasuredMaxErrorTransformed);
      to.SumSquaredError += from.SumSquaredError;
      to.StepRmse.insert(to.StepRmse.end(), from.StepRmse.begin(), from.StepRmse.end());
      to.FiniteCount += from.FiniteCount;
      to.NonFiniteCount += from.NonFiniteCount;
      to.ClampedCount += from.ClampedCount;
      to.FillCount += from.FillCount;
      to.InvisibleCount += from.InvisibleCount;
      to.SumWeightedError += from.SumWeightedError;
    }
  }
  EncodeStatistics& to = index.Statistics;
  const EncodeStatistics& from = group.Statistics;
  to.Bricks += from.Bricks;
  to.MacroVoxelBricks += from.MacroVoxelBricks;
  to.UnchangedBricks += from.UnchangedBricks;
  to.MergedBricks += from.MergedBricks;
  to.RawBricks += from.RawBricks;
  to.PayloadBytes += from.PayloadBytes;
  to.TableBytes += from.TableBytes;
  to.Blocks += from.Blocks;
  to.EmptyBlocks += from.EmptyBlocks;
  to.ExceptionVoxels += from.ExceptionVoxels;
  to.ChainSum += from.ChainSum;
  to.ChainBricks += from.ChainBricks;
  to.ChainMost = std::max(to.ChainMost, from.ChainMost);
  to.RepeatedSegments += from.RepeatedSegments;
  to.RepeatedBytes += from.RepeatedBytes;
  index.PayloadBytesIn += group.BytesIn;
}

} // namespace banyan
