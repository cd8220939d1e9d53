// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Rendering_LeafPictures_h
#define banyan_Testing_Rendering_LeafPictures_h

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDoubleArray.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <cmath>
#include <string>
#include <vector>

namespace leaf_pictures
{

using namespace mapper_testing;

/// Between 0 and 1, at a place in [0, 1]^3.
inline double Wavy(double x, double y, double z)
{
  return 0.5 + 0.2 * std::sin(9.0 * x + 2.0 * y) + 0.2 * std::cos(7.0 * z - 3.0 * y);
}

/// @param enhancement how much of the motion that the arrays beside the drawn one tell is brought
/// out
inline std::vector<unsigned char> PictureOf(vtkDataObject* data, double enhancement = 0.0)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputDataObject(data);
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectScalarArray("field");
  mapper->SetSampleDistanceVoxels(0.5);
  mapper->SetTemporalEnhancement(enhancement);
  Stage stage(mapper);
  const double bounds[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  stage.LookAt(bounds);
  return stage.Draw();
}

inline std::string Said(vtkDataObject* data, const char* array = "field")
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputDataObject(data);
  mapper->SetScalarModeToUseCellFieldData();
  mapper->SelectScalarArray(array);
  std::string said;
  vtkNew<vtkCallbackCommand> listen;
  listen->SetClientData(&said);
  listen->SetCallback([](vtkObject*, unsigned long, void* client, void* text)
    { *static_cast<std::string*>(client) += static_cast<const char*>(text); });
  mapper->AddObserver(vtkCommand::ErrorEvent, listen);
  Stage stage(mapper);
  const double bounds[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  stage.LookAt(bounds);
  stage.Draw();
  return said;
}

inline void ExpectSays(vtkDataObject* data, const std::string& part, const char* array = "field")
{
  const std::string said = Said(data, array);
  Check(said.find(part) != std::string::npos, "'" + part + "' in '" + said + "'");
}

inline void ExpectSame(
  vtkDataObject* one, vtkDataObject* other, const std::string& what, double enhancement = 0.0)
{
  const auto picture = PictureOf(one, enhancement);
  Check(Covered(picture) > 3000, what + " is seen");
  const int difference = Difference(picture, PictureOf(other, enhancement));
  Check(
    difference <= 1, what + " is drawn as its cells, and differs by " + std::to_string(difference));
}

/// Voxels by their low corner and edges, each with points of its own, and a value in its cell.
class Voxels
{
public:
  Voxels() { this->Values->SetName("field"); }

  void Add(const double low[3], const double edge[3], double value)
  {
    vtkIdType ids[8];
    for (int i = 0; i < 8; ++i)
    {
      ids[i] = this->Points->InsertNextPoint(
        low[0] + edge[0] * (i & 1), low[1] + edge[1] * (i >> 1 & 1), low[2] + edge[2] * (i >> 2));
    }
    this->Grid->InsertNextCell(VTK_VOXEL, 8, ids);
    this->Values->InsertNextValue(value);
  }

  vtkUnstructuredGrid* Done()
  {
    this->Grid->SetPoints(this->Points);
    this->Grid->GetCellData()->AddArray(this->Values);
    return this->Grid;
  }

private:
  vtkNew<vtkUnstructuredGrid> Grid;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkDoubleArray> Values;
};

} // namespace leaf_pictures

#endif
