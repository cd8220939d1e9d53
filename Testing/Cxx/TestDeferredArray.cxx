// SPDX-License-Identifier: BSD-3-Clause
// The array that decodes on first touch: what touches it, what does not, and that it gives what a
// plain array gives.
#include "VtkIoTesting.h"

#include "vtkBanyanDecode.h"
#include "vtkBanyanDeferred.h"
#include "vtkBanyanSeriesReader.h"

#include "vtkArrayIterator.h"
#include "vtkDataArray.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkTransform.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"
#include "vtkVersionMacros.h"

#include "Cache/BrickCache.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/SeriesFile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace
{

using banyan::ScalarType;

class DeferredArray : public testing::Test
{
protected:
  void SetUp() override { this->Make(SimpleGrid({ 37, 20, 18 }), ScalarType::Float32, 1); }

  void Make(const banyan::Grid& grid, ScalarType type, int components, double time = 1.0)
  {
    this->Source = WaveSource(grid, { 0.0, 1.0, 2.0 }, type, components);
    WriteSeries(this->Source, this->Folder / "a.banyan");
    this->Read = Reader(this->Folder / "a.banyan");
    this->ReadsDeferred->SetInputConnection(this->Read->GetOutputPort());
    this->Read->UpdateTimeStep(time);
    this->Image = this->Read->GetOutput();
    this->Array = this->Image->GetPointData()->GetScalars();
    const auto plainReader = Reader(this->Folder / "a.banyan");
    plainReader->DeferDecodingOff();
    this->PlainImage = ImageAt(plainReader, time);
    this->Plain = this->PlainImage->GetPointData()->GetScalars();
  }

  std::uint64_t Decoded() const
  {
    return vtkBanyanDeferred::From(this->Array)->Series->BricksDecoded();
  }

  TemporaryFolder Folder;
  vtkSmartPointer<TestSource> Source;
  vtkSmartPointer<vtkBanyanSeriesReader> Read;
  vtkNew<vtkBanyanDecode> ReadsDeferred; ///< connected, so that arrays are deferred
  vtkSmartPointer<vtkImageData> PlainImage;
  vtkImageData* Image = nullptr;
  vtkDataArray* Array = nullptr;
  vtkDataArray* Plain = nullptr;
};

TEST_F(DeferredArray, AnswersQuestionsWithoutDecoding)
{
  EXPECT_EQ(this->Array->GetNumberOfTuples(), 37 * 20 * 18);
  EXPECT_EQ(this->Array->GetDataType(), VTK_FLOAT);
  EXPECT_STREQ(this->Array->GetName(), "wave");
  EXPECT_LE(this->Array->GetActualMemorySize(), 2u);
  double range[2];
  this->Array->GetRange(range, 0);
  this->Array->GetRange(range, -1);
  this->Array->GetFiniteRange(range, 0);
#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 6, 0) // until VTK 9.5; then it looks at each value
  this->Image->GetScalarRange(range);
#endif
  this->Image->GetPointData()->GetRange("wave", range, 0);
  this->Image->GetPointData()->GetFiniteRange("wave", range, 0);
  this->Image->GetActualMemorySize();
  vtkNew<vtkImageData> copy;
  copy->ShallowCopy(this->Image);
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));
  EXPECT_EQ(this->Decoded(), 0u);
  EXPECT_EQ(vtkBanyanDeferred::HeldBytes(), 0u);
}

TEST_F(DeferredArray, DecodesOnceWhenTouched)
{
  EXPECT_EQ(this->Array->GetComponent(5, 0), this->Plain->GetComponent(5, 0));
  const std::uint64_t decoded = this->Decoded();
  EXPECT_GT(
    decoded + banyan::BrickCache::Of(*banyan::CacheContext::Process()).GetStatistics().Hits, 0u);
  EXPECT_FALSE(vtkBanyanDeferred::IsUntouched(this->Array));
  for (vtkIdType i = 0; i < this->Array->GetNumberOfTuples(); ++i)
  {
    ASSERT_EQ(this->Array->GetTuple1(i), this->Plain->GetTuple1(i));
  }
  EXPECT_EQ(this->Decoded(), decoded);
  // Reading leaves the handle: the values are still those of the series.
  EXPECT_NE(vtkBanyanDeferred::From(this->Array), nullptr);
}

TEST_F(DeferredArray, RangesAreTheStepsAndTheSeries)
{
  this->Make(SimpleGrid({ 3, 3, 3 }), ScalarType::Float32, 1, 0.0);
  double step[2];
  double plain[2];
  this->Array->GetRange(step, 0);
  this->Plain->GetRange(plain, 0);
  EXPECT_EQ(step[0], plain[0]);
  EXPECT_EQ(step[1], plain[1]);
  this->Image->GetPointData()->GetRange("wave", step, 0);
  EXPECT_EQ(step[0], plain[0]);
  EXPECT_EQ(step[1], plain[1]);

  double series[2];
  this->Array->GetFiniteRange(series, 0);
  double all[2] = { VTK_DOUBLE_MAX, VTK_DOUBLE_MIN };
  const auto reader = Reader(this->Folder / "a.banyan");
  reader->DeferDecodingOff();
  for (const double time : { 0.0, 1.0, 2.0 })
  {
    ImageAt(reader, time)->GetPointData()->GetScalars()->GetRange(plain, 0);
    all[0] = std::min(all[0], plain[0]);
    all[1] = std::max(all[1], plain[1]);
  }
  EXPECT_EQ(series[0], all[0]);
  EXPECT_EQ(series[1], all[1]);
  EXPECT_TRUE(step[0] != all[0] || step[1] != all[1]) << "the step alone tells nothing";
  // ParaView asks the data set since 5.13.
  this->Image->GetPointData()->GetFiniteRange("wave", series, 0);
  EXPECT_EQ(series[0], all[0]);
  EXPECT_EQ(series[1], all[1]);
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));
}

TEST_F(DeferredArray, RangesOfPiecesContainTheTruthAndBecomeExact)
{
  for (int piece = 0; piece < 4; ++piece)
  {
    this->Read->UpdateTimeStep(1.0, piece, 4, 0);
    this->Array = this->Image->GetPointData()->GetScalars();
    double told[2];
    this->Array->GetRange(told, 0);
    double truth[2] = { VTK_DOUBLE_MAX, VTK_DOUBLE_MIN };
    for (vtkIdType i = 0; i < this->Array->GetNumberOfTuples(); ++i)
    {
      truth[0] = std::min(truth[0], this->Array->GetComponent(i, 0));
      truth[1] = std::max(truth[1], this->Array->GetComponent(i, 0));
    }
    EXPECT_LE(told[0], truth[0]);
    EXPECT_GE(told[1], truth[1]);
    this->Array->GetRange(told, 0);
    EXPECT_EQ(told[0], truth[0]);
    EXPECT_EQ(told[1], truth[1]);
  }
}

TEST_F(DeferredArray, RangesWithGhostsSkipThem)
{
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName("vtkGhostType");
  ghosts->SetNumberOfTuples(this->Array->GetNumberOfTuples());
  for (vtkIdType i = 0; i < ghosts->GetNumberOfTuples(); ++i)
  {
    ghosts->SetValue(i, this->Plain->GetTuple1(i) > 5.0 ? vtkDataSetAttributes::HIDDENPOINT : 0);
  }
  double deferred[2];
  double plain[2];
  this->Image->GetPointData()->AddArray(ghosts);
  this->PlainImage->GetPointData()->AddArray(ghosts);
  this->Image->GetPointData()->GetRange("wave", deferred, 0);
  this->PlainImage->GetPointData()->GetRange("wave", plain, 0);
  EXPECT_EQ(deferred[0], plain[0]);
  EXPECT_EQ(deferred[1], plain[1]);
  EXPECT_LE(deferred[1], 5.0);
}

TEST_F(DeferredArray, VectorRangesAreExactWithoutDecoding)
{
  this->Make(SimpleGrid({ 30, 20, 18 }), ScalarType::Float64, 3);
  for (int component = -1; component < 3; ++component)
  {
    double told[2];
    double plain[2];
    this->Array->GetRange(told, component);
    this->Plain->GetRange(plain, component);
    EXPECT_EQ(told[0], plain[0]);
    EXPECT_EQ(told[1], plain[1]);
  }
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));
  this->Array->GetVoidPointer(0);
  double told[2];
  double plain[2];
  this->Array->GetRange(told, -1);
  this->Plain->GetRange(plain, -1);
  EXPECT_EQ(told[0], plain[0]);
  EXPECT_EQ(told[1], plain[1]);
}

TEST_F(DeferredArray, EveryWayInGivesTheSameValues)
{
  const vtkIdType tuples = this->Array->GetNumberOfTuples();
  vtkNew<vtkFloatArray> deep;
  deep->DeepCopy(this->Array);
  EXPECT_TRUE(SameBits(deep, this->Plain));

  std::vector<float> exported(tuples);
  this->Array->ExportToVoidPointer(exported.data());
  EXPECT_EQ(std::memcmp(exported.data(), this->Plain->GetVoidPointer(0), tuples * 4), 0);

  vtkNew<vtkIdList> ids;
  ids->InsertNextId(7);
  ids->InsertNextId(tuples - 1);
  vtkNew<vtkFloatArray> some;
  some->SetNumberOfTuples(2);
  this->Array->GetTuples(ids, some);
  EXPECT_EQ(some->GetValue(0), this->Plain->GetTuple1(7));
  EXPECT_EQ(some->GetValue(1), this->Plain->GetTuple1(tuples - 1));
  some->InsertTuples(0, 2, 100, this->Array);
  EXPECT_EQ(some->GetValue(1), this->Plain->GetTuple1(101));

  EXPECT_EQ(this->Array->GetVariantValue(9).ToFloat(), this->Plain->GetTuple1(9));
  const auto iterator = vtkSmartPointer<vtkArrayIterator>::Take(this->Array->NewIterator());
  ASSERT_TRUE(iterator);
  EXPECT_EQ(static_cast<float*>(this->Array->GetVoidPointer(3))[0], this->Plain->GetTuple1(3));
  EXPECT_EQ(this->Array->GetMaxNorm(), this->Plain->GetMaxNorm());
  EXPECT_EQ(this->Array->LookupValue(this->Plain->GetTuple1(11)),
    this->Plain->LookupValue(this->Plain->GetTuple1(11)));
}

TEST_F(DeferredArray, NewInstancesArePlain)
{
  const auto made = vtkSmartPointer<vtkDataArray>::Take(this->Array->NewInstance());
  EXPECT_TRUE(made->IsA("vtkFloatArray"));
  EXPECT_EQ(vtkFloatArray::SafeDownCast(this->Array), nullptr);
  EXPECT_EQ(vtkArrayDownCast<vtkFloatArray>(this->Array), nullptr);
  EXPECT_FALSE(this->Array->HasStandardMemoryLayout()) << "VTK would cast it to a plain array";
}

TEST_F(DeferredArray, WritingEndsTheHandle)
{
  this->Array->SetComponent(4, 0, 1234.0);
  EXPECT_EQ(vtkBanyanDeferred::From(this->Array), nullptr);
  EXPECT_EQ(this->Array->GetComponent(4, 0), 1234.0);
  EXPECT_EQ(this->Array->GetComponent(5, 0), this->Plain->GetComponent(5, 0));
  double range[2];
  this->Array->GetRange(range, 0);
  EXPECT_EQ(range[1], 1234.0);
  this->Array->SetComponent(4, 0, 2345.0);
  this->Array->Modified();
  this->Array->GetFiniteRange(range, 0);
  EXPECT_EQ(range[1], 2345.0);
}

TEST_F(DeferredArray, WritingThroughAPointerEndsTheHandleWhenItIsSaid)
{
  static_cast<float*>(this->Array->GetVoidPointer(0))[2] = 77.0f;
  this->Array->Modified();
  EXPECT_EQ(vtkBanyanDeferred::From(this->Array), nullptr);
  double range[2];
  this->Array->GetRange(range, 0);
  EXPECT_EQ(range[1], 77.0);
}

TEST_F(DeferredArray, ResizingKeepsValues)
{
  const vtkIdType tuples = this->Array->GetNumberOfTuples();
  this->Array->InsertNextTuple1(3.5);
  EXPECT_EQ(this->Array->GetNumberOfTuples(), tuples + 1);
  EXPECT_EQ(this->Array->GetTuple1(tuples), 3.5);
  EXPECT_EQ(this->Array->GetTuple1(tuples - 1), this->Plain->GetTuple1(tuples - 1));
  this->Array->Initialize();
  EXPECT_EQ(this->Array->GetNumberOfTuples(), 0);
  EXPECT_EQ(vtkBanyanDeferred::From(this->Array), nullptr);
}

TEST_F(DeferredArray, LetsValuesGoAndDecodesAgain)
{
  const double value = this->Array->GetComponent(100, 0);
  EXPECT_EQ(vtkBanyanDeferred::HeldBytes(), 37u * 20 * 18 * 4);
  EXPECT_GT(this->Array->GetActualMemorySize(), 50u);
  vtkBanyanDeferred::ReleaseBeyondBudgets();
  EXPECT_FALSE(vtkBanyanDeferred::IsUntouched(this->Array)) << "there was room";
  // A reader that keeps nothing lets go of its own arrays only.
  const auto other = Reader(this->Folder / "a.banyan");
  other->SetCacheBudget(0);
  vtkNew<vtkBanyanDecode> readsDeferred;
  readsDeferred->SetInputConnection(other->GetOutputPort());
  other->UpdateTimeStep(1.0);
  vtkDataArray* const array = other->GetOutput()->GetPointData()->GetScalars();
  EXPECT_EQ(array->GetComponent(100, 0), value);
  vtkBanyanDeferred::ReleaseBeyondBudgets();
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(array));
  EXPECT_FALSE(vtkBanyanDeferred::IsUntouched(this->Array));
  EXPECT_EQ(array->GetComponent(100, 0), value);
  array->Squeeze();
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(array));
  this->Array->Squeeze();
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));
  EXPECT_EQ(vtkBanyanDeferred::HeldBytes(), 0u);
  EXPECT_EQ(this->Array->GetComponent(100, 0), value);
  this->Array->Squeeze();
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));
  // Whoever has a pointer may use it as long as the array lives.
  const float* pointer = static_cast<float*>(array->GetVoidPointer(0));
  vtkBanyanDeferred::ReleaseBeyondBudgets();
  EXPECT_EQ(pointer[100], value);
  EXPECT_FALSE(vtkBanyanDeferred::IsUntouched(array));
}

TEST_F(DeferredArray, HandleSaysWhereTheValuesAre)
{
  this->Make(OddGrid({ 37, 20, 18 }), ScalarType::Float32, 1);
  this->Read->SetLevel(1);
  this->Read->UpdateTimeStep(2.0, 1, 3, 0);
  this->Array = this->Image->GetPointData()->GetScalars();
  const vtkBanyanDeferred::Handle* handle = vtkBanyanDeferred::From(this->Array);
  ASSERT_TRUE(handle);
  EXPECT_EQ(handle->Step, 2);
  EXPECT_EQ(handle->Level, 1);
  EXPECT_EQ(handle->Samples.Count(), this->Image->GetNumberOfPoints());
  EXPECT_TRUE(vtkBanyanDeferred::LiesOnSeries(this->Image, *handle));
  vtkNew<vtkImageData> moved;
  moved->ShallowCopy(this->Image);
  moved->SetOrigin(0.0, 1.0, 2.0);
  EXPECT_FALSE(vtkBanyanDeferred::LiesOnSeries(moved, *handle));
  moved->ShallowCopy(this->Image);
  moved->SetSpacing(1.0, 1.0, 1.0);
  EXPECT_FALSE(vtkBanyanDeferred::LiesOnSeries(moved, *handle));
  moved->ShallowCopy(this->Image);
  moved->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  EXPECT_FALSE(vtkBanyanDeferred::LiesOnSeries(moved, *handle));
}

TEST_F(DeferredArray, DecodeMakesItPlain)
{
  vtkNew<vtkBanyanDecode> decode;
  decode->SetInputConnection(this->Read->GetOutputPort());
  decode->UpdateTimeStep(1.0);
  auto* image = vtkImageData::SafeDownCast(decode->GetOutputDataObject(0));
  vtkDataArray* array = image->GetPointData()->GetScalars();
  ASSERT_TRUE(array);
  EXPECT_STREQ(array->GetName(), "wave");
  EXPECT_TRUE(SameBits(array, this->Plain));
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Read->GetOutput()->GetPointData()->GetScalars()))
    << "decoded straight into the plain array";
  double range[2];
  double plain[2];
  array->GetFiniteRange(range, 0);
  this->Plain->GetFiniteRange(plain, 0);
  EXPECT_EQ(range[0], plain[0]);
  EXPECT_EQ(range[1], plain[1]);
}

TEST_F(DeferredArray, EveryTypeIsDeferred)
{
  for (int type = 0; type < 10; ++type)
  {
    this->Make(SimpleGrid({ 18, 7, 5 }), static_cast<ScalarType>(type), 2);
    EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array)) << type;
    EXPECT_EQ(LargestDifference(this->Array, this->Plain), 0.0) << type;
    EXPECT_TRUE(SameBits(this->Array, this->Plain)) << type;
  }
}

TEST_F(DeferredArray, NaNDoesNotCountInRanges)
{
  const auto fill = this->Source->Fill;
  this->Source->Fill = [fill](vtkImageData* image, double time)
  {
    fill(image, time);
    auto* values = static_cast<float*>(image->GetPointData()->GetScalars()->GetVoidPointer(0));
    std::fill_n(values, image->GetNumberOfPoints() / 2, std::nanf(""));
  };
  this->Source->Modified();
  WriteSeries(this->Source, this->Folder / "nan.banyan");
  const auto reader = Reader(this->Folder / "nan.banyan");
  this->ReadsDeferred->SetInputConnection(reader->GetOutputPort());
  reader->UpdateTimeStep(1.0);
  vtkDataArray* array = reader->GetOutput()->GetPointData()->GetScalars();
  double told[2];
  array->GetRange(told, 0);
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(array));
  double truth[2];
  vtkBanyanDeferred::Plain(array)->GetRange(truth, 0);
  EXPECT_EQ(told[0], truth[0]);
  EXPECT_EQ(told[1], truth[1]);
}

TEST_F(DeferredArray, NothingButNaNGivesVtksEmptyRange)
{
  this->Source->Fill = [](vtkImageData* image, double)
  {
    vtkNew<vtkFloatArray> array;
    array->SetName("wave");
    array->SetNumberOfTuples(image->GetNumberOfPoints());
    array->FillValue(std::nanf(""));
    image->GetPointData()->SetScalars(array);
  };
  this->Source->Modified();
  WriteSeries(this->Source, this->Folder / "nan.banyan");
  const auto reader = Reader(this->Folder / "nan.banyan");
  this->ReadsDeferred->SetInputConnection(reader->GetOutputPort());
  reader->UpdateTimeStep(1.0);
  vtkDataArray* array = reader->GetOutput()->GetPointData()->GetScalars();
  for (int touched = 0; touched < 2; ++touched)
  {
    double range[2];
    array->GetRange(range, 0);
    EXPECT_GT(range[0], range[1]);
    EXPECT_TRUE(std::isnan(touched ? array->GetComponent(0, 0) : std::nan("")));
  }
}

} // namespace
