// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/TilePicture.h"

#include "Base/Varint.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Communicate/ExchangeBytes.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace banyan
{

std::vector<Bytes> ExchangeCounted(
  Communicator& communicator, std::vector<Bytes> to, const std::string& failure, SentBytes& sent)
{
  for (std::size_t rank = 0; rank < to.size(); ++rank)
  {
    const bool mine = rank == static_cast<std::size_t>(communicator.Rank());
    sent.Bytes += mine ? 0 : to[rank].size();
    sent.Messages += mine || to[rank].empty() ? 0 : 1;
  }
  return ExchangeBytes(communicator, std::move(to), failure);
}

TilePicture::TilePicture(const Communicator& communicator)
  : Tiles{ communicator.Rank(), communicator.Size() }
{
}

void TilePicture::Clear(const PixelRect& rect)
{
  this->Picture.Rect = rect;
  this->Picture.Pixels.assign(static_cast<std::size_t>(rect.Count()), glm::vec4(0.0f));
}

PixelRect TilePicture::RectOf(const glm::ivec2& tile) const
{
  const glm::ivec2 low = tile * RayTile::Edge;
  return Intersection({ low, low + RayTile::Edge }, this->Picture.Rect);
}

void TilePicture::Set(const glm::ivec2& tile, const glm::vec4* pixels)
{
  const PixelRect rect = this->RectOf(tile);
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    const glm::ivec2 at = glm::ivec2(rect.Lo.x, y) - tile * RayTile::Edge;
    std::copy_n(
      pixels + at.y * RayTile::Edge + at.x, rect.Size().x, &this->Picture.At(rect.Lo.x, y));
  }
}

/// Pixels with anything, as runs of them in rows of the picture.
void TilePicture::PutPixels(Bytes& message, const PixelRect& rect) const
{
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    int begin = rect.Lo.x;
    int end = rect.Hi.x;
    const auto isNothing = [&](int x) { return this->Picture.At(x, y) == glm::vec4(0.0f); };
    for (; begin < end && isNothing(begin); ++begin)
    {
    }
    for (; begin < end && isNothing(end - 1); --end)
    {
    }
    if (begin < end)
    {
      const int head[3] = { begin, y, end - begin };
      const auto pixels = static_cast<std::size_t>(end - begin) * sizeof(glm::vec4);
      const std::size_t at = message.size();
      message.resize(at + sizeof(head) + pixels);
      std::memcpy(message.data() + at, head, sizeof(head));
      std::memcpy(message.data() + at + sizeof(head), &this->Picture.At(begin, y), pixels);
    }
  }
}

void TilePicture::TakePixels(const Bytes& message)
{
  ByteReader in(message.data(), message.size());
  while (in.Left() > 0)
  {
    const int x = in.Number<int>();
    const int y = in.Number<int>();
    const auto pixels = static_cast<std::size_t>(in.Number<int>()) * sizeof(glm::vec4);
    std::memcpy(&this->Picture.At(x, y), in.Skip(pixels), pixels);
  }
}

Bytes TilePicture::PixelsOfMyTiles() const
{
  Bytes mine;
  const PixelRect& all = this->Picture.Rect;
  const glm::ivec2 first = all.Lo / RayTile::Edge;
  const glm::ivec2 end = (all.Hi + (RayTile::Edge - 1)) / RayTile::Edge;
  for (int y = first.y; y < end.y; ++y)
  {
    for (int x = first.x; x < end.x; ++x)
    {
      if (this->Tiles.Has({ x, y }))
      {
        this->PutPixels(mine, this->RectOf({ x, y }));
      }
    }
  }
  return mine;
}

FloatImage TilePicture::Gather(
  Communicator& communicator, int root, std::string& failure, SentBytes& sent)
{
  Bytes mine;
  Attempt(failure, [&] { mine = this->PixelsOfMyTiles(); });
  std::vector<Bytes> from;
  if (root == EveryRank)
  {
    const auto others = static_cast<std::uint64_t>(communicator.Size() - 1);
    sent.Bytes += mine.size() * others;
    sent.Messages += mine.empty() ? 0 : others;
    from = AllGatherBytes(communicator, std::move(mine), failure);
  }
  else
  {
    std::vector<Bytes> messages(static_cast<std::size_t>(communicator.Size()));
    messages[static_cast<std::size_t>(root)] = std::move(mine);
    from = ExchangeCounted(communicator, std::move(messages), failure, sent);
  }
  if (root != EveryRank && root != communicator.Rank())
  {
    return {};
  }
  for (const Bytes& message : from)
  {
    this->TakePixels(message);
  }
  return std::move(this->Picture);
}

} // namespace banyan
