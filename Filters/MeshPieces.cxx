#include "MeshPieces.h"

#include "GhostCells.h"
#include "MeshArrays.h"
#include "PieceItems.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <numeric>
#include <set>

namespace banyan
{
namespace
{

class PieceMerger
{
public:
  PieceMerger(const std::vector<vtkUnstructuredGrid*>& pieces, const WantedArrays& wanted)
    : Pieces(pieces)
    , Wanted(wanted)
  {
  }

  vtkSmartPointer<vtkUnstructuredGrid> Merge()
  {
    for (std::size_t piece = 0; piece < this->Pieces.size(); ++piece)
    {
      this->AddPiece(piece);
    }
    this->SortByGlobalIds();
    const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    this->MakePoints(grid);
    this->MakeCells(grid);
    this->MakeArrays(grid);
    this->MakeCellArrays(grid);
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
    grid->Allocate(static_cast<vtkIdType>(this->Cells.size()));
    vtkNew<vtkIdList> ids;
    for (const PieceItem& cell : this->Cells)
    {
      this->Pieces[cell.Piece]->GetCells()->GetCellAtId(cell.Id, ids);
      for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
      {
        ids->SetId(i, this->Merged[cell.Piece][static_cast<std::size_t>(ids->GetId(i))]);
      }
      grid->InsertNextCell(this->Pieces[cell.Piece]->GetCellType(cell.Id), ids);
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

  /// Whether an array has values that are to be kept.
  bool Counts(vtkPointData* points, vtkDataArray* array) const
  {
    return array && array->GetName() && array != points->GetGlobalIds() &&
           std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) != 0 &&
           this->Wanted(array->GetName());
  }

  void MakeArrays(vtkUnstructuredGrid* grid) const
  {
    // An array that the first piece has not is missed there as well.
    for (vtkUnstructuredGrid* piece : this->Pieces)
    {
      vtkPointData* const all = piece->GetPointData();
      for (int a = 0; a < all->GetNumberOfArrays(); ++a)
      {
        vtkDataArray* const array = all->GetArray(a);
        if (this->Counts(all, array) && !grid->GetPointData()->GetArray(array->GetName()))
        {
          const auto joined = this->Joined(array, this->PartsOf(array));
          grid->GetPointData()->AddArray(joined);
          if (array == all->GetPedigreeIds())
          {
            grid->GetPointData()->SetPedigreeIds(joined);
          }
        }
      }
    }
    vtkPointData* const first = this->Pieces[0]->GetPointData();
    if (first->GetScalars() && first->GetScalars()->GetName())
    {
      grid->GetPointData()->SetActiveScalars(first->GetScalars()->GetName());
    }
  }

  /// Those that all pieces have. Others are named in the field data (see InSomePiecesName).
  void MakeCellArrays(vtkUnstructuredGrid* grid) const
  {
    std::set<std::string> done;
    for (vtkUnstructuredGrid* piece : this->Pieces)
    {
      vtkCellData* const all = piece->GetCellData();
      for (int a = 0; a < all->GetNumberOfArrays(); ++a)
      {
        vtkAbstractArray* const array = all->GetAbstractArray(a);
        if (!array->GetName() || array == all->GetGlobalIds() ||
            std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) == 0 ||
            !done.insert(array->GetName()).second)
        {
          continue;
        }
        vtkDataArray* const like = vtkDataArray::SafeDownCast(array);
        if (!like)
        {
          MarkLeftOut(array->GetName(), grid);
          continue;
        }
        this->MakeCellArray(like, grid);
        if (array == all->GetPedigreeIds() && grid->GetCellData()->GetArray(array->GetName()))
        {
          grid->GetCellData()->SetPedigreeIds(grid->GetCellData()->GetArray(array->GetName()));
        }
      }
      vtkFieldData* const fields = piece->GetFieldData();
      for (int a = 0; a < fields->GetNumberOfArrays(); ++a)
      {
        grid->GetFieldData()->AddArray(fields->GetAbstractArray(a));
      }
    }
  }

  void MakeCellArray(vtkDataArray* like, vtkUnstructuredGrid* grid) const
  {
    std::vector<vtkDataArray*> parts;
    bool everywhere = true;
    for (vtkUnstructuredGrid* piece : this->Pieces)
    {
      vtkDataArray* const part = piece->GetCellData()->GetArray(like->GetName());
      const bool fits = part && part->GetDataType() == like->GetDataType() &&
                        part->GetNumberOfComponents() == like->GetNumberOfComponents();
      parts.push_back(part);
      everywhere = everywhere && fits;
    }
    if (everywhere)
    {
      grid->GetCellData()->AddArray(TuplesOf(like, this->Cells, parts));
      return;
    }
    MarkLeftOut(like->GetName(), grid);
  }

  /// Of a cell array that is not in all pieces, or not one of numbers.
  static void MarkLeftOut(const char* array, vtkUnstructuredGrid* grid)
  {
    vtkNew<vtkIntArray> mark;
    mark->InsertNextValue(0); // empty ones are lost between ranks
    mark->SetName(InSomePiecesName(array).c_str());
    grid->GetFieldData()->AddArray(mark);
  }

  std::vector<vtkDataArray*> PartsOf(vtkDataArray* like) const
  {
    std::vector<vtkDataArray*> parts;
    for (vtkUnstructuredGrid* piece : this->Pieces)
    {
      parts.push_back(piece->GetPointData()->GetArray(like->GetName()));
      if (!parts.back() || parts.back()->GetDataType() != like->GetDataType() ||
          parts.back()->GetNumberOfComponents() != like->GetNumberOfComponents())
      {
        throw Error(std::string("The point array ") + like->GetName() +
                    " is not the same in all pieces or blocks of the mesh: choose others with "
                    "'Point Arrays'");
      }
    }
    return parts;
  }

  vtkSmartPointer<vtkDataArray> Joined(
    vtkDataArray* like, const std::vector<vtkDataArray*>& parts) const
  {
    auto whole = TuplesOf(like, this->Points, parts);
    const std::size_t bytes =
      static_cast<std::size_t>(like->GetDataTypeSize()) * like->GetNumberOfComponents();
    for (const auto& twin : this->Twins)
    {
      const auto at = [&](const PieceItem& point)
      {
        return static_cast<const char*>(parts[point.Piece]->GetVoidPointer(0)) +
               static_cast<std::size_t>(point.Id) * bytes;
      };
      if (std::memcmp(at(twin.first), at(twin.second), bytes) != 0)
      {
        throw Error(std::string("Two ranks or blocks have different values of the array ") +
                    like->GetName() + " at the same point of the mesh: which one should be kept?");
      }
    }
    return whole;
  }

  const std::vector<vtkUnstructuredGrid*>& Pieces;
  const WantedArrays& Wanted;
  std::vector<PieceItem> Points;
  std::vector<PieceItem> Cells;
  std::vector<std::pair<PieceItem, PieceItem>> Twins;
  std::vector<std::vector<vtkIdType>> Merged; ///< by piece and its points; -1: left out
  std::map<Coordinates, std::vector<vtkIdType>> AtPlace;
};

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> MergePieces(
  const std::vector<vtkUnstructuredGrid*>& pieces, const WantedArrays& wanted)
{
  if (pieces.empty())
  {
    return vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
  if (pieces.size() == 1 && !HasGhosts(pieces[0]->GetCellGhostArray()))
  {
    return pieces[0];
  }
  return PieceMerger(pieces, wanted).Merge();
}

} // namespace banyan
