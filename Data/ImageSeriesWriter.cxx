// SPDX-License-Identifier: BSD-3-Clause
#include "ImageSeriesWriter.h"

#include "Base/Error.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace banyan
{

namespace
{

/// Writes a whole file under another name and renames it, or throws and leaves nothing.
void WriteFile(const std::filesystem::path& path, const std::string& text)
{
  const std::filesystem::path unfinished = path.string() + ".partial";
  bool written = false;
  {
    std::ofstream file(unfinished, std::ios::binary | std::ios::trunc);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.flush();
    written = file.good();
  }
  std::error_code problem;
  if (written)
  {
    std::filesystem::rename(unfinished, path, problem);
  }
  if (!written || problem)
  {
    std::filesystem::remove(unfinished, problem);
    throw Error("The file could not be written; is the disk full or the folder read-only?",
      { path.string(), {}, {}, {} });
  }
}

/// Shortest text that reads back as the same number.
std::string Exact(double value)
{
  return nlohmann::json(value).dump();
}

std::string DataArrayElement(const ImageArray& array)
{
  const std::uint64_t bytes = array.Values.size() * sizeof(float);
  std::vector<unsigned char> block(sizeof bytes + bytes);
  std::memcpy(block.data(), &bytes, sizeof bytes);
  std::memcpy(block.data() + sizeof bytes, array.Values.data(), bytes);
  return "        <DataArray type=\"Float32\" Name=\"" + array.Name + "\" NumberOfComponents=\"" +
         std::to_string(array.Components) + "\" format=\"binary\">\n" +
         EncodeBase64(block.data(), block.size()) + "\n        </DataArray>\n";
}

} // namespace

std::string EncodeBase64(const unsigned char* bytes, std::size_t count)
{
  static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((count + 2) / 3 * 4);
  for (std::size_t i = 0; i < count; i += 3)
  {
    const std::size_t left = count - i;
    const std::uint32_t three = static_cast<std::uint32_t>(bytes[i]) << 16 |
                                (left > 1 ? static_cast<std::uint32_t>(bytes[i + 1]) << 8 : 0u) |
                                (left > 2 ? static_cast<std::uint32_t>(bytes[i + 2]) : 0u);
    text += letters[three >> 18];
    text += letters[three >> 12 & 63];
    text += left > 1 ? letters[three >> 6 & 63] : '=';
    text += left > 2 ? letters[three & 63] : '=';
  }
  return text;
}

ImageSeriesWriter::ImageSeriesWriter(
  const std::string& folder, const std::string& name, int size, double edge)
  : Folder(folder)
  , Name(name)
  , Size(size)
  , Edge(edge)
{
  std::error_code problem;
  std::filesystem::create_directories(folder, problem);
  if (!std::filesystem::is_directory(folder))
  {
    throw Error("The output folder could not be made.", { folder, {}, {}, {} });
  }
}

std::string ImageSeriesWriter::FileName(int step) const
{
  char number[16];
  std::snprintf(number, sizeof number, "%04d", step);
  return this->Name + "_" + number + ".vti";
}

void ImageSeriesWriter::AddStep(double time, const std::vector<ImageArray>& arrays)
{
  const std::string last = std::to_string(this->Size - 1);
  const std::string extent = "0 " + last + " 0 " + last + " 0 " + last;
  const std::string spacing = Exact(this->Edge / this->Size);
  std::string text = "<?xml version=\"1.0\"?>\n"
                     "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                     "header_type=\"UInt64\">\n"
                     "  <ImageData WholeExtent=\"" +
                     extent + "\" Origin=\"0 0 0\" Spacing=\"" + spacing + " " + spacing + " " +
                     spacing +
                     "\">\n"
                     "    <FieldData>\n"
                     "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
                     "format=\"ascii\">" +
                     Exact(time) +
                     "</DataArray>\n"
                     "    </FieldData>\n"
                     "    <Piece Extent=\"" +
                     extent + "\">\n      <PointData Scalars=\"" + arrays.at(0).Name + "\">\n";
  for (const ImageArray& array : arrays)
  {
    text += DataArrayElement(array);
  }
  text += "      </PointData>\n    </Piece>\n  </ImageData>\n</VTKFile>\n";
  WriteFile(std::filesystem::path(this->Folder) / this->FileName(this->Steps()), text);
  this->Times.push_back(time);
}

void ImageSeriesWriter::Finish() const
{
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (int step = 0; step < this->Steps(); ++step)
  {
    files.push_back({ { "name", this->FileName(step) }, { "time", this->Times[step] } });
  }
  const nlohmann::ordered_json series = { { "file-series-version", "1.0" }, { "files", files } };
  WriteFile(
    std::filesystem::path(this->Folder) / (this->Name + ".vti.series"), series.dump(2) + "\n");
}

} // namespace banyan
