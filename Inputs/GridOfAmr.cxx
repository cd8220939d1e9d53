// SPDX-License-Identifier: BSD-3-Clause
#include "GridOfAmr.h"

#include "ArrayLength.h"
#include "VoxelCells.h"

#include "Base/Error.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include "vtkAMRBox.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUniformGrid.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace banyan
{
namespace
{

constexpr int LeftOut = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL |
                        vtkDataSetAttributes::REFINEDCELL;
/// How far sizes and places may be beside what they should be, in cells: files have few digits.
constexpr double Rounding = 1e-3;

/// How many cells of a level lie along an edge of a cell of level 0: a power of two.
int ScaleOf(vtkOverlappingAMR* blocks, unsigned int level)
{
  double coarsest[3], own[3];
  blocks->GetSpacing(0, coarsest);
  blocks->GetSpacing(level, own);
  const double exact = coarsest[0] / own[0];
  const double exponent = exact > 0.0 ? std::round(std::log2(exact)) : -1.0;
  const double scale = std::exp2(exponent);
  for (int axis = 0; axis < 3; ++axis)
  {
    const double ratio = coarsest[axis] / own[axis];
    if (!(std::abs(ratio - scale) <= Rounding * scale) || exponent < 0.0 || exponent > 30.0)
    {
      throw Error("The cells of level " + std::to_string(level) + " of the AMR are " +
                  std::to_string(ratio) + " times smaller than those of level 0 along axis " +
                  std::to_string(axis) +
                  ": levels of an octree differ by one power of two along all axes. Use 'Resample "
                  "AMR' or 'Resample To Image'.");
    }
  }
  return static_cast<int>(scale);
}

std::string NameOf(unsigned int level, unsigned int index)
{
  return "Block " + std::to_string(index) + " of level " + std::to_string(level) + " of the AMR";
}

vtkUniformGrid* BlockAt(vtkOverlappingAMR* blocks, unsigned int level, unsigned int index)
{
  vtkUniformGrid* const block = blocks->GetDataSet(level, index);
  return block && block->GetNumberOfPoints() > 0 ? block : nullptr;
}

AmrBox BoxOf(vtkOverlappingAMR* blocks, unsigned int level, unsigned int index)
{
  vtkUniformGrid* const block = BlockAt(blocks, level, index);
  const vtkAMRBox& box = blocks->GetAMRBox(level, index);
  double spacing[3];
  blocks->GetSpacing(level, spacing);
  AmrBox made;
  made.Level = static_cast<std::int32_t>(level);
  for (int axis = 0; axis < 3; ++axis)
  {
    made.Lo[axis] = box.GetLoCorner()[axis];
    made.Hi[axis] = box.GetHiCorner()[axis] + 1;
    const int cells = block->GetDimensions()[axis] - 1;
    if (cells < 1)
    {
      throw Error(NameOf(level, index) + " is flat, and a volume is not: show it as 'Surface'.");
    }
    const double first = blocks->GetOrigin()[axis] + made.Lo[axis] * spacing[axis];
    int extent[6];
    block->GetExtent(extent);
    const double begins = block->GetOrigin()[axis] + extent[2 * axis] * block->GetSpacing()[axis];
    // Few digits of a spacing add up along the way from the origin.
    const double tolerance = (std::abs(made.Lo[axis]) * 1e-5 + 0.01) * spacing[axis];
    if (cells != made.Hi[axis] - made.Lo[axis] || std::abs(first - begins) > tolerance)
    {
      throw Error(NameOf(level, index) + " has " + std::to_string(cells) + " cells from " +
                  std::to_string(begins) + " along axis " + std::to_string(axis) +
                  ", and its box " + std::to_string(made.Hi[axis] - made.Lo[axis]) + " from " +
                  std::to_string(first) + ".");
    }
  }
  return made;
}

template <class Function>
void ForBlocks(vtkOverlappingAMR* blocks, const Function& function)
{
  for (unsigned int level = 0; blocks && level < blocks->GetNumberOfLevels(); ++level)
  {
    for (unsigned int index = 0; index < blocks->GetNumberOfDataSets(level); ++index)
    {
      if (BlockAt(blocks, level, index))
      {
        function(level, index);
      }
    }
  }
}

/// How many cells of the next level cover each cell of a block.
std::vector<std::int64_t> Covering(const AmrBox& box, int ratio, const std::vector<AmrBox>& all)
{
  const std::int64_t nx = box.Hi[0] - box.Lo[0], ny = box.Hi[1] - box.Lo[1];
  std::vector<std::int64_t> counts(static_cast<std::size_t>(nx * ny * (box.Hi[2] - box.Lo[2])));
  for (const AmrBox& finer : all)
  {
    if (finer.Level != box.Level + 1)
    {
      continue;
    }
    int lo[3], hi[3];
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto floor = [&](int cell)
      { return static_cast<int>(std::floor(cell / double(ratio))); };
      lo[axis] = std::max(box.Lo[axis], floor(finer.Lo[axis]));
      hi[axis] = std::min(box.Hi[axis], floor(finer.Hi[axis] - 1) + 1);
    }
    const auto along = [&](int axis, std::int64_t cell)
    {
      return std::min<std::int64_t>(finer.Hi[axis], (cell + 1) * ratio) -
             std::max<std::int64_t>(finer.Lo[axis], cell * ratio);
    };
    for (int z = lo[2]; z < hi[2]; ++z)
    {
      for (int y = lo[1]; y < hi[1]; ++y)
      {
        for (int x = lo[0]; x < hi[0]; ++x)
        {
          const std::int64_t cell = ((z - box.Lo[2]) * ny + (y - box.Lo[1])) * nx + (x - box.Lo[0]);
          counts[static_cast<std::size_t>(cell)] += along(0, x) * along(1, y) * along(2, z);
        }
      }
    }
  }
  return counts;
}

/// Appends visible cells of blocks.
class BlockCollector
{
public:
  BlockCollector(vtkOverlappingAMR* blocks, const std::vector<AmrBox>& all)
    : Blocks(blocks)
    , All(all)
  {
    this->Points->SetDataTypeToDouble();
  }

  void Add(unsigned int level, unsigned int index)
  {
    const AmrBox box = BoxOf(this->Blocks, level, index);
    const vtkNew<vtkIdList> kept;
    this->ChooseCells(box, index, kept);
    if (kept->GetNumberOfIds() == 0)
    {
      return;
    }
    const std::int64_t cells[3] = { box.Hi[0] - box.Lo[0], box.Hi[1] - box.Lo[1],
      box.Hi[2] - box.Lo[2] };
    const vtkIdType before = this->Points->GetNumberOfPoints();
    this->AddPoints(box);
    for (vtkIdType i = 0; i < kept->GetNumberOfIds(); ++i)
    {
      const vtkIdType cell = kept->GetId(i);
      const std::int64_t at[3] = { cell % cells[0], cell / cells[0] % cells[1],
        cell / (cells[0] * cells[1]) };
      vtkIdType corners[8];
      for (int c = 0; c < 8; ++c)
      {
        corners[c] = before +
                     ((at[2] + (c >> 2)) * (cells[1] + 1) + at[1] + (c >> 1 & 1)) * (cells[0] + 1) +
                     at[0] + (c & 1);
      }
      this->Voxels.Add(corners);
    }
    this->Used.push_back({ this->Blocks->GetDataSet(level, index), kept });
  }

  vtkSmartPointer<vtkUnstructuredGrid> Grid(const std::string& array) const
  {
    const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    if (this->Used.empty())
    {
      return grid;
    }
    this->Voxels.Finish(grid, this->Points);
    for (const int where : { vtkDataObject::CELL, vtkDataObject::POINT })
    {
      vtkDataSetAttributes* const first = this->Used[0].Block->GetAttributes(where);
      for (int i = 0; i < first->GetNumberOfArrays(); ++i)
      {
        vtkDataArray* const like = first->GetArray(i);
        const std::string name = like && like->GetName() ? like->GetName() : "";
        const bool wanted = like && name != vtkDataSetAttributes::GhostArrayName() &&
                            (array.empty() || name == array);
        if (const auto joined = wanted ? this->Joined(where, like) : nullptr)
        {
          grid->GetAttributes(where)->AddArray(joined);
        }
      }
    }
    return grid;
  }

private:
  struct UsedBlock
  {
    vtkUniformGrid* Block;
    vtkSmartPointer<vtkIdList> Cells;
  };

  void ChooseCells(const AmrBox& box, unsigned int index, vtkIdList* kept) const
  {
    const auto level = static_cast<unsigned int>(box.Level);
    vtkUniformGrid* const block = this->Blocks->GetDataSet(level, index);
    CheckLength(GhostFlags(block->GetCellData()), vtkDataObject::CELL, block->GetNumberOfCells());
    vtkUnsignedCharArray* const flags = block->GetCellGhostArray();
    const int scale = ScaleOf(this->Blocks, level);
    const bool finer = std::any_of(this->All.begin(), this->All.end(),
      [&](const AmrBox& other) { return other.Level == box.Level + 1; });
    const int ratio = finer ? ScaleOf(this->Blocks, level + 1) / scale : 1;
    if (ratio < 1)
    {
      throw Error("The cells of level " + std::to_string(level + 1) +
                  " of the AMR are larger than those of the level before.");
    }
    const std::vector<std::int64_t> counts = Covering(box, ratio, this->All);
    const std::int64_t full = std::int64_t{ ratio } * ratio * ratio;
    for (std::size_t cell = 0; cell < counts.size(); ++cell)
    {
      const auto id = static_cast<vtkIdType>(cell);
      const int flag = flags ? flags->GetValue(id) : 0;
      if (counts[cell] > 0 && counts[cell] < full &&
          (flag & (vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL)) == 0)
      {
        throw Error(
          "Cell " + std::to_string(cell) + " of block " + std::to_string(index) + " of level " +
          std::to_string(level) +
          " of the AMR is covered in part by blocks of the next level: an octree has cells "
          "that are covered, and cells that are not. Use 'Resample AMR'.");
      }
      if (counts[cell] == 0 && (flag & LeftOut) == 0)
      {
        kept->InsertNextId(id);
      }
    }
  }

  void AddPoints(const AmrBox& box)
  {
    const double scale = ScaleOf(this->Blocks, static_cast<unsigned int>(box.Level));
    double coarsest[3];
    this->Blocks->GetSpacing(0, coarsest);
    const double* const origin = this->Blocks->GetOrigin();
    // Places are computed in cells of level 0, so one place has the same bits on all levels.
    const auto at = [&](int axis, int plane)
    { return origin[axis] + plane / scale * coarsest[axis]; };
    for (int z = box.Lo[2]; z <= box.Hi[2]; ++z)
    {
      for (int y = box.Lo[1]; y <= box.Hi[1]; ++y)
      {
        for (int x = box.Lo[0]; x <= box.Hi[0]; ++x)
        {
          this->Points->InsertNextPoint(at(0, x), at(1, y), at(2, z));
        }
      }
    }
  }

  /// Null when a block has no such array.
  vtkSmartPointer<vtkDataArray> Joined(int where, vtkDataArray* like) const
  {
    const auto whole = vtkSmartPointer<vtkDataArray>::Take(like->NewInstance());
    whole->SetName(like->GetName());
    whole->SetNumberOfComponents(like->GetNumberOfComponents());
    whole->CopyComponentNames(like);
    for (const UsedBlock& used : this->Used)
    {
      vtkDataArray* const part = used.Block->GetAttributes(where)->GetArray(like->GetName());
      if (!part || part->GetDataType() != like->GetDataType() ||
          part->GetNumberOfComponents() != like->GetNumberOfComponents())
      {
        return nullptr;
      }
      CheckLength(part, where, used.Block->GetNumberOfElements(where));
      const vtkIdType before = whole->GetNumberOfTuples();
      if (where == vtkDataObject::POINT)
      {
        whole->InsertTuples(before, part->GetNumberOfTuples(), 0, part);
      }
      else
      {
        const auto chosen = Chosen(part, used.Cells);
        whole->InsertTuples(before, chosen->GetNumberOfTuples(), 0, chosen);
      }
    }
    return whole;
  }

  vtkOverlappingAMR* Blocks;
  const std::vector<AmrBox>& All;
  vtkNew<vtkPoints> Points;
  VoxelCells Voxels;
  std::vector<UsedBlock> Used;
};

} // namespace

std::vector<AmrBox> BoxesOf(vtkOverlappingAMR* blocks)
{
  std::vector<AmrBox> boxes;
  ForBlocks(blocks,
    [&](unsigned int level, unsigned int index)
    {
      (void)ScaleOf(blocks, level);
      boxes.push_back(BoxOf(blocks, level, index));
    });
  return boxes;
}

vtkSmartPointer<vtkUnstructuredGrid> GridOfAmr(
  vtkOverlappingAMR* blocks, const std::vector<AmrBox>& all, const std::string& array)
{
  BlockCollector collector(blocks, all);
  ForBlocks(blocks, [&](unsigned int level, unsigned int index) { collector.Add(level, index); });
  return collector.Grid(array);
}

std::vector<AmrBox> BoxesOfAll(Communicator& ranks, const std::vector<AmrBox>& mine)
{
  std::vector<AmrBox> all;
  const std::string bytes(reinterpret_cast<const char*>(mine.data()), mine.size() * sizeof(AmrBox));
  for (const std::string& theirs : AllGatherStrings(ranks, bytes))
  {
    const std::size_t before = all.size();
    all.resize(before + theirs.size() / sizeof(AmrBox));
    if (!theirs.empty())
    {
      std::memcpy(all.data() + before, theirs.data(), theirs.size());
    }
  }
  return all;
}

vtkSmartPointer<vtkUnstructuredGrid> GridOfAmrOnRanks(
  Communicator& ranks, vtkOverlappingAMR* blocks)
{
  std::vector<AmrBox> boxes;
  Collective(ranks, [&] { boxes = BoxesOf(blocks); });
  boxes = BoxesOfAll(ranks, boxes);
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  Collective(ranks, [&] { grid = GridOfAmr(blocks, boxes); });
  return grid;
}

} // namespace banyan
