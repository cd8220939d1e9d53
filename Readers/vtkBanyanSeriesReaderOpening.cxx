// SPDX-License-Identifier: BSD-3-Clause
// How all ranks open one series.
#include "SeriesReaderInternals.h"

#include "vtkErrorCode.h"
#include "vtkMultiProcessController.h"

#include "Series/Decode/SeriesFile.h"

#include <exception>

std::string vtkBanyanSeriesReader::TryToOpen()
{
  this->Self->Series.reset();
  if (!this->FileName || !*this->FileName)
  {
    return "No file name is set: set FileName to the path of a .banyan file.";
  }
  try
  {
    this->Self->Series = banyan::SeriesFile::Open(this->FileName);
    this->Self->OpenName = this->FileName;
    this->Self->Mesh.Open(this->Self->Series);
    return {};
  }
  catch (const std::exception& error)
  {
    return this->Place() + " cannot be opened as a Banyan series: " + error.what();
  }
}

bool vtkBanyanSeriesReader::OpenOnAllRanks()
{
  const std::string wanted = this->FileName ? this->FileName : "";
  // Every rank comes to the same decision here: after a failure no rank has a series.
  if (this->Self->Series && this->Self->OpenName == wanted && !this->Self->Reopen)
  {
    return true;
  }
  this->Self->Reopen = false;
  const bool named = this->FileName && *this->FileName;
  // Ranks may come before and after a series is replaced; then all of them open it again.
  constexpr int attempts = 5;
  for (int attempt = 0; attempt < attempts; ++attempt)
  {
    const std::string problem = this->TryToOpen();
    if (!this->AllRanksAreWell(
          named ? vtkErrorCode::CannotOpenFileError : vtkErrorCode::NoFileNameError, problem))
    {
      this->Self->Series.reset();
      return false;
    }
    if (this->AllRanksHaveTheSame())
    {
      return true;
    }
  }
  this->Self->Series.reset();
  this->Fail(vtkErrorCode::CannotOpenFileError,
    this->Place() +
      " cannot be opened: the ranks see different series of this name. Copy it to all "
      "machines, or to a file system that they share.");
  return false;
}

/// Collective. Whether they have opened one series, and not several of one name.
bool vtkBanyanSeriesReader::AllRanksHaveTheSame() const
{
  vtkMultiProcessController* controller = this->Self->Controller;
  if (!controller || controller->GetNumberOfProcesses() < 2)
  {
    return true;
  }
  const banyan::Hash128 mine = this->Self->Series->Fingerprint();
  vtkTypeUInt64 ofRankZero[2] = { mine.Low, mine.High };
  controller->Broadcast(ofRankZero, 2, 0);
  const int other = mine.Low != ofRankZero[0] || mine.High != ofRankZero[1] ? 1 : 0;
  int others = 0;
  controller->AllReduce(&other, &others, 1, vtkCommunicator::SUM_OP);
  return others == 0;
}
