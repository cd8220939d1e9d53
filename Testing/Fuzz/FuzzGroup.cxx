// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Cache/BrickCache.h"
#include "GroupFiles.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Format/IndexText.h"
#include "Series/Format/SegmentFormat.h"

#include <filesystem>
#include <fstream>
#include <memory>

#include <stdlib.h>

namespace
{

using namespace banyan;

std::string MakeFolder()
{
  const std::filesystem::path memory = "/dev/shm";
  const std::filesystem::path parent =
    std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
  std::string name = parent / "banyan-fuzz-XXXXXX";
  if (mkdtemp(name.data()) == nullptr)
  {
    abort();
  }
  return name;
}

/// Series to put segments into; removed at exit.
struct Stage
{
  Stage()
    : Folder(MakeFolder())
  {
    for (int kind = 0; kind < fuzz::SeriesKinds; ++kind)
    {
      this->Series.push_back(std::make_unique<fuzz::SmallSeries>(this->Folder, kind));
    }
  }
  ~Stage() { std::filesystem::remove_all(this->Folder); }

  std::string Folder;
  std::vector<std::unique_ptr<fuzz::SmallSeries>> Series;
};

void Write(const std::string& path, const char* data, std::size_t bytes)
{
  std::ofstream(path, std::ios::binary).write(data, static_cast<std::streamsize>(bytes));
}

/// Everything that a reader can be asked for; an Error here does not keep the rest from being read.
void ReadEverything(const SeriesFile& file)
{
  const auto edge = static_cast<std::size_t>(file.Index().BrickCells) + 1;
  std::vector<std::uint64_t> values(edge * edge * edge);
  for (int step = file.Index().Steps(); step-- > 0;)
  {
    for (int level = 0; level < file.Index().Levels; ++level)
    {
      const FieldKey field{ step, 0, 0, level };
      for (std::int64_t brick = 0; brick < file.Layout(level).BrickCount(); ++brick)
      {
        try
        {
          file.DecodeBrick(field, brick, values.data());
        }
        catch (const Error&)
        {
        }
        try
        {
          file.VerifyBricks(field, { brick });
        }
        catch (const Error&)
        {
        }
      }
      try
      {
        (void)file.Nodes(field);
      }
      catch (const Error&)
      {
      }
      try
      {
        const Box whole{ glm::ivec3(0), file.Layout(level).Samples() };
        std::vector<std::uint64_t> all(static_cast<std::size_t>(whole.Count()));
        BrickCache cache(std::uint64_t{ 1 } << 20);
        ReadRegion(cache, file, field, whole, all.data(), 1, 0);
      }
      catch (const Error&)
      {
      }
    }
  }
}

} // namespace

/// The input: type of the series, then the sections of its segment (size, bytes), then its
/// payloads; see GroupFiles.h. Compression and checksums are put around them, so that what lies
/// behind is reached.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  static const Stage stage;
  if (size < 1)
  {
    return 0;
  }
  fuzz::SmallSeries& series = *stage.Series[data[0] % fuzz::SeriesKinds];
  SegmentIndex& changed = series.Changed();
  const fuzz::Bytes segment =
    fuzz::Assemble(fuzz::FromInput(data + 1, size - 1, series.Parts.Sections.size()), changed);
  const Hash128 hash = HashOf(segment.data(), segment::HeaderBytes);
  changed.Bytes = segment.size();
  changed.HashLow = hash.Low;
  changed.HashHigh = hash.High;
  Write(series.Path + ".d/" + changed.File, reinterpret_cast<const char*>(segment.data()),
    segment.size());
  const std::string text = IndexToText(series.Index);
  Write(series.Path, text.data(), text.size());
  try
  {
    ReadEverything(*SeriesFile::Open(series.Path));
  }
  catch (const Error&)
  {
  }
  return 0;
}
