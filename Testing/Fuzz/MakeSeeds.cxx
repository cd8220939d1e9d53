#include "GroupFiles.h"

#include "Series/Exceptions.h"
#include "Series/IndexText.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

namespace
{

using banyan::fuzz::Bytes;

void Write(const std::string& path, const Bytes& bytes)
{
  std::ofstream(path, std::ios::binary)
    .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

/// The JSON of an index.
Bytes BodyOf(const std::string& text)
{
  return { text.begin() + static_cast<std::ptrdiff_t>(text.find('\n') + 1), text.end() };
}

/// Seeds from series that are there: the indices of all, and segments of version 1.
void CopyGolden(const std::filesystem::path& golden, const std::filesystem::path& folder)
{
  for (const auto& entry : std::filesystem::recursive_directory_iterator(golden))
  {
    if (!entry.is_regular_file())
    {
      continue;
    }
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string content{ std::istreambuf_iterator<char>(stream), {} };
    const std::string name =
      entry.path().parent_path().filename().string() + "-" + entry.path().filename().string();
    if (entry.path().extension() == ".banyan")
    {
      Write((folder / "Index" / name).string(), BodyOf(content));
    }
    else if (entry.path().extension() == ".seg" && content[8] == 1)
    {
      Write((folder / "Segment" / name).string(), { content.begin(), content.end() });
    }
  }
}

} // namespace

/// Writes the seeds of Testing/Fuzz/Seeds: MakeSeeds FOLDER. With a second folder, of golden files,
/// more of them.
int main(int argc, char** argv)
{
  namespace fs = std::filesystem;
  if (argc != 2 && argc != 3)
  {
    std::cerr << "MakeSeeds FOLDER [GOLDEN]\n";
    return 1;
  }
  const fs::path folder = argv[1];
  const fs::path scratch = folder / "scratch";
  for (const fs::path& part :
    { folder / "Group", folder / "Exceptions", folder / "Index", folder / "Segment", scratch })
  {
    fs::create_directories(part);
  }
  for (int kind = 0; kind < banyan::fuzz::SeriesKinds; ++kind)
  {
    const banyan::fuzz::SmallSeries series(scratch.string(), kind);
    const std::string name = std::to_string(kind);
    Write((folder / "Group" / name).string(), banyan::fuzz::ToInput(kind, series.Parts));
    if (series.Number == 0)
    {
      Write((folder / "Index" / name).string(), BodyOf(banyan::IndexToText(series.Index)));
    }
  }
  for (int share = 1; share <= 512; share *= 8)
  {
    banyan::ExceptionList<float> list;
    for (std::uint32_t i = 0; i < 512; i += 512 / static_cast<unsigned>(share))
    {
      list.Positions.push_back(i);
      list.Values.push_back(static_cast<float>(i * i));
    }
    Bytes input{ static_cast<std::uint8_t>(banyan::ScalarType::Float32), 0 };
    const Bytes payload = banyan::PackExceptions(list, 512, 3);
    input.insert(input.end(), payload.begin(), payload.end());
    Write((folder / "Exceptions" / std::to_string(share)).string(), input);
  }
  if (argc == 3)
  {
    CopyGolden(argv[2], folder);
  }
  else
  {
    fs::remove(folder / "Segment");
  }
  fs::remove_all(scratch);
  return 0;
}
