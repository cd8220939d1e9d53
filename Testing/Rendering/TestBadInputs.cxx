// SPDX-License-Identifier: BSD-3-Clause
// Data that the mapper cannot draw: a sentence that says what is wrong with which array, no crash,
// and the next input is drawn.

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkHyperTreeGrid.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkOverlappingAMR.h"
#include "vtkRandomHyperTreeGridSource.h"
#include "vtkTestErrorObserver.h"
#include "vtkUnstructuredGrid.h"

using namespace mapper_testing;

namespace
{

vtkSmartPointer<vtkImageData> Good()
{
  return PlainImage(Balls, { 20, 20, 20 });
}

/// Draws what is bad, and then what is good with the same mapper.
/// @param part of the sentence; empty where there is nothing to say
void ExpectSays(vtkDataObject* bad, const std::string& part)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  vtkNew<vtkTest::ErrorObserver> errors;
  mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  mapper->SetInputDataObject(bad);
  Stage stage(mapper);
  stage.LookAt(Good()->GetBounds());
  Check(Covered(stage.Draw()) == 0, "nothing is drawn of " + part);
  stage.Renderer->ResetCamera(); // asks for bounds
  const std::string said = errors->GetErrorMessage();
  Check(part.empty() ? said.empty() : said.find(part) != std::string::npos,
    "'" + said + "' has '" + part + "'");
  errors->Clear();
  mapper->SetInputDataObject(Good());
  stage.LookAt(Good()->GetBounds());
  Check(Covered(stage.Draw()) > 1000, "what follows is drawn after " + part);
  Check(!errors->GetError(), errors->GetErrorMessage());
}

vtkSmartPointer<vtkDoubleArray> Numbers(vtkIdType count, const char* name)
{
  auto numbers = vtkSmartPointer<vtkDoubleArray>::New();
  numbers->SetNumberOfTuples(count);
  numbers->Fill(0.7);
  numbers->SetName(name);
  return numbers;
}

void ArraysOfAnotherLength()
{
  const auto image = Good();
  image->GetPointData()->SetScalars(Numbers(5, "field"));
  ExpectSays(image, "The array 'field' has 5 values for 8000 points");
  const auto flagged = Good();
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->InsertNextValue(vtkDataSetAttributes::HIDDENPOINT);
  flagged->GetPointData()->AddArray(flags);
  ExpectSays(flagged, "The point array vtkGhostType has 1 values for 8000 points");
}

void Trees()
{
  vtkNew<vtkRandomHyperTreeGridSource> source;
  source->SetDimensions(3, 3, 3);
  source->SetMaxDepth(2);
  source->Update();
  vtkHyperTreeGrid* const trees = source->GetHyperTreeGridOutput();
  const vtkIdType cells = trees->GetNumberOfCells();
  trees->GetCellData()->Initialize();
  trees->GetCellData()->SetScalars(Numbers(3, "field"));
  ExpectSays(trees, "The cell array field of the hyper tree grid has 3 values");
  trees->GetCellData()->Initialize();
  trees->GetCellData()->SetScalars(Numbers(cells, nullptr));
  ExpectSays(trees, "The array to draw has no name");
}

void Blocks()
{
  ExpectSays(vtkNew<vtkOverlappingAMR>(), "");
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetNumberOfBlocks(2);
  blocks->SetBlock(1, Good());
  ExpectSays(blocks, "Data of the type vtkMultiBlockDataSet cannot be drawn");
  vtkNew<vtkUnstructuredGrid> noPoints;
  noPoints->Allocate(1);
  const vtkIdType ids[8] = { 0, 1, 2, 3, 4, 5, 6, 7 };
  noPoints->InsertNextCell(VTK_HEXAHEDRON, 8, ids);
  noPoints->GetCellData()->SetScalars(Numbers(1, "field"));
  ExpectSays(noPoints, "has 1 cells, but no points");
}

} // namespace

int main()
{
  ArraysOfAnotherLength();
  Trees();
  Blocks();
  return Failures();
}
