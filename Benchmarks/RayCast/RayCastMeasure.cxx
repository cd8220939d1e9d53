// SPDX-License-Identifier: BSD-3-Clause
#include "RayCastMeasure.h"

#include <algorithm>
#include <cstdio>

namespace banyan::bench
{
namespace
{

/// One renderer with one setting, and what was found out about it.
struct Candidate
{
  RayCastRenderer* Renderer;
  std::size_t Setting;
  RayCastMeasurement Result;
  std::vector<double> Milliseconds;
  std::vector<double> ProcessorMilliseconds;
  std::vector<double> ProbeMilliseconds;
  std::vector<double> StrideMilliseconds;
};

std::string Number(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string Number(const std::optional<double>& value)
{
  return value ? Number(*value) : std::string();
}

double MedianOf(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::string NameOf(const Setting& setting)
{
  return setting.Tolerance ? "tolerance " + Number(*setting.Tolerance)
                           : "step " + Number(setting.SampleDistance.value_or(0.0));
}

bool OneSamplePerVoxel(const Setting& setting)
{
  return setting.SampleDistance.value_or(0.0) == 1.0;
}

/// VTK's mapper for processors is many times slower than its other one: goals do without it.
bool HasGoals(const BenchScene& scene, const RayCastRenderer& renderer)
{
  return scene.HasGoals && renderer.Name() != "vtk-fixed-point";
}

std::vector<Setting> ChosenSettings(
  const RayCastRenderer& renderer, const BenchScene& scene, const RayCastMeasuring& options)
{
  const std::vector<double>& wanted = options.Settings;
  const bool few = options.GoalsOnly && !HasGoals(scene, renderer);
  std::vector<Setting> settings = renderer.SettingsFor(scene);
  const auto unwanted = [&](const Setting& setting)
  {
    const double number = setting.Tolerance.value_or(setting.SampleDistance.value_or(0.0));
    return (few && !OneSamplePerVoxel(setting)) ||
           (!wanted.empty() && std::find(wanted.begin(), wanted.end(), number) == wanted.end());
  };
  settings.erase(std::remove_if(settings.begin(), settings.end(), unwanted), settings.end());
  return settings;
}

std::string FileNameOf(const RayCastMeasurement& m)
{
  std::string name = m.Scene + "-" + m.Renderer + "-" + NameOf(m.Accuracy) + ".ppm";
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

void Add(Candidate& candidate, const Frame& frame)
{
  candidate.Milliseconds.push_back(1e3 * frame.Seconds);
  candidate.ProcessorMilliseconds.push_back(1e3 * frame.ProcessorSeconds);
  if (frame.ProbeSeconds && frame.StrideSeconds)
  {
    candidate.ProbeMilliseconds.push_back(1e3 * *frame.ProbeSeconds);
    candidate.StrideMilliseconds.push_back(1e3 * *frame.StrideSeconds);
  }
}

void JudgeFirst(
  Candidate& candidate, const Frame& frame, const FloatImage& reference, const std::string& folder)
{
  RayCastMeasurement& result = candidate.Result;
  result.FirstFrameMilliseconds = 1e3 * (frame.Seconds + frame.OnceSeconds.value_or(0.0));
  if (frame.OnceSeconds)
  {
    Add(candidate, frame);
  }
  if (frame.TreeSeconds)
  {
    result.TreeMilliseconds = 1e3 * *frame.TreeSeconds;
  }
  result.Samples = frame.Samples;
  result.EstimatedError = frame.EstimatedError;
  result.Error = ErrorOf(frame.Shown, reference);
  if (frame.Unrounded)
  {
    result.LargestErrorUnrounded = ErrorOf(*frame.Unrounded, reference).Largest;
  }
  if (!folder.empty() && OneSamplePerVoxel(result.Accuracy))
  {
    WritePicture(frame.Shown, folder + "/" + FileNameOf(result));
  }
}

/// How many frames of a candidate are timed.
int TurnsOf(const Candidate& candidate, const RayCastMeasuring& options)
{
  const int least = OneSamplePerVoxel(candidate.Result.Accuracy) ? 2 : 1;
  const double frames =
    1e3 * options.PatienceSeconds / std::max(1e-3, candidate.Result.FirstFrameMilliseconds);
  const int turns = static_cast<int>(std::min(frames, static_cast<double>(options.Repeat)));
  return std::max(turns, std::min(least, options.Repeat));
}

} // namespace

std::vector<RayCastMeasurement> MeasureScene(const BenchScene& scene, const FloatImage& reference,
  const RendererList& renderers, const RayCastMeasuring& options)
{
  std::vector<Candidate> candidates;
  for (const auto& renderer : renderers)
  {
    const std::vector<Setting> settings = ChosenSettings(*renderer, scene, options);
    if (!settings.empty())
    {
      renderer->Prepare(scene, settings);
    }
    for (std::size_t i = 0; i < settings.size(); ++i)
    {
      Candidate candidate{ renderer.get(), i, {}, {}, {}, {}, {} };
      candidate.Result.Scene = scene.Name;
      candidate.Result.Renderer = renderer->Name();
      candidate.Result.Threads = options.Threads;
      candidate.Result.Accuracy = settings[i];
      JudgeFirst(candidate, renderer->Draw(i), reference, options.PictureFolder);
      candidates.push_back(std::move(candidate));
    }
  }
  for (int turn = 0; turn < options.Repeat; ++turn)
  {
    for (Candidate& candidate : candidates)
    {
      const auto timed = static_cast<int>(candidate.Milliseconds.size());
      if (timed < TurnsOf(candidate, options))
      {
        Add(candidate, candidate.Renderer->Draw(candidate.Setting));
      }
    }
  }
  std::vector<RayCastMeasurement> results;
  for (Candidate& candidate : candidates)
  {
    candidate.Result.FrameMilliseconds = MedianOf(candidate.Milliseconds);
    candidate.Result.ProcessorMilliseconds = MedianOf(candidate.ProcessorMilliseconds);
    if (!candidate.ProbeMilliseconds.empty())
    {
      candidate.Result.ProbeMilliseconds = MedianOf(candidate.ProbeMilliseconds);
      candidate.Result.StrideMilliseconds = MedianOf(candidate.StrideMilliseconds);
    }
    results.push_back(candidate.Result);
  }
  return results;
}

std::string RayCastCsvHeader()
{
  return "scene,renderer,threads,tolerance,ms_per_frame,samples,msamples_s,psnr_db,max_error,"
         "sample_distance,first_frame_ms,processor_ms,max_error_unrounded,estimated_error,tree_ms,"
         "probe_ms,stride_ms";
}

std::string RayCastCsvLine(const RayCastMeasurement& m)
{
  std::string samples;
  std::string rate;
  if (m.Samples)
  {
    samples = std::to_string(*m.Samples);
    rate = Number(1e-3 * static_cast<double>(*m.Samples) / m.FrameMilliseconds);
  }
  return m.Scene + "," + m.Renderer + "," + std::to_string(m.Threads) + "," +
         Number(m.Accuracy.Tolerance) + "," + Number(m.FrameMilliseconds) + "," + samples + "," +
         rate + "," + Number(m.Error.PsnrDecibels) + "," + Number(m.Error.Largest) + "," +
         Number(m.Accuracy.SampleDistance) + "," + Number(m.FirstFrameMilliseconds) + "," +
         Number(m.ProcessorMilliseconds) + "," + Number(m.LargestErrorUnrounded) + "," +
         Number(m.EstimatedError) + "," + Number(m.TreeMilliseconds) + "," +
         Number(m.ProbeMilliseconds) + "," + Number(m.StrideMilliseconds);
}

std::string RayCastMessage(const RayCastMeasurement& m)
{
  char text[256];
  std::snprintf(text, sizeof(text),
    "%-16s %-16s %-14s %9.1f ms  %9.1f ms of processors  %6.2f dB  max %7.2f/255", m.Scene.c_str(),
    m.Renderer.c_str(), NameOf(m.Accuracy).c_str(), m.FrameMilliseconds, m.ProcessorMilliseconds,
    m.Error.PsnrDecibels, m.Error.Largest);
  return text;
}

} // namespace banyan::bench
