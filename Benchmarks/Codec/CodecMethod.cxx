// SPDX-License-Identifier: BSD-3-Clause
#include "CodecMethod.h"

#include "Base/Error.h"

namespace banyan::bench
{

void EncodedSeries::DecodeBrick(int, const Box&, float*)
{
  throw Error("This method cannot decode a brick by itself.");
}

MethodList AllMethods([[maybe_unused]] std::vector<std::string>& missing)
{
  MethodList methods;
  AppendBanyanMethods(methods);
  AppendPaperMethods(methods);
  AppendZstdMethods(methods);
#ifdef BANYAN_BENCHMARK_ZFP
  AppendZfpMethods(methods);
#else
  missing.emplace_back("zfp");
#endif
#ifdef BANYAN_BENCHMARK_BLOSC
  AppendBitshuffleMethods(methods);
#else
  missing.emplace_back("bitshuffle (Blosc)");
#endif
#ifdef BANYAN_BENCHMARK_OPENVDB
  AppendOpenVdbMethods(methods);
#else
  missing.emplace_back("OpenVDB");
#endif
#ifdef BANYAN_BENCHMARK_NANOVDB
  AppendNanoVdbMethods(methods);
#else
  missing.emplace_back("NanoVDB");
#endif
  return methods;
}

} // namespace banyan::bench
