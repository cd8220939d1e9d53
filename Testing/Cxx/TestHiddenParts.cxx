// SPDX-License-Identifier: BSD-3-Clause
// Hidden points and cells of images come back from a series as they were, with the values below.
#include "VtkIoTesting.h"

#include "vtkBanyanDeferred.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkStructuredData.h"
#include "vtkUnsignedCharArray.h"

#include "Series/Decode/SeriesFile.h"
#include "Series/Format/IndexText.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

namespace
{

using banyan::ScalarType;

enum class Cells
{
  None,   ///< no flags
  Follow, ///< hidden where a corner is
  Random  ///< hidden or refined, whatever the corners are
};

struct Case
{
  unsigned Seed = 0;
  ScalarType Type = ScalarType::Float32;
  int Components = 1;
  int Late = 0; ///< so many steps hide nothing
  bool Points = true;
  Cells OfCells = Cells::Follow;
  glm::ivec3 Samples{ 1 };

  std::mt19937 Random(double time) const
  {
    return std::mt19937(this->Seed * 97 + static_cast<unsigned>(time * 8));
  }
};

void HidePoints(const Case& one, double time, vtkImageData* image)
{
  std::mt19937 random = one.Random(time);
  std::bernoulli_distribution some(one.Seed % 3 == 0 ? 0.02 : 0.6);
  vtkUnsignedCharArray* const flags = image->AllocatePointGhostArray();
  vtkDataArray* const values = image->GetPointData()->GetScalars();
  const std::size_t bytes =
    static_cast<std::size_t>(values->GetDataTypeSize() * values->GetNumberOfComponents());
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    const bool hidden = time >= one.Late && some(random);
    // Points that neighbours share are none of the series' business.
    flags->SetValue(i, (hidden ? vtkDataSetAttributes::HIDDENPOINT : 0) | (i % 5 == 0 ? 1 : 0));
    auto* const raw = static_cast<unsigned char*>(values->GetVoidPointer(0)) + i * bytes;
    for (std::size_t b = 0; b < bytes && hidden; ++b)
    {
      raw[b] = static_cast<unsigned char>(one.Seed % 2 == 0 ? 0 : random());
    }
  }
}

/// Corners of a cell of an image. (Since VTK 9.3 a cell that is hidden has none.)
vtkSmartPointer<vtkIdList> CornersOf(vtkImageData* image, vtkIdType cell)
{
  auto corners = vtkSmartPointer<vtkIdList>::New();
  int dimensions[3];
  image->GetDimensions(dimensions);
  vtkStructuredData::GetCellPoints(
    cell, corners, vtkStructuredData::GetDataDescription(dimensions), dimensions);
  return corners;
}

void HideCells(const Case& one, double time, vtkImageData* image)
{
  std::mt19937 random = one.Random(time + 100);
  std::bernoulli_distribution some(0.1);
  vtkUnsignedCharArray* const flags = image->AllocateCellGhostArray();
  vtkUnsignedCharArray* const points = image->GetPointGhostArray();
  for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
  {
    bool corner = false;
    const auto corners = CornersOf(image, cell);
    for (vtkIdType c = 0; c < corners->GetNumberOfIds() && points; ++c)
    {
      corner = corner || (points->GetValue(corners->GetId(c)) & 2) != 0;
    }
    const int bit =
      random() % 2 == 0 ? vtkDataSetAttributes::HIDDENCELL : vtkDataSetAttributes::REFINEDCELL;
    const int hidden = time < one.Late                ? 0
                       : one.OfCells == Cells::Follow ? (corner ? 32 : 0)
                       : some(random)                 ? bit
                                                      : 0;
    flags->SetValue(cell, hidden | (cell % 7 == 0 ? 1 : 0));
  }
}

vtkSmartPointer<TestSource> SourceOf(const Case& one)
{
  double scale = 0.0;
  double offset = 0.0;
  GoodRange(one.Type, scale, offset);
  const auto source = WaveSource(OddGrid(one.Samples), { 0.0, 1.0, 2.0 }, one.Type);
  source->Fill = [one, scale, offset](vtkImageData* image, double time)
  {
    image->GetPointData()->SetScalars(
      WaveArray(one.Type, "wave", one.Components, image->GetExtent(), time, scale, offset));
    if (one.Points)
    {
      HidePoints(one, time, image);
    }
    if (one.OfCells != Cells::None)
    {
      HideCells(one, time, image);
    }
  };
  return source;
}

int FlagAt(vtkUnsignedCharArray* flags, vtkIdType i, int bits)
{
  return flags ? flags->GetValue(i) & bits : 0;
}

void ExpectTheSame(const Case& one, vtkImageData* original, vtkImageData* decoded, double bound)
{
  vtkDataArray* const a = original->GetPointData()->GetScalars();
  vtkDataArray* const b = decoded->GetPointData()->GetScalars();
  ASSERT_TRUE(b);
  ASSERT_EQ(b->GetNumberOfTuples(), a->GetNumberOfTuples());
  const int bytes = a->GetDataTypeSize() * a->GetNumberOfComponents();
  const auto* const rawA = static_cast<unsigned char*>(a->GetVoidPointer(0));
  const auto* const rawB = static_cast<unsigned char*>(b->GetVoidPointer(0));
  banyan::ValueRange range;
  for (vtkIdType i = 0; i < original->GetNumberOfPoints(); ++i)
  {
    const int hidden = FlagAt(original->GetPointGhostArray(), i, 2);
    ASSERT_EQ(FlagAt(decoded->GetPointGhostArray(), i, 255), hidden) << "point " << i;
    if (hidden != 0)
    {
      ASSERT_EQ(std::memcmp(rawA + i * bytes, rawB + i * bytes, static_cast<std::size_t>(bytes)), 0)
        << "point " << i;
      continue;
    }
    for (int c = 0; c < a->GetNumberOfComponents(); ++c)
    {
      ASSERT_LE(std::abs(a->GetComponent(i, c) - b->GetComponent(i, c)), bound) << "point " << i;
    }
    range.Include(b->GetComponent(i, 0));
  }
  for (vtkIdType i = 0; i < original->GetNumberOfCells(); ++i)
  {
    ASSERT_EQ(FlagAt(decoded->GetCellGhostArray(), i, 255),
      FlagAt(original->GetCellGhostArray(), i, 32 | 8))
      << "cell " << i;
  }
  double found[2];
  decoded->GetPointData()->GetRange(b->GetName(), found, 0);
  if (!range.Empty() && one.Components == 1)
  {
    EXPECT_EQ(found[0], range.Low);
    EXPECT_EQ(found[1], range.High);
  }
}

/// Whether each hidden cell has a hidden corner.
bool CellsFollow(vtkImageData* image)
{
  bool follow = true;
  for (vtkIdType cell = 0; cell < image->GetNumberOfCells(); ++cell)
  {
    bool corner = false;
    const auto corners = CornersOf(image, cell);
    for (vtkIdType c = 0; c < corners->GetNumberOfIds(); ++c)
    {
      corner = corner || FlagAt(image->GetPointGhostArray(), corners->GetId(c), 2);
    }
    follow = follow && (corner || FlagAt(image->GetCellGhostArray(), cell, 32 | 8) == 0);
  }
  return follow;
}

/// Whether something of an image is hidden.
bool Hides(vtkImageData* image)
{
  bool hides = false;
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    hides = hides || FlagAt(image->GetPointGhostArray(), i, 2) != 0;
  }
  for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i)
  {
    hides = hides || FlagAt(image->GetCellGhostArray(), i, 32 | 8) != 0;
  }
  return hides;
}

void RoundTrip(const Case& one)
{
  double scale = 0.0;
  double offset = 0.0;
  GoodRange(one.Type, scale, offset);
  TemporaryFolder folder;
  const auto source = SourceOf(one);
  const int mode = static_cast<int>(one.Seed % 3);
  WriteSeries(source, folder / "a.banyan",
    [&](vtkBanyanSeriesWriter* writer)
    {
      writer->SetErrorBoundMode(mode == 1 ? vtkBanyanSeriesWriter::ABSOLUTE
                                          : vtkBanyanSeriesWriter::RELATIVE_TO_SERIES_RANGE);
      writer->SetErrorBound(mode == 0 ? 0.0 : mode == 1 ? scale / 100 : 1.0 / 200);
      writer->SetKeyframeInterval(2);
      if (one.Seed % 4 == 1)
      {
        // ParaView's Save Data of one array does so; what is hidden comes along.
        writer->GetPointArraySelection()->EnableArray("wave");
      }
    });
  const bool hides =
    Hides(ImageAt(source, 0.0)) || Hides(ImageAt(source, 1.0)) || Hides(ImageAt(source, 2.0));
  EXPECT_EQ(banyan::FeaturesOf(banyan::SeriesFile::Open(folder / "a.banyan")->Index()).size(),
    hides ? 1u : 0u);
  const auto reader = Reader(folder / "a.banyan");
  for (const double time : { 0.0, 2.0, 1.0 })
  {
    const auto original = ImageAt(source, time);
    reader->UpdateTimeStep(time);
    vtkImageData* const decoded = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
    EXPECT_EQ(reader->GetNumberOfPointArrays(), 1);
    if (const auto* handle = vtkBanyanDeferred::From(decoded->GetPointData()->GetScalars()))
    {
      // Bricks leave out hidden points, and no cell that does not have one.
      EXPECT_EQ(vtkBanyanDeferred::LiesOnSeries(decoded, *handle), CellsFollow(original));
    }
    ExpectTheSame(one, original, decoded, mode == 0 ? 0.0 : scale / 100 * (1 + 1e-9));
  }
}

TEST(HiddenParts, ComeBackAsTheyWere)
{
  for (unsigned seed = 0; seed < 120; ++seed)
  {
    Case one;
    one.Seed = seed;
    one.Type = static_cast<ScalarType>(seed % 10);
    one.Components = seed % 7 == 3 ? 3 : 1;
    one.Late = seed % 5 == 2 ? 1 : 0;
    one.Points = seed % 6 != 5;
    one.OfCells = static_cast<Cells>(seed / 2 % 3);
    std::mt19937 random = one.Random(0);
    const auto edge = [&](int most) { return 1 + static_cast<int>(random() % most); };
    one.Samples = { edge(12), edge(10), edge(9) };
    SCOPED_TRACE("seed " + std::to_string(seed));
    RoundTrip(one);
  }
}

TEST(HiddenParts, OfCoarserLevels)
{
  Case one;
  one.Samples = { 40, 21, 18 };
  one.Seed = 3;
  TemporaryFolder folder;
  const auto source = SourceOf(one);
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  reader->SetLevel(1);
  const auto coarse = ImageAt(reader, 1.0);
  const auto fine = ImageAt(source, 1.0);
  const int* const n = coarse->GetDimensions();
  ASSERT_LT(n[0], 40);
  for (vtkIdType i = 0; i < coarse->GetNumberOfPoints(); ++i)
  {
    const int x = std::min<int>(2 * (i % n[0]), 39);
    const int y = std::min<int>(2 * (i / n[0] % n[1]), 20);
    const int z = std::min<int>(2 * (i / n[0] / n[1]), 17);
    ASSERT_EQ(coarse->GetPointGhostArray()->GetValue(i),
      fine->GetPointGhostArray()->GetValue((z * 21 + y) * 40 + x) & 2);
  }
  for (vtkIdType cell = 0; cell < coarse->GetNumberOfCells(); ++cell)
  {
    bool corner = false;
    const auto corners = CornersOf(coarse, cell);
    for (vtkIdType c = 0; c < 8; ++c)
    {
      corner = corner || coarse->GetPointGhostArray()->GetValue(corners->GetId(c)) != 0;
    }
    ASSERT_TRUE(!corner || coarse->GetCellGhostArray()->GetValue(cell) == 32) << cell;
  }
}

/// Where others hide more than the series, its bricks are no picture of the image.
TEST(HiddenParts, OfOthersAreDrawnFromTheImage)
{
  TemporaryFolder folder;
  const auto source = WaveSource(SimpleGrid({ 9, 9, 9 }), {});
  WriteSeries(source, folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  reader->Update();
  vtkImageData* const image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  EXPECT_EQ(image->GetPointGhostArray(), nullptr);
  EXPECT_EQ(image->GetCellGhostArray(), nullptr);
  const auto* const handle = vtkBanyanDeferred::From(image->GetPointData()->GetScalars());
  ASSERT_TRUE(handle);
  EXPECT_TRUE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
  image->AllocatePointGhostArray()->SetValue(40, vtkDataSetAttributes::DUPLICATEPOINT);
  EXPECT_TRUE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
  image->GetPointGhostArray()->SetValue(41, vtkDataSetAttributes::HIDDENPOINT);
  image->GetPointGhostArray()->Modified();
  EXPECT_FALSE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
  image->GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  EXPECT_TRUE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
  image->AllocateCellGhostArray()->SetValue(7, vtkDataSetAttributes::HIDDENCELL);
  EXPECT_FALSE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
}

/// A series whose flags somebody took away or changed.
TEST(HiddenParts, OfTheSeriesMayBeShownAgain)
{
  Case one;
  one.Samples = { 9, 8, 7 };
  TemporaryFolder folder;
  WriteSeries(SourceOf(one), folder / "a.banyan");
  const auto reader = Reader(folder / "a.banyan");
  reader->Update();
  vtkImageData* const image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  const auto* const handle = vtkBanyanDeferred::From(image->GetPointData()->GetScalars());
  ASSERT_TRUE(handle);
  EXPECT_TRUE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
  image->GetPointGhostArray()->SetValue(0, 0);
  image->GetPointGhostArray()->Modified();
  EXPECT_FALSE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
  image->GetPointData()->RemoveArray(vtkDataSetAttributes::GhostArrayName());
  EXPECT_FALSE(vtkBanyanDeferred::LiesOnSeries(image, *handle));
}

} // namespace
