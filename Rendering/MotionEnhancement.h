// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_MotionEnhancement_h
#define banyan_Rendering_MotionEnhancement_h

#include "Parallel/Fields/InputStamp.h"
#include "Render/Steps/TemporalEnhancement.h"

#include "vtkSmartPointer.h"

#include <array>
#include <memory>
#include <string>

class vtkDataArray;
class vtkDataObject;
class vtkVolumeProperty;

namespace banyan
{

class Communicator;
struct FieldPiece;

/// Temporal enhancement of what a mapper draws: bricks of encoded series are enhanced as they are
/// drawn, plain values when the data change.
class MotionEnhancement
{
public:
  /// Names of the arrays of a data set, beside the drawn one, in which the drawn array's values of
  /// the step before and after are looked for; without them plain data are drawn as they are.
  static const char* PreviousName() { return "banyan: step before"; }
  static const char* NextName() { return "banyan: step after"; }

  /// Collective. Puts enhanced values in the place of a plain piece's, or notes how those of a
  /// series are to be enhanced. The scale is the largest magnitude that the opacity function knows,
  /// so that functions mean the same with and without. Of hyper trees and AMR a copy by reference,
  /// with the enhanced array in the place of the drawn one, takes their place: in each block, what
  /// has as many values as now is compared with.
  ///
  /// A step that one rank has nothing to compare with of is compared with on none: the picture is
  /// that of one rank.
  /// @param strength in [0, 1], the same on all ranks; 0 does nothing
  void Apply(Communicator& communicator, double strength, vtkVolumeProperty* property,
    vtkDataObject* data, FieldPiece& piece);

  /// What a user should know of the last Apply: the step that only some ranks have. Empty if
  /// nothing. The same on all ranks.
  const std::string& Note() const { return this->NoteText; }

private:
  void Agree(Communicator& communicator, vtkDataObject* data, const FieldPiece& piece, bool plain);
  void ApplyHere(
    double strength, vtkVolumeProperty* property, vtkDataObject* data, FieldPiece& piece);
  void ApplyToArray(vtkDataObject* data, FieldPiece& piece);
  void ApplyToLeaves(FieldPiece& piece);

  std::array<bool, 2> Compared{ { false, false } }; ///< step before, after: the same on all ranks
  std::string NoteText;
  vtkSmartPointer<vtkDataArray> Enhanced;
  vtkSmartPointer<vtkDataObject> Leaves; ///< with Enhanced in them; null for other data
  InputStamp Stamp;                      ///< of what it was made of
};

} // namespace banyan

#endif
