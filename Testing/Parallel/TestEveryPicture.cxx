// SPDX-License-Identifier: BSD-3-Clause
// Every way to draw a picture on the ranks of this job, by IceT too where ParaView is there.
#include "EveryPicture.h"
#include "MpiProgram.h"

#ifdef BANYAN_TESTS_HAVE_ICET
#include "CompositingCases.h"
#include "IceTCompositing.h"

#include "Base/Error.h"

#include "vtkMPIController.h"
#include "vtkNew.h"

#include <numeric>
#endif

namespace
{

using namespace banyan;
using namespace banyan::testing;

#ifdef BANYAN_TESTS_HAVE_ICET

/// IceT's own list of tests by IceT.
std::string CompositeByIceT(Communicator& communicator, const CompositeOptions::Compositor& iceT)
{
  CompositeOptions options;
  options.Method = CompositingMethod::IceTRadixK;
  options.External = iceT;
  std::string wrong;
  for (int which = 0; which < static_cast<int>(Case::Count); ++which)
  {
    for (const PixelRect& viewport : Viewports())
    {
      const PreparedCase prepared(
        static_cast<Case>(which), communicator.Size(), viewport, Combination::Over);
      wrong += CheckMethod(communicator, prepared, options);
    }
  }
  return wrong;
}

/// The last rank gives IceT an order that is none: all ranks must hear of it, and the next frame is
/// right again.
std::string ComplainAsIceT(Communicator& communicator, const CompositeOptions::Compositor& iceT)
{
  const int size = communicator.Size();
  const PixelRect viewport{ { 0, 0 }, { 16, 9 } };
  std::vector<int> order(static_cast<std::size_t>(size));
  std::iota(order.begin(), order.end(), 0);
  if (communicator.Rank() == size - 1)
  {
    order.assign(order.size(), 0);
  }
  CompositeStatistics statistics;
  const FloatImage mine = ImageOf(Case::AllOverlap, communicator.Rank(), size, viewport);
  std::string said;
  try
  {
    iceT(communicator, mine, order, viewport, statistics);
  }
  catch (const Error& error)
  {
    said = error.what();
  }
  const std::string expected = "Rank " + std::to_string(size - 1) + ": IceT could";
  return size == 1 || said.rfind(expected, 0) == 0 ? "" : "IceT's complaint came as '" + said + "'";
}

CompositeOptions::Compositor IceT()
{
  // Stays: it is part of the compositor.
  vtkMPIController* const controller = vtkMPIController::New();
  controller->Initialize(nullptr, nullptr, 1);
  return IceTRadixK(controller);
}

std::string CheckIceT(Communicator& communicator, const CompositeOptions::Compositor& iceT)
{
  const std::string wrong = ComplainAsIceT(communicator, iceT);
  return wrong + CompositeByIceT(communicator, iceT);
}

#else

CompositeOptions::Compositor IceT()
{
  return nullptr;
}

std::string CheckIceT(Communicator&, const CompositeOptions::Compositor&)
{
  return "";
}

#endif

} // namespace

int main(int argc, char** argv)
{
  return RunOnMpiRanks(argc, argv, 75,
    [&](Communicator& communicator)
    {
      std::string wrong = CheckRankCount(communicator, argc, argv);
      if (!wrong.empty())
      {
        return wrong;
      }
      const CompositeOptions::Compositor iceT = IceT();
      wrong += CheckIceT(communicator, iceT);
      wrong += CheckEveryPicture(communicator, iceT);
      return wrong;
    });
}
