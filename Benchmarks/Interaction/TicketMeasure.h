// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Interaction_TicketMeasure_h
#define banyan_Benchmarks_Interaction_TicketMeasure_h

#include "BenchScene.h"
#include "TicketMeter.h"

#include "Parallel/Fields/DistributedField.h"

#include <vector>

namespace banyan::bench
{

struct TicketOptions
{
  int Views = 30;             ///< of an orbit
  double ViewDegrees = 7.0;   ///< between two of them
  bool Plans = true;          ///< otherwise a sample per voxel is taken, and no probe is drawn
  int DragTickets = 50;       ///< of a drag, a degree and a half apart; 0 for none
  double DragSeconds = 0.040; ///< between two of them
  bool OneProcess = false;    ///< whether all ranks are threads of this process
  LoadBalancing Balancing = LoadBalancing::MeasuredCost;
};

/// What happens while somebody drags the scene. Times are those of the first rank.
struct DragTook
{
  int Tickets = 0;
  std::vector<double> CoarseMilliseconds; ///< from a ticket to its picture; of those that had one
  std::vector<double> StopMilliseconds;   ///< from a ticket until nothing of the one before is done
  double ExactMilliseconds = 0.0;         ///< from the last ticket to its exact picture
};

struct TicketsTook
{
  std::vector<PictureTook> Synchronous; ///< FieldFrames::Draw, of each view
  std::vector<PictureTook> Late;        ///< LateFramesOfRanks, until the exact picture
  DragTook Drag;
};

/// Collective: draws views of a scene as a client asks for them, and directly. Shared pool of
/// threads: ThreadPool::Process.
/// @param scene whose volume each process has
/// Throws Error when a picture takes anything from an earlier one, which makes it no measurement;
/// and when the two ways give pictures that differ by more than 1/255.
TicketsTook MeasureTickets(
  Communicator& ranks, const BenchScene& scene, const TicketOptions& options);

/// The smallest value that a part of all are not above: 0.5 for the median. 0 for none.
double QuantileOf(std::vector<double> values, double part);

} // namespace banyan::bench

#endif
