// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_ImageOutput_h
#define banyan_Readers_ImageOutput_h

#include "StepRequest.h"
#include "VerifiedBricks.h"
#include "vtkBanyanDeferred.h"

#include "Base/Box.h"

class vtkImageData;
class vtkPointData;

namespace banyan
{

/// When the arrays of an image are decoded, and whether they know their series afterwards.
enum class ArrayForm
{
  Deferred, ///< on first touch: see vtkBanyanDeferred::New
  Decoded,  ///< at once: see vtkBanyanDeferred::NewDecoded
  Plain,    ///< at once, and know nothing: see vtkBanyanDeferred::NewPlain
};

/// The image of a series with the values of a step.
class ImageOutput
{
public:
  /// Grid, hidden points and cells, and arrays.
  /// @param wanted the part of the level's extent that is wanted; it may go beyond
  /// @param direction of the axes, as VTK has it: 3 x 3 numbers, row by row
  /// Throws Error.
  void Fill(const StepRequest& request, const Box& wanted, const double* direction, ArrayForm form,
    vtkImageData* output);

private:
  void AddArrays(const StepRequest& request, vtkBanyanDeferred::Handle handle, ArrayForm form,
    vtkPointData* output);

  VerifiedBricks Verified;
  VerifiedBricks VerifiedNext; ///< of the later step, where values between two are read
};

} // namespace banyan

#endif
