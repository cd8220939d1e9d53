// SPDX-License-Identifier: BSD-3-Clause
#include "AnyMesh/LinearParts.h"

#include "AnyMesh/SplitRules.h"
#include "AnyMesh/StarShape.h"
#include "ArrayLength.h"
#include "CellArrays.h"
#include "Fields/PieceOfMesh.h"
#include "VoxelCells.h"

#include "Cells/CellMesh.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <utility>

namespace banyan
{
namespace
{

std::string NameOfCell(vtkIdType cell, int type)
{
  const char* const name = vtkCellTypes::GetClassNameFromTypeId(type);
  return "Cell " + std::to_string(cell) + " of the type " + (name ? name : std::to_string(type));
}

class PartsMaker
{
public:
  explicit PartsMaker(vtkUnstructuredGrid* grid)
    : Whole(grid)
    , Points(grid->GetPoints())
  {
  }

  /// Makes room for the parts of all cells; more is taken where polyhedra need it.
  void Reserve(vtkUnsignedCharArray* types)
  {
    std::size_t points = 0;
    std::size_t sources = 0;
    vtkIdType parts = 0;
    vtkIdType corners = 0;
    for (vtkIdType cell = 0; cell < types->GetNumberOfValues(); ++cell)
    {
      const SplitRule* const rule = SplitRuleOf(types->GetValue(cell));
      points += rule ? rule->NewPoints : 1;
      sources += rule ? rule->Sources : 0;
      parts += rule ? static_cast<vtkIdType>(rule->Parts.size()) : 1;
      corners += rule ? rule->Corners : 8;
    }
    this->Points.Reserve(points, sources);
    this->Begins->Allocate(parts + 1);
    this->Types->Allocate(parts);
    this->CellOf.reserve(static_cast<std::size_t>(parts));
    this->Corners->Allocate(corners);
  }

  void AddCell(vtkIdType cell, int type)
  {
    this->Cell = cell;
    const CellShape shape = CellMesh::ShapeOf(static_cast<std::uint8_t>(type));
    if (shape == CellShape::None && !HasLinearParts(type))
    {
      return;
    }
    this->Whole->GetCellPoints(cell, this->Ids);
    this->RequireExisting(*this->Ids);
    if (shape != CellShape::None)
    {
      this->RequirePoints(type, CornersOf(shape));
      this->BeginPart(type);
      this->AddCorners(*this->Ids);
    }
    else if (const SplitRule* const rule = SplitRuleOf(type))
    {
      this->AddByRule(type, *rule);
    }
    else if (type == VTK_POLYHEDRON)
    {
      this->AddPolyhedron();
    }
    else
    {
      this->AddPointSet();
    }
  }

  LinearParts Finish()
  {
    LinearParts parts;
    parts.OldPoints = this->Whole->GetNumberOfPoints();
    parts.OldCells = this->Whole->GetNumberOfCells();
    parts.NewPoints = this->Points.Finish();
    parts.CellOf = std::move(this->CellOf);
    parts.Folded = this->Folded;
    vtkNew<vtkPoints> points;
    points->SetData(parts.PointValues(this->Whole->GetPoints()->GetData()));
    parts.Grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    parts.Grid->SetPoints(points);
    this->Begins->InsertNextValue(this->Corners->GetNumberOfValues());
    vtkNew<vtkCellArray> cells;
    cells->SetData(this->Begins, this->Corners);
    parts.Grid->SetCells(this->Types, cells);
    return parts;
  }

private:
  template <class Points>
  void RequireExisting(const Points& points) const
  {
    for (const vtkIdType point : points)
    {
      if (point < 0 || point >= this->Whole->GetNumberOfPoints())
      {
        throw Error("Cell " + std::to_string(this->Cell) + " refers to point " +
                    std::to_string(point) + ", and the mesh has " +
                    std::to_string(this->Whole->GetNumberOfPoints()) + " points.");
      }
    }
  }

  void RequirePoints(int type, int count) const
  {
    if (this->Ids->GetNumberOfIds() != count)
    {
      throw Error(NameOfCell(this->Cell, type) + " has " +
                  std::to_string(this->Ids->GetNumberOfIds()) + " points in place of " +
                  std::to_string(count) + ".");
    }
  }

  /// Begins a part of the cell; its points follow.
  void BeginPart(int type)
  {
    this->Begins->InsertNextValue(this->Corners->GetNumberOfValues());
    this->Types->InsertNextValue(static_cast<unsigned char>(type));
    this->CellOf.push_back(this->Cell);
  }

  template <class Points>
  void AddCorners(const Points& points)
  {
    for (const vtkIdType point : points)
    {
      this->Corners->InsertNextValue(point);
    }
  }

  void AddTetrahedron(const std::array<vtkIdType, 4>& points)
  {
    this->BeginPart(VTK_TETRA);
    this->AddCorners(points);
  }

  void AddByRule(int type, const SplitRule& rule)
  {
    this->RequirePoints(type, rule.PointCount);
    this->Nodes.clear();
    for (const SplitRule::Node& node : rule.Nodes)
    {
      this->Sources.clear();
      for (const auto& [point, weight] : node)
      {
        this->Sources.emplace_back(this->Ids->GetId(point), weight);
      }
      this->Nodes.push_back(this->Points.Add(this->Sources));
    }
    for (const SplitRule::Part& part : rule.Parts)
    {
      this->BeginPart(part.Type);
      for (const int node : part.Nodes)
      {
        this->Corners->InsertNextValue(this->Nodes[static_cast<std::size_t>(node)]);
      }
    }
  }

  void AddPolyhedron()
  {
    // The number of faces; then of each the number of its points, and these.
    vtkNew<vtkIdList> stream;
    this->Whole->GetFaceStream(this->Cell, stream);
    std::vector<vtkIdType> all;
    std::vector<std::vector<vtkIdType>> faces;
    for (vtkIdType at = 1; at < stream->GetNumberOfIds(); at += stream->GetId(at) + 1)
    {
      if (stream->GetId(at) < 0 || stream->GetId(at) >= stream->GetNumberOfIds() - at)
      {
        throw Error(NameOfCell(this->Cell, VTK_POLYHEDRON) + " has a face that is cut off.");
      }
      const vtkIdType* const first = stream->GetPointer(at + 1);
      faces.emplace_back(first, first + stream->GetId(at));
      this->RequireExisting(faces.back());
      all.insert(all.end(), faces.back().begin(), faces.back().end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (all.size() < 4)
    {
      return; // it has no inside
    }
    if (!IsStarAroundMean(faces, this->Whole->GetPoints()) && this->Folded.Count++ == 0)
    {
      this->Folded.First = this->Cell;
      this->Folded.Type = vtkCellTypes::GetClassNameFromTypeId(VTK_POLYHEDRON);
    }
    const vtkIdType middle = this->Points.AddMean(all);
    for (const std::vector<vtkIdType>& face : faces)
    {
      this->AddFace(face, middle);
    }
  }

  /// Tetrahedra between a face, which is seen from outside, and a point.
  void AddFace(const std::vector<vtkIdType>& face, vtkIdType middle)
  {
    if (face.size() == 3)
    {
      this->AddTetrahedron({ face[0], face[2], face[1], middle });
    }
    else if (face.size() > 3)
    {
      const vtkIdType mean = this->Points.AddMean(face);
      for (std::size_t i = 0; i < face.size(); ++i)
      {
        this->AddTetrahedron({ face[(i + 1) % face.size()], face[i], mean, middle });
      }
    }
  }

  void AddPointSet()
  {
    if (this->Ids->GetNumberOfIds() < 4)
    {
      return; // it has no inside
    }
    this->Whole->GetCell(this->Cell, this->General);
    vtkNew<vtkIdList> ids;
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    this->General->Triangulate(0, ids, places);
    // The numbers mean the cell's points in some versions of VTK, and the grid's in others.
    for (vtkIdType i = 0; i + 3 < places->GetNumberOfPoints(); i += 4)
    {
      this->AddTetrahedron({ this->PointAt(places, i), this->PointAt(places, i + 1),
        this->PointAt(places, i + 2), this->PointAt(places, i + 3) });
    }
  }

  /// The point of the general cell that lies at one of some places.
  vtkIdType PointAt(vtkPoints* places, vtkIdType i) const
  {
    double at[3];
    places->GetPoint(i, at);
    for (vtkIdType point = 0; point < this->General->GetNumberOfPoints(); ++point)
    {
      double there[3];
      this->General->GetPoints()->GetPoint(point, there);
      if (std::equal(at, at + 3, there))
      {
        return this->General->GetPointId(point);
      }
    }
    throw Error(NameOfCell(this->Cell, VTK_CONVEX_POINT_SET) + " has a point that is no number.");
  }

  vtkUnstructuredGrid* Whole;
  WeightedPointMaker Points;
  vtkIdType Cell = 0;
  vtkNew<vtkIdList> Ids; ///< of Cell
  vtkNew<vtkGenericCell> General;
  // Of the parts.
  vtkNew<vtkIdTypeArray> Begins;
  vtkNew<vtkIdTypeArray> Corners;
  vtkNew<vtkUnsignedCharArray> Types;
  std::vector<vtkIdType> CellOf;
  OtherCells Folded;
  // Of a cell.
  std::vector<vtkIdType> Nodes;
  std::vector<WeightedPointMaker::Source> Sources;
};

Hash128 Continue(const Hash128& before, vtkDataArray* array)
{
  const auto bytes =
    static_cast<std::size_t>(array->GetNumberOfValues()) * array->GetDataTypeSize();
  return HashOf(array->GetVoidPointer(0), bytes, before.Low ^ before.High);
}

/// Of all that parts are made of.
Hash128 KeyOf(vtkUnstructuredGrid* grid, vtkUnsignedCharArray* types)
{
  Hash128 key;
  for (vtkDataArray* const array :
    { grid->GetPoints()->GetData(), static_cast<vtkDataArray*>(types),
      grid->GetCells()->GetOffsetsArray(), grid->GetCells()->GetConnectivityArray() })
  {
    key = Continue(key, array);
  }
  vtkNew<vtkIdTypeArray> faces;
  vtkNew<vtkIdList> stream;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    if (types->GetValue(cell) == VTK_POLYHEDRON)
    {
      grid->GetFaceStream(cell, stream);
      std::for_each(
        stream->begin(), stream->end(), [&](vtkIdType id) { faces->InsertNextValue(id); });
    }
  }
  return Continue(key, faces);
}

} // namespace

bool HasLinearParts(int type)
{
  return type == VTK_POLYHEDRON || type == VTK_CONVEX_POINT_SET || SplitRuleOf(type);
}

std::shared_ptr<const LinearParts> LinearPartsOf(
  vtkUnstructuredGrid* grid, const std::shared_ptr<const LinearParts>& before)
{
  const auto types = PlainCellTypesOf(grid);
  const Hash128 key = KeyOf(grid, types);
  if (before && before->Key == key)
  {
    return before;
  }
  PartsMaker maker(grid);
  maker.Reserve(types);
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    maker.AddCell(cell, types->GetValue(cell));
  }
  LinearParts parts = maker.Finish();
  parts.Key = key;
  return std::make_shared<const LinearParts>(std::move(parts));
}

vtkSmartPointer<vtkDataArray> LinearParts::PointValues(vtkDataArray* old) const
{
  CheckLength(old, vtkDataObject::POINT, this->OldPoints);
  const NodeArray from = NodesOf(old, 0);
  vtkSmartPointer<vtkDataArray> values;
  if (FitsFloat(from.Type))
  {
    values = vtkSmartPointer<vtkFloatArray>::New();
  }
  else
  {
    values = vtkSmartPointer<vtkDoubleArray>::New();
  }
  values->SetName(old->GetName());
  values->SetNumberOfComponents(from.Components);
  values->CopyComponentNames(old);
  values->SetNumberOfTuples(this->OldPoints + static_cast<vtkIdType>(this->NewPoints.Count()));
  Dispatch(from.Type,
    [&](auto tag)
    {
      const auto* const first = static_cast<const typename decltype(tag)::Type*>(from.Values);
      const auto count = this->OldPoints * from.Components;
      const auto extend = [&](auto* to)
      {
        using Out = std::decay_t<decltype(*to)>;
        std::transform(
          first, first + count, to, [](auto value) { return static_cast<Out>(value); });
        this->NewPoints.Sum(first, from.Components, to + count);
      };
      FitsFloat(from.Type) ? extend(static_cast<float*>(values->GetVoidPointer(0)))
                           : extend(static_cast<double*>(values->GetVoidPointer(0)));
    });
  return values;
}

vtkSmartPointer<vtkDataArray> LinearParts::CellValues(vtkDataArray* old) const
{
  CheckLength(old, vtkDataObject::CELL, this->OldCells);
  vtkNew<vtkIdList> cells;
  cells->SetNumberOfIds(static_cast<vtkIdType>(this->CellOf.size()));
  std::copy(this->CellOf.begin(), this->CellOf.end(), cells->begin());
  return Chosen(old, cells);
}

} // namespace banyan
