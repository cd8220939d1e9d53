// SPDX-License-Identifier: BSD-3-Clause
// Components that are colours (IndependentComponentsOff), in a real window: beside VTK's own
// mapper, plain and encoded. With an argument the pictures are kept in that folder.

#include "MapperTesting.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageImport.h"
#include "vtkPNGWriter.h"
#include "vtkTestErrorObserver.h"

#include <algorithm>

using namespace mapper_testing;

namespace
{

using Picture = std::vector<unsigned char>;
const glm::ivec3 Samples{ 45, 38, 41 };

/// What a look at a field has besides.
struct Look
{
  bool Colours = true;
  bool Shaded = false;
  double SampleDistance = 0.1; ///< 0: as the tolerance wants it
  int BlendMode = vtkVolumeMapper::COMPOSITE_BLEND;
};

std::string& PictureFolder()
{
  static std::string folder;
  return folder;
}

void Save(const Picture& picture, const std::string& name)
{
  if (PictureFolder().empty())
  {
    return;
  }
  vtkNew<vtkImageImport> import;
  import->CopyImportVoidPointer(
    const_cast<unsigned char*>(picture.data()), static_cast<int>(picture.size()));
  import->SetDataScalarTypeToUnsignedChar();
  import->SetNumberOfScalarComponents(3);
  import->SetWholeExtent(0, 239, 0, 179, 0, 0);
  import->SetDataExtentToWholeExtent();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(import->GetOutputPort());
  writer->SetFileName((PictureFolder() + "/" + name + ".png").c_str());
  writer->Write();
}

/// Red, green, blue and alpha of samples, one after the other: alpha is that of two soft balls,
/// from 0 to 255 as red is (VTK's mapper asks the opacity function for alpha as a part of its
/// range, from one end of red's range to the other).
std::vector<unsigned char> Bytes(int components, int step = 0)
{
  const std::vector<float> balls = Sampled(Balls, Samples, 5 * step);
  const auto [least, most] = std::minmax_element(balls.begin(), balls.end());
  std::vector<unsigned char> bytes;
  std::size_t at = 0;
  for (int z = 0; z < Samples.z; ++z)
  {
    for (int y = 0; y < Samples.y; ++y)
    {
      for (int x = 0; x < Samples.x; ++x, ++at)
      {
        const double parts[4] = { x / (Samples.x - 1.0), 1.0 - y / (Samples.y - 1.0),
          0.5 + 0.5 * std::sin(0.3 * z + step), double(balls[at] - *least) / (*most - *least) };
        for (int c = 0; c < components; ++c)
        {
          bytes.push_back(static_cast<unsigned char>(255.0 * parts[c]));
        }
      }
    }
  }
  return bytes;
}

vtkSmartPointer<vtkImageData> ColourImage(int components, int step = 0)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(Samples.x, Samples.y, Samples.z);
  const std::vector<unsigned char> bytes = Bytes(components, step);
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName("colours");
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(bytes.size()) / components);
  std::copy(bytes.begin(), bytes.end(), array->GetPointer(0));
  image->GetPointData()->SetScalars(array);
  return image;
}

void WriteColours(const std::string& path, int components)
{
  banyan::Grid grid;
  grid.Extent.Hi = Samples;
  banyan::EncodeOptions options;
  options.ErrorBound = 0.0;
  options.Mode = banyan::ErrorBoundMode::Absolute;
  const std::vector<std::string> names(static_cast<std::size_t>(components), "");
  banyan::SeriesEncoder encoder(path, grid, { { "colours", banyan::ScalarType::UInt8, names, {} } },
    options, banyan::ThreadPool::Process());
  for (int step = 0; step < 2; ++step)
  {
    const std::vector<unsigned char> bytes = Bytes(components, step);
    banyan::ArrayValues values{ bytes.data() };
    encoder.AddStep(step, { values });
  }
  encoder.Finish();
}

Picture Draw(vtkVolumeMapper* mapper, const Look& look)
{
  Stage stage(mapper);
  vtkVolumeProperty* const property = stage.Volume->GetProperty();
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(40.0, 0.0);
  opacity->AddPoint(255.0, 0.5);
  property->SetScalarOpacity(opacity);
  property->SetIndependentComponents(look.Colours ? 0 : 1);
  property->SetShade(look.Shaded ? 1 : 0);
  property->SetAmbient(0.3);
  property->SetDiffuse(0.7);
  property->SetSpecular(0.3);
  mapper->SetBlendMode(look.BlendMode);
  const double bounds[6] = { 0, Samples.x - 1.0, 0, Samples.y - 1.0, 0, Samples.z - 1.0 };
  stage.LookAt(bounds);
  return stage.Draw();
}

Picture DrawOurs(vtkImageData* image, const Look& look)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(look.SampleDistance);
  mapper->SetInputData(image);
  return Draw(mapper, look);
}

/// The largest difference of the channels of a pixel: 0 in grey pictures.
int Colourfulness(const Picture& picture)
{
  int most = 0;
  for (std::size_t i = 0; i + 2 < picture.size(); i += 3)
  {
    const auto [low, high] = std::minmax({ picture[i], picture[i + 1], picture[i + 2] });
    most = std::max(most, int{ high } - int{ low });
  }
  return most;
}

void DrawsWhatVtkDraws()
{
  const vtkSmartPointer<vtkImageData> image = ColourImage(4);
  const Look look;
  vtkNew<vtkGPUVolumeRayCastMapper> mapper;
  mapper->SetInputData(image);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->LockSampleDistanceToInputSpacingOff();
  mapper->UseJitteringOff();
  mapper->SetSampleDistance(static_cast<float>(look.SampleDistance));
  const Picture theirs = Draw(mapper, look);
  const Picture ours = DrawOurs(image, look);
  Save(theirs, "theirs");
  Save(ours, "ours");
  Check(Covered(ours) > 20000 && Colourfulness(ours) > 100, "colours are seen");
  const int difference = Difference(ours, theirs);
  Check(difference <= 2, "VTK's mapper differs by " + std::to_string(difference) + " of 255");
  Look mapped = look;
  mapped.Colours = false;
  Check(Difference(DrawOurs(image, mapped), ours) > 30, "the colour function draws otherwise");
}

/// The luminance of three components in place of alpha: as four of which that is the fourth.
void LuminanceStandsForAlpha()
{
  const vtkSmartPointer<vtkImageData> three = ColourImage(3);
  const vtkSmartPointer<vtkImageData> four = ColourImage(4);
  vtkDataArray* const bytes = four->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < bytes->GetNumberOfTuples(); ++i)
  {
    const double luminance = 0.30 * bytes->GetComponent(i, 0) + 0.59 * bytes->GetComponent(i, 1) +
                             0.11 * bytes->GetComponent(i, 2);
    bytes->SetComponent(i, 3, std::floor(luminance + 0.5));
  }
  for (const bool shaded : { false, true })
  {
    Look look;
    look.Shaded = shaded;
    look.SampleDistance = 0.5;
    const Picture picture = DrawOurs(three, look);
    Save(picture, shaded ? "luminance_shaded" : "luminance");
    Check(Covered(picture) > 5000, "three components are seen");
    Check(Difference(picture, DrawOurs(four, look)) == 0, "luminance is their opacity's argument");
  }
}

void EncodedDrawsLikePlain(const std::string& path, int components)
{
  WriteColours(path, components);
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  for (const bool deferred : { true, false })
  {
    reader->SetDeferDecoding(deferred);
    for (int step = 0; step < 2; ++step)
    {
      Look look;
      look.SampleDistance = 1.0;
      look.Shaded = step == 1;
      vtkNew<vtkBanyanVolumeMapper> mapper;
      mapper->SetSampleDistanceVoxels(look.SampleDistance);
      mapper->SetInputConnection(reader->GetOutputPort());
      reader->UpdateTimeStep(step);
      const Picture picture = Draw(mapper, look);
      Save(picture, "encoded_" + std::to_string(components) + "_" + std::to_string(step));
      Check(Colourfulness(picture) > 50, "colours are seen");
      Check(Difference(picture, DrawOurs(ColourImage(components, step), look)) == 0,
        "encoded without loss draws like plain");
      Check(mapper->GetStatistics()->GetEncodingErrorOfValues() == 0.0, "and says so");
    }
  }
}

void TheToleranceIsKept()
{
  const vtkSmartPointer<vtkImageData> image = ColourImage(4);
  const Picture fine = DrawOurs(image, {});
  for (const double tolerance : { 1.0, 4.0 })
  {
    vtkNew<vtkBanyanVolumeMapper> mapper;
    mapper->SetImageErrorTolerance(tolerance);
    mapper->SetInputData(image);
    const int difference = Difference(Draw(mapper, {}), fine);
    const double estimated = mapper->GetStatistics()->GetEstimatedImageError();
    Check(estimated > 0.0 && estimated <= tolerance, "the error is estimated");
    Check(difference <= tolerance + 1.0, "it is " + std::to_string(difference));
  }
}

/// What a mapper says when it draws an image.
std::string SentenceOf(vtkImageData* image, const Look& look, double enhancement = 0.0)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  vtkNew<vtkTest::ErrorObserver> messages;
  mapper->AddObserver(vtkCommand::ErrorEvent, messages);
  mapper->AddObserver(vtkCommand::WarningEvent, messages);
  mapper->SetTemporalEnhancement(enhancement);
  mapper->SetInputData(image);
  Draw(mapper, look);
  return messages->GetErrorMessage() + messages->GetWarningMessage();
}

void SaysWhatHasNoColours()
{
  Check(SentenceOf(ColourImage(4), {}).empty(), "nothing is said of colours");
  Look projected;
  projected.BlendMode = vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND;
  const std::string sentence = SentenceOf(ColourImage(4), projected);
  Check(sentence.find("IndependentComponents off") != std::string::npos, sentence);
  Look mapped = projected;
  mapped.Colours = false;
  Check(Difference(DrawOurs(ColourImage(4), projected), DrawOurs(ColourImage(4), mapped)) == 0,
    "a projection is that of the magnitude");
  Check(SentenceOf(ColourImage(2), {}).find("IndependentComponents off") != std::string::npos,
    "two components have no colours");
  Check(SentenceOf(ColourImage(1), {}).empty(), "one component is mapped without a word");
  Check(SentenceOf(ColourImage(4), {}, 0.5).find("colours have several") != std::string::npos,
    "colours are not enhanced");
}

} // namespace

int main(int argc, char** argv)
{
  PictureFolder() = argc > 1 ? argv[1] : "";
  const TemporaryFolder folder;
  DrawsWhatVtkDraws();
  LuminanceStandsForAlpha();
  EncodedDrawsLikePlain(folder / "three.banyan", 3);
  EncodedDrawsLikePlain(folder / "four.banyan", 4);
  TheToleranceIsKept();
  SaysWhatHasNoColours();
  std::cout << Failures() << " checks failed\n";
  return Failures();
}
