// SPDX-License-Identifier: BSD-3-Clause
#include "RawSeriesWriter.h"

#include "Base/Error.h"

#include <filesystem>

namespace banyan
{

namespace
{

std::string Unfinished(const std::string& path)
{
  return path + ".partial";
}

[[noreturn]] void Fail(const std::string& path)
{
  throw Error("The file could not be written; is the disk full or the folder missing or read-only?",
    { path, {}, {}, {} });
}

} // namespace

RawSeriesWriter::RawSeriesWriter(const std::string& path)
  : Path(path)
  , File(Unfinished(path), std::ios::binary | std::ios::trunc)
{
  if (!this->File.good())
  {
    Fail(path);
  }
}

RawSeriesWriter::~RawSeriesWriter()
{
  if (!this->Finished)
  {
    this->File.close();
    std::error_code ignored;
    std::filesystem::remove(Unfinished(this->Path), ignored);
  }
}

void RawSeriesWriter::AddStep(const std::vector<float>& values)
{
  // The machines that Banyan is built for are little-endian; so is its own file format.
  this->File.write(reinterpret_cast<const char*>(values.data()),
    static_cast<std::streamsize>(values.size() * sizeof(float)));
  if (!this->File.good())
  {
    Fail(this->Path);
  }
}

void RawSeriesWriter::Finish()
{
  this->File.close();
  std::error_code problem;
  if (this->File.good())
  {
    std::filesystem::rename(Unfinished(this->Path), this->Path, problem);
  }
  if (!this->File.good() || problem)
  {
    Fail(this->Path);
  }
  this->Finished = true;
}

} // namespace banyan
