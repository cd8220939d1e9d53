// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanFrameStatistics_h
#define vtkBanyanFrameStatistics_h

#include "BanyanRenderingModule.h" // for export macro
#include "vtkObject.h"

#include <string> // for members

// clang-format off
/// The table of the statistics, in the order of the display's properties. A row has the type, the
/// name, the value before the first frame (a text is empty), and the sentence that ParaView shows.
/// CMake/BanyanTables.cmake makes ParaView's XML of it. Counts and bytes are sums over all ranks.
#define BANYAN_FRAME_STATISTICS(Number, Text)                                                      \
  Number(double, TotalSeconds, 0.0,                                                                \
    "Seconds that the last frame took, from reading back geometry to the finished picture; the "   \
    "slowest rank.")                                                                               \
  Number(double, RenderSeconds, 0.0,                                                               \
    "Seconds of casting rays (and loading bricks); the slowest rank.")                             \
  Number(double, CompositeSeconds, 0.0,                                                            \
    "Seconds of compositing the pictures of all ranks.")                                           \
  Number(double, PilotSeconds, 0.0,                                                                \
    "Seconds, before casting rays, of finding the sample distances and levels that keep the "      \
    "tolerance.")                                                                                  \
  Number(double, StrideSeconds, 0.0,                                                               \
    "Seconds, before casting rays, of finding the pixels that need none.")                         \
  Number(vtkIdType, Pilots, 0,                                                                     \
    "Small pictures that were drawn to find both.")                                                \
  Number(double, Imbalance, 1.0,                                                                   \
    "Render seconds of the slowest rank over the mean of all ranks; 1 is perfect.")                \
  Number(vtkIdType, SamplesTaken, 0,                                                               \
    "Samples interpolated, over all ranks.")                                                       \
  Number(vtkIdType, BricksDrawn, 0,                                                                \
    "Bricks whose values were needed, over all ranks.")                                            \
  Number(vtkIdType, BricksUniform, 0,                                                              \
    "Bricks of one value, which were drawn without being loaded or sampled, over all ranks.")      \
  Number(vtkIdType, BricksSkipped, 0,                                                              \
    "Bricks that could not be seen, over all ranks.")                                              \
  Number(vtkIdType, BytesComposited, 0,                                                            \
    "Bytes sent between ranks to composite the picture.")                                          \
  Number(vtkIdType, MessagesComposited, 0,                                                         \
    "Messages in which they were sent.")                                                           \
  Number(vtkIdType, BytesRead, 0,                                                                  \
    "Bytes read from series files for the last frame, over all ranks.")                            \
  Number(vtkIdType, CacheBytes, 0,                                                                 \
    "Bytes of decoded bricks held in memory, over all ranks.")                                     \
  Number(vtkIdType, PixelsReadBehind, 0,                                                           \
    "Pixels that the first rank has read back of what other props had drawn.")                     \
  Number(vtkIdType, MeshBytes, 0,                                                                  \
    "Bytes that all ranks hold of a mesh that is drawn: octree, cells, values and coarser "        \
    "meshes. What ranks of a machine have together counts once.")                                  \
  Number(vtkIdType, MeshBytesShared, 0,                                                            \
    "Of these, bytes that ranks of a machine have together.")                                      \
  Number(vtkIdType, BytesMoved, 0,                                                                 \
    "Bytes of bricks that went from one rank's zone to another's for the last frame.")             \
  Number(vtkIdType, CacheHits, 0,                                                                  \
    "Bricks that the caches of all ranks had for the last frame.")                                 \
  Number(vtkIdType, CacheMisses, 0,                                                                \
    "Bricks that had to be decoded for the last frame, over all ranks.")                           \
  Number(vtkIdType, CacheHitsAhead, 0,                                                             \
    "Of the hits, bricks that were decoded in the background before they were asked for, over "    \
    "all ranks.")                                                                                  \
  Number(double, EstimatedImageError, 0.0,                                                         \
    "The largest error that is expected of a pixel of the last frame by sampling, in 1/255, "      \
    "without the error of encoded values (Encoding Error Of Values); 0 where the sample "          \
    "distance was fixed. Image Error Limit says why it is above the tolerance.")                   \
  Text(ImageErrorLimit,                                                                            \
    "The reason why the estimated error is above the tolerance that was set, or may be too "       \
    "low, in a sentence; empty if there is none.")                                                 \
  Number(double, EncodingErrorOfValues, 0.0,                                                       \
    "The largest error that encoding has made of the drawn values, over all steps, in the "        \
    "units of the data: the estimated image error leaves it out. 0 for plain data; NaN for "       \
    "meshes, of which it is not known.")                                                           \
  Number(double, MeshDeviation, 0.0,                                                               \
    "How far the field that is drawn may be from that of a mesh of general hexahedra, as a "       \
    "part of the spread of the values around; 0 for octrees and image data, which are drawn as "   \
    "they are.")                                                                                   \
  Number(vtkIdType, Frames, 0,                                                                     \
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

#define BANYAN_NUMBER(Type, Name, Initial, Sentence)                                               \
  vtkSetMacro(Name, Type);                                                                         \
  vtkGetMacro(Name, Type);
#define BANYAN_TEXT(Name, Sentence)                                                                \
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

#define BANYAN_NUMBER(Type, Name, Initial, Sentence) Type Name = Initial;
#define BANYAN_TEXT(Name, Sentence) std::string Name;
  BANYAN_FRAME_STATISTICS(BANYAN_NUMBER, BANYAN_TEXT)
#undef BANYAN_NUMBER
#undef BANYAN_TEXT
};

#endif
