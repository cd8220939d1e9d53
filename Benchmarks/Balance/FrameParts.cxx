// SPDX-License-Identifier: BSD-3-Clause
// Loaded before ParaView (LD_PRELOAD): what the parts of still renders take. Functions of ParaView,
// IceT and Banyan that exported symbols lead to are wrapped; a part does not count those inside it.
// OpenGL draws later than it is asked to: it is made to finish at the ends of parts, so that its
// work counts where it was asked for, and frames take a little longer.
//
// At the end rank N writes $BANYAN_FRAME_PARTS.N: medians over frames, in wall-clock time and in
// processor time of all threads of the process (waiting for messages is both).
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

namespace
{

enum Part
{
  Rest,
  BanyanFrame,
  BanyanWrite,
  ReadPixels,
  Composite,
  CopyPicture,
  ShowPicture,
  WindowFrame,
  Parts
};
const char* const Names[Parts] = { "the rest of ParaView", "Banyan: rays, compositing, statistics",
  "Banyan: the picture into OpenGL", "reading it back for IceT", "IceT", "copying IceT's picture",
  "IceT's picture onto the screen", "the window: the finished picture into it" };
constexpr std::size_t FirstFrame = 4;

using Times = std::array<double, 2>; ///< ms, wall-clock and processor

double Milliseconds(clockid_t clock)
{
  timespec time;
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

template <class Function>
Function Next(const char* name)
{
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

class Meter
{
public:
  ~Meter()
  {
    const char* path = std::getenv("BANYAN_FRAME_PARTS");
    const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
    if (!path || this->Frames.size() <= FirstFrame)
    {
      return;
    }
    std::FILE* file = std::fopen((std::string(path) + "." + (rank ? rank : "0")).c_str(), "w");
    if (!file)
    {
      return;
    }
    std::fprintf(file, "part,ms,processor_ms\n");
    for (std::size_t part = 0; part < Parts; ++part)
    {
      std::fprintf(
        file, "%s,%.2f,%.2f\n", Names[part], this->Median(part, 0), this->Median(part, 1));
    }
    std::fclose(file);
  }

  /// From now on this part takes time. @return the one before
  Part Switch(Part part)
  {
    if (this->Inside)
    {
      const auto finish = reinterpret_cast<void (*)()>(dlsym(RTLD_DEFAULT, "glFinish"));
      if (finish)
      {
        finish();
      }
      const Times now{ Milliseconds(CLOCK_MONOTONIC), Milliseconds(CLOCK_PROCESS_CPUTIME_ID) };
      for (std::size_t i = 0; i < now.size(); ++i)
      {
        this->Frame[this->Now][i] += now[i] - this->Since[i];
      }
      this->Since = now;
    }
    const Part before = this->Now;
    this->Now = part;
    return before;
  }

  void Begin()
  {
    this->Frame = {};
    this->Now = Rest;
    this->Since = { Milliseconds(CLOCK_MONOTONIC), Milliseconds(CLOCK_PROCESS_CPUTIME_ID) };
    this->Inside = true;
  }
  void End()
  {
    this->Switch(Rest);
    this->Inside = false;
    this->Frames.push_back(this->Frame);
  }

private:
  double Median(std::size_t part, std::size_t which) const
  {
    std::vector<double> values;
    for (std::size_t i = FirstFrame; i < this->Frames.size(); ++i)
    {
      values.push_back(this->Frames[i][part][which]);
    }
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
  }

  using FrameTimes = std::array<Times, Parts>;
  bool Inside = false; ///< a still render
  Part Now = Rest;
  Times Since{};
  FrameTimes Frame{};
  std::vector<FrameTimes> Frames;
};

Meter TheMeter;

} // namespace

// All of them have up to six arguments that fit into registers.
#define BANYAN_WRAP(symbol, part)                                                                  \
  extern "C" long symbol(long a, long b, long c, long d, long e, long f)                           \
  {                                                                                                \
    static const auto next = Next<decltype(&symbol)>(#symbol);                                     \
    const Part before = TheMeter.Switch(part);                                                     \
    const long result = next(a, b, c, d, e, f);                                                    \
    TheMeter.Switch(before);                                                                       \
    return result;                                                                                 \
  }

BANYAN_WRAP(_ZN15vtkBanyanVolume13RenderOverlayEP11vtkViewport, BanyanFrame)
BANYAN_WRAP(
  _ZN6banyan8Backdrop5WriteERKNS_12CommunicatorEP11vtkRendererRKNS_10FloatImageE, BanyanWrite)
BANYAN_WRAP(icetDrawFrame, Composite)
BANYAN_WRAP(_ZN20vtkIceTCompositePass4DrawEPK14vtkRenderStateRKNS_14IceTDrawParamsE, Rest)
BANYAN_WRAP(icetImageCopyColorub, CopyPicture)
BANYAN_WRAP(icetImageCopyDepthf, CopyPicture)
BANYAN_WRAP(_ZN24vtkSynchronizedRenderers11vtkRawImage14PushToViewportEP11vtkRendererb, ShowPicture)
BANYAN_WRAP(_ZN21vtkOpenGLRenderWindow5FrameEv, WindowFrame)

extern "C" void glReadPixels(
  int x, int y, int width, int height, unsigned format, unsigned type, void* pixels)
{
  static const auto next = Next<decltype(&glReadPixels)>("glReadPixels");
  const Part before = TheMeter.Switch(ReadPixels);
  next(x, y, width, height, format, type, pixels);
  TheMeter.Switch(before);
}

extern "C" void _ZN15vtkPVRenderView11StillRenderEv(void* view)
{
  static const auto next =
    Next<decltype(&_ZN15vtkPVRenderView11StillRenderEv)>("_ZN15vtkPVRenderView11StillRenderEv");
  TheMeter.Begin();
  next(view);
  TheMeter.End();
}
