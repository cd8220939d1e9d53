// SPDX-License-Identifier: BSD-3-Clause
// What cannot be written is refused with a sentence that says why and where, and leaves nothing.
#include "WriterRobustness.h"

#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanSeriesWriter.h"

#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkDataArraySelection.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkMetaImageReader.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkOutputWindow.h"
#include "vtkPointData.h"
#include "vtkSphereSource.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStringArray.h"
#include "vtkTrivialProducer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkXMLImageDataReader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

namespace
{

using banyan::ScalarType;

INSTANTIATE_TEST_SUITE_P(Modes, WriterRobustness, testing::Values(0, 1),
  [](const auto& info) { return info.param ? "Absolute" : "Relative"; });

TEST_P(WriterRobustness, DimensionsChange)
{
  this->ExpectRefused(this->SourceThatChanges(
                        [](vtkImageData* image)
                        {
                          image->Initialize();
                          image->SetDimensions(12, 11, 9);
                          image->GetPointData()->SetScalars(
                            WaveArray(ScalarType::Float32, "wave", 1, image->GetExtent(), 0, 1, 0));
                        }),
    { "step 2 (time 1.5)", "extent was 0..11 x 0..10 x 0..9 and is 0..11 x 0..10 x 0..8" });
}

TEST_P(WriterRobustness, SpacingChanges)
{
  this->ExpectRefused(
    this->SourceThatChanges([](vtkImageData* image) { image->SetSpacing(1, 1, 2); }),
    { "step 2 (time 1.5)", "spacing was (1, 1, 1) and is (1, 1, 2)" });
}

TEST_P(WriterRobustness, OriginChanges)
{
  this->ExpectRefused(
    this->SourceThatChanges([](vtkImageData* image) { image->SetOrigin(0, 0.5, 0); }),
    { "step 2 (time 1.5)", "origin" });
}

TEST_P(WriterRobustness, DirectionChanges)
{
  this->ExpectRefused(this->SourceThatChanges([](vtkImageData* image)
                        { image->SetDirectionMatrix(0, 1, 0, 1, 0, 0, 0, 0, 1); }),
    { "step 2 (time 1.5)", "direction" });
}

TEST_P(WriterRobustness, TypeChanges)
{
  this->ExpectRefused(this->SourceThatChanges(
                        [](vtkImageData* image)
                        {
                          image->GetPointData()->SetScalars(
                            WaveArray(ScalarType::UInt8, "wave", 1, image->GetExtent(), 0, 1, 1));
                        }),
    { "step 2 (time 1.5)", "the array wave was float32 and is uint8" });
}

TEST_P(WriterRobustness, ComponentsChange)
{
  this->ExpectRefused(this->SourceThatChanges(
                        [](vtkImageData* image)
                        {
                          image->GetPointData()->SetScalars(
                            WaveArray(ScalarType::Float32, "wave", 2, image->GetExtent(), 0, 1, 1));
                        }),
    { "step 2 (time 1.5)", "wave had 1 component(s) and has 2" });
}

TEST_P(WriterRobustness, ArrayIsRenamed)
{
  this->ExpectRefused(this->SourceThatChanges([](vtkImageData* image)
                        { image->GetPointData()->GetScalars()->SetName("other"); }),
    { "step 2 (time 1.5)", "the point array wave is missing" });
}

TEST_P(WriterRobustness, ArrayAppears)
{
  this->ExpectRefused(this->SourceThatChanges(
                        [](vtkImageData* image)
                        {
                          image->GetPointData()->AddArray(
                            WaveArray(ScalarType::Float32, "new", 1, image->GetExtent(), 0, 1, 1));
                        }),
    { "step 2 (time 1.5)", "new point array new" });
}

TEST_P(WriterRobustness, InputFailsMidway)
{
  const auto source = this->SourceThatChanges([](vtkImageData*) {});
  source->FailingStep = 2;
  this->ExpectRefused(source, { "step 2 (time 1.5)", "cannot be read" });
}

/// All that scripts write to their standard error comes to the output window, piece by piece.
TEST_P(WriterRobustness, ExceptionsOfScriptsAreErrorsAndWarningsAreNot)
{
  const auto saying = [this](const std::vector<const char*>& pieces)
  {
    return this->SourceThatChanges(
      [pieces](vtkImageData*)
      {
        for (const char* const piece : pieces)
        {
          vtkOutputWindowDisplayErrorText(piece);
        }
      });
  };
  this->ExpectRefused(
    saying({ "Traceback (most recent call last):\n", "  File \"script\", line 2, in <module>\n",
      "    raise ValueError('no such wind')\n", "ValueError: ", "no such wind\n" }),
    { "step 2 (time 1.5)", "cannot be read: ValueError: no such wind" });
  this->ExpectRefused(saying({ "  File \"script\", line 1\n", "SyntaxError: invalid syntax\n" }),
    { "step 2 (time 1.5)", "SyntaxError: invalid syntax" });
  WriteSeries(saying({ "script:2: RuntimeWarning: divide by zero encountered in log\n",
                "  return numpy.log(w)\n", ".", "step done\n" }),
    this->Folder / "warned.banyan");
}

TEST_P(WriterRobustness, TimesAreNumbers)
{
  for (const double time : { std::nan(""), HUGE_VAL })
  {
    const auto source = WaveSource(SimpleGrid({ 7, 7, 7 }), { 0.0, 1.0, time });
    this->ExpectRefused(source, { "step 2", "no time" });
  }
}

TEST_P(WriterRobustness, AnOlderSeriesStays)
{
  const auto good = WaveSource(SimpleGrid({ 7, 7, 7 }), { 0.0, 1.0 });
  WriteSeries(good, this->Folder / "a.banyan");
  const auto before = this->Folder.Entries();
  this->Refuse(this->SourceThatChanges([](vtkImageData* image) { image->SetSpacing(1, 1, 2); }),
    { "spacing" });
  EXPECT_EQ(this->Folder.Entries(), before);
  const auto original = ImageAt(good, 1.0);
  const auto decoded = ImageAt(Reader(this->Folder / "a.banyan"), 1.0);
  EXPECT_LE(LargestDifference(
              original->GetPointData()->GetScalars(), decoded->GetPointData()->GetScalars()),
    20.0 / 512.0);
}

vtkSmartPointer<vtkTrivialProducer> Produce(vtkDataObject* data)
{
  auto producer = vtkSmartPointer<vtkTrivialProducer>::New();
  producer->SetOutput(data);
  return producer;
}

vtkSmartPointer<vtkImageData> Image()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(4, 4, 4);
  return image;
}

void AddCells(vtkImageData* image, const char* name)
{
  vtkNew<vtkFloatArray> cells;
  cells->SetName(name);
  cells->SetNumberOfTuples(image->GetNumberOfCells());
  cells->Fill(1.0);
  image->GetCellData()->AddArray(cells);
}

TEST_P(WriterRobustness, OnlyCellData)
{
  const auto image = Image();
  AddCells(image, "pressure");
  this->ExpectRefused(Produce(image), { "only cell arrays (pressure)", "Cell Data to Point Data" });
}

TEST_P(WriterRobustness, NoArraysAtAll)
{
  this->ExpectRefused(Produce(Image()), { "no point array to write" });
}

TEST_P(WriterRobustness, OnlyStrings)
{
  const auto image = Image();
  vtkNew<vtkStringArray> strings;
  strings->SetName("words");
  strings->SetNumberOfValues(64);
  image->GetPointData()->AddArray(strings);
  vtkNew<vtkBitArray> bits;
  bits->SetName("bits");
  bits->SetNumberOfTuples(64);
  image->GetPointData()->AddArray(bits);
  this->ExpectRefused(Produce(image), { "words (string)", "bits (bit)" });
}

TEST_P(WriterRobustness, AnArrayThatIsNotThere)
{
  this->Change = [](vtkBanyanSeriesWriter* w)
  { w->GetPointArraySelection()->EnableArray("nothere"); };
  this->ExpectRefused(
    WaveSource(SimpleGrid({ 4, 4, 4 }), {}), { "no point array nothere", "there are: wave" });
}

TEST_P(WriterRobustness, NoImage)
{
  vtkNew<vtkSphereSource> sphere;
  this->ExpectRefused(sphere, { "vtkPolyData", "image data" });
  this->ExpectRefused(Produce(vtkNew<vtkMultiBlockDataSet>()), { "vtkMultiBlockDataSet" });
}

TEST_P(WriterRobustness, AnEmptyImage)
{
  this->ExpectRefused(Produce(vtkNew<vtkImageData>()), { "empty" });
}

TEST_P(WriterRobustness, NoInput)
{
  this->ExpectRefused(nullptr, { "no input" });
}

TEST_P(WriterRobustness, NoFileName)
{
  this->Change = [](vtkBanyanSeriesWriter* w) { w->SetFileName(nullptr); };
  this->ExpectRefused(WaveSource(SimpleGrid({ 4, 4, 4 }), {}), { "No file name" });
}

TEST_P(WriterRobustness, AFolderThatDoesNotExist)
{
  this->Change = [this](vtkBanyanSeriesWriter* w)
  { w->SetFileName((this->Folder / "no/such/a.banyan").c_str()); };
  this->ExpectRefused(WaveSource(SimpleGrid({ 4, 4, 4 }), {}), { "no/such" });
}

TEST_P(WriterRobustness, BadOptions)
{
  for (const double bound : { -1.0, std::nan(""), HUGE_VAL })
  {
    this->Change = [bound](vtkBanyanSeriesWriter* w) { w->SetErrorBound(bound); };
    this->ExpectRefused(WaveSource(SimpleGrid({ 4, 4, 4 }), {}), { "a.banyan" });
  }
  for (const int interval : { 0, -3, 100000 })
  {
    this->Change = [interval](vtkBanyanSeriesWriter* w) { w->SetKeyframeInterval(interval); };
    this->ExpectRefused(WaveSource(SimpleGrid({ 4, 4, 4 }), {}), { "a.banyan" });
  }
  for (const int cells : { -16, 7, 8, 24, 64 })
  {
    this->Change = [cells](vtkBanyanSeriesWriter* w) { w->SetBrickCells(cells); };
    this->ExpectRefused(WaveSource(SimpleGrid({ 4, 4, 4 }), {}), { "a.banyan", "16 or 32" });
  }
}

TEST_P(WriterRobustness, GhostFlagsMayBeSelectedAsParaViewDoes)
{
  const auto image = Image();
  image->AllocateScalars(VTK_FLOAT, 1);
  image->GetPointData()->GetScalars()->SetName("p");
  image->GetPointData()->GetScalars()->Fill(3.0);
  image->AllocatePointGhostArray()->SetValue(5, vtkDataSetAttributes::DUPLICATEPOINT);
  WriteSeries(Produce(image), this->Folder / "a.banyan",
    [](vtkBanyanSeriesWriter* w)
    {
      w->GetPointArraySelection()->EnableArray("p");
      w->GetPointArraySelection()->EnableArray(vtkDataSetAttributes::GhostArrayName());
    });
  const auto read = ImageAt(Reader(this->Folder / "a.banyan"), 0.0);
  EXPECT_EQ(read->GetPointData()->GetNumberOfArrays(), 1);
  EXPECT_EQ(read->GetPointData()->GetArray("p")->GetTuple1(5), 3.0);
}

TEST_P(WriterRobustness, CellDataBesidePointDataIsNamedInAWarning)
{
  const auto image = Image();
  image->AllocateScalars(VTK_FLOAT, 1);
  image->GetPointData()->GetScalars()->SetName("p");
  image->GetPointData()->GetScalars()->Fill(3.0);
  AddCells(image, "pressure");
  AddCells(image, "speed");
  vtkNew<vtkBanyanSeriesWriter> writer;
  Messages messages(writer);
  writer->SetInputData(image);
  writer->SetFileName((this->Folder / "a.banyan").c_str());
  writer->SetErrorBoundMode(GetParam());
  EXPECT_EQ(writer->Write(), 1);
  EXPECT_EQ(messages.Errors, "");
  EXPECT_NE(messages.Warnings.find("pressure, speed are not written"), std::string::npos)
    << messages.Warnings;
}

/// Files that were broken on purpose; skipped where the data are not there.
class BrokenFiles : public testing::Test
{
protected:
  void SetUp() override
  {
    if (DataPath("").empty() || !std::filesystem::is_directory(DataPath("")))
    {
      GTEST_SKIP() << "BANYAN_DATA_DIR names no folder of data";
    }
  }
  void ExpectRefused(vtkAlgorithm* reader)
  {
    TemporaryFolder folder;
    vtkNew<vtkBanyanSeriesWriter> writer;
    Messages messages(writer);
    messages.Watch(reader);
    writer->SetInputConnection(reader->GetOutputPort());
    writer->SetFileName((folder / "a.banyan").c_str());
    EXPECT_EQ(writer->Write(), 0);
    EXPECT_NE(messages.Errors.find("was not written"), std::string::npos) << messages.Errors;
    EXPECT_TRUE(folder.Entries().empty());
  }
};

TEST_F(BrokenFiles, RawFileTooShort)
{
  vtkNew<vtkMetaImageReader> reader;
  reader->SetFileName(DataPath("malformed_basic/m01_short.mhd").c_str());
  this->ExpectRefused(reader);
}

TEST_F(BrokenFiles, RawFileMissing)
{
  vtkNew<vtkMetaImageReader> reader;
  reader->SetFileName(DataPath("malformed_basic/m03_missing.mhd").c_str());
  this->ExpectRefused(reader);
}

TEST_F(BrokenFiles, TruncatedXml)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(DataPath("malformed_basic/v11_trunc.vti").c_str());
  this->ExpectRefused(reader);
}

} // namespace
