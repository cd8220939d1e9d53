// SPDX-License-Identifier: BSD-3-Clause
// vtkBanyanVolumeMapper in a real window: equal pictures from different ways to the same answer.

#include "MapperTesting.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkActor.h"
#include "vtkCellData.h"
#include "vtkFollower.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkSphereSource.h"
#include "vtkTestErrorObserver.h"
#include "vtkTransform.h"

#include <limits>

using namespace mapper_testing;

namespace
{

using Picture = std::vector<unsigned char>;
const glm::ivec3 Samples{ 45, 38, 41 };
const double Bounds[6] = { 0, 44, 0, 37, 0, 40 };

Picture DrawImage(vtkImageData* image, int multiSamples = 0)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  mapper->SetInputData(image);
  Stage stage(mapper, multiSamples);
  stage.LookAt(Bounds);
  return stage.Draw();
}

void EncodedDrawsLikePlain(const std::string& path)
{
  const vtkSmartPointer<vtkImageData> plain = PlainImage(Balls, Samples);
  const Picture expected = DrawImage(plain);
  Check(Covered(expected) > 5000, "the volume covers a good part of the picture");
  WriteSeries(path, Balls, Samples, 3, 0.0);
  for (const bool deferred : { true, false })
  {
    vtkNew<vtkBanyanSeriesReader> reader;
    reader->SetFileName(path.c_str());
    reader->SetDeferDecoding(deferred);
    vtkNew<vtkBanyanVolumeMapper> mapper;
    mapper->SetSampleDistanceVoxels(1.0);
    mapper->SetInputConnection(reader->GetOutputPort());
    Stage stage(mapper);
    stage.LookAt(Bounds);
    reader->UpdateTimeStep(0);
    Check(Difference(stage.Draw(), expected) <= 1, "encoded without loss draws like plain");
    reader->UpdateTimeStep(2);
    Check(Difference(stage.Draw(), expected) > 3, "another step draws another picture");
    reader->UpdateTimeStep(0);
    Check(Difference(stage.Draw(), expected) <= 1, "going back draws the first picture again");
  }
}

/// The budget is changed while the series is shown. Without one, bricks are decoded for each
/// picture.
void TheBudgetChangesNoPicture(const std::string& path)
{
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  mapper->SetInputConnection(reader->GetOutputPort());
  Stage stage(mapper);
  stage.LookAt(Bounds);
  reader->UpdateTimeStep(0);
  const Picture expected = stage.Draw();
  const vtkIdType shared = mapper->GetStatistics()->GetCacheBytes();
  for (const int mebibytes : { 0, 1, 64, -1 })
  {
    reader->SetCacheBudget(mebibytes);
    reader->UpdateTimeStep(0);
    const Picture first = stage.Draw();
    Check(first == expected, "the picture is the same with any budget");
    const vtkIdType misses = mapper->GetStatistics()->GetCacheMisses();
    const vtkIdType bytes = mapper->GetStatistics()->GetCacheBytes();
    Check((misses > 0) == (mebibytes >= 0), "caches of its own are empty at first");
    Check(mebibytes < 0 ? bytes == shared : bytes <= (vtkIdType{ mebibytes } << 20) / 8 * 3,
      "decoded bricks are those of the series");
    Check((bytes > 0) == (mebibytes != 0), "no budget, no bricks");
    Check(stage.Draw() == expected, "and the next one is");
  }
}

/// Level 1 is every second sample: the same picture as of those samples by themselves.
void ACoarserLevelDrawsItsSamples(const std::string& path)
{
  const glm::ivec3 coarse = (Samples - 1) / 2 + 1;
  const glm::dvec3 shrink = 2.0 * glm::dvec3(coarse - 1) / glm::dvec3(Samples - 1);
  const auto everySecond = [&](double x, double y, double z, int step)
  { return Balls(x * shrink.x, y * shrink.y, z * shrink.z, step); };
  const vtkSmartPointer<vtkImageData> plain = PlainImage(everySecond, coarse);
  plain->SetSpacing(2.0, 2.0, 2.0);
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetLevel(1);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  mapper->SetInputConnection(reader->GetOutputPort());
  Stage stage(mapper);
  stage.LookAt(Bounds);
  Check(Difference(stage.Draw(), DrawImage(plain)) <= 1, "level 1 draws every second sample");
}

/// The direct way may be taken only where the points are those of the series.
void AMovedImageIsDrawnWhereItLies(const std::string& path)
{
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkNew<vtkImageData> moved;
  moved->ShallowCopy(reader->GetOutput());
  moved->SetOrigin(30.0, 0.0, 0.0);
  const vtkSmartPointer<vtkImageData> plain = PlainImage(Balls, Samples);
  plain->SetOrigin(30.0, 0.0, 0.0);
  Check(Difference(DrawImage(moved), DrawImage(plain)) <= 1, "a moved image is drawn moved");
}

void MatricesMoveTheVolume()
{
  const vtkSmartPointer<vtkImageData> image = PlainImage(Balls, Samples);
  const vtkSmartPointer<vtkImageData> scaled = PlainImage(Balls, Samples);
  scaled->SetSpacing(2.0, 2.0, 2.0);
  scaled->SetOrigin(5.0, 0.0, 0.0);
  Stage expected(nullptr);
  vtkNew<vtkBanyanVolumeMapper> first;
  first->SetSampleDistanceVoxels(1.0);
  first->SetInputData(scaled);
  expected.Volume->SetMapper(first);
  expected.Volume->GetProperty()->SetScalarOpacityUnitDistance(2.0);
  const double bounds[6] = { 0, 98, 0, 74, 0, 80 };
  expected.LookAt(bounds);

  vtkNew<vtkBanyanVolumeMapper> second;
  second->SetSampleDistanceVoxels(1.0);
  second->SetInputData(image);
  Stage moved(second);
  moved.Volume->SetScale(2.0);
  moved.Volume->SetPosition(5.0, 0.0, 0.0);
  moved.LookAt(bounds);
  Check(
    Difference(expected.Draw(), moved.Draw()) <= 1, "scale and position equal spacing and origin");
}

/// Opaque balls before, in, behind and beside the volume.
void AddBalls(vtkRenderer* renderer, int count = 4)
{
  const double centers[4][3] = { { 22, 30, 60 }, { 22, 19, 20 }, { 10, 5, -15 }, { 60, 30, 20 } };
  for (int i = 0; i < count; ++i)
  {
    const double* const center = centers[i];
    vtkNew<vtkSphereSource> sphere;
    sphere->SetCenter(center[0], center[1], center[2]);
    sphere->SetRadius(6.0);
    sphere->SetThetaResolution(40);
    sphere->SetPhiResolution(40);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputConnection(sphere->GetOutputPort());
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->LightingOff();
    actor->GetProperty()->SetColor(0.2, 0.9, 0.3);
    renderer->AddActor(actor);
  }
}

Picture WithBalls(bool volume, int multiSamples)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  mapper->SetInputData(PlainImage(Balls, Samples));
  Stage stage(mapper, multiSamples);
  stage.Volume->SetVisibility(volume);
  AddBalls(stage.Renderer);
  const double bounds[6] = { -10, 66, -10, 40, -21, 66 };
  stage.LookAt(bounds);
  return stage.Draw();
}

void GeometryEndsRays()
{
  for (const int samples : { 0, 4 })
  {
    const Picture alone = WithBalls(false, samples);
    const Picture together = WithBalls(true, samples);
    std::size_t untouched = 0;
    std::size_t tinted = 0;
    for (std::size_t i = 0; i + 2 < alone.size(); i += 3)
    {
      const bool ball = alone[i + 1] == 230; // the balls' green, unlit
      const bool same =
        Difference({ &alone[i], &alone[i] + 3 }, { &together[i], &together[i] + 3 }) <= 1;
      untouched += ball && same ? 1 : 0;
      tinted += ball && !same ? 1 : 0;
    }
    Check(untouched > 150, "balls before and beside the volume stay as they are");
    Check(tinted > 50, "balls in and behind the volume are seen through it");
  }
}

/// Pixels are read back where other props are on the screen, and the picture is the same.
void OnlyWhatOthersDrawIsReadBack()
{
  for (const int samples : { 0, 4 })
  {
    vtkNew<vtkBanyanVolumeMapper> mapper;
    mapper->SetSampleDistanceVoxels(1.0);
    mapper->SetInputData(PlainImage(Balls, Samples));
    Stage stage(mapper, samples);
    const double bounds[6] = { -10, 66, -10, 40, -21, 66 };
    stage.LookAt(bounds);
    const auto read = [&] { return mapper->GetStatistics()->GetPixelsReadBehind(); };
    const Picture bare = stage.Draw();
    Check(read() == 0, "without other props no pixel is read");
    AddBalls(stage.Renderer, 1);
    const Picture some = stage.Draw();
    const vtkIdType few = read();
    // Of a prop that may draw beyond its bounds nothing is known: everything is read then.
    vtkNew<vtkPolyDataMapper> nothing;
    nothing->SetInputData(vtkNew<vtkPolyData>());
    vtkNew<vtkFollower> other;
    other->SetMapper(nothing);
    stage.Renderer->AddActor(other);
    Check(Difference(stage.Draw(), some) == 0, "the picture is that of reading all pixels");
    const vtkIdType all = read();
    Check(Difference(some, bare) > 50, "a ball is seen");
    Check(few > 100 && 3 * few < all,
      "few pixels are read: " + std::to_string(few) + " of " + std::to_string(all));
    other->VisibilityOff();
    AddBalls(stage.Renderer, 4);
    const Picture most = stage.Draw();
    Check(read() > few && read() < all, "more balls are more pixels");
    other->VisibilityOn();
    Check(Difference(stage.Draw(), most) == 0, "that of all balls, too");
  }
}

void VectorsAreDrawnByMagnitudeOrComponent()
{
  const vtkSmartPointer<vtkImageData> image = PlainImage(Balls, Samples);
  const Picture expected = DrawImage(image);
  const vtkSmartPointer<vtkDataArray> scalars = image->GetPointData()->GetScalars();
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("vectors");
  vectors->SetNumberOfComponents(3);
  vectors->SetNumberOfTuples(scalars->GetNumberOfTuples());
  for (vtkIdType i = 0; i < scalars->GetNumberOfTuples(); ++i)
  {
    const double value = scalars->GetTuple1(i);
    vectors->SetTuple3(i, 0.6 * value, value, -0.8 * value);
  }
  image->GetPointData()->SetScalars(vectors);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  mapper->SetInputData(image);
  Stage stage(mapper);
  stage.LookAt(Bounds);
  vtkColorTransferFunction* colors = stage.Volume->GetProperty()->GetRGBTransferFunction(0);
  colors->SetVectorModeToComponent();
  colors->SetVectorComponent(1);
  Check(Difference(stage.Draw(), expected) <= 1, "a component draws like the same scalars");
  colors->SetVectorModeToMagnitude();
  Check(Difference(stage.Draw(), expected) > 3, "the magnitude draws differently");
  for (vtkIdType i = 0; i < scalars->GetNumberOfTuples(); ++i)
  {
    const double value = scalars->GetTuple1(i);
    vectors->SetTuple3(i, 0.6 * value, 0.0, -0.8 * value);
  }
  vectors->Modified();
  image->Modified();
  Check(Difference(stage.Draw(), expected) <= 1, "the magnitude of (0.6, 0, -0.8) v draws like v");
}

void MissingValuesAreEmpty()
{
  const vtkSmartPointer<vtkImageData> image = PlainImage(Balls, Samples);
  auto* values = vtkFloatArray::SafeDownCast(image->GetPointData()->GetScalars());
  values->Fill(std::numeric_limits<float>::quiet_NaN());
  Check(Covered(DrawImage(image)) == 0, "NaN is drawn as empty");
}

void SmallVolumesDrawWithoutAWord()
{
  for (const glm::ivec3 n :
    { glm::ivec3(1), glm::ivec3(1, 8, 9), glm::ivec3(2), glm::ivec3(17, 16, 2) })
  {
    vtkNew<vtkBanyanVolumeMapper> mapper;
    mapper->SetSampleDistanceVoxels(1.0);
    vtkNew<vtkTest::ErrorObserver> errors;
    mapper->AddObserver(vtkCommand::ErrorEvent, errors);
    mapper->SetInputData(PlainImage([](double, double, double, int) { return 0.9f; }, n));
    Stage stage(mapper);
    const double bounds[6] = { 0, 8, 0, 8, 0, 8 };
    stage.LookAt(bounds);
    const bool flat = n.x == 1 || n.y == 1 || n.z == 1;
    Check((Covered(stage.Draw()) == 0) == flat, "only a volume of some thickness is seen");
    Check(!errors->GetError(), "a small volume is no error");
  }
}

void UnusableInputGetsASentence()
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(9, 9, 9);
  vtkNew<vtkFloatArray> cells;
  cells->SetName("pressure");
  cells->SetNumberOfTuples(image->GetNumberOfCells());
  cells->Fill(0.9f);
  image->GetCellData()->SetScalars(cells);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  vtkNew<vtkTest::ErrorObserver> errors;
  mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  mapper->SetInputData(image);
  mapper->SetScalarMode(VTK_SCALAR_MODE_USE_CELL_FIELD_DATA);
  mapper->SelectScalarArray("pressure");
  Stage stage(mapper);
  stage.LookAt(Bounds);
  Check(Covered(stage.Draw()) == 0, "cell data is not drawn");
  Check(errors->GetErrorMessage().find("Cell Data to Point Data") != std::string::npos,
    "the message says what to do about cell data");
  errors->Clear();
  mapper->SetScalarMode(VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  stage.Draw();
  Check(errors->GetErrorMessage().find("pressure") != std::string::npos,
    "the message names the array that is missing");
}

void HalvingTheStepChangesLittle()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(1.0);
  mapper->SetInputData(PlainImage(Balls, Samples));
  Stage stage(mapper);
  stage.LookAt(Bounds);
  const Picture expected = stage.Draw();
  mapper->SetSampleDistanceVoxels(0.5);
  const vtkIdType before = mapper->GetStatistics()->GetSamplesTaken();
  Check(Difference(stage.Draw(), expected) <= 2, "half the step draws the same within 2/255");
  Check(mapper->GetStatistics()->GetSamplesTaken() > 3 * before / 2, "and takes more samples");
}

void ShadingChangesColours(const std::string& path)
{
  WriteSeries(path, Balls, Samples, 1, 0.0);
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkBanyanVolumeMapper> encoded;
  encoded->SetSampleDistanceVoxels(1.0);
  encoded->SetInputConnection(reader->GetOutputPort());
  vtkNew<vtkBanyanVolumeMapper> plain;
  plain->SetSampleDistanceVoxels(1.0);
  plain->SetInputData(PlainImage(Balls, Samples));
  const auto draw = [](vtkBanyanVolumeMapper* mapper, bool shade)
  {
    Stage stage(mapper);
    stage.LookAt(Bounds);
    stage.Volume->GetProperty()->SetShade(shade);
    return stage.Draw();
  };
  const Picture shaded = draw(plain, true);
  Check(Difference(shaded, draw(plain, false)) > 20, "shading is seen");
  Check(Difference(shaded, draw(encoded, true)) <= 1, "encoded volumes are shaded like plain ones");
}

} // namespace

int main()
{
  const TemporaryFolder folder;
  EncodedDrawsLikePlain(folder / "series.banyan");
  TheBudgetChangesNoPicture(folder / "series.banyan");
  ACoarserLevelDrawsItsSamples(folder / "series.banyan");
  AMovedImageIsDrawnWhereItLies(folder / "series.banyan");
  MatricesMoveTheVolume();
  GeometryEndsRays();
  OnlyWhatOthersDrawIsReadBack();
  VectorsAreDrawnByMagnitudeOrComponent();
  MissingValuesAreEmpty();
  SmallVolumesDrawWithoutAWord();
  UnusableInputGetsASentence();
  HalvingTheStepChangesLittle();
  ShadingChangesColours(folder / "shaded.banyan");
  std::cout << Failures() << " checks failed\n";
  return Failures();
}
