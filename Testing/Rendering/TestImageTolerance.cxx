// SPDX-License-Identifier: BSD-3-Clause
// The tolerance for errors of vtkBanyanVolumeMapper's pictures, still and while somebody interacts.

#include "MapperTesting.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkDataArray.h"

using namespace mapper_testing;

namespace
{

const glm::ivec3 Samples{ 49, 41, 45 };
const double Bounds[6] = { 0, 48, 0, 40, 0, 44 };
const glm::ivec3 ColumnSamples{ 9, 193, 9 };
const glm::ivec3 PlateSamples{ 121, 5, 97 };

double EstimateOf(vtkBanyanVolumeMapper* mapper)
{
  return mapper->GetStatistics()->GetEstimatedImageError();
}

bool Says(vtkBanyanVolumeMapper* mapper, const std::string& words)
{
  return std::string(mapper->GetStatistics()->GetImageErrorLimit()).find(words) !=
         std::string::npos;
}

/// Finding samplings is part of the frame, and none of it where a distance is given.
void CheckTimes(vtkBanyanVolumeMapper* mapper, bool planned)
{
  vtkBanyanFrameStatistics* const frame = mapper->GetStatistics();
  const double planning = frame->GetProbeSeconds() + frame->GetStrideSeconds();
  Check(planned == (frame->GetProbeSeconds() > 0.0), "what probes take is told");
  Check(planned == (frame->GetProbes() > 1), "how many there were is told");
  Check(planning <= frame->GetTotalSeconds(), "planning is part of the frame");
}

/// @param samples of the volume: its proportions decide how many pixels see it
void PicturesStayWithinTheirTolerance(const std::string& path, const glm::ivec3& samples)
{
  const double bounds[6] = { 0, samples.x - 1.0, 0, samples.y - 1.0, 0, samples.z - 1.0 };
  WriteSeries(path, Balls, samples, 1, 0.0);
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  std::string limit;
  for (const bool encoded : { false, true })
  {
    const auto draw = [&](double tolerance, double distance, double& estimate, vtkIdType& taken)
    {
      vtkNew<vtkBanyanVolumeMapper> mapper;
      if (encoded)
      {
        mapper->SetInputConnection(reader->GetOutputPort());
      }
      else
      {
        mapper->SetInputData(PlainImage(Balls, samples));
      }
      mapper->SetImageErrorTolerance(tolerance);
      mapper->SetSampleDistanceVoxels(distance);
      Stage stage(mapper);
      stage.LookAt(bounds);
      const auto picture = stage.Draw();
      estimate = EstimateOf(mapper);
      limit = mapper->GetStatistics()->GetImageErrorLimit();
      CheckTimes(mapper, distance == 0.0);
      taken = mapper->GetStatistics()->GetSamplesTaken();
      return picture;
    };
    double estimate = 0.0;
    vtkIdType taken = 0;
    const auto exact = draw(1.0, 0.05, estimate, taken);
    Check(estimate == 0.0, "nothing is estimated where the sample distance is fixed");
    vtkIdType before = 0;
    for (const double tolerance : { 20.0, 4.0, 1.0 })
    {
      const auto picture = draw(tolerance, 0.0, estimate, taken);
      Check(estimate > 0.0 && estimate <= tolerance, "the estimate is within the tolerance");
      Check(limit.empty(), "nothing keeps it from that: " + limit);
      // Both pictures are rounded to 8 bits, and the exact one's rays end at an opacity of 0.999.
      const double ownErrors = 1.0 + 0.001 * 255.0;
      const double error = Difference(picture, exact);
      Check(error <= estimate + ownErrors,
        "the error is below the estimate: " + std::to_string(error) + " and " +
          std::to_string(estimate) + ", encoded: " + std::to_string(encoded));
      Check(taken > before, "smaller tolerances take more samples");
      before = taken;
    }
  }
}

void FramesThatTakeTooLongGetALargerTolerance()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputData(PlainImage(Balls, Samples));
  mapper->SetInteractiveImageErrorTolerance(2.0);
  mapper->SetInteractiveFrameSeconds(1e-6);
  mapper->SetReuseFrames(false); // the camera does not move
  Stage stage(mapper);
  stage.LookAt(Bounds);
  stage.Draw();
  const double still = EstimateOf(mapper);
  const auto stillPicture = stage.Draw();
  Check(still <= 1.0, "a still frame keeps its tolerance");
  stage.Window->SetDesiredUpdateRate(5.0);
  stage.Draw();
  const double first = EstimateOf(mapper);
  Check(first > still && first <= 2.0, "while interacting there is another tolerance");
  for (int i = 0; i < 10; ++i)
  {
    stage.Draw();
  }
  const double last = EstimateOf(mapper);
  Check(last > 2.0 && last <= 32.0, "it grows while frames take too long, up to 16 times");
  Check(Says(mapper, "Interactive Frame Seconds were exceeded"), "and that is said");
  mapper->SetInteractiveFrameSeconds(1000.0);
  for (int i = 0; i < 6; ++i)
  {
    stage.Draw();
  }
  Check(EstimateOf(mapper) <= 2.0, "and shrinks when they do not");
  stage.Window->SetDesiredUpdateRate(0.0001);
  Check(Difference(stage.Draw(), stillPicture) == 0, "still frames know nothing of all that");
}

/// Larger cells take fewer samples; small ones give the picture of one sample per voxel.
void CellsAreAsLargeAsAllowedOnTheScreen(const std::string& path)
{
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  for (const bool encoded : { false, true })
  {
    const auto draw = [&](double pixels, double distance, vtkIdType& taken)
    {
      vtkNew<vtkBanyanVolumeMapper> mapper;
      if (encoded)
      {
        mapper->SetInputConnection(reader->GetOutputPort());
      }
      else
      {
        mapper->SetInputData(PlainImage(Balls, Samples));
      }
      mapper->SetScreenErrorPixels(pixels);
      mapper->SetSampleDistanceVoxels(distance);
      Stage stage(mapper);
      stage.LookAt(Bounds);
      const auto picture = stage.Draw();
      Check(EstimateOf(mapper) == 0.0, "nothing is estimated where the size of cells decides");
      taken = mapper->GetStatistics()->GetSamplesTaken();
      return picture;
    };
    vtkIdType all = 0;
    vtkIdType some = 0;
    vtkIdType few = 0;
    vtkIdType close = 0;
    const auto exact = draw(0.0, 1.0, all);
    Check(
      Difference(draw(0.01, 0.0, some), exact) == 0, "cells that may not be larger are the finest");
    Check(some == all, "and take a sample each");
    const auto coarse = draw(40.0, 0.0, few);
    // Not eight times fewer: coarse cells leave out less of what is transparent.
    Check(0 < few && few < all, "larger cells take fewer samples: " + std::to_string(few) +
                                  " in place of " + std::to_string(all));
    Check(Difference(coarse, exact) > 0, "and are seen");
    draw(40.0, 1.0, close);
    Check(close > 2 * few, "a fixed distance is kept");
  }
}

void WhatLimitsAnEstimateIsSaid()
{
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputData(PlainImage(Balls, Samples));
  mapper->SetImageErrorTolerance(0.001);
  Stage stage(mapper);
  stage.LookAt(Bounds);
  stage.Draw();
  Check(EstimateOf(mapper) > 0.001, "no sampling keeps such a tolerance");
  Check(Says(mapper, "The finest sampling was reached"), "that is said");
  Check(!Says(mapper, "reaches 1"), "the opacity does not");
  mapper->SetImageErrorTolerance(20.0);
  stage.Draw();
  Check(EstimateOf(mapper) <= 20.0 && Says(mapper, "") &&
          std::string(mapper->GetStatistics()->GetImageErrorLimit()).empty(),
    "a tolerance that is kept needs no words");
  vtkNew<vtkPiecewiseFunction> opaque;
  opaque->AddPoint(0.25, 0.0);
  opaque->AddPoint(0.8, 1.0);
  stage.Volume->GetProperty()->SetScalarOpacity(opaque);
  stage.Draw();
  Check(Says(mapper, "The opacity function reaches 1"), "values that hide everything are told");
  opaque->RemoveAllPoints();
  opaque->AddPoint(0.25, 0.0);
  opaque->AddPoint(5.0, 1.0);
  stage.Draw();
  Check(!Says(mapper, "reaches 1"), "but for those that do not occur");
  mapper->SetSampleDistanceVoxels(1.0);
  stage.Draw();
  Check(std::string(mapper->GetStatistics()->GetImageErrorLimit()).empty(),
    "nothing is estimated where the sample distance is fixed");
}

/// The largest difference of what is decoded to what was written.
void ErrorsOfEncodingAreTold(const TemporaryFolder& folder)
{
  const std::vector<float> values = Sampled(Balls, Samples, 0);
  for (const double bound : { 0.0, 0.001, 0.01 })
  {
    const std::string path = folder / ("bound" + std::to_string(bound) + ".banyan");
    WriteSeries(path, Balls, Samples, 1, bound);
    vtkNew<vtkBanyanSeriesReader> reader;
    reader->SetFileName(path.c_str());
    vtkNew<vtkBanyanVolumeMapper> mapper;
    mapper->SetInputConnection(reader->GetOutputPort());
    Stage stage(mapper);
    stage.LookAt(Bounds);
    stage.Draw();
    const double told = mapper->GetStatistics()->GetEncodingErrorOfValues();
    vtkDataArray* const decoded = reader->GetOutput()->GetPointData()->GetArray("field");
    double largest = 0.0;
    for (vtkIdType i = 0; i < decoded->GetNumberOfTuples(); ++i)
    {
      largest = std::max(
        largest, std::abs(decoded->GetComponent(i, 0) - values[static_cast<std::size_t>(i)]));
    }
    Check(std::abs(told - largest) <= 1e-6 * bound,
      "the largest error of values is told: " + std::to_string(told) + ", " +
        std::to_string(largest));
    Check(told <= bound && (told > 0.5 * bound || bound == 0.0), "it is near the bound");
    mapper->SetInputConnection(nullptr);
    mapper->SetInputData(PlainImage(Balls, Samples));
    stage.Draw();
    Check(mapper->GetStatistics()->GetEncodingErrorOfValues() == 0.0, "plain data have none");
  }
}

} // namespace

int main()
{
  const TemporaryFolder folder;
  PicturesStayWithinTheirTolerance(folder / "series.banyan", Samples);
  PicturesStayWithinTheirTolerance(folder / "column.banyan", ColumnSamples);
  PicturesStayWithinTheirTolerance(folder / "plate.banyan", PlateSamples);
  CellsAreAsLargeAsAllowedOnTheScreen(folder / "series.banyan");
  FramesThatTakeTooLongGetALargerTolerance();
  WhatLimitsAnEstimateIsSaid();
  ErrorsOfEncodingAreTold(folder);
  return Failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
