// SPDX-License-Identifier: BSD-3-Clause
#include "StepReport.h"

#include "PieceValues.h"

#include "vtkMultiProcessStream.h"

#include "Parallel/Communicate/Communicator.h"
#include "Series/Encode/SeriesEncoder.h"

#include <algorithm>
#include <sstream>

namespace banyan
{
namespace
{

std::vector<WrittenArray>::const_iterator Find(
  const std::vector<WrittenArray>& arrays, const std::string& name)
{
  return std::find_if(
    arrays.begin(), arrays.end(), [&](const WrittenArray& array) { return array.Name == name; });
}

std::string Text(const Box& extent)
{
  std::ostringstream text;
  for (int axis = 0; axis < 3; ++axis)
  {
    text << (axis ? " x " : "") << extent.Lo[axis] << ".." << extent.Hi[axis] - 1;
  }
  return text.str();
}

std::string Text(const glm::dvec3& v)
{
  std::ostringstream text;
  text.precision(17);
  text << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return text.str();
}

std::string ChangeOfPlacement(const Grid& a, const Grid& b)
{
  if (a.Spacing != b.Spacing)
  {
    return "the spacing was " + Text(a.Spacing) + " and is " + Text(b.Spacing);
  }
  if (a.Origin != b.Origin)
  {
    return "the origin was " + Text(a.Origin) + " and is " + Text(b.Origin);
  }
  if (a.Direction != b.Direction)
  {
    return "the direction matrix is another one";
  }
  return {};
}

std::string ChangeOfArrays(
  const std::vector<WrittenArray>& arraysA, const std::vector<WrittenArray>& arraysB)
{
  for (const WrittenArray& array : arraysA)
  {
    const auto same = Find(arraysB, array.Name);
    if (same == arraysB.end())
    {
      return "the point array " + array.Name + " is missing";
    }
    if (same->Type != array.Type)
    {
      return "the array " + array.Name + " was " + banyan::NameOf(array.Type) + " and is " +
             banyan::NameOf(same->Type);
    }
    if (same->Components.size() != array.Components.size())
    {
      return "the array " + array.Name + " had " + std::to_string(array.Components.size()) +
             " component(s) and has " + std::to_string(same->Components.size());
    }
  }
  for (const WrittenArray& array : arraysB)
  {
    if (Find(arraysA, array.Name) == arraysA.end())
    {
      return "there is a new point array " + array.Name;
    }
  }
  return {};
}

void Merge(const StepReport& report, StepAgreement& agreement)
{
  if (agreement.Whole.Extent.Empty())
  {
    agreement.Whole = report.Piece;
    agreement.Arrays = report.Arrays;
    agreement.ActiveScalars = report.ActiveScalars;
    return;
  }
  std::string difference = ChangeOfPlacement(agreement.Whole, report.Piece);
  if (difference.empty())
  {
    difference = ChangeOfArrays(agreement.Arrays, report.Arrays);
  }
  if (!difference.empty() && agreement.Problem.empty())
  {
    agreement.Problem = "The ranks hold different data: from one to another, " + difference + ".";
  }
  agreement.Whole.Extent = Union(agreement.Whole.Extent, report.Piece.Extent);
  for (WrittenArray& array : agreement.Arrays)
  {
    const auto same = Find(report.Arrays, array.Name);
    for (std::size_t c = 0; difference.empty() && c < array.Ranges.size(); ++c)
    {
      array.Ranges[c].Include(same->Ranges[c]);
    }
  }
}

void Save(const WrittenArray& array, vtkMultiProcessStream& stream)
{
  stream << array.Name << static_cast<int>(array.Type) << static_cast<int>(array.Components.size());
  for (std::size_t c = 0; c < array.Components.size(); ++c)
  {
    stream << array.Components[c] << array.Ranges[c].Low << array.Ranges[c].High;
  }
}

WrittenArray LoadArray(vtkMultiProcessStream& stream)
{
  WrittenArray array;
  int type = 0;
  int components = 0;
  stream >> array.Name >> type >> components;
  array.Type = static_cast<ScalarType>(type);
  array.Components.resize(components);
  array.Ranges.resize(components);
  for (int c = 0; c < components; ++c)
  {
    stream >> array.Components[c] >> array.Ranges[c].Low >> array.Ranges[c].High;
  }
  return array;
}

} // namespace

void StepReport::Save(vtkMultiProcessStream& stream) const
{
  stream << this->Problem << this->Warning << static_cast<int>(this->Aborted)
         << this->ActiveScalars;
  for (int axis = 0; axis < 3; ++axis)
  {
    stream << this->Piece.Extent.Lo[axis] << this->Piece.Extent.Hi[axis] << this->Piece.Origin[axis]
           << this->Piece.Spacing[axis];
    for (int row = 0; row < 3; ++row)
    {
      stream << this->Piece.Direction[axis][row];
    }
  }
  stream << static_cast<int>(this->Arrays.size());
  for (const WrittenArray& array : this->Arrays)
  {
    banyan::Save(array, stream);
  }
  stream << static_cast<int>(this->HidesPoints) << static_cast<int>(this->HidesCells)
         << static_cast<int>(this->NotChosen.size());
  for (const std::string& name : this->NotChosen)
  {
    stream << name;
  }
}

void StepReport::Load(vtkMultiProcessStream& stream)
{
  int aborted = 0;
  stream >> this->Problem >> this->Warning >> aborted >> this->ActiveScalars;
  this->Aborted = aborted != 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    stream >> this->Piece.Extent.Lo[axis] >> this->Piece.Extent.Hi[axis] >>
      this->Piece.Origin[axis] >> this->Piece.Spacing[axis];
    for (int row = 0; row < 3; ++row)
    {
      stream >> this->Piece.Direction[axis][row];
    }
  }
  int arrays = 0;
  stream >> arrays;
  this->Arrays.clear();
  for (int i = 0; i < arrays; ++i)
  {
    this->Arrays.push_back(LoadArray(stream));
  }
  int hidesPoints = 0, hidesCells = 0, notChosen = 0;
  stream >> hidesPoints >> hidesCells >> notChosen;
  this->HidesPoints = hidesPoints != 0;
  this->HidesCells = hidesCells != 0;
  this->NotChosen.resize(notChosen);
  for (std::string& name : this->NotChosen)
  {
    stream >> name;
  }
}

StepAgreement Agree(const std::vector<StepReport>& reports)
{
  StepAgreement agreement;
  std::vector<Box> pieces;
  std::vector<std::string> problems;
  for (const StepReport& report : reports)
  {
    problems.push_back(report.Problem);
  }
  agreement.Problem = AgreedError(problems);
  for (const StepReport& report : reports)
  {
    pieces.push_back(report.Piece.Extent);
    agreement.Aborted = agreement.Aborted || report.Aborted;
    agreement.HidesPoints = agreement.HidesPoints || report.HidesPoints;
    agreement.HidesCells = agreement.HidesCells || report.HidesCells;
    agreement.NotChosen.insert(report.NotChosen.begin(), report.NotChosen.end());
    if (agreement.Warning.empty())
    {
      agreement.Warning = report.Warning;
    }
    if (report.Problem.empty() && !report.Piece.Extent.Empty())
    {
      Merge(report, agreement);
    }
  }
  if (agreement.Whole.Extent.Empty() && agreement.Problem.empty())
  {
    agreement.Problem = "The image is empty, so there is nothing to write. If it comes from a file "
                        "that could not be read, an earlier message says why.";
  }
  agreement.Plan = PlanGathering(agreement.Whole.Extent, pieces);
  if (agreement.HidesCells)
  {
    std::vector<Box> cells;
    for (const Box& piece : pieces)
    {
      cells.push_back(CellsIn(piece, agreement.Whole.Extent));
    }
    agreement.CellPlan =
      PlanGathering(CellsIn(agreement.Whole.Extent, agreement.Whole.Extent), cells);
  }
  for (const Box& piece : pieces)
  {
    agreement.HoldsWhole.push_back(piece == agreement.Whole.Extent);
  }
  if (!agreement.Plan.Missing.empty() && agreement.Problem.empty())
  {
    agreement.Problem = "The pieces of the ranks leave out the extent " +
                        Text(agreement.Plan.Missing.front()) + " of " +
                        Text(agreement.Whole.Extent) + ".";
  }
  return agreement;
}

WrittenArray HiddenFlags(ArrayFlags flags)
{
  const ArrayDescription description = DescriptionOfFlags(flags);
  WrittenArray array;
  array.Name = description.Name;
  array.Type = description.Type;
  array.Components = description.ComponentNames;
  array.Flags = flags;
  return array;
}

std::string ChangeBetween(const Grid& before, const Grid& now)
{
  return before.Extent != now.Extent
           ? "the extent was " + Text(before.Extent) + " and is " + Text(now.Extent)
           : ChangeOfPlacement(before, now);
}

std::string ChangeBetween(const StepAgreement& before, const StepAgreement& now)
{
  const std::string change = ChangeBetween(before.Whole, now.Whole);
  return change.empty() ? ChangeOfArrays(before.Arrays, now.Arrays) : change;
}

} // namespace banyan
