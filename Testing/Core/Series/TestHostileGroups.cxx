// SPDX-License-Identifier: BSD-3-Clause
// Files of groups that refer to the one before, damaged or made with ill intent.
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Codec/BlockModes.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Format/IndexText.h"
#include "Series/Format/SegmentFormat.h"
#include "Series/Format/Zstd.h"

#include <fstream>
#include <functional>
#include <iterator>

namespace banyan::testing
{
namespace
{

constexpr int Interval = 4;
const Grid Domain = GridOf(37, 33, 35);

std::string Content(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), {} };
}

void Write(const std::string& path, const std::string& content)
{
  std::ofstream(path, std::ios::binary) << content;
}

EncodeOptions Options()
{
  EncodeOptions options;
  options.KeyframeInterval = Interval;
  options.BrickCells = 16;
  return options;
}

using Sections = std::vector<Bytes>; ///< unpacked: hashes of pages, the head, the steps

/// Changes the sections of a segment and makes all hashes fit again.
void Rewrite(const std::string& path, std::size_t segment,
  const std::function<void(Sections&, segment::Header&)>& change)
{
  SeriesIndex index = IndexFromText(Content(path), path);
  SegmentIndex& at = index.Segments[segment];
  const std::string old = Content(path + ".d/" + at.File);
  const auto* data = reinterpret_cast<const std::uint8_t*>(old.data());
  segment::Header header = segment::LoadHeader(data);
  Sections sections;
  for (std::uint32_t i = 0; i < header.Sections; ++i)
  {
    const std::uint8_t* entry = data + header.DirectoryOffset + i * group::EntryBytes;
    const std::uint8_t* stored = data + LoadNumber<std::uint64_t>(entry);
    const auto bytes = LoadNumber<std::uint32_t>(entry + 8);
    sections.emplace_back(stored, stored + bytes);
    if (const auto raw = LoadNumber<std::uint32_t>(entry + 12); raw != bytes)
    {
      sections.back().resize(raw);
      Decompress(stored, bytes, sections.back().data(), raw);
    }
  }
  change(sections, header);
  Bytes file(data, data + header.PayloadEnd);
  Bytes directory(sections.size() * group::EntryBytes);
  for (std::size_t i = 0; i < sections.size(); ++i)
  {
    const std::size_t offset = file.size();
    file.insert(file.end(), sections[i].begin(), sections[i].end());
    std::uint8_t* entry = directory.data() + i * group::EntryBytes;
    StoreNumber(entry, std::uint64_t{ offset });
    StoreNumber(entry + 8, static_cast<std::uint32_t>(file.size() - offset));
    StoreNumber(entry + 12, static_cast<std::uint32_t>(sections[i].size()));
    StoreNumber(entry + 16, ShortHashOf(file.data() + offset, file.size() - offset));
  }
  header.DirectoryOffset = file.size();
  header.DirectoryHash = ShortHashOf(directory.data(), directory.size());
  file.insert(file.end(), directory.begin(), directory.end());
  header.FileBytes = file.size();
  segment::StoreHeader(header, file.data());
  const Hash128 hash = HashOf(file.data(), segment::HeaderBytes);
  at.Bytes = file.size();
  at.HashLow = hash.Low;
  at.HashHigh = hash.High;
  Write(path + ".d/" + at.File, { file.begin(), file.end() });
  Write(path, IndexToText(index));
}

group::FieldHead HeadOf(const Sections& sections)
{
  return group::UnpackHead(sections[1].data(), sections[1].size());
}

class HostileGroups : public ::testing::Test
{
protected:
  HostileGroups()
    : Path(this->Folder / "s.banyan")
    , Index(Encode(this->Path, Domain, Sample<float>(Domain, 12, Wavy<float>), Options()))
  {
  }

  std::string FileOf(std::size_t segment) const
  {
    return this->Path + ".d/" + this->Index.Segments[segment].File;
  }

  /// What reading a step says, which must name the file; empty when it can be read.
  std::string Complaint(int step, std::size_t segment)
  {
    std::string first;
    const auto file = SeriesFile::Open(this->Path);
    const auto collect = [&](const std::function<void()>& read)
    {
      try
      {
        read();
      }
      catch (const Error& error)
      {
        const std::string text = error.what();
        EXPECT_NE(text.find(this->Index.Segments[segment].File), std::string::npos) << text;
        first = first.empty() ? text : first;
        return true;
      }
      return false;
    };
    std::vector<std::int64_t> all;
    bool decodingFails = false;
    for (std::int64_t b = 0; b < file->Layout(0).BrickCount(); ++b)
    {
      all.push_back(b);
      std::vector<float> values(static_cast<std::size_t>(file->Layout(0).SamplesOf(b).Count()));
      decodingFails |= collect([&] { file->DecodeBrick({ step, 0, 0, 0 }, b, values.data()); });
    }
    const bool checkingFails = collect([&] { file->VerifyBricks({ step, 0, 0, 0 }, all); });
    EXPECT_EQ(decodingFails, checkingFails);
    return first;
  }

  TemporaryFolder Folder;
  std::string Path;
  SeriesIndex Index;
};

bool Says(const std::string& text, const std::string& part)
{
  return text.find(part) != std::string::npos;
}

TEST_F(HostileGroups, RewritingAloneHurtsNothing)
{
  for (const std::size_t segment : { 0, 1, 2 })
  {
    Rewrite(this->Path, segment,
      [segment](Sections& sections, segment::Header&)
      { ASSERT_EQ(HeadOf(sections).Open, segment > 0); });
  }
  for (int step = 0; step < 12; ++step)
  {
    EXPECT_EQ(this->Complaint(step, 0), "");
  }
}

TEST_F(HostileGroups, DamageOfTheKeyFrameBeforeIsSaid)
{
  std::string bytes = Content(this->FileOf(0));
  for (std::size_t at = 64; at < bytes.size(); ++at)
  {
    bytes[at] = static_cast<char>(bytes[at] ^ 0x55);
  }
  Write(this->FileOf(0), bytes);
  EXPECT_NE(this->Complaint(4, 0), "");
  EXPECT_EQ(this->Complaint(7, 0), "") << "a key frame needs nothing else";
  for (int step = 8; step < 12; ++step)
  {
    EXPECT_EQ(this->Complaint(step, 0), "") << "no step goes further back than one segment";
  }
}

TEST_F(HostileGroups, AMissingSegmentIsSaid)
{
  std::filesystem::remove(this->FileOf(0));
  try
  {
    (void)SeriesFile::Open(this->Path);
    ADD_FAILURE() << "it opened";
  }
  catch (const Error& error)
  {
    EXPECT_TRUE(Says(error.what(), this->Index.Segments[0].File)) << error.what();
  }
}

TEST_F(HostileGroups, NothingComesBeforeTheFirstSegment)
{
  Rewrite(this->Path, 0,
    [](Sections& sections, segment::Header&)
    {
      group::FieldHead head = HeadOf(sections);
      head.Open = true;
      sections[1] = PackHead(head);
    });
  EXPECT_TRUE(Says(this->Complaint(0, 0), "first segment of a series refers to one before"));
  Rewrite(this->Path, 0,
    [](Sections& sections, segment::Header&)
    {
      group::FieldHead head = HeadOf(sections);
      head.Open = false;
      head.Static = true;
      sections[1] = PackHead(head);
    });
  EXPECT_TRUE(Says(this->Complaint(0, 0), "first segment of a series says that a field is as"));
}

/// A head that rests takes the place of everything behind it.
TEST_F(HostileGroups, ASegmentThatRestsIsTheLastStepBefore)
{
  const auto last = ReadAll<float>(*SeriesFile::Open(this->Path), { Interval - 1, 0, 0, 0 });
  Rewrite(this->Path, 1,
    [](Sections& sections, segment::Header&)
    {
      group::FieldHead head = HeadOf(sections);
      head.Open = false;
      head.Static = true;
      sections[1] = PackHead(head);
      for (std::size_t step = 2; step < sections.size(); ++step)
      {
        sections[step].clear();
      }
    });
  const auto file = SeriesFile::Open(this->Path);
  for (int step = Interval; step < 2 * Interval; ++step)
  {
    EXPECT_EQ(ReadAll<float>(*file, { step, 0, 0, 0 }), last);
    EXPECT_EQ((*file->Nodes({ step, 0, 0, 0 }))[0].Identity,
      (*file->Nodes({ Interval - 1, 0, 0, 0 }))[0].Identity);
  }
}

TEST_F(HostileGroups, AnotherLatticeBeforeIsRefused)
{
  for (const bool axes : { true, false })
  {
    Rewrite(this->Path, 0,
      [axes](Sections& sections, segment::Header&)
      {
        group::FieldHead head = HeadOf(sections);
        if (axes)
        {
          std::swap(head.Axes[0], head.Axes[1]);
        }
        head.Greatest += axes ? 0 : 1;
        sections[1] = PackHead(head);
      });
    EXPECT_TRUE(Says(this->Complaint(5, 1), "is quantized differently"));
    EXPECT_EQ(this->Complaint(7, 1), "");
  }
}

TEST_F(HostileGroups, AKeyFrameThatRefersToOthersIsRefused)
{
  Rewrite(this->Path, 0,
    [this](Sections& sections, segment::Header& header)
    {
      const group::TableShape shape =
        group::ShapeOf(Domain.Samples(), HeadOf(sections).Axes, 16, this->Index.Levels);
      Bytes& keyFrame = sections.back();
      group::StepTable table = group::UnpackStep(
        keyFrame.data(), keyFrame.size(), shape, Interval - 1, {}, header.PayloadEnd);
      table.Planes[0][0].Mode = static_cast<std::uint8_t>(
        block::NumberOf({ block::Reference::A, block::Interpolation::Cubic }));
      keyFrame = group::PackStep(table, shape, Interval - 1, {});
    });
  EXPECT_TRUE(Says(this->Complaint(3, 0), "key frame of a segment refers to another step"));
  EXPECT_TRUE(Says(this->Complaint(4, 0), "key frame of a segment refers to another step"));
  EXPECT_EQ(this->Complaint(7, 0), "");
}

} // namespace
} // namespace banyan::testing
