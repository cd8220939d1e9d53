// SPDX-License-Identifier: BSD-3-Clause
// Values between two steps: as the reader gives them, and as they are drawn.
#include "VtkIoTesting.h"

#include "Fields/FieldPiece.h"
#include "Fields/InputOfPiece.h"
#include "vtkBanyanDecode.h"
#include "vtkBanyanDeferred.h"
#include "vtkBanyanSeriesReader.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Fields/DistributedField.h"
#include "Render/Bricks/SampledBox.h"
#include "Series/Decode/SeriesFile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using banyan::ScalarType;

/// Waves as scalars, vectors and labels; points may be hidden, at each time others.
class Interpolation : public testing::TestWithParam<bool>
{
protected:
  Interpolation()
  {
    this->Source = vtkSmartPointer<TestSource>::New();
    this->Source->Grid = OddGrid({ 41, 23, 19 });
    this->Source->Times = { 0.0, 0.5, 2.0 };
    this->Source->Fill = [](vtkImageData* image, double time)
    {
      const int* const e = image->GetExtent();
      const auto add = [&](ScalarType type, const char* name, int components, double scale)
      { image->GetPointData()->AddArray(WaveArray(type, name, components, e, time, scale, 0.0)); };
      add(ScalarType::Float32, "wave", 1, 1.0);
      add(ScalarType::Float64, "wind", 3, 7.0);
      add(ScalarType::Int16, "label", 1, 20.0);
      image->GetPointData()->SetActiveScalars("wave");
      if (GetParam())
      {
        vtkUnsignedCharArray* const flags = image->AllocatePointGhostArray();
        for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
        {
          const bool hidden = i % 97 == static_cast<vtkIdType>(4 * time);
          flags->SetValue(i, hidden ? vtkDataSetAttributes::HIDDENPOINT : 0);
        }
      }
    };
    WriteSeries(this->Source, this->Path());
    this->Read = this->NewReader();
  }

  std::string Path() const { return this->Folder / "a.banyan"; }
  vtkSmartPointer<vtkBanyanSeriesReader> NewReader() const
  {
    const auto reader = Reader(this->Path());
    reader->SetInterpolateInTime(true);
    return reader;
  }

  TemporaryFolder Folder;
  vtkSmartPointer<TestSource> Source;
  vtkSmartPointer<vtkBanyanSeriesReader> Read;
};

vtkDataArray* ArrayOf(vtkImageData* image, const char* name)
{
  return image->GetPointData()->GetArray(name);
}

double TimeOf(vtkAlgorithm* algorithm)
{
  return algorithm->GetOutputDataObject(0)->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP());
}

TEST_P(Interpolation, StepsAndTimesBeyondThemAreAsWithout)
{
  const auto plain = Reader(this->Path());
  for (const double time : { -3.0, 0.0, 0.5, 2.0, 99.0 })
  {
    const auto expected = ImageAt(plain, time);
    const auto found = ImageAt(this->Read, time);
    EXPECT_EQ(TimeOf(this->Read), TimeOf(plain));
    for (const char* name : { "wave", "wind", "label" })
    {
      EXPECT_TRUE(SameBits(ArrayOf(found, name), ArrayOf(expected, name))) << name << " " << time;
    }
  }
}

/// The slow, obvious way: from the steps' own values.
TEST_P(Interpolation, ValuesLieBetweenThoseOfTheSteps)
{
  const auto plain = Reader(this->Path());
  const auto earlier = ImageAt(plain, 0.5);
  const auto later = ImageAt(plain, 2.0);
  for (const double time : { 0.6, 1.25, 1.9 })
  {
    const double f = (time - 0.5) / 1.5;
    const auto found = ImageAt(this->Read, time);
    EXPECT_EQ(TimeOf(this->Read), time);
    for (const char* name : { "wave", "wind" })
    {
      vtkDataArray* const a = ArrayOf(earlier, name);
      vtkDataArray* const b = ArrayOf(later, name);
      vtkDataArray* const c = ArrayOf(found, name);
      ASSERT_EQ(c->GetDataType(), a->GetDataType());
      const double room = std::string(name) == "wave" ? 1e-7 : 1e-14;
      for (vtkIdType i = 0; i < a->GetNumberOfTuples(); ++i)
      {
        for (int component = 0; component < a->GetNumberOfComponents(); ++component)
        {
          const double expected =
            (1.0 - f) * a->GetComponent(i, component) + f * b->GetComponent(i, component);
          ASSERT_NEAR(c->GetComponent(i, component), expected, room) << name;
        }
      }
    }
    EXPECT_GT(LargestDifference(ArrayOf(found, "wave"), ArrayOf(earlier, "wave")), 0.01);
    EXPECT_GT(LargestDifference(ArrayOf(found, "wave"), ArrayOf(later, "wave")), 0.01);
  }
  EXPECT_TRUE(SameBits(ArrayOf(ImageAt(plain, 1.9), "wave"), ArrayOf(earlier, "wave")))
    << "off: the step before";
}

TEST_P(Interpolation, LabelsStayAndAWarningSaysSoOnce)
{
  Messages messages(this->Read);
  (void)ImageAt(this->Read, 0.5);
  EXPECT_EQ(messages.Warnings, "");
  const auto earlier = ImageAt(Reader(this->Path()), 0.5);
  EXPECT_TRUE(SameBits(ArrayOf(ImageAt(this->Read, 1.9), "label"), ArrayOf(earlier, "label")));
  EXPECT_NE(messages.Warnings.find("may be labels: label of " + this->Path()), std::string::npos)
    << messages.Warnings;
  messages.Warnings.clear();
  (void)ImageAt(this->Read, 1.0);
  EXPECT_EQ(messages.Warnings, "");
  this->Read->SetPointArrayStatus("label", 0);
  this->Read->Refresh();
  (void)ImageAt(this->Read, 1.1);
  EXPECT_EQ(messages.Warnings, "");
}

TEST_P(Interpolation, WhatAStepHidesIsHidden)
{
  const auto plain = Reader(this->Path());
  const auto flags = [](vtkImageData* image) { return image->GetPointGhostArray(); };
  const auto earlier = ImageAt(plain, 0.0);
  const auto later = ImageAt(plain, 0.5);
  const auto between = ImageAt(this->Read, 0.2);
  ASSERT_EQ(flags(between) != nullptr, GetParam());
  vtkIdType hidden = 0;
  for (vtkIdType i = 0; GetParam() && i < between->GetNumberOfPoints(); ++i)
  {
    ASSERT_EQ(flags(between)->GetValue(i), flags(earlier)->GetValue(i) | flags(later)->GetValue(i));
    hidden += flags(between)->GetValue(i) != 0;
  }
  EXPECT_EQ(hidden > 0, GetParam());
}

/// Values of arrays that decode on first touch are those of plain ones, and in the range that is
/// told before.
TEST_P(Interpolation, DeferredArraysAreThePlainOnes)
{
  const auto plain = ImageAt(this->Read, 1.0);
  const auto reader = this->NewReader();
  vtkNew<vtkBanyanDecode> readsDeferred; // connected, so that nothing is decoded yet
  readsDeferred->SetInputConnection(reader->GetOutputPort());
  reader->UpdateTimeStep(1.0);
  auto* const image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  for (const char* name : { "wave", "wind", "label" })
  {
    vtkDataArray* const array = ArrayOf(image, name);
    const bool deferred = !GetParam() || std::string(name) != "label";
    ASSERT_EQ(vtkBanyanDeferred::IsUntouched(array), deferred) << name;
    double told[2];
    array->GetRange(told, -1);
    double exact[2];
    ArrayOf(plain, name)->GetRange(exact, -1);
    if (!GetParam())
    {
      EXPECT_LE(told[0], exact[0]) << name;
      EXPECT_GE(told[1], exact[1]) << name;
    }
    EXPECT_TRUE(SameBits(array, ArrayOf(plain, name))) << name;
  }
}

/// The bricks that are drawn, of an array and component, against the reader's plain output.
void ExpectDrawn(vtkImageData* lazy, vtkImageData* plain, const char* name, int component)
{
  banyan::FieldPiece piece;
  piece.Image = lazy;
  piece.Array = ArrayOf(lazy, name);
  piece.ArrayName = name;
  piece.Component = component;
  banyan::InputOfPiece input(piece);
  const auto alone = banyan::MakeSelfCommunicator();
  banyan::DistributedField field;
  field.Update(*alone, input);
  ASSERT_EQ(field.Problem(), "");
  ASSERT_TRUE(field.Drawn().IsEncoded());
  banyan::BrickSource& source = *field.Drawn().Source();
  vtkDataArray* const values = ArrayOf(plain, name);
  vtkUnsignedCharArray* const flags = plain->GetPointGhostArray();
  const int* const n = plain->GetDimensions();
  const glm::ivec3 counts = source.Bricks();
  for (std::int64_t b = 0; b < std::int64_t{ counts.x } * counts.y * counts.z; ++b)
  {
    const banyan::Box cells = source.CellsOf(b);
    const banyan::Box samples{ cells.Lo, cells.Hi + 1 };
    std::vector<double> found(static_cast<std::size_t>(samples.Count()));
    banyan::CopySamples({ source.Load(b), samples }, samples, ScalarType::Float64, found.data());
    std::size_t i = 0;
    for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
    {
      for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
      {
        for (int x = samples.Lo.x; x < samples.Hi.x; ++x, ++i)
        {
          const vtkIdType at = x + static_cast<vtkIdType>(n[0]) * (y + vtkIdType{ n[1] } * z);
          if (flags && flags->GetValue(at) != 0)
          {
            ASSERT_TRUE(std::isnan(found[i])) << "hidden";
            continue;
          }
          double expected = values->GetComponent(at, std::max(component, 0));
          for (int c = 1; component < 0 && c < values->GetNumberOfComponents(); ++c)
          {
            expected = std::hypot(expected, values->GetComponent(at, c));
          }
          ASSERT_NEAR(
            found[i], component < 0 ? std::abs(expected) : expected, component < 0 ? 1e-5 : 0.0);
          ASSERT_LE(source.RangeOf(b).Low, found[i] + 1e-6);
          ASSERT_GE(source.RangeOf(b).High, found[i] - 1e-6);
        }
      }
    }
  }
}

TEST_P(Interpolation, DrawnBricksAreThePlainOutput)
{
  const auto reader = this->NewReader();
  vtkNew<vtkBanyanDecode> readsDeferred;
  readsDeferred->SetInputConnection(reader->GetOutputPort());
  for (const double time : { 0.1, 0.5, 1.25 })
  {
    const auto plain = ImageAt(this->Read, time);
    reader->UpdateTimeStep(time);
    auto* const image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
    ExpectDrawn(image, plain, "wave", 0);
    ExpectDrawn(image, plain, "wind", 2);
    ExpectDrawn(image, plain, "wind", -1);
  }
}

/// Enhancement compares steps: between them it is refused, and never drawn from one step.
TEST_P(Interpolation, IsNotEnhanced)
{
  const auto reader = this->NewReader();
  vtkNew<vtkBanyanDecode> readsDeferred;
  readsDeferred->SetInputConnection(reader->GetOutputPort());
  for (const double time : { 1.0, 0.5 })
  {
    reader->UpdateTimeStep(time);
    banyan::FieldPiece piece;
    piece.Image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
    piece.Array = ArrayOf(piece.Image, "wave");
    piece.ArrayName = "wave";
    piece.Enhancement = { 0.5, 1.0, 0.0 };
    banyan::InputOfPiece input(piece);
    const auto alone = banyan::MakeSelfCommunicator();
    banyan::DistributedField field;
    field.Update(*alone, input);
    EXPECT_EQ(field.Problem().find("lie between two") != std::string::npos, time == 1.0)
      << field.Problem();
  }
}

INSTANTIATE_TEST_SUITE_P(PointsHidden, Interpolation, testing::Bool());

} // namespace
