// SPDX-License-Identifier: BSD-3-Clause
// Translucent surfaces before volumes of one density, in them and behind them, with opaque spheres
// between: each pixel is what a formula says, for the points in which its ray meets triangles.

#include "SeveralVolumes.h"

#include "../Core/Render/Dice.h"

#include "vtkAppendPolyData.h"
#include "vtkBillboardTextActor3D.h"
#include "vtkCellArray.h"
#include "vtkPNGWriter.h"
#include "vtkPlaneSource.h"
#include "vtkPolyData.h"
#include "vtkPolyDataAlgorithm.h"
#include "vtkTextProperty.h"

#include <array>

using namespace several_volumes;

namespace
{

/// Colours are rounded, and light that is below a limit is left out.
constexpr double Rounding = 2.5;
/// Of pixels: OpenGL puts rims of surfaces somewhere else by parts of a pixel.
constexpr double MostRims = 0.01;

struct Surface
{
  std::vector<std::array<glm::dvec3, 3>> Triangles;
  glm::dvec4 Color{ 0.0 };
  vtkActor* Actor = nullptr;
};

/// Where a ray meets a triangle; infinite if it does not.
double Meets(const banyan::Ray& ray, const std::array<glm::dvec3, 3>& triangle)
{
  const glm::dvec3 one = triangle[1] - triangle[0];
  const glm::dvec3 two = triangle[2] - triangle[0];
  const glm::dvec3 across = glm::cross(ray.Direction, two);
  const double volume = glm::dot(one, across);
  const glm::dvec3 from = ray.Origin - triangle[0];
  const glm::dvec3 other = glm::cross(from, one);
  const double u = glm::dot(from, across) / volume;
  const double v = glm::dot(ray.Direction, other) / volume;
  const double t = glm::dot(two, other) / volume;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > ray.Near && t < ray.Far
           ? t
           : std::numeric_limits<double>::infinity();
}

/// A volume of one density and colour.
struct Medium
{
  Shown* Its = nullptr;
  glm::dvec3 Color{ 0.0 };
  double Density = 0.0; ///< per length in its own space
};

class Place
{
public:
  Place()
  {
    // Beside volumes VTK draws surfaces, in their order only so.
    this->Shot.Renderer->UseDepthPeelingOn();
    this->Shot.Renderer->SetMaximumNumberOfPeels(64);
  }
  Medium& AddMedium(const glm::ivec3& samples, const glm::dvec3& color, double opacity)
  {
    Shown& shown = this->Shot.Add(samples, color, opacity);
    shown.Mapper->SetInputDataObject(
      PlainImage([](double, double, double, int) { return 0.5f; }, samples));
    vtkNew<vtkColorTransferFunction> colors;
    colors->AddRGBPoint(0.5, color.r, color.g, color.b);
    vtkNew<vtkPiecewiseFunction> opacities;
    opacities->AddPoint(0.0, opacity);
    opacities->AddPoint(1.0, opacity);
    shown.Volume->GetProperty()->SetColor(colors);
    shown.Volume->GetProperty()->SetScalarOpacity(opacities);
    this->Media.push_back({ &shown, color, -std::log1p(-opacity) });
    return this->Media.back();
  }

  Surface& AddSurface(vtkPolyDataAlgorithm* source, const glm::dvec4& color)
  {
    source->Update();
    vtkPolyData* const data = source->GetOutput();
    Surface surface;
    surface.Color = color;
    surface.Actor = this->Shot.AddActor(source->GetOutputPort(), color.a);
    surface.Actor->GetProperty()->SetColor(color.r, color.g, color.b);
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    const auto at = [&](vtkIdType i)
    {
      const double* const point = data->GetPoint(ids[i]);
      return glm::dvec3(point[0], point[1], point[2]);
    };
    for (data->GetPolys()->InitTraversal(); data->GetPolys()->GetNextCell(count, ids) != 0;)
    {
      for (vtkIdType i = 2; i < count; ++i)
      {
        surface.Triangles.push_back({ at(0), at(i - 1), at(i) });
      }
    }
    this->Surfaces.push_back(std::move(surface));
    return this->Surfaces.back();
  }

  void AddPlane(
    const glm::dvec3& middle, const glm::dvec3& one, const glm::dvec3& two, const glm::dvec4& color)
  {
    const glm::dvec3 corner = middle - 0.5 * (one + two);
    const glm::dvec3 first = corner + one;
    const glm::dvec3 second = corner + two;
    vtkNew<vtkPlaneSource> plane;
    plane->SetOrigin(corner.x, corner.y, corner.z);
    plane->SetPoint1(first.x, first.y, first.z);
    plane->SetPoint2(second.x, second.y, second.z);
    this->AddSurface(plane, color);
  }

  void AddSphere(const glm::dvec3& center, double radius, const glm::dvec4& color)
  {
    vtkNew<vtkSphereSource> sphere;
    sphere->SetCenter(center.x, center.y, center.z);
    sphere->SetRadius(radius);
    sphere->SetThetaResolution(24);
    sphere->SetPhiResolution(17);
    this->AddSurface(sphere, color);
  }

  /// What the formula says.
  Picture Expected()
  {
    this->Shot.Show(-2);
    this->ShowTranslucent(false);
    const Picture behind = this->Shot.Draw();
    this->Shot.Show(-1);
    this->ShowTranslucent(true);
    const banyan::RayCamera camera = this->Shot.Camera();
    Picture result = behind;
    for (int pixel = 0; pixel < Width * Height; ++pixel)
    {
      const glm::dvec4 before = this->Along(camera.RayOf(pixel % Width, pixel / Width));
      for (int c = 0; c < 3; ++c)
      {
        const auto at = static_cast<std::size_t>(3 * pixel + c);
        const double value = 255.0 * before[c] + (1.0 - before.a) * behind[at];
        result[at] = static_cast<unsigned char>(std::lround(std::clamp(value, 0.0, 255.0)));
      }
    }
    return result;
  }

  void ShowTranslucent(bool shows)
  {
    for (const Surface& surface : this->Surfaces)
    {
      surface.Actor->SetVisibility(shows || surface.Color.a >= 1.0);
    }
  }

  int Warnings() const
  {
    int count = 0;
    for (const auto& shown : this->Shot.Volumes)
    {
      count += shown->Warnings + (shown->Messages->GetError() ? 1 : 0);
    }
    return count;
  }

  Scene Shot;
  std::vector<Medium> Media;
  std::vector<Surface> Surfaces;

private:
  struct Part
  {
    double Begin;
    double End;
    glm::dvec4 Color; ///< of a surface; of a medium with density in place of opacity
  };

  glm::dvec4 Along(const banyan::Ray& ray) const
  {
    double end = ray.Far;
    std::vector<Part> parts;
    for (const Surface& surface : this->Surfaces)
    {
      for (const auto& triangle : surface.Triangles)
      {
        const double at = Meets(ray, triangle);
        end = surface.Color.a >= 1.0 ? std::min(end, at) : end;
        if (surface.Color.a < 1.0 && std::isfinite(at))
        {
          parts.push_back({ at, at, surface.Color });
        }
      }
    }
    std::vector<double> cuts{ ray.Near, end };
    for (const Medium& medium : this->Media)
    {
      const double enters = medium.Its->Enters(ray);
      if (std::isfinite(enters))
      {
        const glm::dvec3 step(glm::inverse(medium.Its->ToWorld) * glm::dvec4(ray.Direction, 0.0));
        const double leaves = -medium.Its->Enters({ ray.Origin, -ray.Direction, 0.0, 0.0 });
        parts.push_back(
          { enters, leaves, glm::dvec4(medium.Color, medium.Density * glm::length(step)) });
      }
    }
    for (const Part& part : parts)
    {
      cuts.push_back(part.Begin);
      cuts.push_back(part.End);
    }
    std::sort(cuts.begin(), cuts.end());
    glm::dvec4 color(0.0);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    {
      if (cuts[i] < ray.Near || cuts[i + 1] > end)
      {
        continue;
      }
      double density = 0.0;
      glm::dvec3 mixed(0.0);
      for (const Part& part : parts)
      {
        if (part.Begin == part.End && part.Begin == cuts[i] && cuts[i + 1] > cuts[i])
        {
          color += (1.0 - color.a) * part.Color.a * glm::dvec4(glm::dvec3(part.Color), 1.0);
        }
        if (part.Begin <= cuts[i] && part.End >= cuts[i + 1])
        {
          density += part.Color.a;
          mixed += part.Color.a * glm::dvec3(part.Color);
        }
      }
      if (density > 0.0 && cuts[i + 1] > cuts[i])
      {
        const double opacity = -std::expm1(-density * (cuts[i + 1] - cuts[i]));
        color += (1.0 - color.a) * opacity * glm::dvec4(mixed / density, 1.0);
      }
    }
    return color;
  }
};

/// For somebody to look at.
void Save(const Picture& picture, const std::string& name)
{
  const char* const folder = std::getenv("BANYAN_KEEP_PICTURES");
  if (folder == nullptr)
  {
    return;
  }
  vtkNew<vtkImageData> image;
  image->SetDimensions(Width, Height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  std::copy(picture.begin(), picture.end(), static_cast<unsigned char*>(image->GetScalarPointer()));
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName((std::string(folder) + "/" + name + ".png").c_str());
  writer->SetInputData(image);
  writer->Write();
}

/// The part of pixels that are off.
double Off(const Picture& a, const Picture& b)
{
  int count = 0;
  for (std::size_t pixel = 0; pixel < a.size() / 3; ++pixel)
  {
    int worst = 0;
    for (std::size_t c = 0; c < 3; ++c)
    {
      worst = std::max(worst, std::abs(int{ a[3 * pixel + c] } - int{ b[3 * pixel + c] }));
    }
    count += worst > Rounding ? 1 : 0;
  }
  return static_cast<double>(count) / (static_cast<double>(a.size()) / 3.0);
}

void ExpectFormula(Place& place, const std::string& name)
{
  const Picture expected = place.Expected();
  const Picture drawn = place.Shot.Draw();
  const double off = Off(drawn, expected);
  Check(off <= MostRims, name + ": " + std::to_string(100.0 * off) + " % of pixels are off");
  Check(Difference(place.Shot.Draw(), drawn) == 0, name + " is the same once more");
  Check(place.Warnings() == 0, name + " needs no message");
  Save(drawn, name);
  Save(expected, name + " expected");
}

const glm::dvec4 Green(0.1, 0.9, 0.2, 0.5);
const glm::dvec4 Yellow(0.9, 0.9, 0.1, 0.4);
const glm::dvec3 Along(9.0, 0.0, 0.0);
const glm::dvec3 Up(0.0, 9.0, 0.0);

/// One cube in the middle, of 6 units.
Medium& AddCube(Place& place)
{
  Medium& cube = place.AddMedium(glm::ivec3(7), { 0.9, 0.2, 0.1 }, 0.2);
  cube.Its->Place(glm::translate(glm::dmat4(1.0), glm::dvec3(-3.0)));
  return cube;
}

void ArrangementsOfOneVolume()
{
  using Arrange = std::function<void(Place&)>;
  const std::vector<std::pair<std::string, Arrange>> all{
    { "plane",
      [](Place& place) {
        place.AddPlane({ 1, 0, 0.5 }, Along, Up, Green);
      } },
    { "plane before",
      [](Place& place) {
        place.AddPlane({ 1, 0, 4.5 }, Along, Up, Green);
      } },
    { "planes",
      [](Place& place)
      {
        place.AddPlane({ 1, 0, 4.5 }, Along, Up, Yellow);
        place.AddPlane({ 0, 1, 0.5 }, Along, Up, Green);
        place.AddPlane({ -1, 0, 0 }, { 0, 0, 9 }, { 3, 9, 0 }, Yellow);
        place.AddPlane({ 0, 0, -4 }, Along, Up, { 0.2, 0.3, 0.9, 0.7 });
      } },
    { "sphere round it",
      [](Place& place) {
        place.AddSphere({ 0, 0, 0 }, 5.5, Green);
      } },
    { "sphere inside",
      [](Place& place) {
        place.AddSphere({ 0.5, 0, 0 }, 1.8, Green);
      } },
    { "opaque between",
      [](Place& place)
      {
        place.AddSphere({ 0.5, 0, 1 }, 1.8, Green);
        place.AddSphere({ 1.0, 0, 0 }, 1.2, { 0.9, 0.9, 0.9, 1.0 });
        place.AddPlane({ 1, 0, 4.5 }, Along, Up, Yellow);
        place.AddPlane({ 1, 0, -1.5 }, Along, Up, Yellow);
      } },
  };
  for (const auto& arrangement : all)
  {
    for (const bool parallel : { false, true })
    {
      Place place;
      AddCube(place);
      arrangement.second(place);
      place.Shot.Look({ 5, 4, 14 }, { 0, 0, 0 }, parallel);
      ExpectFormula(place, arrangement.first + (parallel ? " parallel" : ""));
    }
  }
}

/// Volumes with spaces of their own, which also share space with each other.
void RandomArrangements()
{
  for (unsigned seed = 0; seed < 60; ++seed)
  {
    Dice dice(seed);
    Place place;
    const int volumes = 1 + static_cast<int>(dice.In(0.0, 3.0));
    for (int i = 0; i < volumes; ++i)
    {
      const glm::ivec3 samples(static_cast<int>(dice.In(3, 11)), static_cast<int>(dice.In(3, 11)),
        static_cast<int>(dice.In(3, 11)));
      Medium& medium =
        place.AddMedium(samples, { double(i != 0), dice.In(0, 1), double(i == 0) }, 0.15);
      glm::dmat4 matrix = glm::rotate(
        glm::translate(glm::dmat4(1.0), dice.Point(2.0)), dice.In(0.0, 6.0), dice.Direction());
      matrix[1] += 0.3 * dice.In(-1.0, 1.0) * matrix[0];
      medium.Its->Place(
        glm::scale(matrix, glm::dvec3(5.0) * glm::exp(dice.Point(0.7)) / medium.Its->High) *
        glm::translate(glm::dmat4(1.0), -0.5 * medium.Its->High));
    }
    const int surfaces = 1 + static_cast<int>(dice.In(0.0, 4.0));
    for (int i = 0; i < surfaces; ++i)
    {
      const glm::dvec4 color(dice.In(0, 1), dice.In(0, 1), dice.In(0, 1), dice.In(0.1, 0.9));
      const glm::dvec3 one = 6.0 * dice.Direction();
      dice.In(0.0, 1.0) < 0.5
        ? place.AddSphere(dice.Point(3.0), dice.In(0.5, 5.0), color)
        : place.AddPlane(dice.Point(3.0), one, glm::cross(one, dice.Direction()), color);
    }
    place.AddSphere(dice.Point(3.0), dice.In(0.3, 1.2), { 0.9, 0.9, 0.9, 1.0 });
    place.Shot.Look(dice.Direction() * 14.0, dice.Point(1.0), dice.In(0.0, 1.0) < 0.4);
    ExpectFormula(place, "arrangement " + std::to_string(seed));
  }
}

/// What others draw stays as it is, and what cannot be mixed is told of.
void OthersStayAsTheyAre()
{
  Place place;
  Medium& cube = AddCube(place);
  place.Shot.Look({ 5, 4, 14 }, { 0, 0, 0 }, false);
  vtkNew<vtkBillboardTextActor3D> text;
  text->SetInput("Behind");
  text->SetPosition(-3, -1, -5);
  text->GetTextProperty()->SetFontSize(14);
  place.Shot.Renderer->AddActor(text);
  place.AddSphere({ 2, 2, -5 }, 1.0, { 0.9, 0.9, 0.9, 1.0 });
  const Picture before = place.Shot.Draw();
  place.AddSphere({ -1, 0, 1 }, 1.0, { 0.1, 0.9, 0.2, 1e-4 });
  const Picture drawn = place.Shot.Draw();
  Check(Difference(drawn, before) <= 1, "what nobody sees changes nothing");
  place.AddSphere({ -1, 0, 1 }, 1.0, Green);
  Check(Difference(place.Shot.Draw(), drawn) > 20, "what somebody sees does");
  Save(place.Shot.Draw(), "text behind");
  Check(place.Warnings() == 0, "and nothing is told");
  cube.Its->Mapper->MixVolumesOff();
  place.Shot.Draw();
  place.Shot.Draw();
  Check(place.Warnings() == 1, "what is not mixed is told of, once");
  const std::string told = cube.Its->Messages->GetWarningMessage();
  Check(told.find("Switch MixVolumes") != std::string::npos, "in words: " + told);
}

void OneWarningOfTextsBeforeVolumes()
{
  Place place;
  Medium& cube = AddCube(place);
  place.Shot.Look({ 5, 4, 14 }, { 0, 0, 0 }, false);
  place.AddPlane({ 1, 0, 0.5 }, Along, Up, Green);
  vtkNew<vtkBillboardTextActor3D> text;
  text->SetInput("Before");
  text->SetPosition(0, 0, 5);
  place.Shot.Renderer->AddActor(text);
  place.Shot.Draw();
  place.Shot.Draw();
  Check(place.Warnings() == 1, "a text before a volume is told of once");
  const std::string told = cube.Its->Messages->GetWarningMessage();
  Check(told.find("A text in space") != std::string::npos, "in words: " + told);
}

/// A surface of many layers.
void MoreLayersThanAreTaken()
{
  for (const int layers : { 60, 70 })
  {
    Place place;
    Medium& cube = AddCube(place);
    place.Shot.Look({ 5, 4, 14 }, { 0, 0, 0 }, false);
    vtkNew<vtkAppendPolyData> all;
    for (int i = 0; i < layers; ++i)
    {
      vtkNew<vtkPlaneSource> plane;
      plane->SetOrigin(-3, -3, -2.0 + 0.05 * i);
      plane->SetPoint1(3, -3, -2.0 + 0.05 * i);
      plane->SetPoint2(-3, 3, -2.0 + 0.05 * i);
      all->AddInputConnection(plane->GetOutputPort());
    }
    place.AddSurface(all, { 0.1, 0.9, 0.2, 0.02 });
    place.Shot.Draw();
    place.Shot.Draw();
    const std::string told = cube.Its->Messages->GetWarningMessage();
    Check((told.find("more than 64 layers") != std::string::npos) == (layers > 64),
      std::to_string(layers) + " layers: " + told);
  }
}

} // namespace

int main()
{
  ArrangementsOfOneVolume();
  RandomArrangements();
  OthersStayAsTheyAre();
  OneWarningOfTextsBeforeVolumes();
  MoreLayersThanAreTaken();
  return Failures();
}
