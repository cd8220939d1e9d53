// SPDX-License-Identifier: BSD-3-Clause
#include "LineToClient.h"

#include "Base/Timer.h"

#include "vtkClientSocket.h"
#include "vtkMultiProcessController.h"
#include "vtkNetworkAccessManager.h"
#include "vtkPVSession.h"
#include "vtkProcessModule.h"
#include "vtkSocketCommunicator.h"

#include <poll.h>

namespace banyan
{
namespace
{

/// Null on ranks that have no client.
vtkMultiProcessController* Client()
{
  vtkPVSession* const session =
    vtkPVSession::SafeDownCast(vtkProcessModule::GetProcessModule()->GetActiveSession());
  return session ? session->GetController(vtkPVSession::CLIENT) : nullptr;
}

/// Without waiting, which ParaView's own question does.
bool HasMore(vtkMultiProcessController* client)
{
  auto* const communicator =
    client ? vtkSocketCommunicator::SafeDownCast(client->GetCommunicator()) : nullptr;
  vtkClientSocket* const socket = communicator ? communicator->GetSocket() : nullptr;
  if (!socket || !socket->GetConnected() || communicator->HasBufferredMessages())
  {
    return true;
  }
  pollfd waiting{ socket->GetSocketDescriptor(), POLLIN, 0 };
  return poll(&waiting, 1, 0) != 0;
}

} // namespace

PictureServer::Line LineToClient()
{
  const vtkSmartPointer<vtkMultiProcessController> client = Client();
  PictureServer::Line line;
  line.Send = [client](const Bytes& message)
  {
    if (client)
    {
      Bytes copy = message;
      client->TriggerRMI(1, copy.data(), static_cast<int>(copy.size()), PictureParcel::Tag);
    }
  };
  line.HasMore = [client] { return HasMore(client); };
  return line;
}

bool ReadMessages(double seconds)
{
  vtkNetworkAccessManager* const network =
    vtkProcessModule::GetProcessModule()->GetNetworkAccessManager();
  const Timer timer;
  while (timer.Seconds() < seconds && network->GetNetworkEventsAvailable())
  {
    network->ProcessEvents(1);
  }
  return !network->GetNetworkEventsAvailable();
}

} // namespace banyan
