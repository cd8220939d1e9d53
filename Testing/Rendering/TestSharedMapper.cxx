// SPDX-License-Identifier: BSD-3-Clause
// One mapper in several windows, renderers and volumes, and windows that come and go: each picture
// is that of a mapper of its own.

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkTestErrorObserver.h"

#include <memory>

using namespace mapper_testing;

namespace
{

using Picture = std::vector<unsigned char>;

vtkSmartPointer<vtkImageData> Data()
{
  static const vtkSmartPointer<vtkImageData> image = PlainImage(Balls, { 24, 22, 20 });
  return image;
}

/// A window of its own for a volume that others show as well.
class Shown : public Stage
{
public:
  explicit Shown(vtkBanyanVolumeMapper* mapper)
    : Stage(mapper)
  {
    mapper->SetInputDataObject(Data());
    this->LookAt(Data()->GetBounds());
  }
};

Picture Alone()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  return Shown(mapper).Draw();
}

void WindowsTakeTurns()
{
  const Picture expected = Alone();
  Check(Covered(expected) > 3000, "the volume is seen");
  vtkNew<vtkBanyanVolumeMapper> mapper;
  Shown first(mapper);
  {
    Shown second(mapper);
    for (int turn = 0; turn < 3; ++turn)
    {
      Check(Difference(first.Draw(), expected) == 0, "the first window draws");
      Check(Difference(second.Draw(), expected) == 0, "the second window draws");
    }
    mapper->ReleaseGraphicsResources(second.Window);
    Check(Difference(first.Draw(), expected) == 0, "the first window keeps what it has");
    Check(Difference(second.Draw(), expected) == 0, "the second one makes it again");
    second.Window->Finalize();
    Check(Difference(first.Draw(), expected) == 0, "a window that is closed takes nothing along");
  }
  Check(Difference(first.Draw(), expected) == 0, "nor one that is gone");
  mapper->ReleaseGraphicsResources(nullptr);
  Check(Difference(first.Draw(), expected) == 0, "all can be released");
  auto third = std::make_unique<Shown>(mapper);
  third->Draw();
  third->Window->RemoveRenderer(third->Renderer);
  third.reset();
  Check(Difference(Shown(mapper).Draw(), expected) == 0, "renderers may go before their windows");
}

/// Two volumes of one renderer, side by side, that one mapper draws: each with a component of its
/// own.
void VolumesOfOneRenderer()
{
  vtkSmartPointer<vtkImageData> image = PlainImage(Balls, { 24, 22, 20 });
  vtkNew<vtkFloatArray> two;
  two->SetName("two");
  two->SetNumberOfComponents(2);
  two->SetNumberOfTuples(image->GetNumberOfPoints());
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    const float value = static_cast<float>(image->GetPointData()->GetScalars()->GetTuple1(i));
    two->SetTuple2(i, value, 1.0f - value);
  }
  image->GetPointData()->SetScalars(two);
  const auto draw = [&](bool shared, int shown)
  {
    vtkNew<vtkBanyanVolumeMapper> mapper;
    vtkNew<vtkBanyanVolumeMapper> own;
    mapper->SetInputDataObject(image);
    own->SetInputDataObject(image);
    Stage stage(mapper);
    vtkNew<vtkVolume> second;
    vtkNew<vtkVolumeProperty> property;
    property->DeepCopy(stage.Volume->GetProperty());
    property->GetRGBTransferFunction()->SetVectorModeToComponent();
    property->GetRGBTransferFunction()->SetVectorComponent(1);
    stage.Volume->GetProperty()->GetRGBTransferFunction()->SetVectorModeToComponent();
    second->SetProperty(property);
    second->SetMapper(shared ? mapper : own);
    second->SetPosition(30, 0, 0);
    stage.Renderer->AddVolume(second);
    const double bounds[6] = { 0, 54, 0, 22, 0, 20 };
    stage.LookAt(bounds);
    stage.Volume->SetVisibility(shown != 1);
    second->SetVisibility(shown != 0);
    stage.Draw();
    return stage.Draw();
  };
  const Picture expected = draw(false, 2);
  Check(Difference(expected, draw(false, 0)) > 20 && Difference(expected, draw(false, 1)) > 20,
    "both volumes are seen");
  Check(Difference(draw(true, 2), expected) == 0, "one mapper draws both as two mappers do");
}

/// Of a property that was copied, gradient opacity is a function that is 1 everywhere.
void CopiesSayNothing()
{
  const Picture expected = Alone();
  vtkNew<vtkBanyanVolumeMapper> mapper;
  vtkNew<vtkTest::ErrorObserver> messages;
  mapper->AddObserver(vtkCommand::WarningEvent, messages);
  mapper->AddObserver(vtkCommand::ErrorEvent, messages);
  Shown window(mapper);
  vtkNew<vtkVolume> copy;
  copy->ShallowCopy(window.Volume);
  vtkNew<vtkVolumeProperty> property;
  property->DeepCopy(window.Volume->GetProperty());
  copy->SetProperty(property);
  window.Renderer->RemoveVolume(window.Volume);
  window.Renderer->AddVolume(copy);
  Check(Difference(window.Draw(), expected) == 0, "a copy of a volume is drawn as the volume");
  Check(!messages->GetWarning() && !messages->GetError(), messages->GetWarningMessage());
}

} // namespace

int main()
{
  WindowsTakeTurns();
  VolumesOfOneRenderer();
  CopiesSayNothing();
  return Failures();
}
