// SPDX-License-Identifier: BSD-3-Clause
#include "StepReport.h"

#include "ArrayLength.h"
#include "PieceValues.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

std::string Joined(const std::vector<std::string>& names)
{
  std::string text;
  for (const std::string& name : names)
  {
    text += (text.empty() ? "" : ", ") + name;
  }
  return text;
}

std::string NameOf(vtkAbstractArray* array, int index)
{
  const char* name = array->GetName();
  return name && *name ? name : "Unnamed" + std::to_string(index);
}

std::vector<std::string> CellArrayNames(vtkImageData* image)
{
  std::vector<std::string> names;
  vtkCellData* cells = image->GetCellData();
  for (int i = 0; i < cells->GetNumberOfArrays(); ++i)
  {
    const std::string name = NameOf(cells->GetAbstractArray(i), i);
    if (name != vtkDataSetAttributes::GhostArrayName())
    {
      names.push_back(name);
    }
  }
  return names;
}

Grid GridOf(vtkImageData* image)
{
  Grid grid;
  const int* extent = image->GetExtent();
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.Extent.Lo[axis] = extent[2 * axis];
    grid.Extent.Hi[axis] = extent[2 * axis + 1] + 1;
    grid.Origin[axis] = image->GetOrigin()[axis];
    grid.Spacing[axis] = image->GetSpacing()[axis];
    for (int row = 0; row < 3; ++row)
    {
      grid.Direction[axis][row] = image->GetDirectionMatrix()->GetElement(row, axis);
    }
  }
  if (grid.Extent.Empty())
  {
    grid.Extent = Box{};
  }
  return grid;
}

WrittenArray Describe(vtkDataArray* array, const std::string& name)
{
  WrittenArray written;
  written.Name = name;
  written.Type = TypeOf(array);
  for (int c = 0; c < array->GetNumberOfComponents(); ++c)
  {
    const char* component = array->GetComponentName(c);
    written.Components.emplace_back(component ? component : "");
  }
  written.Ranges.resize(written.Components.size());
  return written;
}

/// Compared with those of other steps, NaN is a change: so this comes first.
void CheckPlacement(const Grid& grid, StepReport& report)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!std::isfinite(grid.Origin[axis]) || !std::isfinite(grid.Spacing[axis]))
    {
      report.Problem = "The origin or the spacing of the image is not finite.";
    }
  }
}

/// Says in `report` which chosen arrays are not there.
void CheckSelection(
  vtkDataArraySelection& selection, const std::vector<std::string>& available, StepReport& report)
{
  for (int i = 0; i < selection.GetNumberOfArrays(); ++i)
  {
    const std::string name = selection.GetArrayName(i);
    // ParaView offers the ghost flags like any array and selects them by default. Hidden points
    // are written whether they are chosen or not.
    if (selection.GetArraySetting(i) && name != vtkDataSetAttributes::GhostArrayName() &&
        std::find(available.begin(), available.end(), name) == available.end())
    {
      report.Problem = "There is no point array " + name +
                       (available.empty() ? "." : "; there are: " + Joined(available) + ".");
    }
  }
}

/// The arrays to write of a piece that is not empty; says in `report` what is not written.
std::vector<vtkDataArray*> Choose(
  vtkImageData* image, vtkDataArraySelection& selection, StepReport& report)
{
  std::vector<vtkDataArray*> chosen;
  std::vector<std::string> unfit;
  std::vector<std::string> available;
  vtkPointData* points = image->GetPointData();
  for (int i = 0; i < points->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = points->GetAbstractArray(i);
    const std::string name = NameOf(array, i);
    if (name == vtkDataSetAttributes::GhostArrayName())
    {
      continue;
    }
    available.push_back(name);
    const bool wanted =
      selection.GetNumberOfArrays() == 0 || selection.ArrayIsEnabled(name.c_str());
    vtkDataArray* values = vtkDataArray::SafeDownCast(array);
    if (wanted && values && values->GetDataType() != VTK_BIT)
    {
      report.Problem = report.Problem.empty()
                         ? WrongLength(values, vtkDataObject::POINT, image->GetNumberOfPoints())
                         : report.Problem;
      chosen.push_back(values);
      report.Arrays.push_back(Describe(values, name));
    }
    else if (!wanted && values && values->GetDataType() != VTK_BIT)
    {
      report.NotChosen.push_back("point array " + name);
    }
    else if (wanted)
    {
      unfit.push_back(name + " (" + array->GetDataTypeAsString() + ")");
    }
  }
  CheckSelection(selection, available, report);
  const std::vector<std::string> cells = CellArrayNames(image);
  if (chosen.empty() && report.Problem.empty())
  {
    report.Problem =
      !unfit.empty()
        ? "Only numbers can be written, and not these point arrays: " + Joined(unfit) + "."
      : cells.empty() ? "There is no point array to write."
                      : "There is no point array to write, only cell arrays (" + Joined(cells) +
                          "): apply the filter 'Cell Data to Point Data' first.";
  }
  if (!cells.empty())
  {
    report.Warning += "The cell arrays " + Joined(cells) +
                      " are not written; apply 'Cell Data to Point Data' first to keep them. ";
  }
  if (!unfit.empty())
  {
    report.Warning +=
      "The point arrays " + Joined(unfit) + " are not numbers and are not written. ";
  }
  return chosen;
}

void CheckBlanking(vtkImageData* image, StepReport& report)
{
  for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    const std::string problem = WrongLength(
      GhostFlags(image->GetAttributes(where)), where, image->GetNumberOfElements(where));
    if (!problem.empty())
    {
      report.Problem = problem;
      return;
    }
  }
  report.HidesPoints = Hides(image, ArrayFlags::OfPoints);
  report.HidesCells = Hides(image, ArrayFlags::OfCells);
}

/// Why data of another kind cannot be written, and what to do.
std::string OtherKind(vtkDataObject* data)
{
  const std::string kinds =
    "A Banyan series is made from image data (a regular grid), from a rectilinear or curvilinear "
    "grid, or from an unstructured grid, and the input is ";
  if (!data)
  {
    return kinds + "nothing: see what its source says.";
  }
  const bool table = data->IsA("vtkTable");
  return kinds + data->GetClassName() + ": " +
         (table ? "make a grid of it with 'Table To Structured Grid', and then " : "") +
         "apply 'Resample To Image' first.";
}

} // namespace

StepReport ReportOf(vtkDataObject* data, vtkDataArraySelection& selection, bool withRanges)
{
  StepReport report;
  vtkImageData* image = vtkImageData::SafeDownCast(data);
  if (!image)
  {
    report.Problem = OtherKind(data);
    return report;
  }
  report.Piece = GridOf(image);
  if (report.Piece.Extent.Empty())
  {
    return report;
  }
  const std::vector<vtkDataArray*> chosen = Choose(image, selection, report);
  CheckPlacement(report.Piece, report);
  CheckBlanking(image, report);
  if (vtkDataArray* active = image->GetPointData()->GetScalars())
  {
    report.ActiveScalars = active->GetName() ? active->GetName() : "";
  }
  for (std::size_t i = 0; withRanges && report.Problem.empty() && i < chosen.size(); ++i)
  {
    report.Arrays[i].Ranges = FiniteRangesOf(image, chosen[i]);
  }
  return report;
}

} // namespace banyan
