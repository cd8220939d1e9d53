// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanFrameStatistics_h
#define vtkBanyanFrameStatistics_h

#include "BanyanRenderingModule.h" // for export macro
#include "vtkObject.h"

#include <string> // for members

// clang-format off
/// The table of the statistics, in the order of the display's properties. A row has the type, the
/// name, the value before the first frame (a text is empty), who sees it (the panel's group "Last
/// Frame" and scripts, or scripts alone), and the sentence that ParaView shows.
/// CMake/BanyanTables.cmake makes ParaView's XML of it. Counts and bytes are sums over all ranks.
#define BANYAN_FRAME_STATISTICS(Number, Text)                                                      \
  Number(double, TotalSeconds, 0.0, panel,                                                         \
    "Seconds of the last frame, from reading back geometry to the finished picture. Slowest "      \
    "rank.")                                                                                       \
  Number(double, RenderSeconds, 0.0, script,                                                       \
    "Seconds of casting rays, loading bricks included. Slowest rank.")                             \
  Number(double, CompositeSeconds, 0.0, script,                                                    \
    "Seconds of compositing the pictures of all ranks.")                                           \
  Number(double, ProbeSeconds, 0.0, script,                                                        \
    "Seconds before casting rays: finding the sample distances and levels that keep the "          \
    "tolerance.")                                                                                  \
  Number(double, StrideSeconds, 0.0, script,                                                       \
    "Seconds before casting rays: finding the pixels that need no rays.")                          \
  Number(vtkIdType, Probes, 0, script,                                                             \
    "Number of small pictures drawn for Probe Seconds and Stride Seconds.")                        \
  Number(double, Imbalance, 1.0, panel,                                                            \
    "Render seconds of the slowest rank, divided by the mean over all ranks. 1 is perfect.")       \
  Number(double, ReusedFraction, 0.0, script,                                                      \
    "The part of the picture that came from earlier frames: 1 for a scene that was drawn "         \
    "before.")                                                                                     \
  Number(vtkIdType, Threads, 0, script,                                                            \
    "Threads that cast rays and decoded, over all ranks.")                                         \
  Number(vtkIdType, SamplesTaken, 0, script,                                                       \
    "Interpolated samples, sum over all ranks.")                                                   \
  Number(vtkIdType, BricksDrawn, 0, panel,                                                         \
    "Bricks whose values were needed, sum over all ranks.")                                        \
  Number(vtkIdType, BricksUniform, 0, script,                                                      \
    "Bricks of one value, drawn without loading or sampling, sum over all ranks.")                 \
  Number(vtkIdType, BricksSkipped, 0, script,                                                      \
    "Invisible bricks, sum over all ranks.")                                                       \
  Number(vtkIdType, BytesComposited, 0, script,                                                    \
    "Bytes sent between ranks to composite the picture.")                                          \
  Number(vtkIdType, MessagesComposited, 0, script,                                                 \
    "Messages sent between ranks to composite the picture.")                                       \
  Number(vtkIdType, BytesRead, 0, panel,                                                           \
    "Bytes read from series files for the last frame, sum over all ranks.")                        \
  Number(vtkIdType, CacheBytes, 0, panel,                                                          \
    "Bytes of decoded bricks in memory, sum over all ranks.")                                      \
  Number(vtkIdType, PictureBytes, 0, script,                                                       \
    "Bytes of pictures that the first rank keeps for scenes that come again.")                     \
  Number(vtkIdType, PixelsReadBehind, 0, script,                                                   \
    "Pixels that the first rank has read back of what other props had drawn.")                     \
  Number(vtkIdType, MeshBytes, 0, script,                                                          \
    "Bytes of a drawn mesh in memory: octree, cells, values and coarser meshes. Sum over "         \
    "all ranks; memory that ranks of a machine share counts once.")                                \
  Number(vtkIdType, MeshBytesShared, 0, script,                                                    \
    "The part of Mesh Bytes in memory that ranks of a machine share.")                             \
  Number(vtkIdType, BytesMoved, 0, script,                                                         \
    "Bytes of bricks that changed from the zone of one rank to that of another before the "        \
    "last frame.")                                                                                 \
  Number(vtkIdType, CacheHits, 0, script,                                                          \
    "Bricks that the caches held for the last frame, sum over all ranks.")                         \
  Number(vtkIdType, CacheMisses, 0, script,                                                        \
    "Bricks that had to be decoded, or fetched from another rank, for the last frame. Sum "        \
    "over all ranks.")                                                                             \
  Number(vtkIdType, CacheHitsAhead, 0, script,                                                     \
    "Cache hits that were decoded in the background before they were needed, sum over all "        \
    "ranks.")                                                                                      \
  Number(double, EstimatedImageError, 0.0, panel,                                                  \
    "Estimated largest error of a pixel by sampling, in 1/255. Errors of encoding are not "        \
    "part of it (Encoding Error Of Values). 0 with a fixed sample distance.")                      \
  Number(vtkIdType, PictureIsExact, 1, script,                                                     \
    "1 for a picture that keeps the tolerance of still ones; 0 for one that was drawn while the "  \
    "camera moved, or that stands for one that is still being drawn (Decoupled).")                 \
  Text(ImageErrorLimit, panel,                                                                     \
    "The reason why the estimated error exceeds the tolerance, or may be too low, as a "           \
    "sentence. Empty if there is none.")                                                           \
  Number(double, EncodingErrorOfValues, 0.0, panel,                                                \
    "Largest error of the drawn values by encoding, over all steps, in the units of the "          \
    "data. 0 for plain data; NaN for meshes, where it is not known.")                              \
  Number(vtkIdType, Frames, 0, script,                                                             \
    "Frames drawn since the representation was made.")
// clang-format on

/**
 * @class vtkBanyanFrameStatistics
 * @brief what the last frame took, over all ranks
 *
 * Filled by vtkBanyanVolumeMapper after each frame. Sums over ranks, except the seconds, which are
 * those of the slowest rank. In client-server an object of this class lives on the render server,
 * whose root answers for all ranks.
 */
class BANYANRENDERING_EXPORT vtkBanyanFrameStatistics : public vtkObject
{
public:
  static vtkBanyanFrameStatistics* New();
  vtkTypeMacro(vtkBanyanFrameStatistics, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

#define BANYAN_NUMBER(Type, Name, Initial, Where, Sentence)                                        \
  vtkSetMacro(Name, Type);                                                                         \
  vtkGetMacro(Name, Type);
#define BANYAN_TEXT(Name, Where, Sentence)                                                         \
  vtkSetStdStringFromCharMacro(Name);                                                              \
  vtkGetCharFromStdStringMacro(Name);
  BANYAN_FRAME_STATISTICS(BANYAN_NUMBER, BANYAN_TEXT)
#undef BANYAN_NUMBER
#undef BANYAN_TEXT

protected:
  vtkBanyanFrameStatistics() = default;
  ~vtkBanyanFrameStatistics() override = default;

private:
  vtkBanyanFrameStatistics(const vtkBanyanFrameStatistics&) = delete;
  void operator=(const vtkBanyanFrameStatistics&) = delete;

#define BANYAN_NUMBER(Type, Name, Initial, Where, Sentence) Type Name = Initial;
#define BANYAN_TEXT(Name, Where, Sentence) std::string Name;
  BANYAN_FRAME_STATISTICS(BANYAN_NUMBER, BANYAN_TEXT)
#undef BANYAN_NUMBER
#undef BANYAN_TEXT
};

#endif
