// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/KeptPictures.h"

#include "Base/Digest.h"

#include <algorithm>
#include <iterator>

namespace banyan
{

namespace
{

/// A hash of what lies at some levels.
Hash128 ContentAt(const std::set<int>& levels, const std::vector<Hash128>& content)
{
  Digest digest;
  for (const int level : levels)
  {
    digest.Add(content[std::min(static_cast<std::size_t>(level), content.size() - 1)]);
  }
  return digest.Get();
}

} // namespace

template <class Predicate>
void KeptPictures::LetGoIf(Predicate&& predicate)
{
  this->Items.remove_if(
    [&](const Item& item)
    {
      const bool goes = predicate(item);
      this->HeldBytes -= goes ? item.Bytes : 0;
      return goes;
    });
}

KeptPictures::~KeptPictures()
{
  this->Clear();
}

void KeptPictures::KeepIn(const std::shared_ptr<CacheContext>& caches)
{
  if (caches == this->Caches)
  {
    return;
  }
  this->LetGoIf([](const Item&) { return true; });
  if (this->Caches)
  {
    --this->Caches->PictureKeepers();
  }
  this->Caches = caches;
  if (this->Caches)
  {
    ++this->Caches->PictureKeepers();
  }
}

const DrawnPicture* KeptPictures::Find(
  const Hash128& scene, const std::vector<Hash128>& content, const Quality& wanted)
{
  const auto found = std::find_if(this->Items.begin(), this->Items.end(),
    [&](const Item& item)
    {
      return item.Scene == scene && item.How.Coarseness <= wanted.Coarseness &&
             (wanted.Interacting || !item.How.Interacting) &&
             item.Content == ContentAt(item.Levels, content);
    });
  if (found == this->Items.end())
  {
    return nullptr;
  }
  this->Items.splice(this->Items.begin(), this->Items, found);
  return &this->Items.front().Picture;
}

/// Of a full store: the least recently used one of other scenes, else the middle one.
std::list<KeptPictures::Item>::iterator KeptPictures::NextToGo(const Hash128& scene)
{
  for (auto item = this->Items.end(); item != this->Items.begin();)
  {
    if ((--item)->Scene != scene)
    {
      return item;
    }
  }
  return std::next(this->Items.begin(), static_cast<std::ptrdiff_t>(this->Items.size() / 2));
}

void KeptPictures::Keep(const Hash128& scene, const std::vector<Hash128>& content,
  const std::set<int>& levels, const Quality& quality, const DrawnPicture& picture)
{
  const Hash128 at = ContentAt(levels, content);
  this->LetGoIf(
    [&](const Item& item)
    {
      return item.How.Interacting || (item.Scene == scene && !quality.Interacting &&
                                       item.Content == ContentAt(item.Levels, content));
    });
  const std::uint64_t budget =
    this->Caches ? this->Caches->PictureBudgetBytes() /
                     static_cast<std::uint64_t>(this->Caches->PictureKeepers().load())
                 : 0;
  constexpr std::uint64_t least = 4096; // pictures without pixels go, too, when others come
  const std::uint64_t bytes =
    std::max<std::uint64_t>(least, picture.Pixels->Pixels.size() * sizeof(glm::vec4));
  if (bytes > budget)
  {
    return;
  }
  while (this->HeldBytes + bytes > budget)
  {
    const auto goes = this->NextToGo(scene);
    this->HeldBytes -= goes->Bytes;
    this->Items.erase(goes);
  }
  this->Items.push_front({ scene, at, levels, quality, picture, bytes });
  this->HeldBytes += bytes;
}

} // namespace banyan
