// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_SeriesInformation_h
#define banyan_Readers_SeriesInformation_h

#include "Base/Box.h"
#include "Series/Decode/SeriesFile.h"

#include <string>

class vtkDataArray;
class vtkInformation;
class vtkObject;
class vtkUnsignedCharArray;

namespace banyan
{

class Communicator;
struct StepRequest;

/// Half-open boxes to VTK's extents, which include their last index, and back.
void ToExtent(const Box& box, int extent[6]);
Box FromExtent(const int extent[6]);

/// Whether a file is taken for a series: by its name, or by how it begins.
bool LooksAsSeries(const std::string& path);

/// The number that VTK has for a type of values.
int VtkTypeOf(ScalarType type);

/// The type of data that a series is read as, as a number of VTK's: an image where it is null.
/// @param trees whether meshes are read as hyper tree grids
int OutputTypeOf(const SeriesFile* series, bool trees);

/// Tells the pipeline what a series looks like at a level: grid (but that of a mesh), times, active
/// scalars.
void DescribeSeries(const SeriesIndex& index, int level, vtkInformation& information);

/// Sets step, fraction and time to those that show at the time asked for: the last step not after
/// it; the first one before that, and when no time is asked for.
/// @param interpolate whether a time between two steps shows values between them
void TakeTime(
  const SeriesIndex& index, vtkInformation& information, bool interpolate, StepRequest& request);

/// Sets piece and number of pieces to those that are asked for.
void TakePiece(vtkInformation& information, StepRequest& request);

/// Arrays that stay at a step while others are interpolated.
class HeldArrays
{
public:
  /// Warns of those that a request wants between two steps: one rank, once for the same arrays.
  void Warn(vtkObject& reader, const StepRequest& request, const Communicator& ranks);

private:
  std::string Told; ///< the last sentence
};

/// Tells a person what a series holds: size, ratio, and the error bound of each array, a line each.
std::string SummaryOf(const SeriesIndex& index);

/// Tells an array the range of the whole series.
/// @param ghosts the ghost array of the same output; may be null
/// @param values a SeriesRangeArray; others throw std::bad_cast
void DescribeRange(
  const SeriesFile& series, int array, vtkUnsignedCharArray* ghosts, vtkDataArray& values);

} // namespace banyan

#endif
