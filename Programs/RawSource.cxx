// SPDX-License-Identifier: BSD-3-Clause
#include "RawSource.h"

#include "Base/Error.h"

#include <filesystem>
#include <utility>

namespace banyan
{
namespace
{

std::int64_t StepsIn(const std::string& file, std::size_t stepBytes)
{
  std::error_code failure;
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  if (failure)
  {
    throw Error("The file cannot be read: " + failure.message(), { file });
  }
  if (bytes == 0 || bytes % stepBytes != 0)
  {
    throw Error("The size of the file is not a multiple of the " + std::to_string(stepBytes) +
                  " bytes that a time step has with this --raw-type and these --dims",
      { file, {}, bytes });
  }
  return static_cast<std::int64_t>(bytes / stepBytes);
}

} // namespace

RawSource::RawSource(
  std::vector<std::string> files, const SourceArray& array, const glm::ivec3& samples)
  : Files(std::move(files))
  , Array(array)
  , Samples(samples)
{
  for (const std::string& file : this->Files)
  {
    (void)StepsIn(file, BytesOf(array, samples));
  }
}

bool RawSource::Next(SourceStep& step)
{
  if (this->Left == 0)
  {
    if (this->File == this->Files.size())
    {
      return false;
    }
    this->Left = StepsIn(this->Files[this->File], BytesOf(this->Array, this->Samples));
    this->InFile = 0;
    this->Stream = std::ifstream(this->Files[this->File++], std::ios::binary);
  }
  else
  {
    ++this->InFile;
  }
  --this->Left;
  step = {};
  step.Samples = this->Samples;
  step.Arrays = { this->Array };
  return true;
}

void RawSource::ReadValues(std::size_t, std::vector<std::uint8_t>& values)
{
  values.resize(BytesOf(this->Array, this->Samples));
  this->Stream.seekg(
    static_cast<std::streamoff>(this->InFile) * static_cast<std::streamoff>(values.size()));
  this->Stream.read(
    reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size()));
  if (!this->Stream)
  {
    throw Error("The file cannot be read to its end", { this->Files[this->File - 1] });
  }
}

} // namespace banyan
