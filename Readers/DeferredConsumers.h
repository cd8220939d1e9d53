// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_DeferredConsumers_h
#define banyan_Readers_DeferredConsumers_h

// Who is connected to a reader decides whether its arrays may decode on first touch.
//
// VTK 9.2 knows plain arrays by their type, and its dispatch passes over all others: some filters
// then do nothing, and vtkTemporalStatistics adds to the wrong array. So arrays are deferred only
// for those of whom it is known that they read such arrays, or none. All others get plain arrays.
#include "BanyanReadersModule.h" // For export macro

class vtkAlgorithm;

namespace banyan
{

/// The use that an algorithm makes of deferred arrays of its input.
enum class DeferredUse
{
  Unknown,        ///< nobody knows: it needs plain arrays
  Fine,           ///< reads them rightly, or does not look at values; its output has none of them
  HandedOn,       ///< the same, but they are in its output, too
  HandedOnIfAsked ///< the same, and nobody takes its output where nothing is connected to it
};

using DeferredJudge = DeferredUse (*)(vtkAlgorithm& consumer);

/**
 * Adds somebody who knows more algorithms than this module does: it is asked about those that the
 * others answer with Unknown. To be called while libraries are loaded, by one thread.
 */
BANYANREADERS_EXPORT void AddDeferredJudge(DeferredJudge judge);

/**
 * Whether all that is connected to an output of `producer`, directly or behind what hands arrays
 * on, can do with deferred arrays. false when nothing is connected: the output is for a program
 * that takes it by itself. The answer is the same on all ranks whose pipelines are the same.
 */
BANYANREADERS_EXPORT bool ConsumersReadDeferred(vtkAlgorithm& producer);

} // namespace banyan

#endif
