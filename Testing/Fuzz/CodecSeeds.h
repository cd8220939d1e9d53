// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_CodecSeeds_h
#define banyan_Testing_CodecSeeds_h

#include <cstdint>
#include <vector>

namespace banyan::fuzz
{

/// Inputs of FuzzBlock: all edges, narrow and wide lattices, fields that end in a block or go on,
/// and payloads of random bytes, which tables of any kind make symbols of.
std::vector<std::vector<std::uint8_t>> BlockSeeds();

} // namespace banyan::fuzz

#endif
