// SPDX-License-Identifier: BSD-3-Clause
// Series that are reached through links are those that the links lead to.
#include "Series/ContainerTesting.h"
#include "Series/SeriesTesting.h"

#include "Series/Format/SeriesPath.h"

#include <fstream>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

class SeriesLinks : public ::testing::Test
{
protected:
  SeriesLinks()
  {
    fs::create_directory(this->Folder / "data");
    fs::create_directory(this->Folder / "work");
  }

  void Save(const std::string& path, double shift)
  {
    Encode(path, Small, SmallSteps(3, shift), TwoPerSegment());
  }

  static void ExpectHolds(const std::string& path, double shift)
  {
    const auto file = SeriesFile::Open(path);
    ASSERT_EQ(file->Index().Steps(), 3);
    EXPECT_TRUE(WithinBound(SmallSteps(3, shift)[2], ReadAll<float>(*file, { 2, 0, 0, 0 }),
      file->Index().Arrays[0].Components[0].ErrorBoundAbsolute));
  }

  static std::ptrdiff_t FilesIn(const std::string& folder)
  {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  }

  const TemporaryFolder Folder;
  const std::string Real = Folder / "data/real.banyan";
  const std::string Link = Folder / "work/link.banyan";
};

TEST_F(SeriesLinks, ToAnIndexAreFollowed)
{
  this->Save(this->Real, 1);
  fs::create_symlink("../data/real.banyan", this->Link);
  ExpectHolds(this->Link, 1);
  this->Save(this->Link, 2);
  EXPECT_TRUE(fs::is_symlink(this->Link));
  EXPECT_FALSE(fs::exists(this->Link + ".d"));
  ExpectHolds(this->Real, 2);
  ExpectHolds(this->Link, 2);
  EXPECT_EQ(FilesIn(this->Real + ".d"), 2);
  const std::string again = this->Folder / "again.banyan";
  fs::create_symlink(this->Link, again);
  this->Save(again, 3);
  ExpectHolds(this->Real, 3);
}

TEST_F(SeriesLinks, ToAnIndexAndItsFolderAreFollowed)
{
  this->Save(this->Real, 1);
  fs::create_symlink("../data/real.banyan", this->Link);
  fs::create_symlink("../data/real.banyan.d", this->Link + ".d");
  ExpectHolds(this->Link, 1);
  this->Save(this->Link, 2);
  ExpectHolds(this->Real, 2);
  ExpectHolds(this->Link, 2);
  EXPECT_EQ(FilesIn(this->Real + ".d"), 2);
  EXPECT_TRUE(fs::is_symlink(this->Link + ".d"));
}

TEST_F(SeriesLinks, ToNothingMakeWhatTheyLeadTo)
{
  fs::create_symlink("../data/real.banyan", this->Link);
  this->Save(this->Link, 4);
  ExpectHolds(this->Real, 4);
  ExpectHolds(this->Link, 4);
}

TEST_F(SeriesLinks, InACircleAreAnError)
{
  fs::create_symlink("b.banyan", this->Folder / "a.banyan");
  fs::create_symlink("a.banyan", this->Folder / "b.banyan");
  ExpectError([&] { this->Save(this->Folder / "a.banyan", 0); }, "circle");
  ExpectError([&] { (void)SeriesFile::Open(this->Folder / "a.banyan"); }, "symbolic links");
}

/// So does a store of files that links stand for.
TEST_F(SeriesLinks, OfFilesOneByOneAreRead)
{
  this->Save(this->Real, 5);
  fs::create_directory(this->Link + ".d");
  for (const auto& entry : fs::directory_iterator(this->Real + ".d"))
  {
    fs::copy(entry.path(), this->Folder / ("data/" + entry.path().filename().string()));
    fs::create_symlink("../../data/" + entry.path().filename().string(),
      this->Link + ".d/" + entry.path().filename().string());
  }
  fs::remove_all(this->Real + ".d");
  fs::create_symlink("../data/real.banyan", this->Link);
  ExpectHolds(this->Link, 5);
}

TEST_F(SeriesLinks, ToTheFolderOfAnotherSeriesLeaveThatSeriesWhole)
{
  this->Save(this->Real, 1);
  const std::string other = this->Folder / "work/other.banyan";
  fs::copy(this->Real, other);
  fs::create_symlink("../data/real.banyan.d", other + ".d");
  ExpectHolds(other, 1);
  this->Save(other, 2);
  ExpectHolds(other, 2);
  ExpectHolds(this->Real, 1);
}

TEST_F(SeriesLinks, ToAFolderElsewhereAreKept)
{
  fs::create_directory(this->Folder / "large");
  fs::create_symlink(this->Folder / "large", this->Real + ".d");
  this->Save(this->Real, 1);
  this->Save(this->Real, 2);
  ExpectHolds(this->Real, 2);
  EXPECT_EQ(FilesIn(this->Folder / "large"), 2);
  EXPECT_TRUE(fs::is_symlink(this->Real + ".d"));
}

TEST_F(SeriesLinks, OfASecondNameLeaveTheFirst)
{
  this->Save(this->Real, 1);
  const std::string second = this->Folder / "data/second.banyan";
  fs::create_hard_link(this->Real, second);
  fs::create_directory(second + ".d");
  for (const auto& entry : fs::directory_iterator(this->Real + ".d"))
  {
    fs::create_hard_link(entry.path(), second + ".d/" + entry.path().filename().string());
  }
  this->Save(second, 2);
  ExpectHolds(second, 2);
  ExpectHolds(this->Real, 1);
}

/// A temporary file is never somebody else's.
TEST_F(SeriesLinks, AsTemporaryFilesAreNotWrittenThrough)
{
  const std::string precious = this->Folder / "precious";
  std::ofstream(precious) << "mine";
  fs::create_symlink(precious, this->Real + ".part");
  this->Save(this->Real, 1);
  ExpectHolds(this->Real, 1);
  EXPECT_EQ(fs::file_size(precious), 4u);
}

} // namespace
} // namespace banyan::testing
