// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_SeriesInformation_h
#define banyan_Readers_SeriesInformation_h

#include "Base/Box.h"
#include "Series/Decode/SeriesFile.h"

#include <string>

class vtkDataArray;
class vtkInformation;

namespace banyan
{

/// Half-open boxes to VTK's extents, which include their last index, and back.
void ToExtent(const Box& box, int extent[6]);
Box FromExtent(const int extent[6]);

/// Tells the pipeline what a series looks like at a level: grid (but that of a mesh), times, active
/// scalars.
void DescribeSeries(const SeriesIndex& index, int level, vtkInformation& information);

/// The step that shows at the time asked for: the last one not after it; the first one before that,
/// and when no time is asked for.
int StepAt(const SeriesIndex& index, vtkInformation& information);

/// Tells a person what a series holds: size, ratio, and the error bound of each array, a line each.
std::string SummaryOf(const SeriesIndex& index);

/// Gives a plain array the range of the whole series as its finite range, which ParaView takes
/// colours from: so they do not depend on the step that is shown first, and do not drift while a
/// series plays. Until the array is modified.
void DescribeRange(const SeriesFile& series, int array, vtkDataArray& values);

} // namespace banyan

#endif
