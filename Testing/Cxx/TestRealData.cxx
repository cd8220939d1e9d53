// SPDX-License-Identifier: BSD-3-Clause
// Real data, and files that are awkward but right; skipped where the data are not there.
#include "VtkIoTesting.h"

#include "vtkBanyanSeriesReader.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMetaImageReader.h"
#include "vtkPointData.h"
#include "vtkXMLImageDataReader.h"

#include "Series/Decode/SeriesFile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace
{

/// A source whose steps are files.
vtkSmartPointer<TestSource> FileSource(const std::vector<std::string>& files)
{
  std::vector<vtkSmartPointer<vtkImageData>> images;
  for (const std::string& file : files)
  {
    vtkSmartPointer<vtkImageAlgorithm> meta;
    vtkNew<vtkMetaImageReader> mhd;
    vtkNew<vtkXMLImageDataReader> vti;
    images.emplace_back(vtkSmartPointer<vtkImageData>::New());
    if (std::filesystem::path(file).extension() == ".mhd")
    {
      mhd->SetFileName(file.c_str());
      mhd->Update();
      images.back()->DeepCopy(mhd->GetOutput());
    }
    else
    {
      vti->SetFileName(file.c_str());
      vti->Update();
      images.back()->DeepCopy(vti->GetOutput());
    }
  }
  auto source = vtkSmartPointer<TestSource>::New();
  const int* e = images.front()->GetExtent();
  source->Grid.Extent = { { e[0], e[2], e[4] }, { e[1] + 1, e[3] + 1, e[5] + 1 } };
  for (std::size_t i = 0; i < files.size(); ++i)
  {
    source->Times.push_back(static_cast<double>(i));
  }
  source->Fill = [images](vtkImageData* image, double time)
  { image->ShallowCopy(images[static_cast<std::size_t>(time)]); };
  return source;
}

/// Encodes and compares every voxel of every step with the bound in the index.
void ExpectWithinTheBound(const std::vector<std::string>& files)
{
  TemporaryFolder folder;
  const auto source = FileSource(files);
  WriteSeries(source, folder / "a.banyan");
  const auto index = banyan::SeriesFile::Open(folder / "a.banyan")->Index();
  const auto reader = Reader(folder / "a.banyan");
  double largest = 0.0;
  for (std::size_t step = 0; step < files.size(); ++step)
  {
    const auto a = ImageAt(source, static_cast<double>(step));
    const auto b = ImageAt(reader, static_cast<double>(step));
    vtkDataArray* original = a->GetPointData()->GetScalars();
    vtkDataArray* decoded = b->GetPointData()->GetScalars();
    ASSERT_TRUE(original && decoded);
    ASSERT_GT(original->GetNumberOfTuples(), 0);
    ASSERT_STREQ(original->GetName(), decoded->GetName());
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_EQ(a->GetSpacing()[i], b->GetSpacing()[i]);
      EXPECT_EQ(a->GetOrigin()[i], b->GetOrigin()[i]);
    }
    for (vtkIdType i = 0; i < original->GetNumberOfTuples(); ++i)
    {
      const double x = original->GetTuple1(i);
      const double y = decoded->GetTuple1(i);
      if (std::isnan(x))
      {
        ASSERT_TRUE(std::isnan(y));
        continue;
      }
      largest = std::max(largest, std::abs(x - y));
      ASSERT_LE(std::abs(x - y), index.Arrays[0].Components[0].ErrorBoundAbsolute);
    }
  }
  EXPECT_EQ(largest, index.Arrays[0].Components[0].MeasuredMaxError);
}

std::vector<std::string> FilesIn(const std::string& name, const std::string& extension)
{
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(DataPath(name)))
  {
    if (entry.path().extension() == extension)
    {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

class RealData : public testing::Test
{
protected:
  void SetUp() override
  {
    if (DataPath("").empty() || !std::filesystem::is_directory(DataPath("")))
    {
      GTEST_SKIP() << "BANYAN_DATA_DIR names no folder of data";
    }
  }
};

TEST_F(RealData, Isabel)
{
  const auto files = FilesIn("isabel_velmag", ".vti");
  ASSERT_EQ(files.size(), 8u);
  ExpectWithinTheBound(files);
}

TEST_F(RealData, ViscousFingers)
{
  const auto files = FilesIn("viscous_fingers_run01", ".mhd");
  ASSERT_EQ(files.size(), 17u);
  ExpectWithinTheBound(files);
}

TEST_F(RealData, NaNSlab)
{
  ExpectWithinTheBound({ DataPath("malformed_basic/v01_nan.vti") });
}

TEST_F(RealData, Constant)
{
  ExpectWithinTheBound({ DataPath("malformed_basic/v04_const.vti") });
}

TEST_F(RealData, SingleSlice)
{
  ExpectWithinTheBound({ DataPath("malformed_basic/v07_2d.vti") });
}

TEST_F(RealData, SingleVoxel)
{
  ExpectWithinTheBound({ DataPath("malformed_basic/m07_one.mhd") });
}

} // namespace
