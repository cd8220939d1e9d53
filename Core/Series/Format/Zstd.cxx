// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/Zstd.h"

#include "Base/Error.h"

#include <zstd.h>

#include <memory>

namespace banyan
{
namespace
{

struct FreeContext
{
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

ZSTD_CCtx* Compressor()
{
  // One per thread: making a context costs more than compressing a brick.
  thread_local std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  if (!context)
  {
    throw Error("There is no memory left for compression");
  }
  return context.get();
}

ZSTD_DCtx* Decompressor()
{
  thread_local std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  if (!context)
  {
    throw Error("There is no memory left for decompression");
  }
  return context.get();
}

} // namespace

void AppendCompressed(const std::uint8_t* data, std::size_t bytes, int level, Bytes& out)
{
  ZSTD_CCtx* context = Compressor();
  ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(context, ZSTD_c_contentSizeFlag, 0);
  ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 0);
  const std::size_t before = out.size();
  out.resize(before + ZSTD_compressBound(bytes));
  const std::size_t stored =
    ZSTD_compress2(context, out.data() + before, out.size() - before, data, bytes);
  if (ZSTD_isError(stored))
  {
    throw Error(std::string("Compression failed: ") + ZSTD_getErrorName(stored));
  }
  out.resize(before + stored);
}

void Decompress(
  const std::uint8_t* frame, std::size_t bytes, std::uint8_t* out, std::size_t expected)
{
  const std::size_t size = ZSTD_decompressDCtx(Decompressor(), out, expected, frame, bytes);
  if (ZSTD_isError(size))
  {
    throw Error(std::string("Compressed data is damaged: ") + ZSTD_getErrorName(size));
  }
  if (size != expected)
  {
    throw Error("Compressed data has the wrong size", { {}, {}, size, expected });
  }
}

} // namespace banyan
