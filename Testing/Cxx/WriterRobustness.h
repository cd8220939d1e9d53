// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_WriterRobustness_h
#define banyan_Testing_WriterRobustness_h

#include "VtkIoTesting.h"

#include "vtkBanyanSeriesWriter.h"

#include "vtkErrorCode.h"
#include "vtkImageData.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// All bytes of a series, with the names of its segments.
inline std::string SeriesBytes(const std::string& path)
{
  std::set<std::string> files{ path };
  for (const auto& entry : std::filesystem::directory_iterator(path + ".d"))
  {
    files.insert(entry.path().string());
  }
  std::ostringstream bytes;
  for (const std::string& file : files)
  {
    bytes << file << std::ifstream(file, std::ios::binary).rdbuf();
  }
  return bytes.str();
}

/// Writers that have to give up, in each mode of the error bound.
class WriterRobustness : public testing::TestWithParam<int>
{
protected:
  /// Writes in the mode of the parameter; expects a refusal that mentions all the texts, and that
  /// nothing is left.
  void ExpectRefused(vtkAlgorithm* source, const std::vector<std::string>& mentions)
  {
    this->Refuse(source, mentions);
    EXPECT_TRUE(this->Folder.Entries().empty()) << this->Folder.Entries().front();
  }

  void Refuse(vtkAlgorithm* source, const std::vector<std::string>& mentions)
  {
    vtkNew<vtkBanyanSeriesWriter> writer;
    Messages messages(writer);
    if (source)
    {
      messages.Watch(source);
      writer->SetInputConnection(source->GetOutputPort());
    }
    writer->SetFileName((this->Folder / "a.banyan").c_str());
    writer->SetErrorBoundMode(GetParam());
    writer->SetErrorBound(0.01);
    writer->SetKeyframeInterval(1); // so that segments are written before the trouble
    if (this->Change)
    {
      this->Change(writer);
    }
    EXPECT_EQ(writer->Write(), 0);
    EXPECT_NE(writer->GetErrorCode(), static_cast<unsigned long>(vtkErrorCode::NoError));
    for (const std::string& mention : mentions)
    {
      EXPECT_NE(messages.Errors.find(mention), std::string::npos)
        << "no '" << mention << "' in: " << messages.Errors;
    }
  }

  /// Four steps, of which the third is changed.
  vtkSmartPointer<TestSource> SourceThatChanges(const std::function<void(vtkImageData*)>& change,
    banyan::ScalarType type = banyan::ScalarType::Float32)
  {
    const auto source = WaveSource(SimpleGrid({ 12, 11, 10 }), { 0.0, 0.5, 1.5, 2.0 }, type);
    const auto fill = source->Fill;
    source->Fill = [fill, change](vtkImageData* image, double time)
    {
      fill(image, time);
      if (time == 1.5)
      {
        change(image);
      }
    };
    return source;
  }

  TemporaryFolder Folder;
  std::function<void(vtkBanyanSeriesWriter*)> Change;
};

#endif
