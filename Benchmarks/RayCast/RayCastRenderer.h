// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_RayCastRenderer_h
#define banyan_Benchmarks_RayCastRenderer_h

#include "BenchScene.h"
#include "Picture.h"

#include "Base/Timer.h"

#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace banyan::bench
{

/// How exact a renderer is asked to be: one of the two.
struct Setting
{
  std::optional<double> Tolerance;      ///< largest error of a channel, in 1/255
  std::optional<double> SampleDistance; ///< in voxels
};

/// A picture and what it took.
struct Frame
{
  double Seconds = 0;
  /// Of a first frame, what had to be done once, where a renderer can do that apart: not in
  /// Seconds.
  std::optional<double> OnceSeconds;
  /// Of a first frame, what the tree of its values took: in Seconds.
  std::optional<double> TreeSeconds;
  double ProcessorSeconds = 0; ///< of all threads together
  /// Of a tolerance, in Seconds: what finding distances and levels, and pixels without rays, took.
  std::optional<double> ProbeSeconds;
  std::optional<double> StrideSeconds;
  Picture Shown;
  std::optional<FloatImage> Unrounded; ///< where the renderer has it
  std::optional<std::int64_t> Samples; ///< where the renderer tells
  /// In 1/255, where the renderer says how far off its picture may be.
  std::optional<double> EstimatedError;
};

/// Takes the times of a frame.
class FrameClock
{
public:
  void StopInto(Frame& frame) const
  {
    frame.Seconds = this->Wall.Seconds();
    frame.ProcessorSeconds = static_cast<double>(std::clock() - this->Processor) / CLOCKS_PER_SEC;
  }

private:
  Timer Wall;
  std::clock_t Processor = std::clock();
};

/// A volume renderer under measurement: ours or a peer.
class RayCastRenderer
{
public:
  virtual ~RayCastRenderer() = default;
  virtual std::string Name() const = 0;

  /// From exact to quick; none when it cannot draw the scene.
  virtual std::vector<Setting> SettingsFor(const BenchScene& scene) const = 0;

  /// Forgets the scene before and keeps this one, which must stay. No picture that follows may
  /// profit from another setting's.
  virtual void Prepare(const BenchScene& scene, const std::vector<Setting>& settings) = 0;

  /// Draws with setting number `setting` of those prepared. The first time, the time includes all
  /// that has to be done once.
  virtual Frame Draw(std::size_t setting) = 0;
};

using RendererList = std::vector<std::unique_ptr<RayCastRenderer>>;

/// @param plain as still pictures of plain data are drawn: without coarser levels
std::unique_ptr<RayCastRenderer> MakeBanyanRenderer(int threads, bool plain);

/// VTK's mappers, those that this program was built with. Must be called before anything else
/// uses OpenGL: the number of threads is fixed then.
/// @param missing receives the names of those that are not there
RendererList MakeVtkRenderers(int threads, std::vector<std::string>& missing);

} // namespace banyan::bench

#endif
