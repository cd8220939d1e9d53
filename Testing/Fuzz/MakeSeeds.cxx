#include "GroupFiles.h"

#include "Series/Exceptions.h"
#include "Series/IndexText.h"

#include <filesystem>
#include <fstream>
#include <iostream>

namespace
{

using banyan::fuzz::Bytes;

void Write(const std::string& path, const Bytes& bytes)
{
  std::ofstream(path, std::ios::binary)
    .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

} // namespace

/// Writes the seeds of Testing/Fuzz/Seeds: MakeSeeds FOLDER
int main(int argc, char** argv)
{
  namespace fs = std::filesystem;
  if (argc != 2)
  {
    std::cerr << "MakeSeeds FOLDER\n";
    return 1;
  }
  const fs::path folder = argv[1];
  const fs::path scratch = folder / "scratch";
  for (const fs::path& part :
    { folder / "Group", folder / "Exceptions", folder / "Index", scratch })
  {
    fs::create_directories(part);
  }
  for (int kind = 0; kind < banyan::fuzz::SeriesKinds; ++kind)
  {
    const banyan::fuzz::SmallSeries series(scratch.string(), kind);
    const std::string name = std::to_string(kind);
    Write((folder / "Group" / name).string(), banyan::fuzz::ToInput(kind, series.Parts));
    const std::string text = banyan::IndexToText(series.Index);
    const std::string body = text.substr(text.find('\n') + 1);
    Write((folder / "Index" / name).string(), { body.begin(), body.end() });
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
  fs::remove_all(scratch);
  return 0;
}
