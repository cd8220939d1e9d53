// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Parallel_EveryPicture_h
#define banyan_Testing_Parallel_EveryPicture_h

#include "Parallel/Compositing.h"
#include "Parallel/LoadBalancer.h"

#include <string>

// However zones are balanced, whoever composites, and with however many threads, the picture is
// that of one rank.
namespace banyan::testing
{

/// Draws a few frames in every mode of balancing, by every method of compositing, as floats and in
/// few bits, with one thread per rank and with several, and compares all of them with those that
/// one rank with one thread draws: floats within 1e-5, few bits within 1 of 255. Collective.
/// @param iceT what composites as IceT does; none without it
/// @return what is wrong, or an empty string; only the first rank knows, and prints what it
/// compared
std::string CheckEveryPicture(Communicator& communicator, const CompositeOptions::Compositor& iceT);

} // namespace banyan::testing

#endif
