// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/RunMerger.h"

#include <algorithm>
#include <tuple>

namespace banyan
{

/// Raw intervals are blended as if each were a ray of its own with one interval, by the code that
/// blends slabs of whole meshes.
struct RunMerger::Room
{
  RayTile Rays;
  TileRows Rows;
  SampleSlab Slab;
};

RunMerger::RunMerger()
  : Work(std::make_unique<Room>())
{
}

RunMerger::~RunMerger() = default;

void RunMerger::Add(int rank, const TileRuns& part)
{
  for (const RayRun& run : part.Runs)
  {
    this->Elements.push_back({ run.First, run.Last, &run, nullptr, rank, run.Pixel });
  }
  for (const RawInterval& raw : part.Raw)
  {
    this->Elements.push_back({ raw.Number, raw.Number, nullptr, &raw, rank, raw.Pixel });
  }
  this->Sorted = false;
}

/// By pixel, then along the ray; the same for any order in which ranks were added.
void RunMerger::Sort() const
{
  if (!this->Sorted)
  {
    std::sort(this->Elements.begin(), this->Elements.end(),
      [](const Element& a, const Element& b)
      { return std::tie(a.Pixel, a.First, a.Rank) < std::tie(b.Pixel, b.First, b.Rank); });
    this->Sorted = true;
  }
}

bool RunMerger::Agree(std::vector<std::vector<AskedIntervals>>& asked) const
{
  this->Sort();
  bool agree = true;
  const std::size_t count = this->Elements.size();
  for (std::size_t i = 0; i < count; ++i)
  {
    const Element& a = this->Elements[i];
    for (std::size_t j = i + 1; j < count; ++j)
    {
      const Element& b = this->Elements[j];
      if (b.Pixel != a.Pixel || b.First > a.Last)
      {
        break;
      }
      const AskedIntervals both{ b.First, std::min(a.Last, b.Last), a.Pixel };
      for (const Element* const element : { &a, &b })
      {
        if (element->Run)
        {
          asked[static_cast<std::size_t>(element->Rank)].push_back(both);
          agree = false;
        }
      }
    }
  }
  return agree;
}

void RunMerger::Merge(const SlabBlend& blend, float limit, TilePixels& pixels)
{
  this->Sort();
  this->Resolve(blend);
  this->BlendPixels(blend, limit, pixels);
  this->Elements.clear();
}

/// Decides raw intervals, and blends each.
void RunMerger::Resolve(const SlabBlend& blend)
{
  this->Decided.clear();
  const Element* before = nullptr;
  for (const Element& element : this->Elements)
  {
    if (!element.Raw)
    {
      continue;
    }
    const RawInterval& raw = *element.Raw;
    if (!before || before->Pixel != element.Pixel || before->First != element.First)
    {
      this->Decided.push_back(raw);
    }
    else
    {
      RawInterval& decided = this->Decided.back();
      decided.Crossed.Add(raw.Crossed);
      // The last cell in the order owns the sample.
      if (raw.Claimed && (!decided.Claimed || !(raw.Key < decided.Key)))
      {
        decided.Claimed = true;
        decided.Value = raw.Value;
        decided.Cosine = raw.Cosine;
        decided.Key = raw.Key;
      }
    }
    before = &element;
  }
  this->Resolved.assign(this->Decided.size(), RayRun());
  for (std::size_t begin = 0; begin < this->Decided.size(); begin += RayTile::Slots)
  {
    this->ResolveBatch(blend, begin, std::min(begin + RayTile::Slots, this->Decided.size()));
  }
}

/// Puts raw intervals side by side into row 0 of a slab.
void RunMerger::ResolveBatch(const SlabBlend& blend, std::size_t begin, std::size_t end)
{
  RayTile& rays = this->Work->Rays;
  TileRows& rows = this->Work->Rows;
  SampleSlab& slab = this->Work->Slab;
  rays.TransmittanceLimit = -1.0f;
  rows.AnyEnds = false;
  for (std::size_t i = begin; i < end; ++i)
  {
    const RawInterval& raw = this->Decided[i];
    const int slot = static_cast<int>(i - begin);
    const int index = SampleSlab::IndexOf(slot, 0);
    const bool whole = raw.Length == 1.0f;
    rays.SetPixel(slot, { 0.0f, 0.0f, 0.0f, 1.0f });
    rays.Head.Fraction[slot] = raw.Length;
    rows.Head[slot] = whole ? TileRows::None : 0;
    rows.Tail[slot] = TileRows::None;
    rows.AnyEnds |= !whole;
    slab.Value[index] = raw.Claimed ? raw.Value : SampleSlab::Nothing;
    slab.Cosine[index] = raw.Cosine;
    slab.Change[index] = raw.Crossed.Change;
    slab.AtBorder[index] = raw.Crossed.AtBorder;
    slab.CosineAtBorder[index] = raw.Crossed.CosineAtBorder;
    slab.Crossings[index] = raw.Crossed.Count;
    slab.Before[index] = raw.Crossed.Before;
    slab.Behind[index] = raw.Crossed.Behind;
    slab.Nearest[index] = raw.Crossed.Nearest;
    slab.NearestEnters[index] = raw.Crossed.NearestEnters;
    slab.Marks[slot / SampleSlab::Lanes] = 1;
    slab.Borders[slot / SampleSlab::Lanes] = 1;
  }
  // The rest of the last packet holds no value.
  for (std::size_t i = end; (i - begin) % SampleSlab::Lanes != 0; ++i)
  {
    const int slot = static_cast<int>(i - begin);
    rays.SetPixel(slot, { 0.0f, 0.0f, 0.0f, 1.0f });
    rows.Head[slot] = rows.Tail[slot] = TileRows::None;
    const int index = SampleSlab::IndexOf(slot, 0);
    slab.Value[index] = SampleSlab::Nothing;
    slab.AtBorder[index] = slab.Crossings[index] = 0.0f;
  }
  BlendSlab(slab, rows, 0, blend, rays);
  for (std::size_t i = begin; i < end; ++i)
  {
    const int slot = static_cast<int>(i - begin);
    const glm::vec4 pixel = rays.PixelOf(slot);
    RayRun& run = this->Resolved[i];
    std::copy_n(&pixel.r, 3, run.Color);
    run.Transmittance = pixel.a;
  }
}

void RunMerger::MergeToSegments(const SlabBlend& blend, double distance, RaySegments& segments)
{
  this->Sort();
  this->Resolve(blend);
  this->ForRuns(
    [&](const Element& element, const RayRun& run)
    {
      if (!run.IsEmpty())
      {
        RaySegment segment;
        segment.Begin = static_cast<double>(element.First) * distance;
        segment.Length = static_cast<float>(distance);
        std::copy_n(run.Color, 3, segment.Color);
        segment.Transmittance = run.Transmittance;
        segment.Pixel = element.Pixel;
        segments.push_back(segment);
      }
    });
  this->Elements.clear();
}

/// Calls function(element, run) for all that was merged, along each ray from the eye on.
template <class Function>
void RunMerger::ForRuns(const Function& function) const
{
  std::size_t resolved = 0;
  const Element* before = nullptr; // raw
  for (const Element& element : this->Elements)
  {
    const RayRun* run = element.Run;
    if (element.Raw)
    {
      const bool again = before && before->Pixel == element.Pixel && before->First == element.First;
      before = &element;
      if (again)
      {
        continue;
      }
      run = &this->Resolved[resolved++];
    }
    function(element, *run);
  }
}

void RunMerger::BlendPixels(const SlabBlend& blend, float limit, TilePixels& pixels) const
{
  const bool sums = blend.Projection && blend.Projection->Averages();
  pixels.fill(glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  this->ForRuns(
    [&](const Element& element, const RayRun& run)
    {
      glm::vec4& pixel = pixels[element.Pixel];
      for (int i = 0; i < 3; ++i)
      {
        if (!blend.Projection)
        {
          pixel[i] += pixel.a > limit ? pixel.a * run.Color[i] : 0.0f;
        }
        else
        {
          pixel[i] = sums ? pixel[i] + run.Color[i] : std::max(pixel[i], run.Color[i]);
        }
      }
      if (!blend.Projection && pixel.a > limit)
      {
        pixel.a *= run.Transmittance;
      }
    });
  for (glm::vec4& pixel : pixels)
  {
    pixel.a = 1.0f - pixel.a;
  }
}

} // namespace banyan
