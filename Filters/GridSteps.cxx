// SPDX-License-Identifier: BSD-3-Clause
#include "GridSteps.h"

#include "ArrayLength.h"
#include "PieceValues.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <algorithm>
#include <cstring>
#include <sstream>

namespace banyan
{
namespace
{

constexpr const char* NoMemoryForPoints = "There is not enough memory for the points of the grid.";

Box BoxOf(const int extent[6])
{
  const Box box{ { extent[0], extent[2], extent[4] },
    { extent[1] + 1, extent[3] + 1, extent[5] + 1 } };
  return box.Empty() ? Box{} : box;
}

/// The kind of grid, if it is one that has points of its own.
std::optional<GridKind> KindOf(vtkDataObject* data)
{
  return vtkStructuredGrid::SafeDownCast(data)    ? std::optional(GridKind::Curvilinear)
         : vtkRectilinearGrid::SafeDownCast(data) ? std::optional(GridKind::Rectilinear)
                                                  : std::nullopt;
}

/// The grid that is the only block of composite data with points; other data as they are.
vtkDataObject* OnlyBlock(vtkDataObject* data)
{
  auto* const blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks)
  {
    return data;
  }
  const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  vtkDataObject* only = nullptr;
  for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem())
  {
    vtkDataObject* const block = each->GetCurrentDataObject();
    if (block->GetNumberOfElements(vtkDataObject::POINT) > 0)
    {
      if (only || !KindOf(block))
      {
        return data;
      }
      only = block;
    }
  }
  return only ? only : data;
}

const int* ExtentOf(vtkDataObject* data)
{
  auto* const curvilinear = vtkStructuredGrid::SafeDownCast(data);
  return curvilinear ? curvilinear->GetExtent()
                     : vtkRectilinearGrid::SafeDownCast(data)->GetExtent();
}

std::string Named(const std::optional<PointsForm>& form)
{
  if (!form)
  {
    return "an image, or no grid";
  }
  const bool curvilinear = form->Kind == GridKind::Curvilinear;
  std::string text = curvilinear ? "a curvilinear grid of " : "a rectilinear grid of ";
  for (std::size_t axis = 0; axis < (curvilinear ? 1 : 3); ++axis)
  {
    text += (axis > 0 ? ", " : "") + std::string(NameOf(form->Types[axis]));
  }
  return text;
}

/// The grid as an image with the same arrays.
vtkSmartPointer<vtkImageData> ImageOf(vtkDataSet* grid, const int extent[6])
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetExtent(const_cast<int*>(extent));
  image->GetPointData()->ShallowCopy(grid->GetPointData());
  image->GetCellData()->ShallowCopy(grid->GetCellData());
  image->GetFieldData()->ShallowCopy(grid->GetFieldData());
  image->GetInformation()->Copy(grid->GetInformation());
  return image;
}

/// An array as a block of tuples, which those of another layout are copied into.
vtkSmartPointer<vtkDataArray> AsBlock(vtkDataArray* array)
{
  if (array->HasStandardMemoryLayout())
  {
    return array;
  }
  const auto copy =
    vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array->GetDataType()));
  copy->DeepCopy(array);
  return copy;
}

/// Throws Error where the points of a piece are not as many as its extent says, or are nowhere.
void CheckPlaces(vtkDataArray* points, int components, std::int64_t wanted, const Box& box,
  const unsigned char* flags, const std::string& named)
{
  const std::int64_t tuples = points ? points->GetNumberOfTuples() : 0;
  if (tuples != wanted || (points && points->GetNumberOfComponents() != components))
  {
    throw Error("The grid has " + std::to_string(tuples) + " " + named + ", and its extent needs " +
                std::to_string(wanted) + ".");
  }
  const auto bad =
    FirstNotFinite(TypeOf(points), components, points->GetVoidPointer(0), tuples, flags);
  if (bad)
  {
    std::ostringstream text;
    text << "The grid has " << named << " that are not finite: ";
    if (components == 3)
    {
      const glm::ivec3 size = box.Size();
      text << "the first one is that of i = " << box.Lo.x + *bad % size.x
           << ", j = " << box.Lo.y + *bad / size.x % size.y
           << ", k = " << box.Lo.z + *bad / size.x / size.y << ".";
    }
    else
    {
      text << "the first one is number " << *bad << ".";
    }
    throw Error(text.str() + " A point needs a place, unless it is hidden.");
  }
}

/// The points of a grid that is not empty, checked.
std::array<vtkSmartPointer<vtkDataArray>, 3> PointsOf(vtkDataObject* data, const Box& box)
{
  std::array<vtkSmartPointer<vtkDataArray>, 3> points;
  if (auto* const grid = vtkStructuredGrid::SafeDownCast(data))
  {
    const std::string problem = WrongLength(
      GhostFlags(grid->GetPointData()), vtkDataObject::POINT, static_cast<vtkIdType>(box.Count()));
    if (!problem.empty())
    {
      throw Error(problem);
    }
    vtkDataArray* const array = grid->GetPoints() ? grid->GetPoints()->GetData() : nullptr;
    points[0] = array ? AsBlock(array) : nullptr;
    vtkUnsignedCharArray* const flags = grid->GetPointGhostArray();
    CheckPlaces(points[0], 3, box.Count(), box, flags ? flags->GetPointer(0) : nullptr, "points");
    return points;
  }
  auto* const grid = vtkRectilinearGrid::SafeDownCast(data);
  vtkDataArray* const along[3] = { grid->GetXCoordinates(), grid->GetYCoordinates(),
    grid->GetZCoordinates() };
  for (int axis = 0; axis < 3; ++axis)
  {
    points[static_cast<std::size_t>(axis)] = along[axis] ? AsBlock(along[axis]) : nullptr;
    CheckPlaces(points[static_cast<std::size_t>(axis)], 1, box.Size()[axis], box, nullptr,
      std::string("coordinates along ") + "xyz"[axis]);
  }
  return points;
}

/// The grid that the ranks have parts of, or nothing. Throws CollectiveError where they differ.
std::optional<PointsForm> FormOf(const std::vector<GridSteps::Facts>& all)
{
  const auto isGrid = [](const GridSteps::Facts& facts) { return facts.Grid >= 0; };
  const auto first = std::find_if(all.begin(), all.end(), isGrid);
  if (first == all.end())
  {
    return std::nullopt;
  }
  for (const GridSteps::Facts& facts : all)
  {
    const bool same = facts.Grid == first->Grid && facts.Types == first->Types;
    if (facts.Other != 0 || (isGrid(facts) && !same))
    {
      throw CollectiveError("The ranks hold different kinds of grids, or coordinates of different "
                            "types: a series is made of one.");
    }
  }
  PointsForm form;
  form.Kind = static_cast<GridKind>(first->Grid);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    form.Types[axis] = static_cast<ScalarType>(first->Types[axis]);
  }
  return form;
}

/// Where the points of a curvilinear grid are in an image.
constexpr const char* PointsName = "points";

WrittenArray ArrayOfPoints(ScalarType type)
{
  WrittenArray array;
  array.Name = PointsName;
  array.Type = type;
  array.Components = { "", "", "" };
  return array;
}

} // namespace

/// Looks at what a rank has; gives the grid as an image.
vtkSmartPointer<vtkImageData> GridSteps::LookAt(vtkDataObject* data, Facts& facts)
{
  const std::optional<GridKind> kind = KindOf(data);
  const Box box = kind ? BoxOf(ExtentOf(data)) : Box{};
  if (!kind || box.Empty())
  {
    facts.Other = !kind && data && data->GetNumberOfElements(vtkDataObject::POINT) > 0 ? 1 : 0;
    return vtkSmartPointer<vtkImageData>::New();
  }
  facts.Grid = static_cast<std::int8_t>(*kind);
  this->Points = PointsOf(data, box);
  for (std::size_t axis = 0; axis < 3; ++axis)
  {
    vtkDataArray* const own = this->Points[axis] ? this->Points[axis] : this->Points[0];
    facts.Types[axis] = static_cast<std::int8_t>(TypeOf(own));
  }
  return ImageOf(vtkDataSet::SafeDownCast(data), ExtentOf(data));
}

void GridSteps::Take(vtkSmartPointer<vtkDataObject>& data, const std::string& problem)
{
  Facts mine;
  vtkSmartPointer<vtkImageData> image;
  this->Points = {};
  vtkDataObject* const own = OnlyBlock(data);
  const auto look = [&] { image = problem.empty() ? this->LookAt(own, mine) : nullptr; };
  Collective(this->Ranks, look, NoMemoryForPoints);
  mine.Failed = problem.empty() ? 0 : 1;
  std::vector<Facts> all(static_cast<std::size_t>(this->Ranks.Size()));
  this->Ranks.AllGather(&mine, sizeof(mine), all.data());
  const std::optional<PointsForm> form = FormOf(all);
  if (std::any_of(all.begin(), all.end(), [](const Facts& facts) { return facts.Failed != 0; }))
  {
    if (image && KindOf(own))
    {
      data = image; // what is wrong with others is told, and not the kind of this one
    }
    return;
  }
  if (this->Looked && !(this->Kind == form))
  {
    throw CollectiveError("The data were " + Named(this->Kind) + ", and are " + Named(form) +
                          ". All steps of a series need the same kind of grid.");
  }
  this->Looked = true;
  this->Kind = form;
  if (form || KindOf(own))
  {
    data = image;
    this->Piece = vtkSmartPointer<vtkImageData>::New();
    this->Piece->CopyStructure(image);
  }
}

bool GridSteps::Gather(const StepAgreement& step)
{
  if (!this->Kind || !this->Changed(step))
  {
    return false;
  }
  this->Samples = step.Whole.Extent.Size();
  if (this->Kind->Kind == GridKind::Curvilinear)
  {
    this->GatherCurvilinear(step);
  }
  else
  {
    this->GatherRectilinear(step);
  }
  return true;
}

/// Collective: whether the points of any rank are others than those that were gathered last.
bool GridSteps::Changed(const StepAgreement& step)
{
  const int* const extent = this->Piece->GetExtent();
  Hash128 mine = HashOf(extent, 6 * sizeof(int));
  for (const auto& points : this->Points)
  {
    if (points)
    {
      mine = HashOf(points->GetVoidPointer(0),
        static_cast<std::size_t>(points->GetNumberOfValues()) *
          static_cast<std::size_t>(points->GetDataTypeSize()),
        mine.Low ^ mine.High);
    }
  }
  std::vector<Hash128> now(step.HoldsWhole.size());
  this->Ranks.AllGather(&mine, sizeof(mine), now.data());
  const bool changed = now != this->Gathered;
  this->Gathered = std::move(now);
  return changed;
}

void GridSteps::GatherCurvilinear(const StepAgreement& step)
{
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->CopyStructure(this->Piece);
  if (this->Points[0])
  {
    const auto named = vtkSmartPointer<vtkDataArray>::Take(this->Points[0]->NewInstance());
    named->ShallowCopy(this->Points[0]);
    named->SetName(PointsName);
    image->GetPointData()->AddArray(named);
  }
  this->Gathering.Gather(image, step, { ArrayOfPoints(this->Kind->Types[0]) }, 0, this->Values);
}

/// Coordinates are few: all ranks have all of them, and compare where pieces overlap.
void GridSteps::GatherRectilinear(const StepAgreement& step)
{
  std::string mine(reinterpret_cast<const char*>(this->Piece->GetExtent()), 6 * sizeof(int));
  for (const auto& points : this->Points)
  {
    if (points)
    {
      mine.append(static_cast<const char*>(points->GetVoidPointer(0)),
        static_cast<std::size_t>(points->GetNumberOfValues()) *
          static_cast<std::size_t>(points->GetDataTypeSize()));
    }
  }
  const std::vector<std::string> all = AllGatherStrings(this->Ranks, mine);
  Collective(
    this->Ranks, [&] { this->Join(all, step.Whole.Extent); }, NoMemoryForPoints);
}

/// @param all extents and coordinates of the ranks' pieces, one behind the other
void GridSteps::Join(const std::vector<std::string>& all, const Box& whole)
{
  this->Values.assign(3, {});
  std::array<std::vector<char>, 3> known;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto a = static_cast<std::size_t>(axis);
    this->Values[a].resize(
      static_cast<std::size_t>(whole.Size()[axis]) * SizeOf(this->Kind->Types[a]));
    known[a].resize(static_cast<std::size_t>(whole.Size()[axis]));
  }
  for (const std::string& text : all)
  {
    int extent[6];
    std::memcpy(extent, text.data(), sizeof(extent));
    const Box piece = BoxOf(extent);
    const char* from = text.data() + sizeof(extent);
    for (int axis = 0; axis < 3 && !piece.Empty(); ++axis)
    {
      const auto a = static_cast<std::size_t>(axis);
      const std::size_t bytes = SizeOf(this->Kind->Types[a]);
      for (int i = piece.Lo[axis]; i < piece.Hi[axis]; ++i, from += bytes)
      {
        const auto at = static_cast<std::size_t>(i - whole.Lo[axis]);
        unsigned char* const to = this->Values[a].data() + at * bytes;
        if (known[a][at] != 0 && std::memcmp(to, from, bytes) != 0)
        {
          throw Error(std::string("The pieces of the grid have different coordinates along ") +
                      "xyz"[axis] + " where they meet, at the index " + std::to_string(i) + ".");
        }
        std::memcpy(to, from, bytes);
        known[a][at] = 1;
      }
    }
  }
}

PointsView GridSteps::Whole() const
{
  PointsView view;
  view.Form = *this->Kind;
  view.Samples = this->Samples;
  for (std::size_t i = 0; i < this->Values.size(); ++i)
  {
    view.Values[i] = this->Values[i].data();
  }
  return view;
}

} // namespace banyan
