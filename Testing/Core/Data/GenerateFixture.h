// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GenerateFixture_h
#define banyan_Testing_GenerateFixture_h

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

/// A folder of its own for each test, removed afterwards.
class Generate : public testing::Test
{
protected:
  void SetUp() override
  {
    std::string pattern =
      (std::filesystem::temp_directory_path() / "banyan-generate-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    this->Folder = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(this->Folder); }

  /// Runs the program and returns whether it succeeded.
  bool Run(const std::string& arguments) const
  {
    const std::string command = std::string("\"") + BANYAN_GENERATE + "\" " + arguments + " 2>\"" +
                                (this->Folder / "messages").string() + "\"";
    return std::system(command.c_str()) == 0;
  }
  std::string Messages() const { return this->Text("messages"); }
  std::string Text(const std::filesystem::path& name) const
  {
    std::ifstream file(this->Folder / name, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  std::filesystem::path Folder;
};

#endif
