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
constexpr int Settling = 5; ///< frames: 16 times the tolerance is doubled four times
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

class Turning
{
public:
  explicit Turning(vtkBanyanVolumeMapper* mapper)
    : Mapper(mapper)
    , Shown(mapper)
  {
    mapper->SetInteractiveImageErrorTolerance(0.5);
    mapper->SetNumberOfThreads(1);
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

private:
  vtkBanyanVolumeMapper* Mapper;
  Stage Shown;
  const double Bounds[6] = { 0, Samples.x - 1.0, 0, Samples.y - 1.0, 0, Samples.z - 1.0 };
};

/// The promise is chosen for the machine: well below what the scene takes at its tolerance, well
/// above what it takes at the largest one.
void HeavyScenesKeepThePromise(vtkBanyanVolumeMapper* mapper, const std::string& name)
{
  Turning scene(mapper);
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
    std::cout << name << ": " << slow << " s at the tolerance, " << quick
              << " s at 16 times as much, " << promised << " s promised, " << taken << " s taken, "
              << all << ", " << least << " and " << some << " samples\n";
    Check(some < all, name + ": samples are left out for the promise");
    kept = slow > 1.4 * quick && taken <= promised;
  }
  Check(kept, name + ": a heavy scene keeps the promised time after a few frames");
}

} // namespace

int main()
{
  const TemporaryFolder folder;
  vtkNew<vtkBanyanVolumeMapper> plain;
  plain->SetInputData(PlainImage(Waves, Samples));
  HeavyScenesKeepThePromise(plain, "plain");
  WriteSeries(folder / "series.banyan", Waves, Samples, 1, 1e-4);
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName((folder / "series.banyan").c_str());
  vtkNew<vtkBanyanVolumeMapper> encoded;
  encoded->SetInputConnection(reader->GetOutputPort());
  HeavyScenesKeepThePromise(encoded, "encoded");
  return Failures() == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
