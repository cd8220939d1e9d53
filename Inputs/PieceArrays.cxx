// SPDX-License-Identifier: BSD-3-Clause
#include "PieceArrays.h"

#include "ArrayLength.h"
#include "MeshArrays.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"

#include <cstring>
#include <set>

namespace banyan
{
namespace
{

void MarkLeftOut(int where, const char* array, vtkUnstructuredGrid* grid)
{
  vtkNew<vtkIntArray> mark;
  mark->InsertNextValue(0); // empty ones are lost between ranks
  mark->SetName(LeftOutName(where, array).c_str());
  grid->GetFieldData()->AddArray(mark);
}

void CopyFields(vtkUnstructuredGrid* from, vtkUnstructuredGrid* to)
{
  vtkFieldData* const fields = from->GetFieldData();
  for (int a = 0; a < fields->GetNumberOfArrays(); ++a)
  {
    to->GetFieldData()->AddArray(fields->GetAbstractArray(a));
  }
}

/// Pedigree ids are no values either, but there are filters that look for them.
bool Passes(vtkDataSetAttributes* all, vtkAbstractArray* array)
{
  return array && array->GetName() && (!IsNoValue(all, array) || array == all->GetPedigreeIds());
}

} // namespace

/// The array of each piece; nothing where one has none, or another one.
std::vector<vtkDataArray*> PieceArrays::PartsOf(int where, vtkDataArray* like) const
{
  std::vector<vtkDataArray*> parts;
  for (vtkUnstructuredGrid* piece : this->Pieces)
  {
    vtkDataArray* const part = piece->GetAttributes(where)->GetArray(like->GetName());
    if (!part || part->GetDataType() != like->GetDataType() ||
        part->GetNumberOfComponents() != like->GetNumberOfComponents())
    {
      return {};
    }
    CheckLength(part, where, piece->GetNumberOfElements(where));
    parts.push_back(part);
  }
  return parts;
}

vtkSmartPointer<vtkDataArray> PieceArrays::Joined(vtkDataArray* like,
  const std::vector<vtkDataArray*>& parts, const std::vector<PieceItem>& points,
  const Twins& twins) const
{
  auto whole = TuplesOf(like, points, parts);
  const std::size_t bytes =
    static_cast<std::size_t>(like->GetDataTypeSize()) * like->GetNumberOfComponents();
  for (const auto& twin : twins)
  {
    const auto at = [&](const PieceItem& point)
    {
      return static_cast<const char*>(parts[point.Piece]->GetVoidPointer(0)) +
             static_cast<std::size_t>(point.Id) * bytes;
    };
    if (std::memcmp(at(twin.first), at(twin.second), bytes) != 0)
    {
      throw Error(std::string("Two ranks or blocks have different values of the array ") +
                  like->GetName() +
                  " at the same point of the mesh: which one should be kept? Choose other arrays "
                  "with 'Point Arrays', or read the blocks that belong together");
    }
  }
  return whole;
}

void PieceArrays::AddPoints(
  const std::vector<PieceItem>& points, const Twins& twins, vtkUnstructuredGrid* grid) const
{
  std::set<std::string> done;
  // An array that the first piece has not is missed there as well.
  for (vtkUnstructuredGrid* piece : this->Pieces)
  {
    vtkPointData* const all = piece->GetPointData();
    for (int a = 0; a < all->GetNumberOfArrays(); ++a)
    {
      vtkDataArray* const array = all->GetArray(a);
      if (!Passes(all, array) || !this->Wanted(array->GetName()) ||
          !done.insert(array->GetName()).second)
      {
        continue;
      }
      const bool ids = array == all->GetPedigreeIds();
      const std::vector<vtkDataArray*> parts = this->PartsOf(vtkDataObject::POINT, array);
      if (parts.empty())
      {
        if (!ids && this->Uneven == UnevenArrays::Refused)
        {
          throw Error(std::string("The point array ") + array->GetName() +
                      " is not the same in all pieces or blocks of the mesh: choose others with "
                      "'Point Arrays'");
        }
        MarkLeftOut(vtkDataObject::POINT, array->GetName(), grid);
        continue;
      }
      const auto joined = this->Joined(array, parts, points, twins);
      grid->GetPointData()->AddArray(joined);
      if (ids)
      {
        grid->GetPointData()->SetPedigreeIds(joined);
      }
    }
  }
  vtkDataArray* const active = this->Pieces[0]->GetPointData()->GetScalars();
  if (active && active->GetName())
  {
    grid->GetPointData()->SetActiveScalars(active->GetName());
  }
}

void PieceArrays::AddCells(const std::vector<PieceItem>& cells, vtkUnstructuredGrid* grid) const
{
  std::set<std::string> done;
  for (vtkUnstructuredGrid* piece : this->Pieces)
  {
    vtkDataSetAttributes* const all = piece->GetAttributes(vtkDataObject::CELL);
    for (int a = 0; a < all->GetNumberOfArrays(); ++a)
    {
      vtkAbstractArray* const array = all->GetAbstractArray(a);
      if (!Passes(all, array) || !done.insert(array->GetName()).second)
      {
        continue;
      }
      vtkDataArray* const like = vtkDataArray::SafeDownCast(array);
      const std::vector<vtkDataArray*> parts =
        like ? this->PartsOf(vtkDataObject::CELL, like) : std::vector<vtkDataArray*>{};
      if (parts.empty())
      {
        MarkLeftOut(vtkDataObject::CELL, array->GetName(), grid);
        continue;
      }
      const auto joined = TuplesOf(like, cells, parts);
      grid->GetAttributes(vtkDataObject::CELL)->AddArray(joined);
      if (array == all->GetPedigreeIds())
      {
        grid->GetAttributes(vtkDataObject::CELL)->SetPedigreeIds(joined);
      }
    }
    CopyFields(piece, grid);
  }
}

} // namespace banyan
