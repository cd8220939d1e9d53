// SPDX-License-Identifier: BSD-3-Clause
// Options that vtkBanyanVolumeMapper shares with VTK's own volume mappers: the pictures of both.
// With an argument the pictures are kept in that folder.

#include "MapperTesting.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageImport.h"
#include "vtkPNGWriter.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkTestErrorObserver.h"

#include <limits>

using namespace mapper_testing;

namespace
{

using Picture = std::vector<unsigned char>;
using Setting = std::function<void(vtkVolumeMapper*, vtkVolume*)>;
const glm::ivec3 Samples{ 45, 38, 41 };

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

double Psnr(const Picture& a, const Picture& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  }
  return sum > 0.0 ? 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / sum) : 99.0;
}

/// Stretched, so that spacing counts.
vtkSmartPointer<vtkImageData> Field()
{
  const vtkSmartPointer<vtkImageData> image = PlainImage(Balls, Samples);
  image->SetSpacing(1.0, 1.2, 0.9);
  image->SetOrigin(-20.0, -10.0, 3.0);
  return image;
}

vtkSmartPointer<vtkImageData> Labels()
{
  const auto label = [](double x, double y, double z, int)
  {
    const bool ball = (x - 0.4) * (x - 0.4) + (y - 0.5) * (y - 0.5) + (z - 0.5) * (z - 0.5) < 0.08;
    return ball ? 0.5f : x + y > 1.3 ? 1.0f : 0.0f;
  };
  return PlainImage(label, { 14, 12, 13 });
}

Picture Draw(vtkVolumeMapper* mapper, vtkImageData* image, const Setting& setting)
{
  mapper->SetInputData(image);
  Stage stage(mapper);
  vtkPiecewiseFunction* opacity = stage.Volume->GetProperty()->GetScalarOpacity();
  opacity->RemoveAllPoints();
  opacity->AddPoint(0.1, 0.0);
  opacity->AddPoint(1.0, 0.6);
  setting(mapper, stage.Volume);
  stage.LookAt(image->GetBounds());
  return stage.Draw();
}

Picture DrawOurs(vtkImageData* image, const Setting& setting)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetSampleDistanceVoxels(0.25);
  vtkNew<vtkTest::ErrorObserver> errors;
  mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  const Picture picture = Draw(mapper, image, setting);
  Check(!errors->GetError(), "no error: " + errors->GetErrorMessage());
  return picture;
}

Picture DrawVtks(vtkImageData* image, const Setting& setting)
{
  vtkNew<vtkGPUVolumeRayCastMapper> mapper;
  mapper->SetAutoAdjustSampleDistances(false);
  mapper->SetSampleDistance(0.25f);
  return Draw(mapper, image, setting);
}

void Nothing(vtkVolumeMapper*, vtkVolume*) {}

void AddPlane(vtkVolumeMapper* mapper, const glm::dvec3& origin, const glm::dvec3& normal)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(origin.x, origin.y, origin.z);
  plane->SetNormal(normal.x, normal.y, normal.z);
  mapper->AddClippingPlane(plane);
}

void Clip(vtkVolumeMapper* mapper, vtkVolume*)
{
  AddPlane(mapper, { 2.0, 12.0, 21.0 }, { 0.6, 0.0, -0.8 });
  AddPlane(mapper, { 2.0, 20.0, 21.0 }, { -0.3, 0.9, 0.1 });
}

void Crop(vtkVolumeMapper* mapper, vtkVolume*)
{
  mapper->SetCropping(true);
  mapper->SetCroppingRegionPlanes(-10.0, 14.3, -4.0, 30.0, 7.0, 30.0);
}

/// @param least PSNR in dB
void ExpectVtksPicture(const std::string& name, vtkImageData* image, const Setting& setting,
  double least, const Setting& without = Nothing)
{
  const Picture ours = DrawOurs(image, setting);
  const Picture theirs = DrawVtks(image, setting);
  Save(ours, name + ".ours");
  Save(theirs, name + ".vtk");
  const double psnr = Psnr(ours, theirs);
  const double change = Psnr(ours, DrawOurs(image, without));
  std::cout << name << ": " << psnr << " dB to VTK's picture, " << change << " dB without\n";
  Check(psnr >= least, name + " looks as in VTK");
  Check(change < least - 8.0, name + " changes the picture");
  Check(Covered(ours) > 3000, name + " is seen");
}

Setting WithMode(int mode, const Setting& more = Nothing)
{
  return [mode, more](vtkVolumeMapper* mapper, vtkVolume* volume)
  {
    mapper->SetBlendMode(mode);
    more(mapper, volume);
  };
}

void PicturesAreVtks()
{
  const vtkSmartPointer<vtkImageData> field = Field();
  ExpectVtksPicture("maximum", field, WithMode(vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND), 55.0);
  const auto opaque = [](vtkVolumeMapper* mapper, vtkVolume* volume)
  {
    mapper->SetBlendModeToMinimumIntensity();
    vtkPiecewiseFunction* opacity = volume->GetProperty()->GetScalarOpacity();
    opacity->RemoveAllPoints();
    opacity->AddPoint(0.0, 0.2);
    opacity->AddPoint(0.3, 0.9);
  };
  ExpectVtksPicture("minimum", field, opaque, 50.0);
  ExpectVtksPicture("average", field, WithMode(vtkVolumeMapper::AVERAGE_INTENSITY_BLEND), 50.0);
  const auto some = [](vtkVolumeMapper* mapper, vtkVolume*)
  {
    mapper->SetBlendModeToAverageIntensity();
    mapper->SetAverageIPScalarRange(0.3, 0.7);
  };
  ExpectVtksPicture(
    "average_of_some", field, some, 50.0, WithMode(vtkVolumeMapper::AVERAGE_INTENSITY_BLEND));
  ExpectVtksPicture("cropped", field, Crop, 43.0);
  ExpectVtksPicture("clipped", field, Clip, 50.0);
  ExpectVtksPicture("maximum_cropped_and_clipped", field,
    WithMode(vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND,
      [](vtkVolumeMapper* mapper, vtkVolume* volume)
      {
        Crop(mapper, volume);
        Clip(mapper, volume);
      }),
    50.0, WithMode(vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND));
  // Planes lie in the world, cropping boxes in the data.
  const auto moved = [](vtkVolumeMapper* mapper, vtkVolume* volume)
  {
    volume->SetPosition(3.0, -2.0, 1.0);
    volume->SetOrientation(10.0, 20.0, 30.0);
    volume->SetScale(0.9, 0.8, 0.7);
    Crop(mapper, volume);
    AddPlane(mapper, { 2.0, 12.0, 15.0 }, { 0.6, 0.0, -0.8 });
  };
  ExpectVtksPicture("moved_cropped_and_clipped", field, moved, 41.0);
}

void LabelsAreVtks()
{
  const auto nearest = [](vtkVolumeMapper*, vtkVolume* volume)
  { volume->GetProperty()->SetInterpolationTypeToNearest(); };
  ExpectVtksPicture("nearest", Labels(), nearest, 40.0);
}

/// VTK's mappers on graphics cards know no greys: they are compared with the colours that they are.
void GreysAreColours()
{
  const auto grey = [](vtkVolumeMapper*, vtkVolume* volume)
  {
    vtkNew<vtkPiecewiseFunction> greys;
    greys->AddPoint(0.2, 0.9);
    greys->AddPoint(0.8, 0.1);
    volume->GetProperty()->SetColor(greys);
  };
  const auto colour = [](vtkVolumeMapper*, vtkVolume* volume)
  {
    vtkNew<vtkColorTransferFunction> colours;
    colours->AddRGBPoint(0.2, 0.9, 0.9, 0.9);
    colours->AddRGBPoint(0.8, 0.1, 0.1, 0.1);
    volume->GetProperty()->SetColor(colours);
  };
  const Picture ours = DrawOurs(Field(), grey);
  Check(Covered(ours) > 3000, "greys are seen");
  Check(Difference(ours, DrawOurs(Field(), colour)) == 0, "a function of greys gives greys");
}

/// What is set and has no effect is said once, and drawn as if it were not set.
void ExpectWarning(const Setting& setting, vtkImageData* image, const std::string& part)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  vtkNew<vtkTest::ErrorObserver> messages;
  mapper->AddObserver(vtkCommand::WarningEvent, messages);
  mapper->SetInputData(image);
  Stage stage(mapper);
  stage.LookAt(image->GetBounds());
  const Picture without = stage.Draw();
  Check(!messages->GetWarning(), "no warning without: " + messages->GetWarningMessage());
  messages->Clear();
  setting(mapper, stage.Volume);
  Check(Difference(stage.Draw(), without) == 0, part + " changes nothing");
  const std::string sentence = messages->GetWarningMessage();
  Check(sentence.find(part) != std::string::npos, "'" + sentence + "' has '" + part + "'");
  messages->Clear();
  stage.Draw();
  Check(!messages->GetWarning(), part + " is said once");
}

void OptionsWithoutEffectGetAWarning()
{
  const vtkSmartPointer<vtkImageData> field = Field();
  const auto gradients = [](vtkVolumeMapper*, vtkVolume* volume)
  {
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(0.0, 0.0);
    opacity->AddPoint(0.1, 1.0);
    volume->GetProperty()->SetGradientOpacity(opacity);
  };
  ExpectWarning(gradients, field, "GradientOpacity");
  const auto weight = [](vtkVolumeMapper*, vtkVolume* volume)
  {
    volume->GetProperty()->SetComponentWeight(0, 0.5);
    volume->GetProperty()->SetTransferFunctionModeTo2D();
  };
  ExpectWarning(weight, field, "functions are drawn), ComponentWeight.");
  const auto normals = [](vtkVolumeMapper* mapper, vtkVolume* volume)
  {
    mapper->ComputeNormalFromOpacityOn();
    volume->GetProperty()->SetScatteringAnisotropy(0.5f);
    volume->GetProperty()->SetUseClippedVoxelIntensity(1);
  };
  ExpectWarning(
    normals, field, "ScatteringAnisotropy, ClippedVoxelIntensity, ComputeNormalFromOpacity");
  const auto labels = [](vtkVolumeMapper*, vtkVolume* volume)
  { volume->GetProperty()->SetLabelColor(1, vtkNew<vtkColorTransferFunction>()); };
  ExpectWarning(labels, field, "functions of labels");
  vtkNew<vtkImageData> vectors;
  vectors->SetDimensions(20, 20, 20);
  vectors->AllocateScalars(VTK_FLOAT, 2);
  vtkDataArray* values = vectors->GetPointData()->GetScalars();
  for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i)
  {
    values->SetTuple2(i, 0.0001 * static_cast<double>(i), 0.5);
  }
  const auto together = [](vtkVolumeMapper*, vtkVolume* volume)
  { volume->GetProperty()->IndependentComponentsOff(); };
  ExpectWarning(together, vectors, "IndependentComponents");
}

/// A picture that is not drawn, and the sentence that says why.
std::string SentenceOf(const Setting& setting)
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  vtkNew<vtkTest::ErrorObserver> errors;
  mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  Check(Covered(Draw(mapper, Field(), setting)) == 0, "nothing is drawn");
  return errors->GetErrorMessage();
}

void ExpectSentence(const Setting& setting, const std::string& part)
{
  const std::string sentence = SentenceOf(setting);
  Check(sentence.find(part) != std::string::npos, "'" + sentence + "' has '" + part + "'");
}

void UnusableOptionsGetASentence()
{
  ExpectSentence(WithMode(vtkVolumeMapper::ADDITIVE_BLEND), "'additive' is not drawn");
  ExpectSentence(WithMode(vtkVolumeMapper::ISOSURFACE_BLEND), "'isosurface' is not drawn");
  ExpectSentence(WithMode(vtkVolumeMapper::SLICE_BLEND), "'slice' is not drawn");
  ExpectSentence(WithMode(77), "of number 77 is not drawn");
  const auto fence = [](vtkVolumeMapper* mapper, vtkVolume* volume)
  {
    Crop(mapper, volume);
    mapper->SetCroppingRegionFlagsToFence();
  };
  ExpectSentence(fence, "SetCroppingRegionFlagsToSubVolume");
  const auto noNormal = [](vtkVolumeMapper* mapper, vtkVolume*) {
    AddPlane(mapper, { 0, 0, 0 }, { 0, 0, 0 });
  };
  ExpectSentence(noNormal, "no normal");
  const auto notFinite = [](vtkVolumeMapper* mapper, vtkVolume*) {
    mapper->AddClippingPlane(vtkNew<vtkPlane>()), AddPlane(mapper, { NAN, 0, 0 }, { 1, 0, 0 });
  };
  ExpectSentence(notFinite, "Clipping plane 1");
  const auto emptyRange = [](vtkVolumeMapper* mapper, vtkVolume*)
  {
    mapper->SetBlendModeToAverageIntensity();
    mapper->SetAverageIPScalarRange(0.7, 0.3);
  };
  ExpectSentence(emptyRange, "range of values to average");
}

} // namespace

int main(int count, char* arguments[])
{
  if (count > 1)
  {
    PictureFolder() = arguments[1];
  }
  PicturesAreVtks();
  LabelsAreVtks();
  GreysAreColours();
  OptionsWithoutEffectGetAWarning();
  UnusableOptionsGetASentence();
  return Failures();
}
