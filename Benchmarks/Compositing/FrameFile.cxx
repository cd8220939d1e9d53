// SPDX-License-Identifier: BSD-3-Clause
#include "FrameFile.h"

#include "Base/Error.h"

namespace banyan::bench
{
namespace
{

template <typename T>
void Write(std::ostream& to, const T* data, std::size_t count)
{
  to.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
}

template <typename T>
void Read(std::istream& from, T* data, std::size_t count)
{
  from.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(count * sizeof(T)));
}

[[noreturn]] void Fail(const std::string& path)
{
  ErrorPlace place;
  place.File = path;
  throw Error("A recorded frame could not be read or written.", place);
}

} // namespace

void WriteFrame(
  const std::string& path, const FrameHead& head, const std::vector<FloatImage>& images)
{
  std::ofstream file(path, std::ios::binary);
  const int ranks = static_cast<int>(images.size());
  Write(file, &ranks, 1);
  Write(file, &head.Viewport, 1);
  Write(file, head.Order.data(), images.size());
  for (std::size_t rank = 0; rank < images.size(); ++rank)
  {
    Write(file, &head.Footprints[rank].Rect, 1);
    Write(file, head.Footprints[rank].Rows.data(), head.Footprints[rank].Rows.size());
    Write(file, &images[rank].Rect, 1);
  }
  for (const FloatImage& image : images)
  {
    Write(file, image.Pixels.data(), image.Pixels.size());
  }
  file.close();
  if (!file)
  {
    Fail(path);
  }
}

FrameReader::FrameReader(const std::string& path)
  : File(path, std::ios::binary)
{
  int ranks = 0;
  Read(this->File, &ranks, 1);
  if (!this->File || ranks < 1 || ranks > 65535)
  {
    Fail(path);
  }
  const auto count = static_cast<std::size_t>(ranks);
  Read(this->File, &this->Contents.Viewport, 1);
  this->Contents.Order.resize(count);
  Read(this->File, this->Contents.Order.data(), count);
  this->Contents.Footprints.resize(count);
  this->Rects.resize(count);
  for (std::size_t rank = 0; rank < count; ++rank)
  {
    Footprint& footprint = this->Contents.Footprints[rank];
    Read(this->File, &footprint.Rect, 1);
    footprint.Rows.resize(static_cast<std::size_t>(footprint.Rect.Size().y));
    Read(this->File, footprint.Rows.data(), footprint.Rows.size());
    Read(this->File, &this->Rects[rank], 1);
  }
  if (!this->File)
  {
    Fail(path);
  }
  this->Begin = this->File.tellg();
}

FloatImage FrameReader::ImageOf(int rank)
{
  std::streamoff offset = this->Begin;
  for (int before = 0; before < rank; ++before)
  {
    offset += static_cast<std::streamoff>(this->Rects[before].Count() * sizeof(glm::vec4));
  }
  FloatImage image{ this->Rects[rank], {} };
  image.Pixels.resize(static_cast<std::size_t>(image.Rect.Count()));
  this->File.seekg(offset);
  Read(this->File, image.Pixels.data(), image.Pixels.size());
  if (!this->File)
  {
    throw Error("A recorded frame ends too early.");
  }
  return image;
}

} // namespace banyan::bench
