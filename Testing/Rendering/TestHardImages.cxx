// SPDX-License-Identifier: BSD-3-Clause
// Images that ray casters fail at, through the mapper: far from the origin, with cells a thousand
// times as long as wide, without any cell, and with the eye inside.

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"
#include "vtkCallbackCommand.h"

using namespace mapper_testing;

namespace
{

const glm::ivec3 Samples{ 41, 37, 33 };

using Picture = std::vector<unsigned char>;

struct Placed
{
  glm::dvec3 Origin{ 0.0 };
  glm::dvec3 Spacing{ 1.0 };
};

bool Failed = false;

void Note(vtkObject*, unsigned long, void*, void*)
{
  Failed = true;
}

class Scene
{
public:
  Scene()
    : Shown(this->Mapper)
  {
    this->Mapper->SetNumberOfThreads(1);
    vtkNew<vtkCallbackCommand> noted;
    noted->SetCallback(Note);
    this->Mapper->AddObserver(vtkCommand::ErrorEvent, noted);
    this->Shown.Volume->GetProperty()->SetScalarOpacityUnitDistance(1.0);
  }

  vtkVolumeProperty* Property() { return this->Shown.Volume->GetProperty(); }

  void Set(const glm::ivec3& samples, const Placed& placed, const Field& field = Balls)
  {
    const auto image = PlainImage(field, samples);
    image->SetOrigin(placed.Origin.x, placed.Origin.y, placed.Origin.z);
    image->SetSpacing(placed.Spacing.x, placed.Spacing.y, placed.Spacing.z);
    this->Mapper->SetInputData(image);
  }

  /// @param eye, at in indices
  Picture From(const Placed& placed, const glm::dvec3& eye, const glm::dvec3& at)
  {
    const auto world = [&](const glm::dvec3& index)
    { return placed.Origin + placed.Spacing * index; };
    const glm::dvec3 from = world(eye);
    const glm::dvec3 to = world(at);
    vtkCamera* const camera = this->Shown.Renderer->GetActiveCamera();
    camera->SetPosition(from.x, from.y, from.z);
    camera->SetFocalPoint(to.x, to.y, to.z);
    camera->SetViewUp(0.0, 1.0, 0.0);
    this->Shown.Renderer->ResetCameraClippingRange();
    return this->Shown.Draw();
  }

private:
  vtkNew<vtkBanyanVolumeMapper> Mapper;
  Stage Shown;
};

const glm::dvec3 Middle(20.0, 18.0, 16.0);
const glm::dvec3 Outside = Middle + glm::dvec3(40.0, 50.0, 90.0);

void FarFromTheOriginIsThePictureAtTheOrigin()
{
  for (const double spacing : { 1.0, 0.01 })
  {
    Placed near;
    near.Spacing = glm::dvec3(spacing);
    Placed far = near;
    far.Origin = glm::dvec3(1e7, -1e7, 3e7);
    Scene scene;
    scene.Property()->SetScalarOpacityUnitDistance(spacing);
    for (const glm::dvec3& eye : { Outside, Middle + glm::dvec3(3.0, 1.0, 5.0) })
    {
      scene.Set(Samples, near);
      const Picture expected = scene.From(near, eye, Middle);
      scene.Set(Samples, far);
      const Picture moved = scene.From(far, eye, Middle);
      Check(Covered(expected) > 5000, "there is something to see");
      const int difference = Difference(expected, moved);
      std::cout << "spacing " << spacing << ": " << difference << "/255 off far from the origin\n";
      Check(difference <= 1, "far from the origin is the picture at the origin");
    }
  }
}

/// In whatever units, and seen from within.
void LongCellsAreLong()
{
  Picture first;
  for (const double unit : { 1.0, 1e-3, 1e5 })
  {
    Placed placed;
    placed.Spacing = unit * glm::dvec3(1.0, 1.0, 1000.0);
    Scene scene;
    scene.Property()->SetScalarOpacityUnitDistance(10.0 * unit);
    scene.Set(Samples, placed);
    const Picture picture = scene.From(placed, { 10.0, 12.0, 16.0 }, { 14.0, 15.0, 16.01 });
    Check(Covered(picture) > 5000, "long cells are seen");
    first = first.empty() ? picture : first;
    const int difference = Difference(first, picture);
    std::cout << "long cells: " << difference << "/255 between units\n";
    Check(difference <= 1, "long cells are seen alike in all units");
  }
}

/// Nothing is drawn, nothing is reported, and the next image is drawn again.
void ImagesWithoutCellsAreEmpty()
{
  Scene scene;
  const Placed placed;
  scene.Set(Samples, placed);
  const Picture before = scene.From(placed, Outside, Middle);
  for (const glm::ivec3& samples :
    { glm::ivec3(1, 1, 50), { 50, 1, 1 }, { 1, 30, 20 }, { 30, 20, 1 }, { 1, 1, 1 } })
  {
    scene.Set(samples, placed);
    Check(Covered(scene.From(placed, Outside, Middle)) == 0, "an image without cells is empty");
  }
  Check(!Failed, "an image without cells is no error");
  scene.Set(Samples, placed);
  Check(scene.From(placed, Outside, Middle) == before, "the next image is drawn");
  scene.Set({ 2, 2, 300 }, placed, [](double, double, double, int) { return 0.8f; });
  Check(Covered(scene.From(placed, { 0.5, 0.5, -3.0 }, { 0.5, 0.5, 300.0 })) > 1000,
    "a column of one cell is drawn");
}

} // namespace

int main()
{
  FarFromTheOriginIsThePictureAtTheOrigin();
  LongCellsAreLong();
  ImagesWithoutCellsAreEmpty();
  Check(!Failed, "no error was reported");
  return Failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
