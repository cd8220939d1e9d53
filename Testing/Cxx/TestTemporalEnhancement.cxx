// SPDX-License-Identifier: BSD-3-Clause
// What moves is brought out at all scales: the filter against the formula, value by value, and what
// it reads.
#include "VtkIoTesting.h"

#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanTemporalEnhancement.h"

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataGroupFilter.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

/// The documented formula, written down once more.
double Expected(
  double strength, double scale, double floor, double before, double now, double after)
{
  double change = 0.0;
  double size = 0.0;
  for (const double other : { before, after })
  {
    if (!std::isnan(other))
    {
      change += std::abs(now - other);
      size += std::abs(now) + std::abs(other) + floor;
    }
  }
  if (size == 0.0)
  {
    return now == 0.0 && strength > 0.0 ? 0.0 : now;
  }
  const double sign = now < 0.0 ? -1.0 : 1.0;
  return sign * std::pow(std::abs(now), 1.0 - strength) *
         std::pow(scale * std::min(4.0 * change / size, 1.0), strength);
}

/// A decaying oscillation whose phase and strength differ from sample to sample.
double Oscillation(vtkIdType sample, double time)
{
  return 100.0 * std::exp(-time - 0.01 * sample) * std::sin(1.3 * time + 0.7 * sample);
}

vtkSmartPointer<TestSource> OscillationSource(int components = 1)
{
  auto source = vtkSmartPointer<TestSource>::New();
  source->Grid = SimpleGrid({ 17, 5, 3 });
  source->Times = { 0.0, 1.0, 2.0, 3.0, 4.0 };
  source->Fill = [components](vtkImageData* image, double time)
  {
    vtkNew<vtkDoubleArray> array;
    array->SetName("motion");
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(image->GetNumberOfPoints());
    for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    {
      for (int c = 0; c < components; ++c)
      {
        array->SetComponent(i, c, Oscillation(i + 31 * c, time));
      }
    }
    image->GetPointData()->SetScalars(array);
  };
  return source;
}

vtkSmartPointer<vtkBanyanTemporalEnhancement> Filter(vtkAlgorithm* source)
{
  auto filter = vtkSmartPointer<vtkBanyanTemporalEnhancement>::New();
  filter->SetInputConnection(source->GetOutputPort());
  return filter;
}

vtkDataArray* EnhancedAt(vtkAlgorithm* filter, double time, const char* name = "motion_enhanced")
{
  filter->UpdateTimeStep(time);
  vtkDataSet* const data = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  return data ? data->GetPointData()->GetArray(name) : nullptr;
}

TEST(TemporalEnhancement, FollowsItsFormulaAtEveryStep)
{
  const auto source = OscillationSource();
  const auto filter = Filter(source);
  filter->SetScale(50.0);
  filter->SetNoiseFloor(0.25);
  for (const double strength : { 0.5, 0.3, 1.0, 0.0 })
  {
    filter->SetStrength(strength);
    for (int step = 0; step < 5; ++step)
    {
      vtkDataArray* const enhanced = EnhancedAt(filter, step);
      ASSERT_TRUE(enhanced);
      for (vtkIdType i = 0; i < enhanced->GetNumberOfTuples(); ++i)
      {
        const double before = step > 0 ? Oscillation(i, step - 1) : NotANumber;
        const double after = step < 4 ? Oscillation(i, step + 1) : NotANumber;
        const double expected = Expected(strength, 50.0, 0.25, before, Oscillation(i, step), after);
        ASSERT_NEAR(enhanced->GetComponent(i, 0), expected, 1e-9) << i << " at " << step;
      }
    }
  }
}

TEST(TemporalEnhancement, ComparesWithTheStepsThatWereChosen)
{
  const auto source = OscillationSource();
  const auto filter = Filter(source);
  filter->SetCompareWith(vtkBanyanTemporalEnhancement::PREVIOUS);
  filter->SetStepDistance(2);
  EXPECT_NEAR(EnhancedAt(filter, 3.0)->GetComponent(7, 0),
    Expected(0.5, 1.0, 0.0, Oscillation(7, 1.0), Oscillation(7, 3.0), NotANumber), 1e-12);
  filter->SetCompareWith(vtkBanyanTemporalEnhancement::NEXT);
  EXPECT_NEAR(EnhancedAt(filter, 1.0)->GetComponent(7, 0),
    Expected(0.5, 1.0, 0.0, NotANumber, Oscillation(7, 1.0), Oscillation(7, 3.0)), 1e-12);
  // There is nothing two steps after the last but one.
  EXPECT_NEAR(EnhancedAt(filter, 3.0)->GetComponent(7, 0), Oscillation(7, 3.0), 1e-12);
}

TEST(TemporalEnhancement, LeavesTheArrayAndTheTimeAsTheyAre)
{
  const auto source = OscillationSource();
  const auto filter = Filter(source);
  EnhancedAt(filter, 2.0);
  vtkImageData* const image = vtkImageData::SafeDownCast(filter->GetOutputDataObject(0));
  EXPECT_EQ(image->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), 2.0);
  vtkDataArray* const motion = image->GetPointData()->GetScalars();
  ASSERT_STREQ(motion->GetName(), "motion");
  EXPECT_EQ(motion->GetComponent(3, 0), Oscillation(3, 2.0));
}

TEST(TemporalEnhancement, ReadsEachStepOnceWhenPlaying)
{
  const auto source = OscillationSource();
  const auto filter = Filter(source);
  EnhancedAt(filter, 1.0);
  EXPECT_EQ(source->Executions, 3);
  EnhancedAt(filter, 2.0);
  EXPECT_EQ(source->Executions, 4);
  EnhancedAt(filter, 3.0);
  EXPECT_EQ(source->Executions, 5);
  filter->SetStrength(0.7); // new parameters read nothing
  EnhancedAt(filter, 3.0);
  EXPECT_EQ(source->Executions, 5);
  source->Modified(); // new data are read anew
  EnhancedAt(filter, 3.0);
  EXPECT_EQ(source->Executions, 8);
}

TEST(TemporalEnhancement, WeakWavesBecomeNearlyAsBrightAsStrongOnes)
{
  const auto source = OscillationSource();
  const auto filter = Filter(source);
  const auto largest = [](vtkDataArray* array)
  {
    double most = 0.0;
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      most = std::max(most, std::abs(array->GetComponent(i, 0)));
    }
    return most;
  };
  // From step 1 to 3 the motion loses a factor of e^2.
  const double early = largest(EnhancedAt(filter, 1.0));
  const double late = largest(EnhancedAt(filter, 3.0));
  EXPECT_NEAR(early / late, std::exp(1.0), 0.5);
}

TEST(TemporalEnhancement, EnhancesTheLengthOfVectors)
{
  const auto source = OscillationSource(3);
  const auto filter = Filter(source);
  vtkDataArray* const enhanced = EnhancedAt(filter, 2.0);
  ASSERT_EQ(enhanced->GetNumberOfComponents(), 3);
  const auto length = [](vtkIdType i, double time) {
    return std::hypot(Oscillation(i, time), Oscillation(i + 31, time), Oscillation(i + 62, time));
  };
  for (vtkIdType i = 0; i < enhanced->GetNumberOfTuples(); ++i)
  {
    const double expected = Expected(0.5, 1.0, 0.0, length(i, 1.0), length(i, 2.0), length(i, 3.0));
    for (int c = 0; c < 3; ++c)
    {
      ASSERT_NEAR(enhanced->GetComponent(i, c),
        Oscillation(i + 31 * c, 2.0) * expected / length(i, 2.0), 1e-9);
    }
  }
}

TEST(TemporalEnhancement, KnowsScaleAndNoiseOfASeries)
{
  TemporaryFolder folder;
  const auto source = OscillationSource();
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  const auto filter = Filter(reader);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "motion");
  vtkDataArray* const enhanced = EnhancedAt(filter, 3.0);
  ASSERT_TRUE(enhanced);
  double low = 0.0;
  double high = 0.0;
  for (const double time : source->Times)
  {
    double range[2];
    ImageAt(source, time)->GetPointData()->GetScalars()->GetRange(range);
    low = std::min(low, range[0]);
    high = std::max(high, range[1]);
  }
  const double most = std::max(high, -low);
  const double bound = (high - low) / 512.0;
  vtkSmartPointer<vtkImageData> steps[3];
  for (int i = 0; i < 3; ++i)
  {
    steps[i] = ImageAt(reader, 2.0 + i);
  }
  for (vtkIdType i = 0; i < enhanced->GetNumberOfTuples(); ++i)
  {
    double from[3];
    for (int step = 0; step < 3; ++step)
    {
      from[step] = steps[step]->GetPointData()->GetArray("motion")->GetComponent(i, 0);
    }
    // The scale is that of decoded values: within the bound.
    const double expected = Expected(0.5, most, bound, from[0], from[1], from[2]);
    ASSERT_NEAR(enhanced->GetComponent(i, 0), expected, 0.005 * std::abs(expected) + 1e-6) << i;
  }
}

TEST(TemporalEnhancement, GoesThroughBlocks)
{
  const auto source = OscillationSource();
  vtkNew<vtkMultiBlockDataGroupFilter> blocks;
  blocks->AddInputConnection(source->GetOutputPort());
  const auto filter = Filter(blocks);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "motion");
  filter->UpdateTimeStep(2.0);
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  ASSERT_TRUE(output);
  vtkDataSet* const block = vtkDataSet::SafeDownCast(output->GetBlock(0));
  ASSERT_TRUE(block && block->GetPointData()->GetArray("motion_enhanced"));
  EXPECT_NEAR(block->GetPointData()->GetArray("motion_enhanced")->GetComponent(4, 0),
    Expected(0.5, 1.0, 0.0, Oscillation(4, 1.0), Oscillation(4, 2.0), Oscillation(4, 3.0)), 1e-9);
}

TEST(TemporalEnhancement, SpecialValuesStay)
{
  auto source = vtkSmartPointer<TestSource>::New();
  source->Grid = SimpleGrid({ 4, 2, 2 });
  source->Times = { 0.0, 1.0, 2.0 };
  source->Fill = [](vtkImageData* image, double time)
  {
    vtkNew<vtkFloatArray> array;
    array->SetName("motion");
    array->SetNumberOfTuples(image->GetNumberOfPoints());
    array->Fill(0.0);
    array->SetValue(1, std::numeric_limits<float>::quiet_NaN());
    array->SetValue(2, std::numeric_limits<float>::infinity());
    array->SetValue(3, time == 1.0 ? 4.0f : std::numeric_limits<float>::quiet_NaN());
    array->SetValue(4, 9.0f); // rests
    image->GetPointData()->SetScalars(array);
  };
  const auto filter = Filter(source);
  vtkDataArray* const enhanced = EnhancedAt(filter, 1.0);
  EXPECT_EQ(enhanced->GetComponent(0, 0), 0.0);
  EXPECT_TRUE(std::isnan(enhanced->GetComponent(1, 0)));
  EXPECT_TRUE(std::isinf(enhanced->GetComponent(2, 0)));
  EXPECT_EQ(enhanced->GetComponent(3, 0), 4.0); // no neighbour is a number
  EXPECT_EQ(enhanced->GetComponent(4, 0), 0.0);
}

TEST(TemporalEnhancement, RefusesDataThatCannotBeCompared)
{
  const auto source = OscillationSource();
  const auto fill = source->Fill;
  const auto filter = Filter(source);
  Messages messages(filter);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "other");
  EnhancedAt(filter, 1.0);
  EXPECT_NE(messages.Errors.find("no array of the chosen name"), std::string::npos);
  EXPECT_EQ(filter->GetErrorCode(), vtkErrorCode::UserError);

  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "motion");
  source->Fill = [fill](vtkImageData* image, double time)
  {
    fill(image, time);
    if (time == 2.0)
    {
      image->GetPointData()->GetScalars()->SetName("gone");
    }
  };
  source->Modified();
  messages.Errors.clear();
  EnhancedAt(filter, 1.0);
  EXPECT_NE(messages.Errors.find("the step after has no point array \"motion\""), std::string::npos)
    << messages.Errors;

  source->Fill = fill;
  source->FailingStep = 2;
  source->Modified();
  Messages upstream(source);
  EnhancedAt(filter, 1.0); // says what the source says
  source->FailingStep = -1;
  source->Modified();
  messages.Errors.clear();
  ASSERT_TRUE(EnhancedAt(filter, 1.0)); // and works again
  EXPECT_EQ(messages.Errors, "");
}

TEST(TemporalEnhancement, DataWithoutTimePassUnchanged)
{
  const auto source = OscillationSource();
  source->Times.clear();
  const auto filter = Filter(source);
  filter->Update();
  vtkImageData* const image = vtkImageData::SafeDownCast(filter->GetOutputDataObject(0));
  vtkDataArray* const enhanced = image->GetPointData()->GetArray("motion_enhanced");
  ASSERT_TRUE(enhanced);
  EXPECT_EQ(
    enhanced->GetComponent(9, 0), image->GetPointData()->GetArray("motion")->GetComponent(9, 0));
}

} // namespace
