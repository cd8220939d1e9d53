// SPDX-License-Identifier: BSD-3-Clause
// Files that are not what they should be: an error that says so, and no output.
#include "VtkIoTesting.h"

#include "vtkBanyanDecode.h"
#include "vtkBanyanDeferred.h"
#include "vtkBanyanSeriesReader.h"

#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkPointData.h"

#include "Series/Decode/SeriesFile.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

namespace
{

namespace fs = std::filesystem;

void Write(const std::string& path, const std::string& text)
{
  std::ofstream(path, std::ios::binary) << text;
}

std::string Content(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), {} };
}

class ReaderRobustness : public testing::Test
{
protected:
  void SetUp() override
  {
    const auto source = WaveSource(SimpleGrid({ 40, 33, 20 }), { 0.0, 1.0, 2.0 });
    WriteSeries(source, this->Path);
    const auto reader = Reader(this->Path);
    for (const double time : { 0.0, 1.0, 2.0 })
    {
      this->Good.push_back(ImageAt(reader, time));
    }
    for (const auto& entry : fs::directory_iterator(this->Path + ".d"))
    {
      this->Segments.push_back(entry.path().string());
    }
    ASSERT_FALSE(this->Segments.empty());
  }

  void ExpectRefused(const std::string& path, const std::string& mention)
  {
    const auto reader = Reader(path);
    Messages messages(reader);
    reader->Update();
    EXPECT_NE(reader->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
    EXPECT_NE(messages.Errors.find(path), std::string::npos) << messages.Errors;
    EXPECT_NE(messages.Errors.find(mention), std::string::npos) << messages.Errors;
    EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 0);
  }

  TemporaryFolder Folder;
  std::string Path = this->Folder / "a.banyan";
  std::vector<std::string> Segments;
  std::vector<vtkSmartPointer<vtkImageData>> Good;
};

TEST_F(ReaderRobustness, MissingFile)
{
  this->ExpectRefused(this->Folder / "none.banyan", "none.banyan");
}

TEST_F(ReaderRobustness, NoFileName)
{
  vtkNew<vtkBanyanSeriesReader> reader;
  Messages messages(reader);
  reader->Update();
  EXPECT_EQ(reader->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoFileNameError));
  EXPECT_NE(messages.Errors.find("FileName"), std::string::npos) << messages.Errors;
}

TEST_F(ReaderRobustness, NotASeries)
{
  for (const char* text : { "", "{", "{}", "[1,2,3]", "\x89PNG\r\n", "<VTKFile/>" })
  {
    Write(this->Folder / "b.banyan", text);
    this->ExpectRefused(this->Folder / "b.banyan", "b.banyan");
  }
}

TEST_F(ReaderRobustness, AFolder)
{
  fs::create_directory(this->Folder / "c.banyan");
  this->ExpectRefused(this->Folder / "c.banyan", "c.banyan");
}

/// Whoever claims a file may say what is wrong with it; others' files are left to others.
TEST_F(ReaderRobustness, ClaimsWhatBeginsOrIsNamedAsASeries)
{
  vtkNew<vtkBanyanSeriesReader> reader;
  const auto claims = [&](const std::string& name, const std::string& text)
  {
    Write(this->Folder / name, text);
    return reader->CanReadFile((this->Folder / name).c_str()) != 0;
  };
  EXPECT_TRUE(claims("cut.banyan", "BanyanSeries 2"));
  EXPECT_TRUE(claims("other.banyan", "<VTKFile/>"));
  EXPECT_TRUE(claims("empty.banyan", ""));
  EXPECT_TRUE(claims("copy of a series", Content(this->Path)));
  EXPECT_FALSE(claims("a.vti", "<VTKFile/>"));
  EXPECT_FALSE(reader->CanReadFile(nullptr));
}

TEST_F(ReaderRobustness, WithoutItsFolder)
{
  fs::rename(this->Path + ".d", this->Folder / "elsewhere");
  this->ExpectRefused(this->Path, "a.banyan.d");
}

TEST_F(ReaderRobustness, ThroughALink)
{
  fs::create_directory(this->Folder / "work");
  fs::create_symlink("../a.banyan", this->Folder / "work/b.banyan");
  EXPECT_TRUE(
    SameBits(ImageAt(Reader(this->Folder / "work/b.banyan"), 1.0)->GetPointData()->GetScalars(),
      this->Good[1]->GetPointData()->GetScalars()));
}

TEST_F(ReaderRobustness, MissingSegment)
{
  fs::remove(this->Segments.front());
  this->ExpectRefused(this->Path, "a.banyan");
}

TEST_F(ReaderRobustness, TruncatedSegment)
{
  fs::resize_file(this->Segments.front(), fs::file_size(this->Segments.front()) / 2);
  this->ExpectRefused(this->Path, "a.banyan");
}

TEST_F(ReaderRobustness, AnotherFileAfterAFailure)
{
  const auto reader = Reader(this->Folder / "none.banyan");
  Messages messages(reader);
  reader->Update();
  EXPECT_NE(messages.Errors, "");
  messages.Errors.clear();
  reader->SetFileName(this->Path.c_str());
  reader->Update();
  EXPECT_EQ(messages.Errors, "");
  EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 40 * 33 * 20);
}

/// Flips bits in index and segments: what is read is an error or right, deferred or not.
TEST_F(ReaderRobustness, FlippedBitsGiveAnErrorOrTheRightValues)
{
  std::mt19937 random(20240607);
  std::vector<std::string> files = this->Segments;
  files.push_back(this->Path);
  int errors = 0;
  constexpr int Mutations = 120;
  for (int i = 0; i < Mutations; ++i)
  {
    const std::string file = files[random() % files.size()];
    const std::string whole = Content(file);
    std::string broken = whole;
    const int flips = 1 + static_cast<int>(random() % 3);
    for (int flip = 0; flip < flips; ++flip)
    {
      broken[random() % broken.size()] ^= static_cast<char>(1u << (random() % 8));
    }
    Write(file, broken);
    const auto reader = Reader(this->Path);
    Messages messages(reader);
    vtkNew<vtkBanyanDecode> readsDeferred;
    if (i % 2 == 0)
    {
      readsDeferred->SetInputConnection(reader->GetOutputPort());
    }
    for (int step = 0; step < 3; ++step)
    {
      messages.Errors.clear();
      reader->UpdateTimeStep(step);
      vtkImageData* image = reader->GetOutput();
      if (!messages.Errors.empty())
      {
        ++errors;
        EXPECT_EQ(image->GetNumberOfPoints(), 0);
        continue;
      }
      ASSERT_EQ(image->GetNumberOfPoints(), 40 * 33 * 20);
      messages.Watch(image->GetPointData()->GetScalars());
      EXPECT_TRUE(SameBits(
        image->GetPointData()->GetScalars(), this->Good[step]->GetPointData()->GetScalars()));
      EXPECT_EQ(messages.Errors, "") << "a value access must not be the first to notice";
    }
    Write(file, whole);
  }
  EXPECT_GT(errors, Mutations / 4);
}

} // namespace
