// SPDX-License-Identifier: BSD-3-Clause
// The promised time of a frame while somebody turns a scene that is too heavy for it.

#include "MapperTesting.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanVolumeMapper.h"

#include <algorithm>

using namespace mapper_testing;

namespace
{

const glm::ivec3 Samples{ 129, 129, 129 };
constexpr int Settling = 8; ///< frames: there are seven steps of pictures without a tolerance
constexpr int Judged = 9;   ///< frames after these
constexpr int Attempts = 5; ///< that other programs may disturb

/// Fine waves everywhere: all of a small tolerance's samples are needed.
float Waves(double x, double y, double z, int)
{
  return static_cast<float>(0.5 +
                            0.25 * std::sin(55.0 * x) * std::sin(47.0 * y) * std::sin(51.0 * z) +
                            0.25 * std::sin(9.0 * x + 5.0 * y * z));
}

double Median(std::vector<double> values)
{
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

struct Kind
{
  std::string Name;
  int BlendMode = vtkVolumeMapper::COMPOSITE_BLEND;
  int Interpolation = VTK_LINEAR_INTERPOLATION;
  double SampleDistanceVoxels = 0.0;

  bool HasTolerance() const
  {
    return this->BlendMode == vtkVolumeMapper::COMPOSITE_BLEND &&
           this->Interpolation == VTK_LINEAR_INTERPOLATION && this->SampleDistanceVoxels == 0.0;
  }
};

class Turning
{
public:
  Turning(vtkBanyanVolumeMapper* mapper, const Kind& kind)
    : Mapper(mapper)
    , Shown(mapper)
  {
    mapper->SetInteractiveImageErrorTolerance(0.5);
    mapper->SetNumberOfThreads(1);
    mapper->SetReuseFrames(false); // the same scene is to take its time again and again
    mapper->SetBlendMode(kind.BlendMode);
    mapper->SetSampleDistanceVoxels(kind.SampleDistanceVoxels);
    this->Shown.Volume->GetProperty()->SetInterpolationType(kind.Interpolation);
    this->Shown.Window->SetSize(640, 640);
    this->Shown.Window->SetDesiredUpdateRate(5.0);
  }

  /// Median of the seconds of frames that promise some, and their samples.
  double Seconds(double promised, vtkIdType& samples)
  {
    this->Mapper->SetInteractiveFrameSeconds(promised);
    this->Shown.LookAt(this->Bounds);
    std::vector<double> taken;
    for (int frame = 0; frame < Settling + Judged; ++frame)
    {
      this->Shown.Renderer->GetActiveCamera()->Azimuth(1.0);
      this->Shown.Window->Render();
      if (frame >= Settling)
      {
        taken.push_back(this->Mapper->GetStatistics()->GetTotalSeconds());
      }
    }
    samples = this->Mapper->GetStatistics()->GetSamplesTaken();
    return Median(taken);
  }

  /// The picture after somebody has let go of the scene.
  std::vector<unsigned char> Still()
  {
    this->Shown.Window->SetDesiredUpdateRate(0.001);
    std::vector<unsigned char> picture = this->Shown.Draw();
    this->Shown.Window->SetDesiredUpdateRate(5.0);
    return picture;
  }

private:
  vtkBanyanVolumeMapper* Mapper;
  Stage Shown;
  const double Bounds[6] = { 0, Samples.x - 1.0, 0, Samples.y - 1.0, 0, Samples.z - 1.0 };
};

/// The promise is chosen for the machine: well below what the scene takes at its best, well above
/// what it takes at its worst.
void HeavyScenesKeepThePromise(Turning& scene, const std::string& name)
{
  bool kept = false;
  for (int attempt = 0; attempt < Attempts && !kept; ++attempt)
  {
    vtkIdType all = 0;
    vtkIdType least = 0;
    vtkIdType some = 0;
    const double slow = scene.Seconds(0.0, all);
    const double quick = scene.Seconds(1e-6, least);
    const double promised = std::sqrt(slow * quick);
    // As if somebody had just taken hold of the scene.
    scene.Seconds(0.0, all);
    const double taken = scene.Seconds(promised, some);
    std::cout << name << ": " << slow << " s at best, " << quick << " s at worst, " << promised
              << " s promised, " << taken << " s taken, " << all << ", " << least << " and " << some
              << " samples\n";
    Check(some < all, name + ": samples are left out for the promise");
    kept = slow > 1.4 * quick && taken <= promised;
  }
  Check(kept, name + ": a heavy scene keeps the promised time after a few frames");
}

/// Of pictures without a tolerance: what interaction leaves out comes back when nothing moves.
void StillPicturesAreExact(Turning& scene, const std::string& name)
{
  vtkIdType samples = 0;
  scene.Seconds(0.0, samples);
  const std::vector<unsigned char> exact = scene.Still();
  Check(Covered(exact) > 1000, name + ": there is something to see");
  scene.Seconds(1e-6, samples);
  Check(scene.Still() == exact, name + ": a still picture is exact");
}

void Try(vtkBanyanVolumeMapper* mapper, const Kind& kind)
{
  Turning scene(mapper, kind);
  HeavyScenesKeepThePromise(scene, kind.Name);
  if (!kind.HasTolerance())
  {
    StillPicturesAreExact(scene, kind.Name);
  }
}

} // namespace

int main()
{
  const TemporaryFolder folder;
  vtkNew<vtkBanyanVolumeMapper> plain;
  plain->SetInputData(PlainImage(Waves, Samples));
  Try(plain, { "plain" });
  Try(plain, { "labels", vtkVolumeMapper::COMPOSITE_BLEND, VTK_NEAREST_INTERPOLATION });
  Try(plain, { "plain maximum", vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND });
  Try(plain, { "fixed distance", vtkVolumeMapper::COMPOSITE_BLEND, VTK_LINEAR_INTERPOLATION, 0.5 });
  WriteSeries(folder / "series.banyan", Waves, Samples, 1, 1e-4);
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName((folder / "series.banyan").c_str());
  vtkNew<vtkBanyanVolumeMapper> encoded;
  encoded->SetInputConnection(reader->GetOutputPort());
  Try(encoded, { "encoded" });
  Try(encoded, { "encoded minimum", vtkVolumeMapper::MINIMUM_INTENSITY_BLEND });
  Try(encoded, { "encoded average", vtkVolumeMapper::AVERAGE_INTENSITY_BLEND });
  return Failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
