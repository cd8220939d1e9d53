// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/SegmentMixer.h"

#include "Render/Raycast/RayTile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Ends of segments that are nearer to each other than this part of one are the same.
constexpr double SamePlace = 1e-5;
/// Less light counts as none: its logarithm is finite.
constexpr float LeastLight = 1e-30f;

bool IsSurface(const RaySegment& segment)
{
  return segment.Length <= 0.0f;
}

double EndOf(const RaySegment& segment)
{
  return segment.Begin + static_cast<double>(segment.Length);
}

} // namespace

/// One ray from the eye on.
class SegmentMixer::RayMix
{
public:
  RayMix(std::vector<Span>& spans, float limit)
    : Spans(spans)
    , Limit(limit)
  {
  }

  glm::vec4 Mix()
  {
    double at = this->NextBegin();
    while (this->Through > this->Limit && at < std::numeric_limits<double>::infinity())
    {
      this->BlendSurfaces(at);
      const double end = this->EndOfPart(at);
      this->BlendPart(at, end);
      at = this->Skip(end);
    }
    return { this->Color, 1.0f - this->Through };
  }

private:
  static bool Covers(const Span& span, double at)
  {
    return span.At != span.End &&
           span.At->Begin <= at + SamePlace * static_cast<double>(span.At->Length);
  }

  double NextBegin() const
  {
    double next = std::numeric_limits<double>::infinity();
    for (const Span& span : this->Spans)
    {
      next = span.At != span.End ? std::min(next, span.At->Begin) : next;
    }
    return next;
  }

  /// Where the segments at a place are no longer all that there are.
  double EndOfPart(double at) const
  {
    double end = std::numeric_limits<double>::infinity();
    for (const Span& span : this->Spans)
    {
      if (span.At != span.End)
      {
        end = std::min(end, Covers(span, at) ? EndOf(*span.At) : span.At->Begin);
      }
    }
    return end;
  }

  void BlendPart(double at, double end)
  {
    const RaySegment* only = nullptr;
    double part = 0.0;
    int count = 0;
    for (const Span& span : this->Spans)
    {
      if (Covers(span, at))
      {
        only = span.At;
        part = PartOf(*only, at, end);
        ++count;
      }
    }
    if (count == 1 && part > 1.0 - SamePlace)
    {
      this->Blend(glm::vec3(only->Color[0], only->Color[1], only->Color[2]), only->Transmittance);
    }
    else if (count > 0)
    {
      this->BlendTogether(at, end);
    }
  }

  /// The part of a segment that lies between two places.
  static double PartOf(const RaySegment& segment, double at, double end)
  {
    return std::min((end - at) / static_cast<double>(segment.Length), 1.0);
  }

  /// Densities add up, and colours count by density.
  struct Mixture
  {
    void Add(const RaySegment& segment, double part)
    {
      const float whole = -std::log(std::max(segment.Transmittance, LeastLight));
      const float its = whole * static_cast<float>(part);
      const float opacity = 1.0f - segment.Transmittance;
      this->Depth += its;
      if (opacity > 0.0f)
      {
        this->Weighted +=
          its / opacity * glm::vec3(segment.Color[0], segment.Color[1], segment.Color[2]);
      }
    }

    float Depth = 0.0f;
    glm::vec3 Weighted{ 0.0f };
  };

  void BlendTogether(double at, double end)
  {
    Mixture mixture;
    for (const Span& span : this->Spans)
    {
      if (Covers(span, at))
      {
        mixture.Add(*span.At, PartOf(*span.At, at, end));
      }
    }
    this->Blend(mixture);
  }

  /// Blends the surfaces at a place, and goes behind them.
  void BlendSurfaces(double at)
  {
    Mixture mixture;
    for (Span& span : this->Spans)
    {
      for (; span.At != span.End && IsSurface(*span.At) && span.At->Begin <= at; ++span.At)
      {
        mixture.Add(*span.At, 1.0);
      }
    }
    this->Blend(mixture);
  }

  void Blend(const Mixture& mixture)
  {
    if (mixture.Depth > 0.0f)
    {
      const float opacity = -std::expm1(-mixture.Depth);
      this->Blend(opacity / mixture.Depth * mixture.Weighted, 1.0f - opacity);
    }
  }

  void Blend(const glm::vec3& color, float transmittance)
  {
    this->Color += this->Through * color;
    this->Through *= transmittance;
  }

  /// Goes behind a place.
  /// @return where the next segment begins
  double Skip(double end)
  {
    double next = std::numeric_limits<double>::infinity();
    for (Span& span : this->Spans)
    {
      while (span.At != span.End && !IsSurface(*span.At) &&
             EndOf(*span.At) <= end + SamePlace * static_cast<double>(span.At->Length))
      {
        ++span.At;
      }
      next = span.At != span.End ? std::min(next, std::max(span.At->Begin, end)) : next;
    }
    return next;
  }

  std::vector<Span>& Spans;
  float Limit;
  glm::vec3 Color{ 0.0f };
  float Through = 1.0f;
};

void SegmentMixer::Add(std::size_t volume, const RaySegments& part)
{
  this->Volumes[volume].Parts.push_back(&part);
}

/// By pixel, then along the ray: parts come in any order.
void SegmentMixer::Sort(OneVolume& volume)
{
  volume.Begins.assign(RayTile::Slots + 1, 0);
  for (const RaySegments* const part : volume.Parts)
  {
    for (const RaySegment& segment : *part)
    {
      ++volume.Begins[segment.Pixel + 1];
    }
  }
  for (int pixel = 0; pixel < RayTile::Slots; ++pixel)
  {
    volume.Begins[pixel + 1] += volume.Begins[pixel];
  }
  if (volume.Segments.size() < volume.Begins.back())
  {
    volume.Segments.clear(); // nothing is to be moved
    volume.Segments.resize(volume.Begins.back());
  }
  std::vector<std::uint32_t> at(volume.Begins.begin(), volume.Begins.end() - 1);
  for (const RaySegments* const part : volume.Parts)
  {
    for (const RaySegment& segment : *part)
    {
      volume.Segments[at[segment.Pixel]++] = segment;
    }
  }
  const auto nearer = [](const RaySegment& a, const RaySegment& b) { return a.Begin < b.Begin; };
  for (int pixel = 0; pixel < RayTile::Slots; ++pixel)
  {
    RaySegment* const begin = volume.Segments.data() + volume.Begins[pixel];
    RaySegment* const end = volume.Segments.data() + volume.Begins[pixel + 1];
    if (!std::is_sorted(begin, end, nearer))
    {
      std::sort(begin, end, nearer);
    }
  }
}

void SegmentMixer::Mix(float limit, glm::vec4* pixels)
{
  for (OneVolume& volume : this->Volumes)
  {
    this->Sort(volume);
  }
  std::vector<Span> spans(this->Volumes.size());
  for (int pixel = 0; pixel < RayTile::Slots; ++pixel)
  {
    for (std::size_t i = 0; i < spans.size(); ++i)
    {
      const OneVolume& volume = this->Volumes[i];
      const RaySegment* const all = volume.Segments.data();
      spans[i] = { all + volume.Begins[pixel], all + volume.Begins[pixel + 1] };
    }
    pixels[pixel] = RayMix(spans, limit).Mix();
  }
  for (OneVolume& volume : this->Volumes)
  {
    volume.Parts.clear();
  }
}

} // namespace banyan
