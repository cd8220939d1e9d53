// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_BlocksAsOne_h
#define banyan_Representations_BlocksAsOne_h

#include "vtkSmartPointer.h"

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;

namespace banyan
{

class MergedBlocks;
class StepWindow;

/// Returns data that can be drawn as they are (data sets, hyper tree grids, overlapping AMR), or
/// blocks as one grid; null if there is none. Hyper tree grids among blocks become grids of their
/// leaves: throws Error where one has none (see GridOfHyperTrees).
/// @param merged what is kept from step to step
vtkSmartPointer<vtkDataObject> BlocksAsOne(vtkDataObject* data, MergedBlocks& merged);

/// (xmin, xmax, ymin, ymax, zmin, zmax) of any of these; uninitialised where there is nothing.
void BoundsOf(vtkDataObject* data, double bounds[6]);

/// Adds the values that `array` has in the step before and after to a piece, under the names that
/// MotionEnhancement looks for. Arrays that decode on first touch are left alone: they are drawn
/// from their series, which has the other steps. Steps with other cells (see HaveSameCells), or
/// that nothing can be drawn of, are taken for steps that are not there. Throws nothing.
/// @return how many steps have other cells
int AddNeighbours(
  vtkDataArray* array, const StepWindow& steps, vtkDataSet* piece, MergedBlocks& merged);

/// The same for hyper trees or AMR, which must be a copy (see CopyOfLeaves).
/// @param array the drawn one, of any block
/// @return how many steps have other leaves
int AddNeighboursToLeaves(vtkDataArray* array, const StepWindow& steps, vtkDataObject* leaves);

} // namespace banyan

#endif
