// SPDX-License-Identifier: BSD-3-Clause
// Translucent surfaces before volumes of one density, in them and behind them, with opaque spheres
// between: each pixel is what a formula says, for the points in which its ray meets triangles.

#include "SurfacesInMedia.h"

#include "../Core/Render/Dice.h"

#include "vtkAppendPolyData.h"
#include "vtkBillboardTextActor3D.h"
#include "vtkPlaneSource.h"
#include "vtkTextProperty.h"

using namespace several_volumes;
using namespace surfaces_in_media;

namespace
{

/// Colours are rounded, and light that is below a limit is left out.
constexpr double Rounding = 2.5;
/// Of pixels: OpenGL puts rims of surfaces somewhere else by parts of a pixel.
constexpr double MostRims = 0.01;

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
