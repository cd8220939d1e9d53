// SPDX-License-Identifier: BSD-3-Clause
#include "MeshPieces.h"

#include "ArrayLength.h"
#include "GhostCells.h"
#include "PieceArrays.h"
#include "PieceItems.h"
#include "SetCells.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace banyan
{
namespace
{

class PieceMerger
{
public:
  explicit PieceMerger(const std::vector<vtkUnstructuredGrid*>& pieces)
    : Pieces(pieces)
  {
  }

  vtkSmartPointer<vtkUnstructuredGrid> Merge(const PieceArrays& arrays)
  {
    for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
    {
      this->AddPiece(piece);
    }
    this->SortByGlobalIds();
    const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    this->MakePoints(grid);
    this->MakeCells(grid);
    arrays.AddPoints(this->Points, this->Twins, grid);
    arrays.AddCells(this->Cells, grid);
    this->KeepGlobalIds(
      this->Points, [](vtkUnstructuredGrid* piece) { return piece->GetPointData(); }, grid);
    this->KeepGlobalIds(
      this->Cells, [](vtkUnstructuredGrid* piece) { return piece->GetCellData(); }, grid);
    return grid;
  }

private:
  using Coordinates = std::array<double, 3>;

  vtkDataArray* PointsOf(std::size_t piece) const
  {
    return this->Pieces[piece]->GetPoints()->GetData();
  }

  void AddPiece(std::size_t piece)
  {
    vtkUnstructuredGrid* const grid = this->Pieces[piece];
    CheckLength(GhostFlags(grid->GetCellData()), vtkDataObject::CELL, grid->GetNumberOfCells());
    vtkUnsignedCharArray* const ghosts = grid->GetCellGhostArray();
    const bool some = HasGhosts(ghosts);
    std::vector<char> used(static_cast<std::size_t>(grid->GetNumberOfPoints()), some ? 0 : 1);
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
    {
      if (some && (ghosts->GetValue(cell) & GhostBits) != 0)
      {
        continue;
      }
      this->Cells.push_back({ piece, cell });
      grid->GetCells()->GetCellAtId(cell, ids);
      for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
      {
        if (ids->GetId(i) < 0 || ids->GetId(i) >= grid->GetNumberOfPoints())
        {
          throw Error("Cell " + std::to_string(cell) + " refers to point " +
                      std::to_string(ids->GetId(i)) + ", and its piece has " +
                      std::to_string(grid->GetNumberOfPoints()) + " points");
        }
        used[static_cast<std::size_t>(ids->GetId(i))] = 1;
      }
    }
    this->Merged.emplace_back(used.size(), -1);
    std::map<Coordinates, std::size_t> seen; // how many of this piece lie there
    for (std::size_t id = 0; id < used.size(); ++id)
    {
      if (used[id] != 0)
      {
        this->AddPoint(piece, static_cast<vtkIdType>(id), seen);
      }
    }
  }

  void AddPoint(std::size_t piece, vtkIdType id, std::map<Coordinates, std::size_t>& seen)
  {
    Coordinates at{};
    this->PointsOf(piece)->GetTuple(id, at.data());
    std::vector<vtkIdType>& known = this->AtPlace[at];
    const std::size_t number = seen[at]++;
    if (number == known.size())
    {
      known.push_back(static_cast<vtkIdType>(this->Points.size()));
      this->Points.push_back({ piece, id });
    }
    else
    {
      this->Twins.push_back(
        { this->Points[static_cast<std::size_t>(known[number])], { piece, id } });
    }
    this->Merged[piece][static_cast<std::size_t>(id)] = known[number];
  }

  static vtkDataArray* GlobalIds(vtkDataSetAttributes* attributes)
  {
    return attributes->GetGlobalIds();
  }

  template <class Attributes>
  bool Sorted(
    std::vector<PieceItem>& items, Attributes attributes, std::vector<vtkIdType>& place) const
  {
    std::vector<vtkIdType> ids;
    for (const PieceItem& item : items)
    {
      vtkDataArray* const global = GlobalIds(attributes(this->Pieces[item.Piece]));
      if (!global)
      {
        return false;
      }
      ids.push_back(static_cast<vtkIdType>(global->GetTuple1(item.Id)));
    }
    std::vector<std::size_t> order(items.size());
    std::iota(order.begin(), order.end(), std::size_t{ 0 });
    std::stable_sort(
      order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a] < ids[b]; });
    std::vector<PieceItem> sorted;
    place.resize(items.size());
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      place[order[i]] = static_cast<vtkIdType>(i);
      sorted.push_back(items[order[i]]);
    }
    items = std::move(sorted);
    return true;
  }

  void SortByGlobalIds()
  {
    std::vector<vtkIdType> place;
    if (this->Sorted(
          this->Points, [](vtkUnstructuredGrid* grid) { return grid->GetPointData(); }, place))
    {
      for (std::vector<vtkIdType>& piece : this->Merged)
      {
        for (vtkIdType& point : piece)
        {
          point = point < 0 ? point : place[static_cast<std::size_t>(point)];
        }
      }
    }
    (void)this->Sorted(
      this->Cells, [](vtkUnstructuredGrid* grid) { return grid->GetCellData(); }, place);
  }

  void MakePoints(vtkUnstructuredGrid* grid) const
  {
    bool doubles = false;
    for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
    {
      doubles = doubles || this->PointsOf(piece)->GetDataType() == VTK_DOUBLE;
    }
    vtkNew<vtkPoints> points;
    points->SetDataType(doubles ? VTK_DOUBLE : VTK_FLOAT);
    points->SetNumberOfPoints(static_cast<vtkIdType>(this->Points.size()));
    for (std::size_t i = 0; i < this->Points.size(); ++i)
    {
      points->GetData()->SetTuple(static_cast<vtkIdType>(i),
        this->PointsOf(this->Points[i].Piece)->GetTuple(this->Points[i].Id));
    }
    grid->SetPoints(points);
  }

  void MakeCells(vtkUnstructuredGrid* grid) const
  {
    vtkNew<vtkCellArray> cells;
    vtkNew<vtkUnsignedCharArray> types;
    vtkNew<vtkIdList> ids;
    FaceStreams faces;
    for (const PieceItem& cell : this->Cells)
    {
      vtkUnstructuredGrid* const piece = this->Pieces[cell.Piece];
      piece->GetCells()->GetCellAtId(cell.Id, ids);
      for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
      {
        ids->SetId(i, this->Merged[cell.Piece][static_cast<std::size_t>(ids->GetId(i))]);
      }
      cells->InsertNextCell(ids);
      types->InsertNextValue(static_cast<unsigned char>(piece->GetCellType(cell.Id)));
      if (piece->GetCellType(cell.Id) == VTK_POLYHEDRON)
      {
        this->AddFaces(cell, faces);
      }
    }
    SetCells(grid, types, cells, faces);
  }

  /// The faces of a polyhedron, with the numbers that its points have now.
  void AddFaces(const PieceItem& cell, FaceStreams& faces) const
  {
    vtkNew<vtkIdList> stream;
    this->Pieces[cell.Piece]->GetFaceStream(cell.Id, stream);
    const std::vector<vtkIdType>& merged = this->Merged[cell.Piece];
    const vtkIdType count = stream->GetNumberOfIds();
    faces.push_back(count > 0 ? stream->GetId(0) : 0);
    for (vtkIdType at = 1; at < count;)
    {
      const vtkIdType corners = stream->GetId(at++);
      faces.push_back(corners);
      for (vtkIdType i = 0; i < corners && at < count; ++i, ++at)
      {
        const vtkIdType id = stream->GetId(at);
        const bool known = id >= 0 && id < static_cast<vtkIdType>(merged.size());
        faces.push_back(known ? merged[static_cast<std::size_t>(id)] : -1);
      }
    }
  }

  /// So that what is merged of blocks can be merged with that of other ranks.
  template <class Attributes>
  void KeepGlobalIds(
    const std::vector<PieceItem>& items, Attributes attributes, vtkUnstructuredGrid* grid) const
  {
    vtkNew<vtkIdTypeArray> kept;
    for (const PieceItem& item : items)
    {
      vtkDataArray* const global = GlobalIds(attributes(this->Pieces[item.Piece]));
      if (!global)
      {
        return;
      }
      kept->SetName(global->GetName());
      kept->InsertNextValue(static_cast<vtkIdType>(global->GetTuple1(item.Id)));
    }
    attributes(grid)->SetGlobalIds(kept);
  }

  const std::vector<vtkUnstructuredGrid*>& Pieces;
  std::vector<PieceItem> Points;
  std::vector<PieceItem> Cells;
  PieceArrays::Twins Twins;
  std::vector<std::vector<vtkIdType>> Merged; ///< by piece and its points; -1: left out
  std::map<Coordinates, std::vector<vtkIdType>> AtPlace;
};

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> MergePieces(
  const std::vector<vtkUnstructuredGrid*>& pieces, const WantedArrays& wanted, UnevenArrays uneven)
{
  if (pieces.empty())
  {
    return vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
  if (pieces.size() == 1 && !HasGhosts(pieces[0]->GetCellGhostArray()))
  {
    return pieces[0];
  }
  return PieceMerger(pieces).Merge(PieceArrays(pieces, wanted, uneven));
}

} // namespace banyan
