// SPDX-License-Identifier: BSD-3-Clause
#include "MotionEnhancement.h"

#include "Fields/FieldPiece.h"

#include "Base/Error.h"
#include "EnhancedArray.h"
#include "LeafParts.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Bricks/ArraySamples.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

int PlaceOf(const FieldPiece& piece)
{
  return piece.Where == ValuesOn::Cells ? vtkDataObject::CELL : vtkDataObject::POINT;
}

/// Null unless it can be compared with `array`.
vtkDataArray* Neighbour(vtkDataSetAttributes* all, const char* name, vtkDataArray* array)
{
  vtkDataArray* const found = all->GetArray(name);
  return found && found->GetNumberOfTuples() == array->GetNumberOfTuples() &&
             found->GetNumberOfComponents() == array->GetNumberOfComponents()
           ? found
           : nullptr;
}

using Neighbours = std::array<vtkDataArray*, 3>; ///< now, before, after

/// @param compared with the step before, after
Neighbours NeighboursOf(
  vtkDataSetAttributes* all, vtkDataArray* array, const std::array<bool, 2>& compared)
{
  return { { array,
    compared[0] ? Neighbour(all, MotionEnhancement::PreviousName(), array) : nullptr,
    compared[1] ? Neighbour(all, MotionEnhancement::NextName(), array) : nullptr } };
}

/// Whether bricks of a series are drawn, which has the other steps.
bool LiesOnSeries(const FieldPiece& piece)
{
  const vtkBanyanDeferred::Handle* const handle = vtkBanyanDeferred::From(piece.Array);
  return handle && piece.Image && vtkBanyanDeferred::LiesOnSeries(piece.Image, *handle);
}

/// What the drawn array lies in, and the array: of each block.
std::vector<std::pair<vtkDataSetAttributes*, vtkDataArray*>> PartsOf(
  vtkDataObject* data, const FieldPiece& piece)
{
  if (!piece.Leaves)
  {
    return { { data->GetAttributes(PlaceOf(piece)), piece.Array } };
  }
  std::vector<std::pair<vtkDataSetAttributes*, vtkDataArray*>> parts;
  for (vtkDataSetAttributes* const values : PartsOfLeaves(piece.Leaves, PlaceOf(piece)))
  {
    // That a block has none is said when the picture is made.
    if (vtkDataArray* const now = values->GetArray(piece.ArrayName.c_str()))
    {
      parts.emplace_back(values, now);
    }
  }
  return parts;
}

/// Null when they cannot be decoded.
vtkSmartPointer<vtkDataArray> Enhance(const Neighbours& arrays, const FieldPiece& piece)
{
  vtkSmartPointer<vtkDataArray> plain[3];
  for (std::size_t i = 0; i < 3; ++i)
  {
    plain[i] = arrays[i] ? vtkBanyanDeferred::Plain(arrays[i]) : nullptr;
  }
  return plain[0] ? EnhancedArray(piece.Enhancement, plain[0], plain[1], plain[2],
                      static_cast<EnhancedPart>(piece.Component))
                  : nullptr;
}

InputStamp StampOf(const Neighbours& arrays, const FieldPiece& piece)
{
  InputStamp stamp;
  for (vtkDataArray* const array : arrays)
  {
    stamp.AddObject(array);
  }
  stamp.Add(piece.Component);
  stamp.Add(piece.Enhancement.Strength);
  stamp.Add(piece.Enhancement.Scale);
  return stamp;
}

constexpr const char* NotDecoded = "The values to be enhanced cannot be decoded.";

} // namespace

/// Collective: which steps all ranks with values in memory have.
void MotionEnhancement::Agree(
  Communicator& communicator, vtkDataObject* data, const FieldPiece& piece, bool plain)
{
  static const char* const names[2] = { PreviousName(), NextName() };
  static const char* const texts[2] = { "before", "after" };
  this->NoteText.clear();
  for (std::size_t i = 0; i < 2; ++i)
  {
    bool all = plain;
    if (plain)
    {
      for (const auto& part : PartsOf(data, piece))
      {
        all = all && Neighbour(part.first, names[i], part.second);
      }
    }
    const bool has = AllMax(communicator, plain && all ? 1.0 : 0.0) > 0.0;
    const bool lacks = AllMax(communicator, plain && !all ? 1.0 : 0.0) > 0.0;
    this->Compared[i] = has && !lacks;
    if (has && lacks)
    {
      this->NoteText += std::string("'Temporal Enhancement' leaves out the step ") + texts[i] +
                        ": some ranks have other cells, trees or blocks there, or cannot read it. ";
    }
  }
}

void MotionEnhancement::Apply(Communicator& communicator, double strength,
  vtkVolumeProperty* property, vtkDataObject* data, FieldPiece& piece)
{
  const bool drawn = data && piece.Array && piece.Problem.empty();
  if (strength == 0.0)
  {
    this->NoteText.clear();
  }
  else
  {
    this->Agree(communicator, data, piece, drawn && !LiesOnSeries(piece));
  }
  try
  {
    this->ApplyHere(drawn ? strength : 0.0, property, data, piece);
  }
  catch (const std::exception& error)
  {
    this->Enhanced = nullptr;
    this->Leaves = nullptr;
    piece.Problem = error.what();
  }
}

void MotionEnhancement::ApplyHere(
  double strength, vtkVolumeProperty* property, vtkDataObject* data, FieldPiece& piece)
{
  if (strength == 0.0)
  {
    this->Enhanced = nullptr;
    this->Leaves = nullptr;
    return;
  }
  if (piece.Component == SampleArray::Colours)
  {
    throw Error("Temporal enhancement is of one value per point, and colours have several: set "
                "'Temporal Enhancement' to 0, or switch 'Map Scalars' (IndependentComponents) on");
  }
  const double* const range = property->GetScalarOpacity(0)->GetRange();
  const double scale = std::max(std::abs(range[0]), std::abs(range[1]));
  piece.Enhancement = {};
  piece.Enhancement.Strength = strength;
  piece.Enhancement.Scale = scale > 0.0 ? scale : 1.0;
  if (piece.Leaves)
  {
    this->ApplyToLeaves(piece);
    return;
  }
  this->Leaves = nullptr;
  if (!LiesOnSeries(piece))
  {
    this->ApplyToArray(data, piece);
  }
}

void MotionEnhancement::ApplyToArray(vtkDataObject* data, FieldPiece& piece)
{
  const Neighbours arrays =
    NeighboursOf(data->GetAttributes(PlaceOf(piece)), piece.Array, this->Compared);
  const InputStamp stamp = StampOf(arrays, piece);
  if (!this->Enhanced || stamp != this->Stamp)
  {
    this->Enhanced = Enhance(arrays, piece);
    if (!this->Enhanced)
    {
      piece.Problem = NotDecoded;
      return;
    }
    this->Stamp = stamp;
  }
  piece.Array = this->Enhanced;
  piece.Component = 0;
}

void MotionEnhancement::ApplyToLeaves(FieldPiece& piece)
{
  // The array of the first block stands for all of them, and the data for what else is new.
  InputStamp stamp = StampOf({ { piece.Array, nullptr, nullptr } }, piece);
  stamp.AddObject(piece.Leaves);
  stamp.Add(this->Compared[0]);
  stamp.Add(this->Compared[1]);
  if (!this->Leaves || stamp != this->Stamp)
  {
    this->Leaves = CopyOfLeaves(piece.Leaves);
    this->Enhanced = nullptr;
    FieldPiece copy = piece;
    copy.Leaves = this->Leaves;
    for (const auto& part : PartsOf(nullptr, copy))
    {
      vtkDataSetAttributes* const values = part.first;
      const vtkSmartPointer<vtkDataArray> enhanced =
        Enhance(NeighboursOf(values, part.second, this->Compared), piece);
      if (!enhanced)
      {
        this->Leaves = nullptr;
        piece.Problem = NotDecoded;
        return;
      }
      enhanced->SetName(piece.ArrayName.c_str());
      values->AddArray(enhanced); // in the place of the one of this name
      this->Enhanced = this->Enhanced ? this->Enhanced : enhanced;
    }
    this->Stamp = stamp;
  }
  piece.Leaves = this->Leaves;
  piece.Array = this->Enhanced;
  piece.Component = 0;
}

} // namespace banyan
