// SPDX-License-Identifier: BSD-3-Clause
// For whom the reader's arrays decode on first touch, and for whom they are plain: whoever is
// connected, and whenever, gets the right values.
#include "VtkIoTesting.h"

#include "vtkBanyanDecode.h"
#include "vtkBanyanDeferred.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanTemporalEnhancement.h"

#include "vtkArrayDispatch.h"
#include "vtkContourFilter.h"
#include "vtkDataArray.h"
#include "vtkElevationFilter.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkOutputWindow.h"
#include "vtkPointData.h"
#include "vtkStringOutputWindow.h"
#include "vtkTemporalStatistics.h"
#include "vtkUnsignedCharArray.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

namespace
{

using banyan::ScalarType;

vtkDataArray* WaveOf(vtkAlgorithm* producer)
{
  return vtkDataSet::SafeDownCast(producer->GetOutputDataObject(0))
    ->GetPointData()
    ->GetArray("wave");
}

class DeferredConsumers : public testing::Test
{
protected:
  void Make(ScalarType type = ScalarType::Float32, int components = 1,
    const std::vector<double>& times = { 0.0, 1.0, 2.0 }, const glm::ivec3& samples = { 19, 8, 7 })
  {
    this->Times = times;
    this->Source = WaveSource(SimpleGrid(samples), times, type, components);
    WriteSeries(this->Source, this->Folder / "a.banyan");
    this->Read = Reader(this->Folder / "a.banyan");
  }

  /// The reader's values of a step, in plain arrays.
  vtkSmartPointer<vtkDataArray> PlainAt(double time) const
  {
    const auto reader = Reader(this->Folder / "a.banyan");
    reader->DeferDecodingOff();
    return ImageAt(reader, time)->GetPointData()->GetArray("wave");
  }

  void Update(double time = 0.0)
  {
    this->Read->UpdateTimeStep(time);
    this->Array = WaveOf(this->Read);
  }

  TemporaryFolder Folder;
  std::vector<double> Times;
  vtkSmartPointer<TestSource> Source;
  vtkSmartPointer<vtkBanyanSeriesReader> Read;
  vtkDataArray* Array = nullptr;
};

/// The result that vtkTemporalStatistics documents, in double precision and by the definitions.
void ExpectStatistics(vtkDataSet* output, const std::vector<vtkSmartPointer<vtkDataArray>>& steps,
  bool deviation, const std::string& what)
{
  vtkDataArray* const average = output->GetPointData()->GetArray("wave_average");
  vtkDataArray* const lowest = output->GetPointData()->GetArray("wave_minimum");
  vtkDataArray* const highest = output->GetPointData()->GetArray("wave_maximum");
  vtkDataArray* const deviations = output->GetPointData()->GetArray("wave_stddev");
  ASSERT_TRUE(average && lowest && highest && (deviations != nullptr) == deviation) << what;
  const double count = static_cast<double>(steps.size());
  const bool floating =
    steps[0]->GetDataType() == VTK_FLOAT || steps[0]->GetDataType() == VTK_DOUBLE;
  for (vtkIdType tuple = 0; tuple < steps[0]->GetNumberOfTuples(); ++tuple)
  {
    for (int c = 0; c < steps[0]->GetNumberOfComponents(); ++c)
    {
      double sum = 0;
      double squares = 0;
      double low = VTK_DOUBLE_MAX;
      double high = -VTK_DOUBLE_MAX;
      for (const auto& step : steps)
      {
        const double value = step->GetComponent(tuple, c);
        sum += value;
        low = std::min(low, value);
        high = std::max(high, value);
      }
      for (const auto& step : steps)
      {
        squares += std::pow(step->GetComponent(tuple, c) - sum / count, 2);
      }
      const double size = std::max({ 1.0, std::abs(low), std::abs(high) });
      EXPECT_EQ(lowest->GetComponent(tuple, c), low) << what;
      EXPECT_EQ(highest->GetComponent(tuple, c), high) << what;
      ASSERT_NEAR(average->GetComponent(tuple, c), sum / count, floating ? 1e-5 * size : 1.0)
        << what;
      if (deviation && floating)
      {
        ASSERT_NEAR(deviations->GetComponent(tuple, c), std::sqrt(squares / count), 1e-3 * size)
          << what;
      }
    }
  }
}

TEST_F(DeferredConsumers, TemporalStatisticsStraightBehindTheReader)
{
  std::mt19937 random(27);
  const auto upTo = [&random](int highest) { return static_cast<int>(random() % highest) + 1; };
  // VTK adds up in the type of the array: sums of these stay within it.
  const ScalarType types[] = { ScalarType::Float32, ScalarType::Float64, ScalarType::Int64 };
  for (int round = 0; round < 100; ++round)
  {
    if (round % 4 == 0)
    {
      std::vector<double> times{ 0.0, 1.0, 2.5, 3.0 };
      times.resize(static_cast<std::size_t>(1 + upTo(3)));
      const glm::ivec3 samples(1 + upTo(9), upTo(5), upTo(5));
      this->Make(types[upTo(3) - 1], upTo(3), times, samples);
    }
    this->Read = Reader(this->Folder / "a.banyan");
    vtkNew<vtkBanyanDecode> before;
    if (round % 4 < 2)
    {
      // The reader is up to date, with deferred arrays, when the filter comes.
      before->SetInputConnection(this->Read->GetOutputPort());
      this->Update(this->Times.back());
      ASSERT_TRUE(vtkBanyanDeferred::IsDeferred(this->Array));
    }
    vtkNew<vtkTemporalStatistics> statistics;
    statistics->SetComputeStandardDeviation(round % 2);
    statistics->SetInputConnection(this->Read->GetOutputPort());
    statistics->Update();
    std::vector<vtkSmartPointer<vtkDataArray>> steps;
    for (const double time : this->Times)
    {
      steps.push_back(this->PlainAt(time));
    }
    ExpectStatistics(vtkDataSet::SafeDownCast(statistics->GetOutputDataObject(0)), steps,
      round % 2 != 0, "round " + std::to_string(round));
    if (HasFatalFailure())
    {
      return;
    }
  }
}

TEST_F(DeferredConsumers, TemporalStatisticsBehindWhatHandsArraysOn)
{
  this->Make();
  vtkNew<vtkBanyanTemporalEnhancement> enhance; // which leaves arrays alone that it is not told of
  enhance->SetInputConnection(this->Read->GetOutputPort());
  vtkNew<vtkTemporalStatistics> statistics;
  statistics->SetInputConnection(enhance->GetOutputPort());
  statistics->Update();
  this->Array = WaveOf(this->Read);
  EXPECT_FALSE(vtkBanyanDeferred::IsDeferred(this->Array));
}

TEST_F(DeferredConsumers, OnlyThoseWhoReadThemGetDeferredArrays)
{
  this->Make();
  this->Update();
  EXPECT_FALSE(vtkBanyanDeferred::IsDeferred(this->Array)) << "nobody is connected";
  EXPECT_TRUE(vtkFloatArray::SafeDownCast(this->Array));

  vtkNew<vtkBanyanDecode> decode;
  decode->SetInputConnection(this->Read->GetOutputPort());
  this->Update(1.0);
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));

  vtkNew<vtkContourFilter> contour;
  contour->SetInputConnection(this->Read->GetOutputPort());
  this->Update(1.0);
  EXPECT_FALSE(vtkBanyanDeferred::IsDeferred(this->Array)) << "up to date, but not for everybody";
  const vtkMTimeType made = this->Read->GetOutput()->GetUpdateTime();
  this->Update(1.0);
  EXPECT_EQ(this->Read->GetOutput()->GetUpdateTime(), made) << "executes in vain";

  contour->RemoveAllInputConnections(0);
  this->Update(1.0);
  EXPECT_EQ(this->Read->GetOutput()->GetUpdateTime(), made) << "plain is fine for all";
  this->Update(2.0);
  EXPECT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));
}

/// VTK's list of consumers keeps those that were destroyed while they were connected.
TEST_F(DeferredConsumers, DestroyedOnesNeedNothing)
{
  this->Make();
  std::mt19937 random(28);
  auto decode = vtkSmartPointer<vtkBanyanDecode>::New();
  decode->SetInputConnection(this->Read->GetOutputPort());
  std::vector<vtkSmartPointer<vtkContourFilter>> filters;
  for (int round = 0; round < 200; ++round)
  {
    const int action = static_cast<int>(random() % 5);
    if (action == 0)
    {
      filters.emplace_back(vtkSmartPointer<vtkContourFilter>::New());
      filters.back()->SetInputConnection(this->Read->GetOutputPort());
    }
    else if (action == 1 && !filters.empty())
    {
      filters.erase(filters.begin() + static_cast<long>(random() % filters.size()));
    }
    else if (action == 2)
    {
      vtkNew<vtkContourFilter> brief;
      brief->SetInputConnection(this->Read->GetOutputPort());
    }
    else if (action == 3)
    {
      decode = vtkSmartPointer<vtkBanyanDecode>::New();
      decode->SetInputConnection(this->Read->GetOutputPort());
    }
    else
    {
      vtkNew<vtkElevationFilter> elsewhere; // in the same place in memory, perhaps
      elsewhere->Update();
    }
    if (random() % 2 == 0)
    {
      this->Update(this->Times[random() % 3]);
      if (!filters.empty())
      {
        ASSERT_FALSE(vtkBanyanDeferred::IsDeferred(this->Array)) << "round " << round;
      }
    }
  }
}

TEST_F(DeferredConsumers, AfterOthersAreGoneArraysAreDeferredAgain)
{
  this->Make();
  vtkNew<vtkBanyanDecode> decode;
  decode->SetInputConnection(this->Read->GetOutputPort());
  this->Update(0.0);
  {
    vtkNew<vtkContourFilter> neverUpdated;
    neverUpdated->SetInputConnection(this->Read->GetOutputPort());
  }
  this->Update(1.0);
  EXPECT_TRUE(vtkBanyanDeferred::IsDeferred(this->Array));
  {
    vtkNew<vtkContourFilter> contour;
    contour->SetInputConnection(this->Read->GetOutputPort());
    contour->Update();
    this->Update(2.0);
    EXPECT_FALSE(vtkBanyanDeferred::IsDeferred(this->Array));
  }
  this->Update(0.0);
  EXPECT_TRUE(vtkBanyanDeferred::IsDeferred(this->Array));
}

TEST_F(DeferredConsumers, ChainsAreFollowed)
{
  this->Make();
  vtkNew<vtkBanyanTemporalEnhancement> enhance;
  enhance->SetInputConnection(this->Read->GetOutputPort());
  vtkNew<vtkBanyanDecode> decode;
  decode->SetInputConnection(enhance->GetOutputPort());
  this->Update();
  EXPECT_TRUE(vtkBanyanDeferred::IsDeferred(this->Array));
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(decode->GetOutputPort());
  this->Update();
  EXPECT_TRUE(vtkBanyanDeferred::IsDeferred(this->Array)) << "Decode makes them plain";
  elevation->SetInputConnection(enhance->GetOutputPort());
  elevation->Update();
  EXPECT_FALSE(vtkBanyanDeferred::IsDeferred(WaveOf(this->Read)));
}

struct Nothing
{
  template <class T>
  void operator()(T*) const
  {
  }
};

TEST_F(DeferredConsumers, PlainArraysArePlainAndKnowTheirSeries)
{
  for (int type = 0; type < 10; ++type)
  {
    this->Make(static_cast<ScalarType>(type), 1 + type % 3);
    this->Update(1.0);
    const vtkSmartPointer<vtkDataArray> plain = this->PlainAt(1.0);
    EXPECT_EQ(this->Array->GetDataType(), plain->GetDataType());
    EXPECT_TRUE(SameBits(this->Array, plain)) << type;
    EXPECT_TRUE(vtkArrayDispatch::Dispatch::Execute(this->Array, Nothing{})) << type;
    EXPECT_TRUE(this->Array->HasStandardMemoryLayout());
    const vtkBanyanDeferred::Handle* const handle = vtkBanyanDeferred::From(this->Array);
    ASSERT_TRUE(handle);
    EXPECT_EQ(handle->Step, 1);
    EXPECT_TRUE(vtkBanyanDeferred::LiesOnSeries(this->Read->GetOutput(), *handle));
    const vtkSmartPointer<vtkDataArray> stripped = vtkBanyanDeferred::Plain(this->Array);
    EXPECT_EQ(vtkBanyanDeferred::From(stripped), nullptr);
    EXPECT_EQ(stripped->GetVoidPointer(0), this->Array->GetVoidPointer(0));
    EXPECT_STREQ(stripped->GetName(), "wave");
    const auto made = vtkSmartPointer<vtkDataArray>::Take(this->Array->NewInstance());
    made->DeepCopy(this->Array);
    EXPECT_EQ(vtkBanyanDeferred::From(made), nullptr);
    EXPECT_TRUE(SameBits(made, plain)) << type;
  }
}

TEST_F(DeferredConsumers, PlainArraysHaveTheRangesOfDeferredOnes)
{
  this->Make(ScalarType::Float32, 3);
  this->Update(1.0);
  vtkNew<vtkBanyanDecode> decode;
  const auto deferring = Reader(this->Folder / "a.banyan");
  decode->SetInputConnection(deferring->GetOutputPort());
  deferring->UpdateTimeStep(1.0);
  vtkDataArray* const deferred = WaveOf(deferring);
  ASSERT_TRUE(vtkBanyanDeferred::IsDeferred(deferred));
  vtkNew<vtkPointData> decodedData; // which ParaView asks since 5.13
  decodedData->AddArray(this->Array);
  vtkNew<vtkPointData> deferredData;
  deferredData->AddArray(deferred);
  for (int component = -1; component < 3; ++component)
  {
    double ours[2];
    double theirs[2];
    this->Array->GetFiniteRange(ours, component);
    deferred->GetFiniteRange(theirs, component);
    EXPECT_EQ(ours[0], theirs[0]) << component;
    EXPECT_EQ(ours[1], theirs[1]) << component;
    for (vtkPointData* const data : { decodedData.Get(), deferredData.Get() })
    {
      data->GetFiniteRange(this->Array->GetName(), theirs, component);
      EXPECT_EQ(ours[0], theirs[0]) << component;
      EXPECT_EQ(ours[1], theirs[1]) << component;
    }
    this->Array->GetRange(ours, component);
    deferred->GetRange(theirs, component);
    EXPECT_NEAR(ours[0], theirs[0], 1e-5) << component;
    EXPECT_NEAR(ours[1], theirs[1], 1e-5) << component;
  }
}

TEST_F(DeferredConsumers, GhostsAreLeftOutOfRanges)
{
  this->Make();
  this->Update(1.0);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetNumberOfTuples(this->Array->GetNumberOfTuples());
  ghosts->FillValue(vtkDataSetAttributes::HIDDENPOINT);
  ghosts->SetValue(3, 0);
  for (const int component : { 0, -1 })
  {
    double range[2];
    this->Array->GetFiniteRange(range, component, ghosts->GetPointer(0), 0xff);
    EXPECT_EQ(range[0], this->Array->GetComponent(3, 0));
    EXPECT_EQ(range[1], this->Array->GetComponent(3, 0));
  }
}

TEST_F(DeferredConsumers, ChangedArraysForgetTheirSeries)
{
  this->Make();
  this->Update();
  vtkFloatArray::SafeDownCast(this->Array)->SetValue(2, 1000.0f);
  this->Array->Modified();
  EXPECT_EQ(vtkBanyanDeferred::From(this->Array), nullptr);
  double range[2];
  this->Array->GetFiniteRange(range, 0);
  EXPECT_EQ(range[1], 1000.0);
}

/// A program may give the output to filters that nobody knows of.
TEST_F(DeferredConsumers, ValuesOneByOneAreRightAndBringOneWarning)
{
  this->Make();
  vtkNew<vtkBanyanDecode> decode;
  decode->SetInputConnection(this->Read->GetOutputPort());
  const auto right = this->PlainAt(0.0);
  vtkNew<vtkStringOutputWindow> told;
  const vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
  vtkOutputWindow::SetInstance(told);
  this->Update();
  ASSERT_TRUE(vtkBanyanDeferred::IsUntouched(this->Array));
  const auto* const first = static_cast<const float*>(this->Array->GetVoidPointer(0));
  EXPECT_EQ(first[3], right->GetComponent(3, 0));
  EXPECT_EQ(told->GetOutput(), "") << "pointers are what such arrays give to everybody";
  for (const double time : { 1.0, 2.0, 0.0 })
  {
    this->Update(time);
    const auto plain = this->PlainAt(time);
    for (vtkIdType i = 0; i < plain->GetNumberOfTuples(); ++i)
    {
      ASSERT_EQ(this->Array->GetComponent(i, 0), plain->GetComponent(i, 0));
    }
  }
  vtkOutputWindow::SetInstance(before);
  const std::string text = told->GetOutput();
  const std::size_t place = text.find("The values of the array wave of ");
  ASSERT_NE(place, std::string::npos) << text;
  EXPECT_NE(text.find("a.banyan", place), std::string::npos) << text;
  EXPECT_EQ(text.find("The values of the array", place + 1), std::string::npos) << "said twice";
}

} // namespace
