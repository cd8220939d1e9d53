// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_SymbolWriter_h
#define banyan_Codec_SymbolWriter_h

#include "Codec/DecodeTables.h"
#include "Codec/Residual.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

/// How often each symbol came in each context.
struct ContextCounts
{
  std::array<std::array<std::uint32_t, tans::SymbolCount>, residual::ContextCount> Of = {};

  /// @param tokens residual::TokenOf(context, symbol)
  void Add(const std::vector<std::uint16_t>& tokens);
  void Add(const ContextCounts& other);
  /// Makes one context of all those of a band: see AblationSwitches.
  void ForgetClasses();
};

/// The tables of all contexts, for writing.
class SymbolTables
{
public:
  /// @param share whether contexts that are alike have one table where that is smaller
  explicit SymbolTables(const ContextCounts& counts, bool share = true);

  const std::vector<tans::Frequencies>& Frequencies() const { return this->Of; }

  /// The payload that SymbolReader reads. The counts must have held all tokens.
  /// @param extra one number per symbol with extra bits
  /// @param runs how many symbols each run has; their sum is the number of tokens
  std::vector<std::uint8_t> Encode(const std::vector<std::uint16_t>& tokens,
    const std::vector<std::uint32_t>& extra, const std::vector<std::uint16_t>& runs) const;

private:
  /// How a symbol goes into a state: FSE's way, one subtraction and one look-up.
  struct Transform
  {
    std::uint32_t DeltaBits = 0; ///< (state + DeltaBits) >> 16 is the number of bits to write
    std::int32_t DeltaState = 0; ///< (state >> bits) + DeltaState is the place in Next
  };
  struct Backwards;
  void AddTable(std::size_t context);
  template <int Lanes>
  static void Write(Backwards& to, const std::vector<std::uint16_t>& tokens,
    const std::vector<std::uint32_t>& extra, const std::vector<std::uint16_t>& runs);
  int LanesLogFor(const std::vector<std::uint16_t>& tokens) const;

  std::vector<tans::Frequencies> Of;
  std::vector<Transform> Transforms; ///< by token
  std::vector<std::uint16_t> Next;   ///< states of all tables; contexts that are alike have one
};

/// Frequencies of all contexts as bytes, and back. Throws Error when the bytes are not valid.
std::vector<std::uint8_t> PackFrequencies(const std::vector<tans::Frequencies>& frequencies);
std::vector<tans::Frequencies> UnpackFrequencies(const std::uint8_t* data, std::size_t bytes);

DecodeTables DecodeTablesOf(const std::vector<tans::Frequencies>& frequencies);

} // namespace banyan

#endif
