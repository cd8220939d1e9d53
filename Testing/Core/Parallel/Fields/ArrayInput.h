// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Parallel_Fields_ArrayInput_h
#define banyan_Testing_Core_Parallel_Fields_ArrayInput_h

#include "Parallel/Fields/DistributedField.h"
#include "Parallel/Fields/Pieces.h"
#include "Parallel/MeshMadeAlone.h"

#include <gtest/gtest.h>

/// Input of a field that tests make and change.
namespace array_input
{

using namespace banyan;

inline const glm::ivec3 GridSamples{ 19, 18, 21 };
inline const glm::ivec3 First{ 5, 6, 7 }; ///< of the grid, in extents of pieces

/// What a rank has; tests change it, and Changes with it.
struct Input final : FieldInput
{
  std::uint64_t Changes = 0;
  PieceFacts Piece;
  std::string Problem;
  std::string Unreadable; ///< fails when values are asked for
  SampleArray Values;     ///< positions begin at 0
  MeshField::Piece Boxes;
  CellsField::Piece AnyCells;
  int Tried = 0; ///< how often an octree was looked for
  TemporalEnhancement Motion{ 0.0, 1.0, 0.0 };
  Box Hidden;

  void Have(const SampleArray& values)
  {
    this->Values = values;
    this->Piece.Has = values.Samples.Empty() ? PieceFacts::Kind::Nothing : PieceFacts::Kind::Image;
    this->Piece.Components = values.Components;
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Piece.Lo[axis] = values.Samples.Lo[axis] + First[axis];
      this->Piece.Hi[axis] = values.Samples.Hi[axis] + First[axis];
    }
    ++this->Changes;
  }

  InputStamp Stamp() const override
  {
    InputStamp stamp;
    stamp.Add(this->Changes);
    return stamp;
  }
  PieceFacts Facts() const override
  {
    if (!this->Problem.empty())
    {
      throw Error(this->Problem);
    }
    return this->Piece;
  }
  std::shared_ptr<const SeriesFile> Series() const override { return nullptr; }
  TemporalEnhancement Enhancement() const override { return this->Motion; }
  SampleArray Samples(const glm::ivec3& first) const override
  {
    EXPECT_TRUE(this->Piece.IsImage());
    EXPECT_EQ(first, First);
    if (!this->Unreadable.empty())
    {
      throw Error(this->Unreadable);
    }
    return this->Values;
  }
  void HideCells(const glm::ivec3& first, HiddenCells& hidden) const override
  {
    EXPECT_EQ(this->Piece.HiddenCells, 1);
    const std::vector<std::uint8_t> flags(static_cast<std::size_t>(this->Hidden.Count()), 1);
    hidden.Hide({ this->Hidden.Lo - first, this->Hidden.Hi - first }, flags.data(), 1);
  }
  double MeshTolerance() const override { return ElementOctree::DefaultTolerance; }
  MeshField::Piece Mesh(Communicator&, bool) override
  {
    ++this->Tried;
    return this->Boxes;
  }
  bool KeepsCellValues() const override { return this->AnyCells.KeepsCellValues; }
  CellsField::Piece Cells() override { return this->AnyCells; }
};

/// A grid that is dealt to ranks, as an image on each.
struct Dealt
{
  std::vector<double> Whole = scenes::Sampled<double>(scenes::Standard, GridSamples);
  pieces::Piece<double> Mine;
  Input In;

  explicit Dealt(const Communicator& communicator, pieces::Deal deal = pieces::Deal::Slabs)
    : Mine(this->Whole, GridSamples,
        pieces::Dealt(
          deal, GridSamples, communicator.Size())[static_cast<std::size_t>(communicator.Rank())])
  {
    this->In.Have(this->Mine.Array);
  }
};

} // namespace array_input

#endif
