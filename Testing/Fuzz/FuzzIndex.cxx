// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Format/IndexText.h"

/// The input is the JSON of an index; every second one is taken as the whole file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  std::string text(reinterpret_cast<const char*>(data), size);
  if (size % 2 == 0)
  {
    text = "BanyanSeries 1 " + banyan::ToHex(banyan::HashOf(data, size)) + "\n" + text;
  }
  try
  {
    const banyan::SeriesIndex index = banyan::IndexFromText(text, "fuzz");
    // What was accepted must be writable, and come back.
    (void)banyan::IndexFromText(banyan::IndexToText(index), "again");
  }
  catch (const banyan::Error&)
  {
  }
  return 0;
}
