// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_FragmentMessage_h
#define banyan_Parallel_Composite_FragmentMessage_h

#include "Parallel/Composite/CompositePlan.h"
#include "Parallel/Composite/FragmentFormat.h"
#include "Render/Scene/FloatImage.h"
#include "Render/Scene/ProjectionTable.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// The pixel of two parts of a volume, of which one lies before the other.
glm::vec4 Combined(const glm::vec4& front, const glm::vec4& back, Combination combination);

/// Drawn pixels that follow each other in a row.
struct DrawnSegment
{
  int Y = 0;
  int X = 0;    ///< of the first one
  int Step = 1; ///< to the next one: 1 or -1
  int Count = 0;
};

/// Writes pixels of regions into one message. A region that both sides know needs no coordinates:
/// only which of its pixels are drawn (not all zero), as the lengths of runs, and these.
///
/// A part is the number of drawn pixels (4 bytes); unless that is 0, the format (8 bytes), the
/// bytes of the runs and of the pixels (4 bytes each; the highest bit of the second one says
/// packed), the runs (skipped, drawn, skipped, ... in varints of 7 bits), the pixels.
class FragmentWriter
{
public:
  /// @param image pixels outside its rectangle count as not drawn
  /// @param pack whether PackPixels or WritePlain; without effect on floats
  /// @param dense whether all pixels travel, not only drawn ones
  void Append(const CompositePlan::Region& region, const FloatImage& image,
    const FragmentFormat& format, bool pack, bool dense = false);

  std::vector<std::uint8_t> Bytes;

private:
  void Collect(const CompositePlan::Region& region, const FloatImage& image, bool dense);
  void AddRun(std::size_t length);

  std::vector<glm::vec4> Drawn;
  std::vector<DrawnSegment> Segments;
  std::vector<std::uint8_t> Runs;
  std::vector<std::uint16_t> Numbers;
  std::vector<std::uint8_t> Other; ///< packed in the other one of two ways
};

/// Returns the bytes that a region takes at most, with the room that packing writes over.
std::size_t FragmentBytesAtMost(const CompositePlan::Region& region);

/// Reads what FragmentWriter has written. Throws Error when the message does not fit to a region.
class FragmentReader
{
public:
  /// @param data must stay
  FragmentReader(const std::uint8_t* data, std::size_t bytes)
    : From(data)
    , End(data + bytes)
  {
  }

  enum class Place
  {
    Before, ///< the pixels read lie before those of the target
    Behind
  };
  /// Blends the next part into `target`, whose rectangle has the whole region inside.
  void Blend(
    const CompositePlan::Region& region, FloatImage& target, Place place, Combination combination);

  bool AtEnd() const { return this->From == this->End; }

private:
  std::uint32_t Number();
  void ReadSegments(const CompositePlan::Region& region, std::size_t drawn, std::size_t bytes);
  void ReadPixels(std::size_t drawn, const FragmentFormat& format, std::uint32_t size);

  const std::uint8_t* From;
  const std::uint8_t* End;
  std::vector<glm::vec4> Drawn;
  std::vector<DrawnSegment> Segments;
  std::vector<std::uint16_t> Numbers;
};

} // namespace banyan

#endif
