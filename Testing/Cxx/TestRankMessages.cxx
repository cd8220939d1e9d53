// SPDX-License-Identifier: BSD-3-Clause
// VTK's data between ranks, and what ranks agree on about them: on simulated ranks.
#include "LeafSteps.h"
#include "MeshSteps.h"
#include "RankMessages.h"

#include "vtkCellType.h"
#include "vtkDataArraySelection.h"
#include "vtkDoubleArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace
{

using namespace banyan;

/// Voxels in a row along x, from `first` on, with the array "v" of x at their points.
vtkSmartPointer<vtkUnstructuredGrid> Row(int first, int count)
{
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> values;
  values->SetName("v");
  grid->AllocateExact(count, 8 * count);
  for (int x = first; x <= first + count && count > 0; ++x)
  {
    for (int corner = 0; corner < 4; ++corner)
    {
      points->InsertNextPoint(x, corner % 2, corner / 2);
      values->InsertNextValue(x);
    }
  }
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    const vtkIdType low = 4 * cell;
    const vtkIdType ids[] = { low, low + 4, low + 1, low + 5, low + 2, low + 6, low + 3, low + 7 };
    grid->InsertNextCell(VTK_VOXEL, 8, ids);
  }
  grid->SetPoints(points);
  grid->GetPointData()->AddArray(values);
  return grid;
}

/// Runs an action on simulated ranks, which all must throw CollectiveError.
void ExpectAllThrow(
  int ranks, const std::function<void(Communicator&)>& action, const std::string& sentence)
{
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      try
      {
        action(communicator);
        ADD_FAILURE() << "rank " << communicator.Rank() << " threw nothing";
      }
      catch (const CollectiveError& error)
      {
        EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
      }
      communicator.Barrier(); // they may go on to talk
    });
}

TEST(RankMessages, StreamsComeInTheOrderOfRanks)
{
  RunOnSimulatedRanks(4,
    [](Communicator& ranks)
    {
      vtkMultiProcessStream mine;
      for (int i = 0; i < ranks.Rank(); ++i) // none on rank 0
      {
        mine << std::string(static_cast<std::size_t>(10 * i), 'x') << 0.1 * ranks.Rank();
      }
      std::vector<vtkMultiProcessStream> all = AllGatherStreams(ranks, mine);
      ASSERT_EQ(all.size(), 4u);
      for (int rank = 0; rank < 4; ++rank)
      {
        for (int i = 0; i < rank; ++i)
        {
          std::string text;
          double number = 0.0;
          all[static_cast<std::size_t>(rank)] >> text >> number;
          EXPECT_EQ(text.size(), static_cast<std::size_t>(10 * i));
          EXPECT_EQ(number, 0.1 * rank);
        }
        EXPECT_TRUE(all[static_cast<std::size_t>(rank)].Empty());
      }
    });
}

TEST(RankMessages, DataComeToRankZero)
{
  RunOnSimulatedRanks(4,
    [](Communicator& ranks)
    {
      const int cells[] = { 2, 7, 0, 3 };
      const auto all = GatherData(ranks, Row(10 * ranks.Rank(), cells[ranks.Rank()]));
      ASSERT_EQ(all.size(), ranks.Rank() == 0 ? 4u : 0u);
      for (int rank = 0; rank < static_cast<int>(all.size()); ++rank)
      {
        auto* const grid = vtkUnstructuredGrid::SafeDownCast(all[static_cast<std::size_t>(rank)]);
        ASSERT_TRUE(grid);
        ASSERT_EQ(grid->GetNumberOfCells(), cells[rank]);
        if (cells[rank] > 0)
        {
          EXPECT_EQ(grid->GetPointData()->GetArray("v")->GetTuple1(0), 10 * rank);
        }
      }
    });
}

TEST(RankMessages, LeavesStayAsTheyAreWhereOneRankHasAProblem)
{
  RunOnSimulatedRanks(3,
    [](Communicator& ranks)
    {
      vtkSmartPointer<vtkDataObject> data = vtkSmartPointer<vtkHyperTreeGrid>::New().GetPointer();
      vtkDataObject* const before = data;
      bool found = false;
      LeavesAsGrid(ranks, ranks.Rank() == 2 ? "It is not there." : "", data, found);
      EXPECT_TRUE(found);
      EXPECT_EQ(data, before);
    });
}

TEST(RankMessages, AMeshOfAllRanksIsAnImageOnTheFirst)
{
  RunOnSimulatedRanks(3,
    [](Communicator& ranks)
    {
      const EncodeOptions options;
      const vtkNew<vtkDataArraySelection> all;
      MeshSteps steps(ranks, options, all, all, {});
      for (int step = 0; step < 2; ++step)
      {
        vtkSmartPointer<vtkDataObject> data = Row(2 * ranks.Rank(), 2).GetPointer();
        steps.Take(data, {});
        ASSERT_TRUE(steps.Active());
        auto* const image = vtkImageData::SafeDownCast(data);
        ASSERT_TRUE(image);
        EXPECT_EQ(image->GetPointData()->HasArray("v"), ranks.Rank() == 0 ? 1 : 0);
      }
    });
}

TEST(RankMessages, AProblemOfOneRankKeepsItsMesh)
{
  RunOnSimulatedRanks(3,
    [](Communicator& ranks)
    {
      const EncodeOptions options;
      const vtkNew<vtkDataArraySelection> all;
      MeshSteps steps(ranks, options, all, all, {});
      vtkSmartPointer<vtkDataObject> data = Row(2 * ranks.Rank(), 2).GetPointer();
      vtkDataObject* const before = data;
      steps.Take(data, ranks.Rank() == 1 ? "It is not there." : "");
      EXPECT_EQ(data, before);
    });
}

TEST(RankMessages, AMistakeIsSaidOfTheRankThatMadeIt)
{
  const auto take = [](Communicator& ranks)
  {
    const EncodeOptions options;
    const vtkNew<vtkDataArraySelection> all;
    MeshSteps steps(ranks, options, all, all, {});
    vtkSmartPointer<vtkDataObject> data = Row(2 * ranks.Rank(), 2).GetPointer();
    if (ranks.Rank() == 2)
    {
      vtkNew<vtkImageData> image;
      image->SetDimensions(3, 3, 3);
      data = image.GetPointer();
    }
    steps.Take(data, {});
  };
  ExpectAllThrow(3, take,
    "Rank 2: Other ranks have a mesh of cells (vtkUnstructuredGrid), and this one has vtkImageData");
}

TEST(RankMessages, AMeshThatChangesFailsOnAllRanks)
{
  const auto take = [](Communicator& ranks)
  {
    const EncodeOptions options;
    const vtkNew<vtkDataArraySelection> all;
    MeshSteps steps(ranks, options, all, all, {});
    for (const int length : { 2, 4 })
    {
      vtkSmartPointer<vtkDataObject> data = Row(length * ranks.Rank(), length).GetPointer();
      steps.Take(data, {});
    }
  };
  ExpectAllThrow(3, take, "Rank 0: The mesh of a series must not change");
}

} // namespace
