// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/BrickCodec.h"

#include <vector>

/// The input: mode, type, samples per axis, step and origin of the quantizer, then the payload.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  constexpr std::size_t head = 2 + 3 + 16;
  if (size < head)
  {
    return 0;
  }
  const auto type = static_cast<banyan::ScalarType>(data[1] % 10);
  const glm::ivec3 samples(1 + data[2] % 17, 1 + data[3] % 17, 1 + data[4] % 17);
  std::vector<std::uint64_t> out(17 * 17 * 17);
  try
  {
    const banyan::Quantizer quantizer = banyan::QuantizerFromBits(type,
      banyan::LoadNumber<std::uint64_t>(data + 5), banyan::LoadNumber<std::uint64_t>(data + 13));
    // A copy of the exact size, so that reading behind it is noticed.
    const banyan::Bytes payload(data + head, data + size);
    banyan::DecodeBrick(data[0], payload.data(), payload.size(), quantizer, type, samples,
      quantizer.Origin, out.data());
  }
  catch (const banyan::Error&)
  {
  }
  return 0;
}
