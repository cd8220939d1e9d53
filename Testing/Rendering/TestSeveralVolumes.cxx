// SPDX-License-Identifier: BSD-3-Clause
// Several volumes in one renderer, in random places, with opaque spheres between them: each pixel
// is what the volumes show there alone, blended in the order in which its ray enters their boxes.

#include "SeveralVolumes.h"

#include "../Core/Render/Dice.h"

#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkPlaneSource.h"

using namespace several_volumes;

namespace
{

/// Volumes on the two sides of planes, each of which cuts what the ones before have left.
void Arrange(Scene& scene, Dice& dice)
{
  const int count = 2 + static_cast<int>(dice.In(0.0, 3.0));
  std::vector<std::pair<glm::dvec3, double>> sides;
  for (int i = 0; i < count; ++i)
  {
    const glm::ivec3 samples(static_cast<int>(dice.In(3, 11)), static_cast<int>(dice.In(3, 11)),
      static_cast<int>(dice.In(3, 11)));
    Shown& shown = scene.Add(samples, { double(i != 0), dice.In(0, 1), double(i == 0) },
      std::pow(10.0, dice.In(-0.6, -0.05)));
    glm::dmat4 matrix = glm::rotate(
      glm::translate(glm::dmat4(1.0), dice.Point(1.0)), dice.In(0.0, 6.0), dice.Direction());
    matrix[1] += 0.3 * dice.In(-1.0, 1.0) * matrix[0];
    shown.Place(glm::scale(matrix, glm::dvec3(5.0) * glm::exp(dice.Point(0.7)) / shown.High) *
                glm::translate(glm::dmat4(1.0), -0.5 * shown.High));
    std::vector<std::pair<glm::dvec3, double>> own = sides;
    if (i + 1 < count)
    {
      const glm::dvec3 normal = dice.Direction();
      own.emplace_back(normal, dice.In(-1.5, 0.5));
      sides.emplace_back(-normal, std::min(0.0, dice.In(-0.5, 0.5)) - own.back().second);
    }
    for (int turn = 0; turn < 200; ++turn)
    {
      for (const auto& side : own)
      {
        const double beyond = std::max(0.0, shown.Reaches(side.first) - side.second);
        shown.Place(
          glm::translate(glm::dmat4(1.0), -1.0000001 * beyond * side.first) * shown.ToWorld);
      }
    }
    for (const auto& side : own)
    {
      Check(
        shown.Reaches(side.first) < side.second + 1e-4 || own.size() > 1, "a box is on its side");
      shown.Volume->SetVisibility(
        shown.Reaches(side.first) < side.second + 1e-7 && shown.Volume->GetVisibility());
    }
  }
  // Volumes that found no place are left out.
  for (std::size_t i = scene.Volumes.size(); i-- > 0;)
  {
    if (!scene.Volumes[i]->Volume->GetVisibility())
    {
      scene.Renderer->RemoveVolume(scene.Volumes[i]->Volume);
      scene.Volumes.erase(scene.Volumes.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    scene.AddSphere(dice.Point(3.0), dice.In(0.3, 1.2));
  }
  const double distance = dice.In(0.0, 1.0) < 0.2 ? 2.0 : 14.0;
  scene.Look(dice.Direction() * distance, dice.Point(1.0), dice.In(0.0, 1.0) < 0.4);
}

/// The pictures of volumes alone, over what is there without them.
class Reference
{
public:
  explicit Reference(Scene& scene)
    : Shot(scene)
  {
    for (std::size_t i = 0; i < scene.Volumes.size(); ++i)
    {
      this->OverBlack.push_back(scene.DrawAlone(i, 0.0));
      this->OverWhite.push_back(scene.DrawAlone(i, 1.0));
    }
    scene.Show(-2);
    this->Behind = scene.Draw();
    scene.Show(-1);
  }

  /// @param byRays in the order in which rays enter them; otherwise as they were added
  Picture Blended(bool byRays) const
  {
    Picture result = this->Behind;
    const banyan::RayCamera camera = this->Shot.Camera();
    for (int pixel = 0; pixel < Width * Height; ++pixel)
    {
      const banyan::Ray ray = camera.RayOf(pixel % Width, pixel / Width);
      std::vector<std::pair<double, std::size_t>> order;
      for (std::size_t i = 0; i < this->Shot.Volumes.size(); ++i)
      {
        order.emplace_back(
          byRays ? -this->Shot.Volumes[i]->Enters(ray) : static_cast<double>(i), i);
      }
      std::sort(order.begin(), order.end());
      for (int c = 0; c < 3; ++c)
      {
        const std::size_t at = static_cast<std::size_t>(3 * pixel + c);
        double value = this->Behind[at];
        for (const auto& one : order)
        {
          const double color = this->OverBlack[one.second][at];
          value = color + (this->OverWhite[one.second][at] - color) / 255.0 * value;
        }
        result[at] = static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0)));
      }
    }
    return result;
  }

private:
  Scene& Shot;
  std::vector<Picture> OverBlack;
  std::vector<Picture> OverWhite;
  Picture Behind;
};

void AddInReverse(Scene& scene)
{
  for (const auto& shown : scene.Volumes)
  {
    scene.Renderer->RemoveVolume(shown->Volume);
  }
  for (std::size_t i = scene.Volumes.size(); i-- > 0;)
  {
    scene.Renderer->AddVolume(scene.Volumes[i]->Volume);
  }
}

/// Several rounded numbers are multiplied in the reference.
constexpr int Rounding = 4;

void VolumesAreBlendedInTheOrderOfRays()
{
  int orderMatters = 0;
  int several = 0;
  for (unsigned seed = 0; seed < 240; ++seed)
  {
    Dice dice(seed);
    Scene scene;
    Arrange(scene, dice);
    const std::string name = "arrangement " + std::to_string(seed);
    const Reference reference(scene);
    const Picture expected = reference.Blended(true);
    orderMatters += Difference(expected, reference.Blended(false)) > 20 ? 1 : 0;
    several += scene.Volumes.size() > 1 ? 1 : 0;
    const Picture drawn = scene.Draw();
    const int error = Difference(drawn, expected);
    Check(error <= Rounding, name + " is off by " + std::to_string(error));
    Check(Difference(scene.Draw(), drawn) == 0, name + " is the same once more");
    AddInReverse(scene);
    Check(Difference(scene.Draw(), drawn) == 0, name + " does not depend on who was first");
    for (const auto& shown : scene.Volumes)
    {
      Check(!shown->Messages->GetWarning() && !shown->Messages->GetError(),
        name + " needs no message: " + shown->Messages->GetWarningMessage());
    }
  }
  std::cout << "The order matters in " << orderMatters << " of " << several << " arrangements\n";
  Check(orderMatters > 40 && several > 200, "the order matters");
}

/// Two cubes behind each other.
struct Pair
{
  Pair()
    : Near(Shot.Add(glm::ivec3(9), { 0.9, 0.2, 0.1 }, 0.3))
    , Far(Shot.Add(glm::ivec3(9), { 0.1, 0.3, 0.9 }, 0.3))
  {
    this->Near.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-4, -4, 2)));
    this->Far.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-4, -4, -10)));
    this->Shot.Look({ 3, 2, 32 }, glm::dvec3(0.0), false);
  }
  int Warnings() const { return this->Near.Warnings + this->Far.Warnings; }
  /// Several frames, with a camera that moves.
  void DrawSome()
  {
    for (int i = 0; i < 3; ++i)
    {
      this->Shot.Look({ 3.0 - 0.1 * i, 2, 32 }, glm::dvec3(0.0), false);
      this->Shot.Draw();
    }
  }
  void AddPlane(double z, double opacity)
  {
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(-6, -6, z);
    plane->SetPoint1(6, -6, z);
    plane->SetPoint2(-6, 6, z);
    this->Shot.AddActor(plane->GetOutputPort(), opacity);
  }

  Scene Shot;
  Shown& Near;
  Shown& Far;
};

/// Where volumes share space and are not to be mixed.
void OneWarningWhereVolumesOverlap()
{
  Pair pair;
  pair.DrawSome();
  Check(pair.Warnings() == 0, "apart, nothing is said");
  pair.Near.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-3, -3, -6)));
  pair.DrawSome();
  Check(pair.Warnings() == 0, "mixed, nothing is said");
  pair.Near.Mapper->MixVolumesOff();
  pair.DrawSome();
  Check(pair.Warnings() == 1, "overlapping volumes are told of once");
  const std::string text =
    pair.Near.Messages->GetWarningMessage() + pair.Far.Messages->GetWarningMessage();
  Check(text.find("share a part of space") != std::string::npos, "in words: " + text);
  const Picture drawn = pair.Shot.Draw();
  AddInReverse(pair.Shot);
  Check(Difference(pair.Shot.Draw(), drawn) == 0, "whoever was added first");
  Check(pair.Warnings() == 1, "and not again");

  Pair cropped;
  cropped.Near.Mapper->MixVolumesOff();
  cropped.Near.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-4, -4, -6)));
  cropped.Near.Mapper->CroppingOn();
  cropped.Near.Mapper->SetCroppingRegionFlagsToSubVolume();
  cropped.Near.Mapper->SetCroppingRegionPlanes(0, 8, 0, 8, 4, 8);
  cropped.DrawSome();
  Check(cropped.Warnings() == 0, "what is cropped away does not overlap");
}

void OneWarningWhereTranslucentSurfacesAreNotBehind()
{
  for (const bool mixes : { false, true })
  {
    for (const double z : { -11.0, -5.0, 0.0, 5.0, 12.0 })
    {
      Pair pair;
      pair.Near.Mapper->SetMixVolumes(mixes);
      pair.Far.Mapper->SetMixVolumes(mixes);
      pair.AddPlane(z, 0.5);
      pair.DrawSome();
      const bool exact = mixes || z < -10.0;
      Check(pair.Warnings() == (exact ? 0 : 1),
        "a surface at " + std::to_string(z) + " gives " + std::to_string(pair.Warnings()));
    }
  }
  Pair pair;
  pair.Near.Mapper->MixVolumesOff();
  pair.Far.Mapper->MixVolumesOff();
  pair.AddPlane(0.0, 1.0);
  pair.DrawSome();
  Check(pair.Warnings() == 0, "opaque surfaces are exact");
  pair.AddPlane(40.0, 0.5);
  pair.DrawSome();
  Check(pair.Warnings() == 0, "what is behind the camera does not show");
}

void OneWarningWhereOtherVolumesAreNotBehind()
{
  Pair pair;
  vtkNew<vtkGPUVolumeRayCastMapper> mapper;
  mapper->SetInputData(pair.Near.Image);
  vtkNew<vtkVolume> stranger;
  stranger->SetMapper(mapper);
  stranger->SetProperty(pair.Near.Volume->GetProperty());
  stranger->SetPosition(-4, -4, -20);
  pair.Shot.Renderer->AddVolume(stranger);
  pair.DrawSome();
  Check(pair.Warnings() == 0, "another volume that is behind is exact");
  stranger->SetPosition(-4, -4, 12);
  pair.DrawSome();
  Check(pair.Warnings() == 1, "one that is before ours is told of");
}

/// A volume that is hidden, off the screen, without data or broken leaves the others as they are.
void OthersAreDrawnWhateverOneDoes()
{
  Pair pair;
  pair.Far.Volume->VisibilityOff();
  const Picture alone = pair.Shot.Draw();
  pair.Far.Volume->VisibilityOn();
  Check(Difference(pair.Shot.Draw(), alone) > 20, "the other one is seen");
  pair.Far.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-4, 60, -10)));
  Check(Difference(pair.Shot.Draw(), alone) == 0, "off the screen");
  pair.Far.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-4, -4, -10)));
  const Picture both = pair.Shot.Draw();
  Check(Difference(both, alone) > 20, "and on it again");
  vtkNew<vtkImageData> nothing;
  pair.Far.Mapper->SetInputDataObject(nothing);
  Check(Difference(pair.Shot.Draw(), alone) == 0, "without data");
  pair.Far.Mapper->SetInputDataObject(pair.Far.Image);
  pair.Far.Mapper->SetBlendMode(vtkVolumeMapper::SLICE_BLEND);
  Check(Difference(pair.Shot.Draw(), alone) == 0, "with a mode that is refused");
  Check(pair.Far.Messages->GetError(), "which is said");
  pair.Far.Mapper->SetBlendMode(vtkVolumeMapper::COMPOSITE_BLEND);
  Check(Difference(pair.Shot.Draw(), both) == 0, "and both again");
  Check(!pair.Near.Messages->GetError(), "the other one had no error");
}

} // namespace

int main()
{
  VolumesAreBlendedInTheOrderOfRays();
  OneWarningWhereVolumesOverlap();
  OneWarningWhereTranslucentSurfacesAreNotBehind();
  OneWarningWhereOtherVolumesAreNotBehind();
  OthersAreDrawnWhateverOneDoes();
  return Failures();
}
