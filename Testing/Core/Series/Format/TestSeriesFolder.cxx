// SPDX-License-Identifier: BSD-3-Clause
// Where segments are looked for: indexes that were moved, renamed or linked, with their folders or
// without.
#include "Series/ContainerTesting.h"

#include "Series/Format/IndexText.h"
#include "Series/Format/SeriesFolder.h"

#include <fstream>
#include <random>

#include <sys/stat.h>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

/// The files of a case: an index, links to it, and a folder somewhere.
enum class Lies
{
  BesideTarget,   ///< under its name, beside the file
  BesideLink,     ///< under the link's name, beside the link
  Linked,         ///< a link of the right name leads to it
  OldName,        ///< the index was renamed
  OldNameForeign, ///< and a folder of another series has the new name
  TwoOldNames,
  Nowhere,
  OneMissing,
  OneShort,
  OneOfOldName, ///< renamed, and only one segment is there
  Count
};

/// A series of 3 segments in `made/`, and the places into which cases put copies of its parts.
class SeriesPlaces : public ::testing::Test
{
protected:
  void SetUp() override
  {
    for (const char* place : { "made", "data", "work", "store" })
    {
      fs::create_directory(this->Folder / place);
    }
    Encode(this->Folder / "made/s.banyan", Small, this->Values, TwoPerSegment());
    for (const auto& entry : fs::directory_iterator(this->Folder / "made/s.banyan.d"))
    {
      this->Segments.push_back(entry.path().filename().string());
    }
    std::sort(this->Segments.begin(), this->Segments.end());
    ASSERT_EQ(this->Segments.size(), 3u);
  }

  void CopyIndex(const std::string& to) { fs::copy(this->Folder / "made/s.banyan", to); }
  void CopyFolder(const std::string& to) { fs::copy(this->Folder / "made/s.banyan.d", to); }

  /// Whether it opens, with the values that were encoded; otherwise the error must name each word.
  void Expect(const std::string& path, bool opens, const std::vector<std::string>& words) const
  {
    try
    {
      const auto file = SeriesFile::Open(path);
      EXPECT_TRUE(opens) << path;
      EXPECT_EQ(file->Path(), path);
      EXPECT_TRUE(WithinBound(this->Values[4], ReadAll<float>(*file, { 4, 0, 0, 0 }),
        file->Index().Arrays[0].Components[0].ErrorBoundAbsolute));
    }
    catch (const Error& error)
    {
      EXPECT_FALSE(opens) << error.what();
      for (const std::string& word : words)
      {
        EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
          << error.what() << "\nlacks " << word;
      }
    }
  }

  /// One case: the path that is opened, and where its parts may lie.
  struct Places
  {
    Lies Kind;
    std::string Target; ///< the index
    std::string Path;   ///< the same, or a link
    std::string Beside; ///< a folder of the right name
    std::string Old;    ///< a folder of another name
    std::string Victim; ///< a segment
  };

  struct Expected
  {
    bool Opens = true;
    std::vector<std::string> Words;
  };

  Places MakePlaces(Lies kind, std::mt19937& random)
  {
    for (const char* place : { "data", "work", "store" })
    {
      fs::remove_all(this->Folder / place);
      fs::create_directory(this->Folder / place);
    }
    Places places;
    places.Kind = kind;
    places.Target = this->Folder / (random() % 2 ? "data/t.banyan" : "data/without suffix");
    this->CopyIndex(places.Target);
    places.Path = places.Target;
    const unsigned links = random() % 3; // a file, a link, or a link to a link
    for (unsigned link = 0; link < links; ++link)
    {
      const std::string from = this->Folder / ("work/l" + std::to_string(link) + ".banyan");
      fs::create_symlink(
        random() % 2 ? places.Path : fs::relative(places.Path, this->Folder / "work").string(),
        from);
      places.Path = from;
    }
    places.Beside = (kind == Lies::BesideLink ? places.Path : places.Target) + ".d";
    places.Old = this->Folder / (links > 0 && random() % 2 ? "work/old.d" : "data/old.d");
    places.Victim = this->Segments[random() % 3];
    return places;
  }

  /// Puts the folder where the case has it.
  Expected Arrange(const Places& places)
  {
    Expected expected{ true, { places.Path } };
    switch (places.Kind)
    {
      case Lies::BesideTarget:
      case Lies::BesideLink:
        this->CopyFolder(places.Beside);
        break;
      case Lies::Linked:
        this->CopyFolder(this->Folder / "store/x");
        fs::create_directory_symlink(this->Folder / "store/x", places.Beside);
        break;
      case Lies::OldNameForeign:
        fs::create_directory(places.Beside);
        std::ofstream(places.Beside + "/other.seg") << "of another series";
        [[fallthrough]];
      case Lies::OldName:
        this->CopyFolder(places.Old);
        break;
      case Lies::TwoOldNames:
        this->CopyFolder(this->Folder / "data/old.d");
        this->CopyFolder(this->Folder / "data/older.d");
        expected.Opens = false;
        expected.Words.insert(expected.Words.end(), { "data/old.d", "data/older.d", "rename" });
        break;
      case Lies::OneMissing:
        this->CopyFolder(places.Beside);
        fs::remove(places.Beside + "/" + places.Victim);
        expected.Opens = false;
        expected.Words.insert(expected.Words.end(),
          { places.Beside, places.Victim, "1 of the 3 files", "copy the folder again" });
        break;
      case Lies::OneShort:
        this->CopyFolder(places.Beside);
        fs::resize_file(places.Beside + "/" + places.Victim, 100);
        expected.Opens = false;
        expected.Words.insert(
          expected.Words.begin(), { places.Beside, places.Victim, "cut short" });
        expected.Words.pop_back(); // the file that is short is named, not the index
        break;
      case Lies::OneOfOldName:
        fs::create_directory(places.Old);
        fs::copy(
          this->Folder / ("made/s.banyan.d/" + places.Victim), places.Old + "/" + places.Victim);
        expected.Opens = false;
        expected.Words.insert(expected.Words.end(), { places.Old, "with 1 of them" });
        [[fallthrough]];
      default:
        expected.Opens = false;
        expected.Words.insert(
          expected.Words.end(), { fs::path(places.Path).filename().string() + ".d", "3 segments",
                                  "is missing beside", "copy or move both" });
        if (places.Path != places.Target)
        {
          expected.Words.push_back(fs::canonical(places.Target).string());
        }
    }
    return expected;
  }

  TemporaryFolder Folder;
  const Steps<float> Values = SmallSteps(5);
  std::vector<std::string> Segments;
};

TEST_F(SeriesPlaces, HundredsOfArrangements)
{
  std::mt19937 random(20261125);
  for (int i = 0; i < 150; ++i)
  {
    SCOPED_TRACE("case " + std::to_string(i));
    const Places places =
      this->MakePlaces(static_cast<Lies>(i % static_cast<int>(Lies::Count)), random);
    const Expected expected = this->Arrange(places);
    this->Expect(places.Path, expected.Opens, expected.Words);
  }
}

TEST_F(SeriesPlaces, AFolderThatIsAFile)
{
  this->CopyIndex(this->Folder / "data/a.banyan");
  std::ofstream(this->Folder / "data/a.banyan.d") << "a file";
  this->Expect(this->Folder / "data/a.banyan", false, { "a.banyan.d", "Not a directory" });
}

TEST_F(SeriesPlaces, AFolderInPlaceOfItsFile)
{
  this->Expect(
    this->Folder / "made/s.banyan.d", false, { "This is a folder", "s.banyan beside it" });
  this->Expect(
    this->Folder / "made/s.banyan.d/", false, { "This is a folder", "s.banyan beside it" });
  this->Expect(this->Folder / "made", false, { "This is a folder", "name.banyan" });
}

TEST_F(SeriesPlaces, LinksThatLeadNowhere)
{
  fs::create_symlink("nothing", this->Folder / "data/dangling.banyan");
  this->Expect(this->Folder / "data/dangling.banyan", false, { "dangling.banyan", "No such file" });
  fs::create_symlink("circle.banyan", this->Folder / "data/circle.banyan");
  this->Expect(this->Folder / "data/circle.banyan", false, { "circle.banyan", "symbolic links" });
}

TEST_F(SeriesPlaces, AFileIsKnownByItsBeginning)
{
  const auto begins = [this](const std::string& text)
  {
    std::ofstream(this->Folder / "data/x", std::ios::binary) << text;
    return BeginsAsSeries(this->Folder / "data/x");
  };
  EXPECT_TRUE(BeginsAsSeries(this->Folder / "made/s.banyan"));
  EXPECT_TRUE(begins("BanyanSeries 9")) << "of a later version, or cut short";
  EXPECT_TRUE(begins("banyan-series 5 0")) << "of a development version";
  EXPECT_FALSE(begins("BanyanSerie"));
  EXPECT_FALSE(begins("BanyanSeriesX2 "));
  EXPECT_FALSE(begins(""));
  EXPECT_FALSE(BeginsAsSeries(this->Folder / "data"));
  EXPECT_FALSE(BeginsAsSeries(this->Folder / "nothing"));
  ASSERT_EQ(mkfifo((this->Folder / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(BeginsAsSeries(this->Folder / "pipe")) << "and does not wait for a writer";
}

} // namespace
} // namespace banyan::testing
