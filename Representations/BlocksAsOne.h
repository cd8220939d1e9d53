#ifndef banyan_Representations_BlocksAsOne_h
#define banyan_Representations_BlocksAsOne_h

#include "vtkSmartPointer.h"

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;

namespace banyan
{

class StepWindow;

/// A data set, or the blocks of one as one grid; null if there is none.
vtkSmartPointer<vtkDataSet> BlocksAsOne(vtkDataObject* data);

/// Adds the values that `array` has in the step before and after to a piece, under the names that
/// MotionEnhancement looks for. Arrays that decode on first touch are left alone: they are drawn
/// from their series, which has the other steps.
void AddNeighbours(vtkDataArray* array, const StepWindow& steps, vtkDataSet* piece);

} // namespace banyan

#endif
