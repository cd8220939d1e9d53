// SPDX-License-Identifier: BSD-3-Clause
#include "SeriesOfRanks.h"

#include "CommunicatorOf.h"

#include "Base/Hash.h"
#include "Parallel/Communicate/Collective.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Decode/SeriesFile.h"

#include "vtkMultiProcessController.h"

#include <utility>

namespace banyan
{
namespace
{

/// @param name null or empty where none is set
std::shared_ptr<const SeriesFile> OpenFile(const char* name, std::int64_t cacheBytes)
{
  if (!name || !*name)
  {
    throw Error("No file name is set: set FileName to the path of a .banyan file.");
  }
  try
  {
    return SeriesFile::Open(name, CacheContext::WithBudget(cacheBytes));
  }
  catch (const std::exception& error)
  {
    throw Error(std::string(name) + " cannot be opened as a Banyan series: " + error.what());
  }
}

} // namespace

SeriesOfRanks::SeriesOfRanks()
  : Given(vtkMultiProcessController::GetGlobalController())
{
}

SeriesOfRanks::~SeriesOfRanks() = default;

void SeriesOfRanks::SetController(vtkMultiProcessController* controller)
{
  if (this->Given != controller)
  {
    this->Given = controller;
    this->Talk.reset();
  }
}

Communicator& SeriesOfRanks::Ranks()
{
  if (!this->Talk)
  {
    this->Talk = CommunicatorOf(this->Given);
  }
  return *this->Talk;
}

bool SeriesOfRanks::IsOpen(const char* name, std::int64_t cacheBytes) const
{
  return this->File && !this->Again && this->OpenName == (name ? name : "") &&
         this->File->Caches()->OwnBudgetBytes() == cacheBytes;
}

void SeriesOfRanks::Open(const char* name, std::int64_t cacheBytes)
{
  // Every rank comes to the same decision here: after a failure no rank has a series.
  if (this->IsOpen(name, cacheBytes))
  {
    return;
  }
  this->Again = false;
  // Ranks may come before and after a series is replaced; then all of them open it again.
  constexpr int attempts = 5;
  for (int attempt = 0; attempt < attempts; ++attempt)
  {
    this->File.reset();
    std::shared_ptr<const SeriesFile> opened;
    Collective(this->Ranks(), [&] { opened = OpenFile(name, cacheBytes); });
    this->File = std::move(opened);
    this->OpenName = name;
    if (this->AllHaveTheSame())
    {
      return;
    }
  }
  this->File.reset();
  throw CollectiveError(std::string(name) +
                        " cannot be opened: the ranks see different series of this name. Copy it "
                        "to all machines, or to a file system that they share.");
}

/// Collective. Whether they have opened one series, and not several of one name.
bool SeriesOfRanks::AllHaveTheSame()
{
  const Hash128 mine = this->File->Fingerprint();
  Hash128 ofRankZero = mine;
  this->Ranks().Broadcast(0, &ofRankZero, sizeof(ofRankZero));
  return AllMax(this->Ranks(), mine == ofRankZero ? 0.0 : 1.0) == 0.0;
}

} // namespace banyan
