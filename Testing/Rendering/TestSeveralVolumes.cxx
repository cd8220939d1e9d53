// Several volumes in one renderer, in random places, with opaque spheres between them: each pixel
// is what the volumes show there alone, blended in the order in which its ray enters their boxes.

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"

#include "Render/RayCamera.h"

#include "vtkActor.h"
#include "vtkCommand.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkMatrix4x4.h"
#include "vtkPlaneSource.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkSphereSource.h"
#include "vtkTestErrorObserver.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <memory>
#include <random>

using namespace mapper_testing;

namespace
{

using Picture = std::vector<unsigned char>;

constexpr int Width = 72;
constexpr int Height = 54;

class Dice
{
public:
  explicit Dice(unsigned seed)
    : Engine(seed)
  {
  }
  double In(double low, double high)
  {
    return std::uniform_real_distribution<double>(low, high)(this->Engine);
  }
  glm::dvec3 Point(double size) { return { In(-size, size), In(-size, size), In(-size, size) }; }
  glm::dvec3 Direction() { return glm::normalize(this->Point(1.0)); }

private:
  std::mt19937 Engine;
};

glm::dmat4 FromVtk(vtkMatrix4x4* matrix)
{
  glm::dmat4 result;
  for (int i = 0; i < 16; ++i)
  {
    result[i % 4][i / 4] = matrix->GetElement(i / 4, i % 4);
  }
  return result;
}

/// One volume, its box in the world, and what its mapper has said.
struct Shown
{
  Shown(const glm::ivec3& samples, const glm::dvec3& color, double opacity)
    : Image(PlainImage(Balls, samples))
    , High(samples - 1)
  {
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(0.0, color.r, color.g, color.b);
    colors->AddRGBPoint(1.0, color.b, color.r, color.g);
    vtkNew<vtkPiecewiseFunction> opacities;
    opacities->AddPoint(0.0, 0.2 * opacity);
    opacities->AddPoint(1.0, opacity);
    this->Volume->GetProperty()->SetColor(colors);
    this->Volume->GetProperty()->SetScalarOpacity(opacities);
    this->Volume->GetProperty()->SetInterpolationTypeToLinear();
    this->Mapper->SetInputDataObject(this->Image);
    this->Mapper->SetSampleDistanceVoxels(1.0); // takes no pilots
    this->Mapper->AddObserver(vtkCommand::WarningEvent, this->Messages);
    this->Mapper->AddObserver(vtkCommand::ErrorEvent, this->Messages);
    this->Mapper->AddObserver(vtkCommand::WarningEvent, this, &Shown::Count);
    this->Volume->SetMapper(this->Mapper);
  }
  void Count(vtkObject*, unsigned long, void*) { ++this->Warnings; }
  void Place(const glm::dmat4& matrix)
  {
    this->ToWorld = matrix;
    vtkNew<vtkMatrix4x4> own;
    for (int i = 0; i < 16; ++i)
    {
      own->SetElement(i / 4, i % 4, matrix[i % 4][i / 4]);
    }
    this->Volume->SetUserMatrix(own);
  }
  /// The farthest that its box reaches in a direction.
  double Reaches(const glm::dvec3& direction) const
  {
    double most = -1e300;
    for (int i = 0; i < 8; ++i)
    {
      const glm::dvec4 corner(
        (i & 1) * this->High.x, (i >> 1 & 1) * this->High.y, (i >> 2) * this->High.z, 1);
      most = std::max(most, glm::dot(direction, glm::dvec3(this->ToWorld * corner)));
    }
    return most;
  }
  /// Where a ray enters its box; infinite if it does not.
  double Enters(const banyan::Ray& ray) const
  {
    const glm::dmat4 inverse = glm::inverse(this->ToWorld);
    const glm::dvec3 origin(inverse * glm::dvec4(ray.Origin, 1.0));
    const glm::dvec3 step(inverse * glm::dvec4(ray.Direction, 0.0));
    double enters = -1e300;
    double leaves = 1e300;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double a = -origin[axis] / step[axis];
      const double b = (this->High[axis] - origin[axis]) / step[axis];
      enters = std::max(enters, std::min(a, b));
      leaves = std::min(leaves, std::max(a, b));
    }
    return enters < leaves ? enters : std::numeric_limits<double>::infinity();
  }

  vtkSmartPointer<vtkImageData> Image;
  glm::dvec3 High;
  glm::dmat4 ToWorld{ 1.0 };
  int Warnings = 0;
  vtkNew<vtkTest::ErrorObserver> Messages;
  vtkNew<vtkBanyanVolumeMapper> Mapper;
  vtkNew<vtkVolume> Volume;
};

/// To make one takes longer than to draw a picture.
vtkRenderWindow* TheWindow()
{
  static const auto window = []
  {
    auto made = vtkSmartPointer<vtkRenderWindow>::New();
    made->SetMultiSamples(0);
    made->SetSize(Width, Height);
    return made;
  }();
  return window;
}

/// Volumes and spheres that have one colour, in the window.
class Scene
{
public:
  Scene()
  {
    this->Window->AddRenderer(this->Renderer);
    this->Renderer->SetBackground(0.1, 0.2, 0.3);
    this->Renderer->SetBackground2(0.9, 0.7, 0.4);
    this->Renderer->GradientBackgroundOn();
  }
  ~Scene() { this->Window->RemoveRenderer(this->Renderer); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
  Shown& Add(const glm::ivec3& samples, const glm::dvec3& color, double opacity)
  {
    this->Volumes.push_back(std::make_unique<Shown>(samples, color, opacity));
    this->Renderer->AddVolume(this->Volumes.back()->Volume);
    return *this->Volumes.back();
  }
  vtkActor* AddActor(vtkAlgorithmOutput* shape, double opacity)
  {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(shape);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetColor(0.9, 0.9, 0.2);
    actor->GetProperty()->SetOpacity(opacity);
    this->Renderer->AddActor(actor);
    this->Actors.push_back(actor.GetPointer());
    return actor;
  }
  void AddSphere(const glm::dvec3& center, double radius)
  {
    vtkNew<vtkSphereSource> sphere;
    sphere->SetCenter(center.x, center.y, center.z);
    sphere->SetRadius(radius);
    this->AddActor(sphere->GetOutputPort(), 1.0);
  }
  void Look(const glm::dvec3& from, const glm::dvec3& at, bool parallel)
  {
    vtkCamera* const camera = this->Renderer->GetActiveCamera();
    camera->SetPosition(from.x, from.y, from.z);
    camera->SetFocalPoint(at.x, at.y, at.z);
    camera->SetViewUp(0.1, 1.0, 0.2);
    camera->SetParallelProjection(parallel);
    camera->SetParallelScale(6.0);
    camera->SetClippingRange(0.01, 60.0);
  }
  Picture Draw()
  {
    this->Window->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window->GetPixelData(0, 0, Width - 1, Height - 1, 0, pixels);
    return { pixels->GetPointer(0), pixels->GetPointer(0) + pixels->GetNumberOfValues() };
  }
  /// Only one of the volumes, and all else in one grey.
  Picture DrawAlone(std::size_t volume, double grey)
  {
    double before[6];
    this->Renderer->GetBackground(before);
    for (const auto& actor : this->Actors)
    {
      actor->GetProperty()->SetColor(grey, grey, grey);
    }
    this->Show(static_cast<int>(volume));
    this->Renderer->GradientBackgroundOff();
    this->Renderer->SetBackground(grey, grey, grey);
    const Picture picture = this->Draw();
    this->Renderer->SetBackground(before);
    this->Renderer->GradientBackgroundOn();
    for (const auto& actor : this->Actors)
    {
      actor->GetProperty()->SetColor(0.9, 0.9, 0.2);
    }
    return picture;
  }
  /// One volume; -1 for all, -2 for none.
  void Show(int which)
  {
    for (std::size_t i = 0; i < this->Volumes.size(); ++i)
    {
      this->Volumes[i]->Volume->SetVisibility(which == -1 || which == static_cast<int>(i));
    }
  }
  banyan::RayCamera Camera()
  {
    return banyan::RayCamera(
      FromVtk(this->Renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
        double{ Width } / Height, -1, 1)),
      { Width, Height }, glm::dvec3(0.0));
  }

  vtkNew<vtkRenderer> Renderer;
  vtkRenderWindow* const Window = TheWindow();
  std::vector<std::unique_ptr<Shown>> Volumes;
  std::vector<vtkSmartPointer<vtkActor>> Actors;
};

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
  // Those that found no place are left out.
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

/// What volumes show alone, over what is there without them.
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

void OneWarningWhereVolumesOverlap()
{
  Pair pair;
  pair.DrawSome();
  Check(pair.Warnings() == 0, "apart, nothing is said");
  pair.Near.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-3, -3, -6)));
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
  cropped.Near.Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-4, -4, -6)));
  cropped.Near.Mapper->CroppingOn();
  cropped.Near.Mapper->SetCroppingRegionFlagsToSubVolume();
  cropped.Near.Mapper->SetCroppingRegionPlanes(0, 8, 0, 8, 4, 8);
  cropped.DrawSome();
  Check(cropped.Warnings() == 0, "what is cropped away does not overlap");
}

void OneWarningWhereTranslucentSurfacesAreNotBehind()
{
  for (const double z : { -11.0, -5.0, 0.0, 5.0, 12.0 })
  {
    Pair pair;
    pair.AddPlane(z, 0.5);
    pair.DrawSome();
    const bool behind = z < -10.0;
    Check(pair.Warnings() == (behind ? 0 : 1),
      "a surface at " + std::to_string(z) + " gives " + std::to_string(pair.Warnings()));
  }
  Pair pair;
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
