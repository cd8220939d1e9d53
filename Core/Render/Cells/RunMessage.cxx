// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/RunMessage.h"

#include "Base/Error.h"
#include "Base/Varint.h"

namespace banyan
{
namespace
{

// What a raw interval has.
constexpr unsigned IsClaimed = 1;
constexpr unsigned IsCrossed = 2;
constexpr unsigned IsPart = 4;
constexpr unsigned IsShaded = 8;
constexpr unsigned Enters = 16;
constexpr unsigned Leaves = 32;

void PutFloat(Bytes& out, float number)
{
  const std::size_t at = out.size();
  out.resize(at + sizeof(number));
  StoreNumber(out.data() + at, number);
}

void PutNumber(Bytes& out, std::uint64_t number)
{
  const std::size_t at = out.size();
  out.resize(at + sizeof(number));
  StoreNumber(out.data() + at, number);
}

/// Counts along rays, from one element to the next.
struct Place
{
  std::uint16_t Pixel = 0;
  std::int64_t Number = 0;

  void Put(Bytes& out, std::uint16_t pixel, std::int64_t number)
  {
    PutVarint(out, static_cast<std::uint64_t>(pixel - this->Pixel));
    PutSigned(out, number - this->Number);
    *this = { pixel, number };
  }

  void Take(ByteReader& in)
  {
    const std::uint64_t pixels = in.Varint();
    if (pixels >= static_cast<std::uint64_t>(RayTile::Slots - this->Pixel))
    {
      throw Error("A message of runs has a pixel outside of its tile");
    }
    this->Pixel = static_cast<std::uint16_t>(this->Pixel + pixels);
    // Wraps around in place of overflowing.
    this->Number = static_cast<std::int64_t>(
      static_cast<std::uint64_t>(this->Number) + static_cast<std::uint64_t>(in.Signed()));
  }
};

float TakeFloat(ByteReader& in)
{
  const float number = in.Number<float>();
  if (!std::isfinite(number))
  {
    throw Error("A message of runs has a number that is not finite");
  }
  return number;
}

void PutRun(Bytes& out, Place& place, const RayRun& run)
{
  place.Put(out, run.Pixel, run.First);
  // Runs that show nothing count too: nobody else has their samples.
  PutVarint(out, static_cast<std::uint64_t>(run.Last - run.First) << 1 | (run.IsEmpty() ? 1 : 0));
  place.Number = run.Last;
  if (!run.IsEmpty())
  {
    for (const float color : run.Color)
    {
      PutFloat(out, color);
    }
    PutFloat(out, run.Transmittance);
  }
}

RayRun TakeRun(ByteReader& in, Place& place)
{
  place.Take(in);
  RayRun run;
  run.Pixel = place.Pixel;
  run.First = place.Number;
  const std::uint64_t length = in.Varint();
  run.Last = static_cast<std::int64_t>(static_cast<std::uint64_t>(run.First) + (length >> 1));
  place.Number = run.Last;
  if (run.Last < run.First)
  {
    throw Error("A message of runs has one that is too long");
  }
  if ((length & 1) == 0)
  {
    for (float& color : run.Color)
    {
      color = TakeFloat(in);
    }
    run.Transmittance = TakeFloat(in);
  }
  return run;
}

unsigned KindOf(const RawInterval& raw)
{
  const CrossingSums& crossed = raw.Crossed;
  return (raw.Claimed ? IsClaimed : 0) | (crossed.Count > 0.0f ? IsCrossed : 0) |
         (raw.Length != 1.0f ? IsPart : 0) |
         (raw.Cosine != 0.0f || crossed.CosineAtBorder != 0.0f ? IsShaded : 0) |
         (crossed.NearestEnters > 0.0f ? Enters : 0) | (crossed.NearestEnters < 0.0f ? Leaves : 0);
}

void PutRaw(Bytes& out, Place& place, const RawInterval& raw)
{
  place.Put(out, raw.Pixel, raw.Number);
  const unsigned kind = KindOf(raw);
  out.push_back(static_cast<std::uint8_t>(kind));
  if ((kind & IsPart) != 0)
  {
    PutFloat(out, raw.Length);
  }
  if ((kind & IsClaimed) != 0)
  {
    PutNumber(out, raw.Key.Place);
    PutNumber(out, raw.Key.Hash);
    PutFloat(out, raw.Value);
    if ((kind & IsShaded) != 0)
    {
      PutFloat(out, raw.Cosine);
    }
  }
  if ((kind & IsCrossed) != 0)
  {
    const CrossingSums& crossed = raw.Crossed;
    PutFloat(out, crossed.Change);
    PutFloat(out, crossed.AtBorder);
    PutFloat(out, crossed.Nearest);
    if ((kind & IsShaded) != 0)
    {
      PutFloat(out, crossed.CosineAtBorder);
    }
    for (const float whole : { crossed.Count, crossed.Before, crossed.Behind })
    {
      PutSigned(out, static_cast<std::int64_t>(whole));
    }
  }
}

/// A count of crossings: more than floats count are none.
float TakeCount(ByteReader& in)
{
  constexpr std::int64_t most = 1 << 24;
  const std::int64_t count = in.Signed();
  if (count < -most || count > most)
  {
    throw Error("A message of runs has too many crossings");
  }
  return static_cast<float>(count);
}

RawInterval TakeRaw(ByteReader& in, Place& place)
{
  place.Take(in);
  RawInterval raw;
  raw.Pixel = place.Pixel;
  raw.Number = place.Number;
  const unsigned kind = in.Byte();
  raw.Length = (kind & IsPart) != 0 ? TakeFloat(in) : 1.0f;
  raw.Claimed = (kind & IsClaimed) != 0;
  if (raw.Claimed)
  {
    raw.Key.Place = in.Number<std::uint64_t>();
    raw.Key.Hash = in.Number<std::uint64_t>();
    raw.Value = TakeFloat(in);
    raw.Cosine = (kind & IsShaded) != 0 ? TakeFloat(in) : 0.0f;
  }
  if ((kind & IsCrossed) != 0)
  {
    CrossingSums& crossed = raw.Crossed;
    crossed.Change = TakeFloat(in);
    crossed.AtBorder = TakeFloat(in);
    crossed.Nearest = TakeFloat(in);
    crossed.CosineAtBorder = (kind & IsShaded) != 0 ? TakeFloat(in) : 0.0f;
    crossed.Count = TakeCount(in);
    crossed.Before = TakeCount(in);
    crossed.Behind = TakeCount(in);
    crossed.NearestEnters = (kind & Enters) != 0 ? 1.0f : (kind & Leaves) != 0 ? -1.0f : 0.0f;
  }
  return raw;
}

void PutPosition(Bytes& out, const glm::ivec2& position)
{
  PutVarint(out, static_cast<std::uint64_t>(position.x));
  PutVarint(out, static_cast<std::uint64_t>(position.y));
}

glm::ivec2 TakePosition(ByteReader& in)
{
  constexpr std::uint64_t most = 1 << 24;
  const std::uint64_t x = in.Varint();
  const std::uint64_t y = in.Varint();
  if (x > most || y > most)
  {
    throw Error("A message of runs has a tile outside of all pictures");
  }
  return { static_cast<int>(x), static_cast<int>(y) };
}

/// @param least bytes that an element takes
std::size_t TakeSize(ByteReader& in, std::size_t least)
{
  const std::uint64_t size = in.Varint();
  if (size > in.Left() / least)
  {
    throw Error("A message of runs is shorter than it says");
  }
  return static_cast<std::size_t>(size);
}

} // namespace

void PutRuns(Bytes& message, const TileRuns& runs)
{
  if (runs.Runs.empty() && runs.Raw.empty())
  {
    return;
  }
  PutPosition(message, runs.Position);
  PutVarint(message, runs.Runs.size());
  PutVarint(message, runs.Raw.size());
  Place place;
  for (const RayRun& run : runs.Runs)
  {
    PutRun(message, place, run);
  }
  place = {};
  for (const RawInterval& raw : runs.Raw)
  {
    PutRaw(message, place, raw);
  }
}

std::vector<TileRuns> TakeRuns(const std::uint8_t* message, std::size_t bytes)
{
  ByteReader in(message, bytes);
  std::vector<TileRuns> tiles;
  while (in.Left() > 0)
  {
    TileRuns& tile = tiles.emplace_back();
    tile.Position = TakePosition(in);
    tile.Runs.resize(TakeSize(in, 3));
    tile.Raw.resize(TakeSize(in, 3));
    Place place;
    for (RayRun& run : tile.Runs)
    {
      run = TakeRun(in, place);
    }
    place = {};
    for (RawInterval& raw : tile.Raw)
    {
      raw = TakeRaw(in, place);
    }
  }
  return tiles;
}

void PutAsked(Bytes& message, const AskedTile& asked)
{
  PutPosition(message, asked.Position);
  PutVarint(message, asked.Intervals.size());
  Place place;
  for (const AskedIntervals& intervals : asked.Intervals)
  {
    place.Put(message, intervals.Pixel, intervals.First);
    PutVarint(message, static_cast<std::uint64_t>(intervals.Last - intervals.First));
  }
}

std::vector<AskedTile> TakeAsked(const std::uint8_t* message, std::size_t bytes)
{
  ByteReader in(message, bytes);
  std::vector<AskedTile> tiles;
  while (in.Left() > 0)
  {
    AskedTile& tile = tiles.emplace_back();
    tile.Position = TakePosition(in);
    tile.Intervals.resize(TakeSize(in, 3));
    Place place;
    for (AskedIntervals& intervals : tile.Intervals)
    {
      place.Take(in);
      intervals.Pixel = place.Pixel;
      intervals.First = place.Number;
      intervals.Last =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(place.Number) + in.Varint());
    }
  }
  return tiles;
}

} // namespace banyan
