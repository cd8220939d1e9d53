// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_FrameFile_h
#define banyan_Benchmarks_FrameFile_h

#include "Parallel/Composite/Footprints.h"
#include "Render/Scene/FloatImage.h"

#include <fstream>
#include <string>
#include <vector>

namespace banyan::bench
{

/// The pictures that all ranks have drawn for one frame, in one file, so that they are drawn once
/// and composited many times.
struct FrameHead
{
  PixelRect Viewport;
  std::vector<int> Order; ///< front to back
  std::vector<Footprint> Footprints;
};

/// Writes head and images (as drawn, without the background around them). Throws Error.
void WriteFrame(
  const std::string& path, const FrameHead& head, const std::vector<FloatImage>& images);

/// Reads the head, and images one at a time: ranks that are simulated share memory.
class FrameReader
{
public:
  explicit FrameReader(const std::string& path);
  const FrameHead& Head() const { return this->Contents; }
  FloatImage ImageOf(int rank);

private:
  std::ifstream File;
  FrameHead Contents;
  std::vector<PixelRect> Rects;
  std::streamoff Begin = 0;
};

} // namespace banyan::bench

#endif
