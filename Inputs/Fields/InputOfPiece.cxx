// SPDX-License-Identifier: BSD-3-Clause
#include "Fields/InputOfPiece.h"

#include "AnyMesh/CellMeshOfData.h"
#include "Fields/GridOfLeaves.h"
#include "Fields/HiddenInImage.h"
#include "Fields/PieceOfMesh.h"
#include "Fields/PlainSamples.h"
#include "HexMeshOfGrid.h"

#include "Base/Error.h"
#include "Series/Decode/SeriesFile.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace banyan
{
namespace
{

/// The largest error that encoding has made of a component, of the length, or of any component of
/// colours.
double EncodingErrorOf(const vtkBanyanDeferred::Handle& handle, int component)
{
  const std::vector<ComponentIndex>& components =
    handle.Series->Index().Arrays.at(static_cast<std::size_t>(handle.Array)).Components;
  if (component >= 0)
  {
    return components.at(static_cast<std::size_t>(component)).MeasuredMaxError;
  }
  double squares = 0.0;
  double largest = 0.0;
  for (const ComponentIndex& each : components)
  {
    squares += each.MeasuredMaxError * each.MeasuredMaxError;
    largest = std::max(largest, each.MeasuredMaxError);
  }
  // A length is off by no more than the vector.
  return component == SampleArray::Colours ? largest : std::sqrt(squares);
}

PieceFacts FactsOfImage(vtkImageData* image, vtkDataArray* array, int component)
{
  PieceFacts facts;
  facts.Has = PieceFacts::Kind::Image;
  facts.Components = array->GetNumberOfComponents();
  facts.Component = component;
  const int* extent = image->GetExtent();
  for (int i = 0; i < 3; ++i)
  {
    facts.Lo[i] = extent[2 * i];
    facts.Hi[i] = extent[2 * i + 1] + 1;
  }
  image->GetOrigin(facts.Origin);
  image->GetSpacing(facts.Spacing);
  std::copy_n(image->GetDirectionMatrix()->GetData(), 9, facts.Direction);
  facts.HiddenCells = HasHiddenCells(image) ? 1 : 0;
  const vtkBanyanDeferred::Handle* const handle = vtkBanyanDeferred::From(array);
  facts.EncodingError = handle ? EncodingErrorOf(*handle, component) : 0.0;
  if (handle && vtkBanyanDeferred::LiesOnSeries(image, *handle))
  {
    facts.Deferred = 1;
    facts.Step = handle->Step;
    facts.Fraction = handle->Fraction;
    facts.Array = handle->Array;
    facts.Level = handle->Level;
  }
  return facts;
}

} // namespace

InputOfPiece::InputOfPiece(FieldPiece piece, std::shared_ptr<const LinearParts>* parts)
  : Piece(std::move(piece))
  , Parts(parts)
{
}

InputOfPiece::~InputOfPiece() = default;

InputStamp InputOfPiece::Stamp() const
{
  const FieldPiece& piece = this->Piece;
  InputStamp stamp;
  stamp.AddObject(piece.Image);
  stamp.AddObject(piece.Grid);
  stamp.AddObject(piece.Curved);
  stamp.AddObject(piece.Leaves);
  stamp.AddObject(piece.Array);
  stamp.Add(piece.Where);
  stamp.Add(piece.Component);
  stamp.Add(piece.MeshTolerance);
  stamp.Add(piece.KeepsCellValues);
  stamp.Add(piece.Enhancement.Strength);
  stamp.Add(piece.Enhancement.Scale);
  stamp.Add(piece.Problem);
  return stamp;
}

PieceFacts InputOfPiece::Facts() const
{
  if (!this->Piece.Problem.empty())
  {
    throw Error(this->Piece.Problem);
  }
  PieceFacts facts;
  if (this->Piece.Leaves)
  {
    facts.Has = PieceFacts::Kind::Leaves;
  }
  else if (this->Piece.Cells())
  {
    facts.Has = this->Piece.Grid && HasBoxesAlone(this->Piece.Grid) ? PieceFacts::Kind::Mesh
                                                                    : PieceFacts::Kind::Cells;
  }
  else if (this->Piece.Image && this->Piece.Array)
  {
    facts = FactsOfImage(this->Piece.Image, this->Piece.Array, this->Piece.Component);
  }
  return facts;
}

std::shared_ptr<const SeriesFile> InputOfPiece::Series() const
{
  const vtkBanyanDeferred::Handle* const handle = vtkBanyanDeferred::From(this->Piece.Array);
  return handle ? handle->Series : nullptr;
}

SampleArray InputOfPiece::Samples(const glm::ivec3& first) const
{
  return PlainSamples(this->Piece.Image, this->Piece.Array, this->Piece.Component, first);
}

void InputOfPiece::HideCells(const glm::ivec3& first, HiddenCells& hidden) const
{
  HideCellsOf(this->Piece.Image, first, hidden);
}

MeshField::Piece InputOfPiece::Mesh(Communicator& communicator, bool leaves)
{
  if (leaves)
  {
    TakeLeaves(communicator, this->Piece, this->Voxels);
  }
  return PieceOfMesh(this->Piece, this->Values);
}

bool InputOfPiece::KeepsCellValues() const
{
  return this->Piece.KeepsCellValues && this->Piece.Where == ValuesOn::Cells;
}

CellsField::Piece InputOfPiece::Cells()
{
  CellsField::Piece piece;
  piece.KeepsCellValues = this->KeepsCellValues();
  MeshOfData before;
  before.Parts = this->Parts ? *this->Parts : nullptr;
  const MeshOfData mesh = CellMeshOf(this->Piece.Cells(), before);
  if (this->Parts)
  {
    *this->Parts = mesh.Parts;
  }
  piece.Mesh = mesh.Mesh;
  piece.Where = this->Piece.Where;
  piece.OtherCells = mesh.Others.Count > 0 ? mesh.Others.Text() : std::string();
  if (piece.Mesh.CellCount > 0)
  {
    this->Values = mesh.ValuesOf(this->Piece.Array, piece.Where);
    piece.Values = NodesOf(this->Values, this->Piece.Component);
  }
  return piece;
}

} // namespace banyan
