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
  CopiesSayNothing();
  return Failures();
}
