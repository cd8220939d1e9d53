// SPDX-License-Identifier: BSD-3-Clause
// Cells that lie in pieces on the ranks, as a field that is drawn.
#include "Cells/DrawnMesh.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/CellsField.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>

namespace
{

using namespace banyan;
using namespace cellmeshes;

OwnedCellMesh Whole()
{
  OwnedCellMesh mesh = Cube(4, Cut::Mixed, { 0.05, 0.05 });
  SetValues(mesh, StandardField());
  return mesh;
}

/// Cells of a mesh that are dealt one by one. The last rank has none where there are several.
OwnedCellMesh PieceOf(const OwnedCellMesh& whole, int rank, int ranks)
{
  OwnedCellMesh piece = whole;
  piece.Ids.clear();
  piece.Offsets = { 0 };
  piece.Types.clear();
  const int dealt = std::max(1, ranks - 1);
  for (std::size_t cell = 0; cell < whole.Types.size(); ++cell)
  {
    if (static_cast<int>(cell) % dealt == rank)
    {
      piece.Ids.insert(piece.Ids.end(), whole.Ids.begin() + whole.Offsets[cell],
        whole.Ids.begin() + whole.Offsets[cell + 1]);
      piece.Offsets.push_back(static_cast<std::int64_t>(piece.Ids.size()));
      piece.Types.push_back(whole.Types[cell]);
    }
  }
  return piece;
}

CellsField::Piece Given(const OwnedCellMesh& mesh)
{
  CellsField::Piece piece;
  piece.Mesh = mesh.View();
  piece.Values.Values = mesh.Values.data();
  return piece;
}

void Take(CellsField& field, Communicator& communicator, const OwnedCellMesh& mesh)
{
  CellsField::Piece piece = Given(mesh);
  const bool has = field.Has(communicator, piece.Mesh);
  field.Take(communicator, std::move(piece), has);
}

const CellField& Drawn(CellsField& field)
{
  return dynamic_cast<CellSource&>(*field.Source()).Cells();
}

TEST(CellsOfRanks, StayWhereTheyAre)
{
  const OwnedCellMesh whole = Whole();
  CellsField alone;
  const auto self = MakeSelfCommunicator();
  Take(alone, *self, whole);
  const DrawnCells& expected = *Drawn(alone).Cells;
  EXPECT_FALSE(expected.IsPiece);
  for (const int ranks : { 2, 3, 5 })
  {
    std::atomic<std::size_t> cells{ 0 };
    std::atomic<std::size_t> border{ 0 };
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        const OwnedCellMesh piece = PieceOf(whole, communicator.Rank(), ranks);
        CellsField field;
        Take(field, communicator, piece);
        const DrawnCells& mine = *Drawn(field).Cells;
        EXPECT_TRUE(mine.IsPiece);
        EXPECT_EQ(mine.Order.size(), piece.Types.size());
        EXPECT_EQ(mine.Count, static_cast<std::int64_t>(whole.Types.size()));
        cells += mine.Order.size();
        border += mine.Border.size();
        EXPECT_EQ(field.Place().Bounds, alone.Place().Bounds);
        EXPECT_EQ(field.Place().IndexToPhysical, alone.Place().IndexToPhysical);
        EXPECT_EQ(field.Note(), "");
        EXPECT_EQ(field.Zones().size(), static_cast<std::size_t>(ranks));
        EXPECT_NE(field.PieceOfCells(), nullptr);
        communicator.Barrier();
      });
    EXPECT_EQ(cells, whole.Types.size());
    EXPECT_EQ(border, expected.Border.size());
  }
}

TEST(CellsOfRanks, NewValuesKeepTheMesh)
{
  const OwnedCellMesh whole = Whole();
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      OwnedCellMesh piece = PieceOf(whole, communicator.Rank(), 3);
      CellsField field;
      Take(field, communicator, piece);
      const std::shared_ptr<const DrawnCells> cells = Drawn(field).Cells;
      const RayScene scene = DrawnMesh(whole).Scene;
      const auto content = field.VisibleContent(scene);
      for (float& value : piece.Values)
      {
        value += 1.0f;
      }
      Take(field, communicator, piece);
      EXPECT_EQ(Drawn(field).Cells, cells);
      EXPECT_NE(field.VisibleContent(scene), content);
      if (communicator.Rank() == 1)
      {
        piece.Points.front() += 0.01;
      }
      Take(field, communicator, piece);
      EXPECT_NE(Drawn(field).Cells, cells) << "a point of one rank has moved";
      communicator.Barrier();
    });
}

/// @param keeps of this rank
void TakeCellValues(
  CellsField& field, Communicator& communicator, const OwnedCellMesh& mesh, bool keeps)
{
  CellsField::Piece piece = Given(mesh);
  piece.Where = ValuesOn::Cells;
  piece.KeepsCellValues = keeps;
  const bool has = field.Has(communicator, piece.Mesh);
  field.Take(communicator, std::move(piece), has);
}

/// The number of each cell, with the cells that a rank has.
OwnedCellMesh WithCellValues(OwnedCellMesh mesh, int first, int step)
{
  mesh.Values.clear();
  for (std::size_t cell = 0; cell < mesh.Types.size(); ++cell)
  {
    mesh.Values.push_back(static_cast<float>(first + static_cast<int>(cell) * step));
  }
  return mesh;
}

TEST(CellsOfRanks, ValuesOfCellsAreMeansOfAllRanksOrKept)
{
  const OwnedCellMesh whole = WithCellValues(Whole(), 0, 1);
  CellsField alone;
  const auto self = MakeSelfCommunicator();
  TakeCellValues(alone, *self, whole, true);
  EXPECT_TRUE(Drawn(alone).OfCells);
  EXPECT_EQ(Drawn(alone).Values, whole.Values);
  TakeCellValues(alone, *self, whole, false);
  EXPECT_FALSE(Drawn(alone).OfCells);
  const std::vector<float> means = Drawn(alone).Values;
  ASSERT_EQ(means.size(), static_cast<std::size_t>(whole.PointCount()));
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      // The last rank has no cells, and the others every second one. Points are those of all.
      const int rank = communicator.Rank();
      const OwnedCellMesh piece = WithCellValues(PieceOf(whole, rank, 3), rank, 2);
      CellsField field;
      TakeCellValues(field, communicator, piece, false);
      EXPECT_FALSE(Drawn(field).OfCells);
      for (const std::int64_t point : piece.Ids)
      {
        const auto at = static_cast<std::size_t>(point);
        ASSERT_NEAR(Drawn(field).Values[at], means[at], 1e-5 * means[at]);
      }
      TakeCellValues(field, communicator, piece, rank == 0);
      EXPECT_TRUE(Drawn(field).OfCells) << "one rank says so";
      EXPECT_EQ(Drawn(field).Values, piece.Values);
      communicator.Barrier();
    });
}

TEST(CellsOfRanks, WhatIsLeftOutIsToldWithItsRank)
{
  const OwnedCellMesh whole = Whole();
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      OwnedCellMesh piece = PieceOf(whole, communicator.Rank(), 3);
      if (communicator.Rank() == 1)
      {
        piece.Ids[static_cast<std::size_t>(piece.Offsets[2])] = piece.PointCount();
        piece.Points.insert(piece.Points.end(), { 0.0, NAN, 0.0 });
        piece.Values.push_back(0.0f);
      }
      CellsField field;
      Take(field, communicator, piece);
      EXPECT_EQ(field.Note(),
        "Cell 2 of rank 1 is left out: coordinates are not finite, or beyond 1e150. ");
      EXPECT_EQ(Drawn(field).Cells->Count, static_cast<std::int64_t>(whole.Types.size() - 1));
      communicator.Barrier();
    });
}

std::string SentenceOf(int ranks, const std::function<void(int, CellsField::Piece&)>& spoil)
{
  const OwnedCellMesh whole = Whole();
  std::string sentence;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      const OwnedCellMesh mesh = PieceOf(whole, communicator.Rank(), ranks);
      CellsField::Piece piece = Given(mesh);
      spoil(communicator.Rank(), piece);
      CellsField field;
      try
      {
        const bool has = field.Has(communicator, piece.Mesh);
        field.Take(communicator, std::move(piece), has);
        ADD_FAILURE() << "rank " << communicator.Rank() << " draws it";
      }
      catch (const CollectiveError& error)
      {
        EXPECT_EQ(field.Source(), nullptr);
        if (communicator.Rank() == 0)
        {
          sentence = error.what();
        }
      }
      communicator.Barrier();
    });
  return sentence;
}

TEST(CellsOfRanks, WhatCannotBeDrawnIsRefusedOnAllOfThem)
{
  const auto out = [](int rank, CellsField::Piece& piece)
  { piece.Mesh.PointCount = rank == 1 ? 20 : piece.Mesh.PointCount; };
  EXPECT_NE(SentenceOf(3, out).find("and the mesh has 20 points"), std::string::npos);
  EXPECT_NE(SentenceOf(3, out).find("Rank 1: "), std::string::npos);
  const auto listed = [](int rank, CellsField::Piece& piece)
  { piece.Mesh.ConnectivityCount = rank == 0 ? 5 : piece.Mesh.ConnectivityCount; };
  EXPECT_NE(SentenceOf(2, listed).find("of the connectivity, which has 5"), std::string::npos);
  const auto none = [](int rank, CellsField::Piece& piece)
  {
    piece.Mesh.CellCount = 0;
    piece.OtherCells = rank == 1 ? "3 cells, cell 0 of the type vtkTriangle" : "";
  };
  EXPECT_NE(
    SentenceOf(3, none).find("no cells in three dimensions, but 3 cells"), std::string::npos);
}

} // namespace
