// SPDX-License-Identifier: BSD-3-Clause
#include "TreeOutput.h"

#include "LargeArrays.h"
#include "SeriesRangeArray.h"

#include "Mesh/Series/MeanOfChildren.h"
#include "Mesh/Series/MeanOfLeaves.h"
#include "Mesh/Series/TreeCells.h"
#include "Series/Decode/SeriesFile.h"

#include "vtkBitArray.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkNew.h"

#include <algorithm>

namespace banyan
{
/// Makes trees of runs of leaves.
class TreeOutput::Maker
{
public:
  explicit Maker(TreeOutput& output)
    : Output(output)
    , Keys(output.Cells->Leaves.Keys)
    , Levels(output.Cells->Leaves.Levels)
  {
  }

  void MakeGrid()
  {
    vtkHyperTreeGrid* const trees = this->Output.Trees;
    const TreeCells& cells = *this->Output.Cells;
    trees->Initialize();
    trees->SetBranchFactor(2);
    const glm::uvec3 planes(cells.Roots + 1);
    trees->SetDimensions(planes.x, planes.y, planes.z);
    trees->SetXCoordinates(this->Planes(0));
    trees->SetYCoordinates(this->Planes(1));
    trees->SetZCoordinates(this->Planes(2));
  }

  /// The trees whose first leaf is one of these.
  void MakeTrees(std::size_t begin, std::size_t end)
  {
    const TreeCells& cells = *this->Output.Cells;
    const MortonKey size = CubeKeys(cells.RootLevel);
    // A tree that begins before is another piece's.
    std::size_t leaf = begin;
    while (leaf > 0 && leaf < end && this->Keys[leaf] / size == this->Keys[leaf - 1] / size)
    {
      ++leaf;
    }
    while (leaf < end)
    {
      const MortonKey key = this->Keys[leaf] / size * size;
      const std::size_t next = this->First(key + size, leaf);
      this->MakeTree(key, leaf, next);
      leaf = next;
    }
    if (this->AnyMasked)
    {
      vtkNew<vtkBitArray> mask;
      mask->SetNumberOfValues(static_cast<vtkIdType>(this->Output.LeafOf.size()));
      for (std::size_t i = 0; i < this->Output.LeafOf.size(); ++i)
      {
        mask->SetValue(static_cast<vtkIdType>(i), this->Output.LeafOf[i] == Masked ? 1 : 0);
      }
      this->Output.Trees->SetMask(mask);
    }
  }

private:
  vtkSmartPointer<vtkDoubleArray> Planes(int axis) const
  {
    const TreeCells& cells = *this->Output.Cells;
    const StoredMesh& mesh = *this->Output.Mesh;
    const auto planes = vtkSmartPointer<vtkDoubleArray>::New();
    for (int i = 0; i <= cells.Roots[axis]; ++i)
    {
      const std::int64_t at = std::int64_t{ cells.FirstRoot[axis] + i } << cells.RootLevel;
      planes->InsertNextValue(mesh.Origin[axis] + static_cast<double>(at) * mesh.Edge[axis]);
    }
    return planes;
  }

  std::size_t First(MortonKey key, std::size_t from) const
  {
    return static_cast<std::size_t>(
      std::lower_bound(
        this->Keys.begin() + static_cast<std::ptrdiff_t>(from), this->Keys.end(), key) -
      this->Keys.begin());
  }

  void MakeTree(MortonKey key, std::size_t begin, std::size_t end)
  {
    vtkHyperTreeGrid* const trees = this->Output.Trees;
    const TreeCells& cells = *this->Output.Cells;
    const glm::uvec3 at((PositionOfKey(key) >> cells.RootLevel) - cells.FirstRoot);
    vtkIdType number = 0;
    trees->GetIndexFromLevelZeroCoordinates(number, at.x, at.y, at.z);
    trees->InitializeNonOrientedCursor(this->Cursor, number, true);
    this->Cursor->SetGlobalIndexStart(static_cast<vtkIdType>(this->Output.LeafOf.size()));
    this->Visit(key, cells.RootLevel, begin, end, -1);
  }

  void Visit(MortonKey key, int level, std::size_t begin, std::size_t end, std::int64_t parent)
  {
    const auto cell = static_cast<std::size_t>(this->Cursor->GetGlobalNodeIndex());
    if (cell >= this->Output.LeafOf.size())
    {
      this->Output.LeafOf.resize(cell + 1, Masked);
      this->Output.Parent.resize(cell + 1, -1);
    }
    this->Output.Parent[cell] = parent;
    if (begin == end)
    {
      this->AnyMasked = true;
      return;
    }
    if (this->Levels[begin] == level)
    {
      this->Output.LeafOf[cell] = static_cast<std::int64_t>(begin);
      return;
    }
    this->Output.LeafOf[cell] = Coarse;
    this->Cursor->SubdivideLeaf();
    for (unsigned char child = 0; child < 8; ++child)
    {
      const MortonKey below = key + child * CubeKeys(level - 1);
      const std::size_t next =
        child == 7 ? end : std::min(end, this->First(below + CubeKeys(level - 1), begin));
      this->Cursor->ToChild(child);
      this->Visit(below, level - 1, begin, next, static_cast<std::int64_t>(cell));
      this->Cursor->ToParent();
      begin = next;
    }
  }

  TreeOutput& Output;
  const std::vector<MortonKey>& Keys;
  const std::vector<std::uint8_t>& Levels;
  vtkNew<vtkHyperTreeGridNonOrientedCursor> Cursor;
  bool AnyMasked = false;
};

TreeOutput::TreeOutput() = default;
TreeOutput::~TreeOutput() = default;

void TreeOutput::Forget()
{
  this->Made[0] = -1;
  this->Mesh.reset();
  this->Cells.reset();
  this->Trees = nullptr;
}

void TreeOutput::FillTrees(std::shared_ptr<const StoredMesh> mesh, int level, int piece, int pieces,
  vtkHyperTreeGrid* output)
{
  if (this->Mesh != mesh || this->Made[0] != level || this->Made[1] != piece ||
      this->Made[2] != pieces)
  {
    this->Forget();
    this->Mesh = std::move(mesh);
    this->Cells = std::make_unique<TreeCells>(TreeCellsOf(*this->Mesh, level));
    this->Trees = vtkSmartPointer<vtkHyperTreeGrid>::New();
    this->LeafOf.clear();
    this->Parent.clear();
    Maker maker(*this);
    maker.MakeGrid();
    const auto count = this->Cells->Leaves.Count();
    maker.MakeTrees(static_cast<std::size_t>(count * piece / pieces),
      static_cast<std::size_t>(count * (piece + 1) / pieces));
    this->Made[0] = level;
    this->Made[1] = piece;
    this->Made[2] = pieces;
  }
  output->ShallowCopy(this->Trees);
}

template <class Out, class ValueOfLeaf>
void TreeOutput::Mean(
  const ValueOfLeaf& valueOfLeaf, int components, int component, Out* means) const
{
  std::vector<MeanOfChildren> below(this->LeafOf.size());
  // Children come behind their parents.
  for (std::size_t cell = this->LeafOf.size(); cell-- > 0;)
  {
    const std::int64_t leaf = this->LeafOf[cell];
    double value = below[cell].Value();
    bool fill = below[cell].IsFill();
    if (leaf >= 0)
    {
      value = valueOfLeaf(static_cast<std::size_t>(leaf), fill);
    }
    means[cell * static_cast<std::size_t>(components) + static_cast<std::size_t>(component)] =
      static_cast<Out>(value);
    if (leaf != Masked && this->Parent[cell] >= 0)
    {
      below[static_cast<std::size_t>(this->Parent[cell])].Add(value, fill);
    }
  }
}

template <class T, class Out>
void TreeOutput::FillComponent(const T* samples, const FillSet<T>& fills, bool ofCells,
  int components, int component, Out* means) const
{
  if (ofCells)
  {
    this->Mean(
      [&](std::size_t leaf, bool& fill)
      {
        return MeanOfLeaves<double>(*this->Mesh, samples, components, component,
          this->Cells->FirstCell[leaf], this->Cells->FirstCell[leaf + 1], fills, &fill);
      },
      components, component, means);
    return;
  }
  this->Mean(
    [&](std::size_t leaf, bool& fill)
    {
      T corners[8];
      for (std::size_t i = 0; i < 8; ++i)
      {
        const auto point = static_cast<std::size_t>(this->Cells->Corners[8 * leaf + i]);
        corners[i] =
          samples[static_cast<std::size_t>(components) * this->Mesh->SampleOfPoint[point] +
                  static_cast<std::size_t>(component)];
      }
      return ValueAtCentre(corners, fills, &fill);
    },
    components, component, means);
}

vtkSmartPointer<vtkDataArray> TreeOutput::Values(const vtkBanyanDeferred::Handle& handle) const
{
  const ArrayIndex& array =
    handle.Series->Index().Arrays.at(static_cast<std::size_t>(handle.Array));
  const vtkSmartPointer<vtkDataArray> image = vtkBanyanDeferred::NewPlain(handle);
  const bool small = SizeOf(array.Type) <= 2 || array.Type == ScalarType::Float32;
  vtkSmartPointer<vtkDataArray> means;
  if (small)
  {
    means = vtkSmartPointer<SeriesRangeArray<vtkFloatArray>>::New();
  }
  else
  {
    means = vtkSmartPointer<SeriesRangeArray<vtkDoubleArray>>::New();
  }
  const int components = image->GetNumberOfComponents();
  const bool ofCells = !array.CellArray.empty();
  means->SetName(image->GetName());
  means->SetNumberOfComponents(components);
  means->CopyComponentNames(image);
  SetTuples(means, static_cast<vtkIdType>(this->LeafOf.size()));
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const samples = static_cast<const T*>(image->GetVoidPointer(0));
      for (int c = 0; c < components; ++c)
      {
        const FillSet<T> fills(array.Components.at(static_cast<std::size_t>(c)).FillValues);
        if (small)
        {
          this->FillComponent(
            samples, fills, ofCells, components, c, static_cast<float*>(means->GetVoidPointer(0)));
        }
        else
        {
          this->FillComponent(
            samples, fills, ofCells, components, c, static_cast<double*>(means->GetVoidPointer(0)));
        }
      }
    });
  return means;
}

} // namespace banyan
