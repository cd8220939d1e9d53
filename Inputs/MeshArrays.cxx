// SPDX-License-Identifier: BSD-3-Clause
#include "MeshArrays.h"

#include "ArrayLength.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstring>
#include <set>

namespace banyan
{
namespace
{

bool Enabled(vtkDataArraySelection* selection, const std::string& name)
{
  return selection->ArrayIsEnabled(name.c_str()) != 0;
}

std::string NameOf(vtkAbstractArray* array, int number)
{
  const char* const name = array->GetName();
  return name && *name ? name : "Unnamed" + std::to_string(number);
}

std::string Joined(const std::set<std::string>& names)
{
  std::string text;
  for (const std::string& name : names)
  {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

/// Arrays of points, or of cells.
struct Found
{
  std::vector<std::pair<std::string, vtkDataArray*>> Numbers;
  std::set<std::string> Ids;    ///< numbers of points or cells, and flags of ghosts
  std::set<std::string> Names;  ///< of those and others that are there
  std::set<std::string> Others; ///< that are no numbers, or not everywhere
};

Found ArraysOf(vtkDataSetAttributes* attributes, const WantedArrays& wanted)
{
  Found found;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = attributes->GetAbstractArray(i);
    const std::string name = NameOf(array, i);
    const bool another = found.Names.insert(name).second;
    if (!another || !wanted(name))
    {
      continue;
    }
    if (IsNoValue(attributes, array))
    {
      found.Ids.insert(name);
      continue;
    }
    vtkDataArray* const numbers = vtkDataArray::SafeDownCast(array);
    if (numbers && numbers->GetDataType() != VTK_BIT)
    {
      found.Numbers.emplace_back(name, numbers);
    }
    else
    {
      found.Others.insert(name);
    }
  }
  return found;
}

/// Throws Error when an array was chosen that is not there.
void CheckChosen(
  vtkDataArraySelection* selection, const char* kind, const std::set<std::string>& names)
{
  for (int i = 0; i < selection->GetNumberOfArrays(); ++i)
  {
    const std::string name = selection->GetArrayName(i);
    // ParaView offers the ghost flags like any array and selects them by default.
    if (selection->GetArraySetting(i) && name != vtkDataSetAttributes::GhostArrayName() &&
        names.count(name) == 0)
    {
      throw Error("There is no " + std::string(kind) + " array " + name +
                  (names.empty() ? "." : "; there are: " + Joined(names) + "."));
    }
  }
}

/// The names of the arrays that were left out of a grid, as not all pieces have them.
std::set<std::string> LeftOut(vtkUnstructuredGrid* grid, int where)
{
  std::set<std::string> names;
  const std::string prefix = LeftOutName(where, {});
  vtkFieldData* const fields = grid->GetFieldData();
  for (int i = 0; i < fields->GetNumberOfArrays(); ++i)
  {
    const std::string name = NameOf(fields->GetAbstractArray(i), i);
    if (name.compare(0, prefix.size(), prefix) == 0)
    {
      names.insert(name.substr(prefix.size()));
    }
  }
  return names;
}

/// Puts arrays that only some pieces have among the others. Such arrays of points are ids.
void AddPartial(vtkUnstructuredGrid* grid, int where, const WantedArrays& wanted, Found& found)
{
  for (const std::string& name : LeftOut(grid, where))
  {
    found.Names.insert(name);
    if (wanted(name))
    {
      (where == vtkDataObject::POINT ? found.Ids : found.Others).insert(name);
    }
  }
}

/// A sentence about ids that somebody chose to write.
std::string AboutIds(vtkDataArraySelection* selection, const char* kind, const Found& found)
{
  std::set<std::string> chosen;
  for (const std::string& name : found.Ids)
  {
    if (Enabled(selection, name) && name != vtkDataSetAttributes::GhostArrayName())
    {
      chosen.insert(name);
    }
  }
  return chosen.empty() ? ""
                        : "The " + std::string(kind) + " arrays " + Joined(chosen) +
                            " are ids, not values, and are not written. ";
}

std::string UniqueName(const std::string& name, const std::set<std::string>& taken)
{
  std::string unique = name;
  while (taken.count(unique) != 0)
  {
    unique += " of cells";
  }
  return unique;
}

} // namespace

bool IsNoValue(vtkDataSetAttributes* attributes, vtkAbstractArray* array)
{
  return array == attributes->GetGlobalIds() || array == attributes->GetPedigreeIds() ||
         (array->GetName() &&
           std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) == 0);
}

std::string LeftOutName(int where, const std::string& array)
{
  return (where == vtkDataObject::POINT ? "at points of some pieces only: "
                                        : "in some pieces only: ") +
         array;
}

std::string TakeLeftOut(vtkUnstructuredGrid* grid)
{
  std::string sentence;
  if (!grid)
  {
    return sentence;
  }
  for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    const std::set<std::string> names = LeftOut(grid, where);
    for (const std::string& name : names)
    {
      grid->GetFieldData()->RemoveArray(LeftOutName(where, name).c_str());
    }
    if (!names.empty())
    {
      sentence += std::string("The ") + (where == vtkDataObject::POINT ? "point" : "cell") +
                  " arrays " + Joined(names) +
                  " are left out: not all blocks of the mesh have them, of one type. ";
    }
  }
  return sentence;
}

bool MeshArrays::Chosen() const
{
  return this->Points->GetNumberOfArrays() > 0 || this->Cells->GetNumberOfArrays() > 0;
}

WantedArrays MeshArrays::WantedPoints(bool leaves) const
{
  return [this, leaves](const std::string& name)
  {
    return !this->Chosen() || Enabled(this->Points, name) || (leaves && Enabled(this->Cells, name));
  };
}

std::vector<std::string> MeshArrays::NotChosen(vtkUnstructuredGrid* grid, bool leaves) const
{
  std::vector<std::string> names;
  for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    const bool points = where == vtkDataObject::POINT;
    vtkDataSetAttributes* const attributes = grid->GetAttributes(where);
    const WantedArrays wanted = this->WantedPoints(leaves);
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* const array = attributes->GetArray(i);
      const std::string name = array ? NameOf(array, i) : "";
      const bool isWanted =
        points || leaves ? wanted(name) : !this->Chosen() || Enabled(this->Cells, name);
      if (array && array->GetDataType() != VTK_BIT && !IsNoValue(attributes, array) && !isWanted)
      {
        names.push_back((points ? "point array " : "cell array ") + name);
      }
    }
  }
  return names;
}

std::vector<MeshArray> MeshArrays::Of(
  vtkUnstructuredGrid* grid, bool leaves, std::string& warning) const
{
  const WantedArrays wantedCells = [this](const std::string& name)
  { return !this->Chosen() || Enabled(this->Cells, name); };
  Found points = ArraysOf(grid->GetPointData(), this->WantedPoints(leaves));
  Found cells = ArraysOf(grid->GetCellData(), wantedCells);
  AddPartial(grid, vtkDataObject::POINT, this->WantedPoints(leaves), points);
  AddPartial(grid, vtkDataObject::CELL, wantedCells, cells);
  CheckChosen(this->Points, "point", points.Names);
  CheckChosen(this->Cells, "cell", leaves ? points.Names : cells.Names);

  std::vector<MeshArray> arrays;
  std::set<std::string> taken;
  for (const auto& point : points.Numbers)
  {
    CheckLength(point.second, vtkDataObject::POINT, grid->GetNumberOfPoints());
    arrays.push_back({ point.second, point.first, {} });
    taken.insert(point.first);
  }
  for (const auto& cell : cells.Numbers)
  {
    CheckLength(cell.second, vtkDataObject::CELL, grid->GetNumberOfCells());
    const std::string name = UniqueName(cell.first, taken);
    arrays.push_back({ cell.second, name, cell.first });
    taken.insert(name);
  }
  if (!points.Others.empty())
  {
    warning +=
      "The point arrays " + Joined(points.Others) + " are not numbers and are not written. ";
  }
  if (!cells.Others.empty())
  {
    warning += "The cell arrays " + Joined(cells.Others) +
               " are not numbers, or not the same in all pieces or blocks of the mesh, and are not "
               "written. ";
  }
  if (arrays.empty())
  {
    throw Error("There is no array of numbers to write at the points or cells of the mesh. " +
                AboutIds(this->Points, "point", points) + AboutIds(this->Cells, "cell", cells) +
                warning);
  }
  return arrays;
}

} // namespace banyan
