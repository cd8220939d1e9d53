// SPDX-License-Identifier: BSD-3-Clause
#ifndef vtkBanyanFrameStatistics_h
#define vtkBanyanFrameStatistics_h

#include "BanyanRenderingModule.h" // for export macro
#include "vtkObject.h"

#include <string> // for ImageErrorLimit

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

  ///@{
  /// Wall-clock seconds of the slowest rank: the whole frame, casting rays, compositing.
  vtkSetMacro(TotalSeconds, double);
  vtkGetMacro(TotalSeconds, double);
  vtkSetMacro(RenderSeconds, double);
  vtkGetMacro(RenderSeconds, double);
  vtkSetMacro(CompositeSeconds, double);
  vtkGetMacro(CompositeSeconds, double);
  ///@}

  ///@{
  /// What it took, before casting rays, to find out how to sample within the tolerance: for
  /// distances and levels, for pixels that need no rays, and how many small pictures were drawn for
  /// both. 0 where nothing has to be found out.
  vtkSetMacro(PilotSeconds, double);
  vtkGetMacro(PilotSeconds, double);
  vtkSetMacro(StrideSeconds, double);
  vtkGetMacro(StrideSeconds, double);
  vtkSetMacro(Pilots, vtkIdType);
  vtkGetMacro(Pilots, vtkIdType);
  ///@}

  ///@{
  /// Render seconds of the slowest rank over the mean of all ranks; 1 is perfect.
  vtkSetMacro(Imbalance, double);
  vtkGetMacro(Imbalance, double);
  ///@}

  ///@{
  /// Samples of the field that were interpolated.
  vtkSetMacro(SamplesTaken, vtkIdType);
  vtkGetMacro(SamplesTaken, vtkIdType);
  ///@}

  ///@{
  /// Bricks whose values were needed, bricks of one value, which are drawn without being loaded or
  /// sampled, and bricks left out (invisible under the transfer function, or off screen).
  vtkSetMacro(BricksDrawn, vtkIdType);
  vtkGetMacro(BricksDrawn, vtkIdType);
  vtkSetMacro(BricksUniform, vtkIdType);
  vtkGetMacro(BricksUniform, vtkIdType);
  vtkSetMacro(BricksSkipped, vtkIdType);
  vtkGetMacro(BricksSkipped, vtkIdType);
  ///@}

  ///@{
  /// Bytes sent between ranks to make one picture of all, read from series files for this frame,
  /// and held by the brick caches now.
  vtkSetMacro(BytesComposited, vtkIdType);
  vtkGetMacro(BytesComposited, vtkIdType);
  /// In so many messages.
  vtkSetMacro(MessagesComposited, vtkIdType);
  vtkGetMacro(MessagesComposited, vtkIdType);
  vtkSetMacro(BytesRead, vtkIdType);
  vtkGetMacro(BytesRead, vtkIdType);
  vtkSetMacro(CacheBytes, vtkIdType);
  vtkGetMacro(CacheBytes, vtkIdType);
  ///@}

  ///@{
  /// Pixels that each rank has read back of what other props had drawn.
  vtkSetMacro(PixelsReadBehind, vtkIdType);
  vtkGetMacro(PixelsReadBehind, vtkIdType);
  ///@}

  ///@{
  /// Bytes that all ranks hold of a mesh of hexahedra that is drawn: its octree, its cells where
  /// they were gathered from several ranks, what it is sampled at, coarser meshes, and values. What
  /// ranks of a machine have together counts once for each machine: that is MeshBytesShared of it.
  /// What the pipeline holds does not count.
  vtkSetMacro(MeshBytes, vtkIdType);
  vtkGetMacro(MeshBytes, vtkIdType);
  vtkSetMacro(MeshBytesShared, vtkIdType);
  vtkGetMacro(MeshBytesShared, vtkIdType);
  ///@}

  ///@{
  /// Bytes of bricks that went from one rank's zone to another's for this frame, and bricks that
  /// the caches had and had not.
  vtkSetMacro(BytesMoved, vtkIdType);
  vtkGetMacro(BytesMoved, vtkIdType);
  vtkSetMacro(CacheHits, vtkIdType);
  vtkGetMacro(CacheHits, vtkIdType);
  vtkSetMacro(CacheMisses, vtkIdType);
  vtkGetMacro(CacheMisses, vtkIdType);
  /// Of the hits, those that were decoded in the background before anybody asked for them.
  vtkSetMacro(CacheHitsAhead, vtkIdType);
  vtkGetMacro(CacheHitsAhead, vtkIdType);
  ///@}

  ///@{
  /// The largest error that is expected of a pixel, in 1/255 of a channel, by sampling: against the
  /// integral over the values that are drawn, without the error of their encoding. 0 where the
  /// sample distance was fixed. Estimated.
  vtkSetMacro(EstimatedImageError, double);
  vtkGetMacro(EstimatedImageError, double);
  /// Sentences: what keeps EstimatedImageError above the tolerance that was set, or what it may
  /// have missed. Empty if nothing.
  vtkSetStdStringFromCharMacro(ImageErrorLimit);
  vtkGetCharFromStdStringMacro(ImageErrorLimit);
  /// The largest error of the drawn values that encoding them has made, over all steps, as it was
  /// measured then; in the units of the data. Its effect on the picture is not estimated:
  /// Documentation/accuracy.md says what it does usually. 0 for plain data. NaN for meshes, of
  /// which it is not known here.
  vtkSetMacro(EncodingErrorOfValues, double);
  vtkGetMacro(EncodingErrorOfValues, double);
  ///@}

  ///@{
  /// How far the field that is drawn may be from that of a mesh of general hexahedra, at the points
  /// that were looked at: a part of the spread of the values around (banyan::CubeDeviation). 0 for
  /// meshes that are octrees, and for image data: they are drawn as they are.
  vtkSetMacro(MeshDeviation, double);
  vtkGetMacro(MeshDeviation, double);
  ///@}

  ///@{
  /// Frames drawn since the object was made.
  vtkSetMacro(Frames, vtkIdType);
  vtkGetMacro(Frames, vtkIdType);
  ///@}

protected:
  vtkBanyanFrameStatistics() = default;
  ~vtkBanyanFrameStatistics() override = default;

  double TotalSeconds = 0.0;
  double RenderSeconds = 0.0;
  double CompositeSeconds = 0.0;
  double PilotSeconds = 0.0;
  double StrideSeconds = 0.0;
  vtkIdType Pilots = 0;
  double Imbalance = 1.0;
  vtkIdType SamplesTaken = 0;
  vtkIdType BricksDrawn = 0;
  vtkIdType BricksUniform = 0;
  vtkIdType BricksSkipped = 0;
  vtkIdType BytesComposited = 0;
  vtkIdType MessagesComposited = 0;
  vtkIdType BytesRead = 0;
  vtkIdType CacheBytes = 0;
  vtkIdType PixelsReadBehind = 0;
  vtkIdType MeshBytes = 0;
  vtkIdType MeshBytesShared = 0;
  vtkIdType BytesMoved = 0;
  vtkIdType CacheHits = 0;
  vtkIdType CacheMisses = 0;
  vtkIdType CacheHitsAhead = 0;
  double EstimatedImageError = 0.0;
  std::string ImageErrorLimit;
  double EncodingErrorOfValues = 0.0;
  double MeshDeviation = 0.0;
  vtkIdType Frames = 0;

private:
  vtkBanyanFrameStatistics(const vtkBanyanFrameStatistics&) = delete;
  void operator=(const vtkBanyanFrameStatistics&) = delete;
};

#endif
