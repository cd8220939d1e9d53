// SPDX-License-Identifier: BSD-3-Clause
// Texts, scalar bars and other 2-D actors are drawn over a volume, after it: no pixel is read back
// for them, and the picture is the one of reading all pixels.

#include "MapperTesting.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkActor2D.h"
#include "vtkAxisActor2D.h"
#include "vtkCornerAnnotation.h"
#include "vtkFollower.h"
#include "vtkLegendBoxActor.h"
#include "vtkPlaneSource.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkPolyDataMapper2D.h"
#include "vtkProperty2D.h"
#include "vtkScalarBarActor.h"
#include "vtkTextActor.h"
#include "vtkTextMapper.h"
#include "vtkTextProperty.h"

using namespace mapper_testing;

namespace
{

const double Bounds[6] = { 0, 44, 0, 37, 0, 40 };

struct Named
{
  const char* Name;
  vtkSmartPointer<vtkActor2D> Prop;
};

/// Half transparent, so that it shows what was there when it was drawn.
vtkSmartPointer<vtkActor2D> Rectangle()
{
  vtkNew<vtkPlaneSource> plane;
  plane->SetOrigin(60, 40, 0);
  plane->SetPoint1(180, 40, 0);
  plane->SetPoint2(60, 140, 0);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputConnection(plane->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(1.0, 1.0, 1.0);
  actor->GetProperty()->SetOpacity(0.5);
  return actor;
}

vtkSmartPointer<vtkActor2D> Text()
{
  auto text = vtkSmartPointer<vtkTextActor>::New();
  text->SetInput("over the volume");
  text->SetPosition(40, 80);
  text->GetTextProperty()->SetFontSize(24);
  return text;
}

vtkSmartPointer<vtkActor2D> ScalarBar(vtkVolume* volume)
{
  auto bar = vtkSmartPointer<vtkScalarBarActor>::New();
  bar->SetLookupTable(volume->GetProperty()->GetRGBTransferFunction(0));
  bar->SetTitle("value");
  bar->SetPosition(0.4, 0.1);
  bar->SetWidth(0.2);
  return bar;
}

vtkSmartPointer<vtkActor2D> Axis()
{
  auto axis = vtkSmartPointer<vtkAxisActor2D>::New();
  axis->SetPoint1(0.2, 0.5);
  axis->SetPoint2(0.8, 0.5);
  return axis;
}

vtkSmartPointer<vtkActor2D> Corner()
{
  auto corner = vtkSmartPointer<vtkCornerAnnotation>::New();
  corner->SetText(vtkCornerAnnotation::UpperLeft, "in a corner,\nand below it");
  return corner;
}

vtkSmartPointer<vtkActor2D> Legend()
{
  auto legend = vtkSmartPointer<vtkLegendBoxActor>::New();
  legend->SetNumberOfEntries(1);
  vtkNew<vtkPlaneSource> symbol;
  symbol->Update();
  double white[3] = { 1.0, 1.0, 1.0 };
  legend->SetEntry(0, symbol->GetOutput(), "entry", white);
  legend->SetPosition(0.4, 0.4);
  return legend;
}

vtkSmartPointer<vtkActor2D> TextOfAMapper()
{
  vtkNew<vtkTextMapper> mapper;
  mapper->SetInput("a line");
  auto actor = vtkSmartPointer<vtkActor2D>::New();
  actor->SetMapper(mapper);
  actor->SetPosition(100, 100);
  return actor;
}

/// Of which nobody knows where it draws: all of the volume's rectangle is read for it. Draws
/// nothing.
vtkSmartPointer<vtkFollower> Unknown()
{
  vtkNew<vtkPolyDataMapper> nothing;
  nothing->SetInputData(vtkNew<vtkPolyData>());
  auto prop = vtkSmartPointer<vtkFollower>::New();
  prop->SetMapper(nothing);
  return prop;
}

void NoPixelIsReadForPropsDrawnLast(int samples)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  mapper->SetInputData(PlainImage(Balls, { 45, 38, 41 }));
  Stage stage(mapper, samples);
  stage.LookAt(Bounds);
  const auto read = [&] { return mapper->GetStatistics()->GetPixelsReadBehind(); };
  const auto bare = stage.Draw();
  const vtkSmartPointer<vtkFollower> unknown = Unknown();
  for (const Named& one : { Named{ "a rectangle", Rectangle() }, Named{ "a text", Text() },
         Named{ "a scalar bar", ScalarBar(stage.Volume) }, Named{ "an axis", Axis() },
         Named{ "a text in a corner", Corner() }, Named{ "a legend", Legend() } })
  {
    const std::string name = one.Name;
    stage.Renderer->AddActor2D(one.Prop);
    const auto with = stage.Draw();
    Check(read() == 0, "no pixel is read for " + name);
    Check(Difference(with, bare) > 50, name + " is seen");
    stage.Renderer->AddActor(unknown);
    Check(Difference(stage.Draw(), with) == 0, "reading all changes nothing under " + name);
    Check(read() > 1000, "all is read for what is not known");
    stage.Renderer->RemoveActor(unknown);
    stage.Renderer->RemoveActor2D(one.Prop);
  }
  // With a mapper of a class that is not known it may draw whenever it likes.
  stage.Renderer->AddActor2D(TextOfAMapper());
  stage.Draw();
  Check(read() > 1000, "all is read for a 2-D actor that is not known");
}

} // namespace

int main()
{
  NoPixelIsReadForPropsDrawnLast(0);
  NoPixelIsReadForPropsDrawnLast(4);
  std::cout << Failures() << " checks failed\n";
  return Failures();
}
