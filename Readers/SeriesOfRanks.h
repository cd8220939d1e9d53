// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_SeriesOfRanks_h
#define banyan_Readers_SeriesOfRanks_h

#include "Parallel/Communicate/Communicator.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <memory>
#include <string>

class vtkMultiProcessController;

namespace banyan
{

class SeriesFile;

/// The series that the ranks of a controller have open: the same one on all of them, or none.
class SeriesOfRanks
{
public:
  SeriesOfRanks();
  ~SeriesOfRanks();

  /// @param controller null for this rank alone; the global one is there from the start
  void SetController(vtkMultiProcessController* controller);
  vtkMultiProcessController* Controller() const { return this->Given; }

  /// The ranks of the controller. Collective when it is called first, and after SetController.
  Communicator& Ranks();

  /// Collective, unless IsOpen. After an error no rank has a series.
  /// @param name of the index file; null or empty where none is set
  /// @param cacheBytes for CacheContext::WithBudget; the same on all ranks
  /// Throws CollectiveError.
  void Open(const char* name, std::int64_t cacheBytes);

  /// Whether that file has been opened with these caches, and not to be opened again. The same on
  /// all ranks.
  bool IsOpen(const char* name, std::int64_t cacheBytes) const;

  /// Makes the next Open() open the file again.
  void OpenAgain() { this->Again = true; }

  /// Null when none is open.
  const std::shared_ptr<const SeriesFile>& Series() const { return this->File; }

private:
  bool AllHaveTheSame();

  vtkSmartPointer<vtkMultiProcessController> Given;
  std::unique_ptr<Communicator> Talk; ///< null until it is needed
  std::shared_ptr<const SeriesFile> File;
  std::string OpenName; ///< that File was opened from
  bool Again = false;
};

} // namespace banyan

#endif
