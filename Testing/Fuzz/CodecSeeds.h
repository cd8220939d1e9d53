// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_CodecSeeds_h
#define banyan_Testing_CodecSeeds_h

#include <cstdint>
#include <string>
#include <vector>

namespace banyan::fuzz
{

/// Inputs of FuzzBlock: all edges, narrow and wide lattices, fields that end in a block or go on,
/// and payloads of random bytes, which tables of any kind make symbols of.
std::vector<std::vector<std::uint8_t>> BlockSeeds();

/// Inputs of FuzzBrick: for each type and mode the shortest payload of a series of version 1.
/// @param path of its index
std::vector<std::vector<std::uint8_t>> BrickSeeds(const std::string& path);

} // namespace banyan::fuzz

#endif
