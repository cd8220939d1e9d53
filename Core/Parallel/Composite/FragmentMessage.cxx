// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/FragmentMessage.h"

#include "Base/Error.h"
#include "Parallel/Composite/PixelPacking.h"
#include "Parallel/Composite/RowAbove.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

constexpr std::uint32_t PackedBit = 1u << 31;
constexpr std::uint32_t AboveBit = 1u << 30; ///< the numbers above were subtracted

[[noreturn]] void Damaged()
{
  throw Error("Pixels that another rank has sent do not fit to the part of the picture that they "
              "are for; do all ranks run the same version?");
}

void Add(std::vector<std::uint8_t>& bytes, const void* data, std::size_t count)
{
  const auto* begin = static_cast<const std::uint8_t*>(data);
  bytes.insert(bytes.end(), begin, begin + count);
}

std::size_t PixelsOf(const CompositePlan::Region& region)
{
  std::size_t pixels = 0;
  for (const CompositePlan::Run& run : region)
  {
    pixels += static_cast<std::size_t>(run.Hi - run.Lo);
  }
  return pixels;
}

/// Walks through the lengths of runs, which are checked before.
class RunLengths
{
public:
  RunLengths(const std::uint8_t* from, const std::uint8_t* end)
    : From(from)
    , End(end)
  {
  }

  std::size_t Next()
  {
    std::size_t length = 0;
    for (int shift = 0; shift < 35; shift += 7)
    {
      if (this->From == this->End)
      {
        Damaged();
      }
      const std::uint8_t byte = *this->From++;
      length |= static_cast<std::size_t>(byte & 127u) << shift;
      if (byte < 128u)
      {
        return length;
      }
    }
    Damaged();
  }
  bool AtEnd() const { return this->From == this->End; }

private:
  const std::uint8_t* From;
  const std::uint8_t* End;
};

} // namespace

glm::vec4 Combined(const glm::vec4& front, const glm::vec4& back, Combination combination)
{
  switch (combination)
  {
    case Combination::Largest:
      return glm::max(front, back);
    case Combination::Sum:
      return front + back;
    default:
      return front + (1.0f - front.a) * back;
  }
}

std::size_t FragmentBytesAtMost(const CompositePlan::Region& region)
{
  // A drawn and a skipped pixel take two bytes for their lengths; longer runs take less.
  const std::size_t pixels = PixelsOf(region);
  return pixels == 0 ? 0 : 20 + 16 + pixels + std::max(16 * pixels, PackedBytesAtMost(pixels));
}

void FragmentWriter::AddRun(std::size_t length)
{
  while (length >= 128)
  {
    this->Runs.push_back(static_cast<std::uint8_t>(128u | (length & 127u)));
    length >>= 7;
  }
  this->Runs.push_back(static_cast<std::uint8_t>(length));
}

void FragmentWriter::Collect(
  const CompositePlan::Region& region, const FloatImage& image, bool dense)
{
  this->Drawn.clear();
  this->Segments.clear();
  this->Runs.clear();
  std::size_t length = 0;
  bool drawing = false;
  const glm::vec4 nothing(0.0f);
  for (const CompositePlan::Run& run : region)
  {
    const bool inside = run.Y >= image.Rect.Lo.y && run.Y < image.Rect.Hi.y;
    const int lo = inside ? std::clamp(image.Rect.Lo.x, run.Lo, run.Hi) : run.Hi;
    const int hi = inside ? std::clamp(image.Rect.Hi.x, lo, run.Hi) : run.Hi;
    const glm::vec4* row = lo < hi ? &image.At(lo, run.Y) : nullptr;
    const int step = run.Reversed ? -1 : 1;
    int x = run.Reversed ? run.Hi - 1 : run.Lo;
    bool begun = false;
    for (int i = run.Lo; i < run.Hi; ++i, x += step)
    {
      const glm::vec4& pixel = x >= lo && x < hi ? row[x - lo] : nothing;
      const bool drawn = dense || pixel != nothing;
      if (drawn != drawing)
      {
        this->AddRun(length);
        length = 0;
        drawing = drawn;
      }
      ++length;
      if (drawn && !begun)
      {
        this->Segments.push_back({ run.Y, x, step, 0 });
      }
      begun = drawn;
      if (drawn)
      {
        ++this->Segments.back().Count;
        this->Drawn.push_back(pixel);
      }
    }
  }
  if (drawing)
  {
    this->AddRun(length);
  }
}

void FragmentWriter::Append(const CompositePlan::Region& region, const FloatImage& image,
  const FragmentFormat& format, bool pack, bool dense)
{
  if (region.empty())
  {
    return;
  }
  this->Collect(region, image, dense);
  const std::size_t count = this->Drawn.size();
  const auto drawn = static_cast<std::uint32_t>(count);
  Add(this->Bytes, &drawn, sizeof(drawn));
  if (count == 0)
  {
    return;
  }
  Add(this->Bytes, &format, sizeof(format));
  const std::size_t lengths = this->Bytes.size();
  this->Bytes.resize(lengths + 2 * sizeof(std::uint32_t));
  Add(this->Bytes, this->Runs.data(), this->Runs.size());
  const std::size_t begin = this->Bytes.size();
  std::size_t bytes = count * sizeof(glm::vec4);
  std::uint32_t packed = 0;
  if (format.Kind == FragmentFormat::Floats)
  {
    Add(this->Bytes, this->Drawn.data(), bytes);
  }
  else
  {
    this->Numbers.resize(4 * count);
    QuantizePixels(format, this->Drawn.data(), count, this->Numbers.data());
    this->Bytes.resize(begin + PackedBytesAtMost(count));
    if (pack)
    {
      bytes = PackPixels(this->Numbers.data(), count, this->Bytes.data() + begin);
      packed = PackedBit;
      // Smooth pictures gain from the row above, noisy ones lose.
      SubtractAbove(this->Segments, this->Numbers.data());
      this->Other.resize(PackedBytesAtMost(count));
      const std::size_t other = PackPixels(this->Numbers.data(), count, this->Other.data());
      if (other < bytes)
      {
        std::memcpy(this->Bytes.data() + begin, this->Other.data(), other);
        bytes = other;
        packed |= AboveBit;
      }
    }
    else
    {
      bytes = WritePlain(this->Numbers.data(), count, this->Bytes.data() + begin);
    }
    this->Bytes.resize(begin + bytes);
  }
  const std::uint32_t sizes[] = { static_cast<std::uint32_t>(this->Runs.size()),
    static_cast<std::uint32_t>(bytes) | packed };
  std::memcpy(this->Bytes.data() + lengths, sizes, sizeof(sizes));
}

std::uint32_t FragmentReader::Number()
{
  std::uint32_t number = 0;
  if (static_cast<std::size_t>(this->End - this->From) < sizeof(number))
  {
    Damaged();
  }
  std::memcpy(&number, this->From, sizeof(number));
  this->From += sizeof(number);
  return number;
}

void FragmentReader::ReadSegments(
  const CompositePlan::Region& region, std::size_t drawn, std::size_t bytes)
{
  this->Segments.clear();
  RunLengths lengths(this->From, this->From + bytes);
  this->From += bytes;
  std::size_t found = 0;
  bool drawing = false;
  std::size_t left = lengths.Next();
  for (const CompositePlan::Run& run : region)
  {
    const int width = run.Hi - run.Lo;
    for (int x = 0; x < width;)
    {
      while (left == 0)
      {
        if (found == drawn)
        {
          return;
        }
        left = lengths.Next();
        drawing = !drawing;
      }
      const int here = static_cast<int>(std::min<std::size_t>(left, width - x));
      left -= static_cast<std::size_t>(here);
      if (drawing)
      {
        found += static_cast<std::size_t>(here);
        this->Segments.push_back(
          { run.Y, run.Reversed ? run.Hi - 1 - x : run.Lo + x, run.Reversed ? -1 : 1, here });
      }
      if (found > drawn)
      {
        Damaged();
      }
      x += here;
    }
  }
  if (found != drawn)
  {
    Damaged();
  }
}

void FragmentReader::ReadPixels(std::size_t drawn, const FragmentFormat& format, std::uint32_t size)
{
  const std::size_t bytes = size & ~(PackedBit | AboveBit);
  this->Drawn.resize(drawn);
  if (format.Kind == FragmentFormat::Floats)
  {
    if (bytes != drawn * sizeof(glm::vec4))
    {
      Damaged();
    }
    std::memcpy(this->Drawn.data(), this->From, bytes);
  }
  else
  {
    this->Numbers.resize(4 * drawn);
    const bool packed = (size & PackedBit) != 0;
    (packed ? UnpackPixels : ReadPlain)(this->From, bytes, drawn, this->Numbers.data());
    if ((size & AboveBit) != 0)
    {
      AddAbove(this->Segments, this->Numbers.data());
    }
    RestorePixels(format, this->Numbers.data(), drawn, this->Drawn.data());
  }
  this->From += bytes;
}

void FragmentReader::Blend(
  const CompositePlan::Region& region, FloatImage& target, Place place, Combination combination)
{
  if (region.empty())
  {
    return;
  }
  const std::size_t drawn = this->Number();
  if (drawn == 0)
  {
    return;
  }
  FragmentFormat format;
  if (static_cast<std::size_t>(this->End - this->From) < sizeof(format) || drawn > PixelsOf(region))
  {
    Damaged();
  }
  std::memcpy(&format, this->From, sizeof(format));
  this->From += sizeof(format);
  const std::size_t runBytes = this->Number();
  const std::uint32_t size = this->Number();
  if (static_cast<std::size_t>(this->End - this->From) <
      runBytes + (size & ~(PackedBit | AboveBit)))
  {
    Damaged();
  }
  this->ReadSegments(region, drawn, runBytes);
  this->ReadPixels(drawn, format, size);
  const glm::vec4* read = this->Drawn.data();
  for (const DrawnSegment& segment : this->Segments)
  {
    glm::vec4* pixel = &target.At(segment.X, segment.Y);
    for (int i = 0; i < segment.Count; ++i, pixel += segment.Step, ++read)
    {
      *pixel = place == Place::Before ? Combined(*read, *pixel, combination)
                                      : Combined(*pixel, *read, combination);
    }
  }
}

} // namespace banyan
