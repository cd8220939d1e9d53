// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/ScalarType.h"
#include "Fuzz.h"
#include "Series/Format/Exceptions.h"

#include <cstdlib>

/// The input: type, size of the block, then the payload.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  banyan::fuzz::Input in(data, size);
  const auto type = static_cast<banyan::ScalarType>(in.Take<std::uint8_t>() % 10);
  const std::uint32_t edge = 16u << in.Take<std::uint8_t>() % 2;
  const std::uint32_t samples = edge * edge * edge;
  const banyan::Bytes payload = in.Rest();
  banyan::Dispatch(type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      try
      {
        const auto list = banyan::UnpackExceptions<T>(payload.data(), payload.size(), samples);
        // What was accepted fits, is written again, and comes back.
        const banyan::Bytes packed = banyan::PackExceptions(list, samples, 1);
        const auto back = banyan::UnpackExceptions<T>(packed.data(), packed.size(), samples);
        if (back.Positions != list.Positions || list.Values.size() != list.Positions.size() ||
            (!list.Positions.empty() && list.Positions.back() >= samples) ||
            (!list.Values.empty() && std::memcmp(back.Values.data(), list.Values.data(),
                                       list.Values.size() * sizeof(T)) != 0))
        {
          std::abort();
        }
      }
      catch (const banyan::Error&)
      {
      }
    });
  return 0;
}
