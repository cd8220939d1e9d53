// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_HeldPiece_h
#define banyan_Representations_HeldPiece_h

#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

namespace banyan
{

/// This rank's piece of data, for ParaView's views: they keep it for each time step that they keep.
/// They may move it as they like: it is an empty mesh to them, or two points, and copies elsewhere
/// hold nothing.
class HeldPiece : public vtkPolyData
{
public:
  static HeldPiece* New();
  vtkTypeMacro(HeldPiece, vtkPolyData);

  /// @param bounds of the piece, for those that get a copy: two corners; null for none
  static vtkSmartPointer<HeldPiece> Of(vtkDataObject* piece, const double* bounds = nullptr);
  /// @param object null, or any
  /// @return what it holds; else an empty image
  static vtkSmartPointer<vtkDataObject> In(vtkDataObject* object);

  void ShallowCopy(vtkDataObject* source) override;

protected:
  HeldPiece() = default;
  ~HeldPiece() override = default;

private:
  HeldPiece(const HeldPiece&) = delete;
  void operator=(const HeldPiece&) = delete;

  vtkSmartPointer<vtkDataObject> Piece;
};

} // namespace banyan

#endif
