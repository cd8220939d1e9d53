// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_PictureServer_h
#define banyan_Rendering_PictureServer_h

#include "PictureTicket.h"

#include "Parallel/Composite/ParcelAssembly.h"
#include "Render/Raycast/DepthOrder.h"
#include "Render/Scene/BytePicture.h"

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>

class vtkBanyanVolumeMapper;
class vtkVolume;

namespace banyan
{

class VolumeFrame;
struct RayScene;
struct MapperState;

/// Draws pictures of a volume for a client that shows them, on all ranks of its server. Nothing
/// waits: between two tickets the ranks do what else they are told, while threads draw.
class PictureServer
{
public:
  /// The line to the client; used on rank 0 alone.
  struct Line
  {
    std::function<void(const Bytes& message)> Send; ///< at most PictureParcel::MostBytes
    std::function<bool()> HasMore;                  ///< whether the client has sent more
  };

  /// @param mapper and volume have to stay
  PictureServer(vtkBanyanVolumeMapper* mapper, vtkVolume* volume);
  ~PictureServer();
  PictureServer(const PictureServer&) = delete;
  PictureServer& operator=(const PictureServer&) = delete;

  /// Collective: draws what can be had at once, sends what may be sent, and works on the exact
  /// picture until it is there, or the client has sent more; on that of another volume first, where
  /// threads draw it. The mapper has its input. What fails is sent as a sentence, and thrown
  /// nowhere.
  void Take(const PictureTicket& ticket, const Line& line);

  /// Whether the client's window does not wait. It wants nothing any more if not.
  void Serve(bool serves);

private:
  /// Something for the client, of which a part was sent.
  struct Parcel
  {
    PictureParcel Head;
    Bytes Content;
    std::size_t Sent = 0;
  };

  void Attempt(const std::function<void()>& action);
  void Draw();
  static PictureServer* WhoDraws();
  void GoOnForParaView(const std::function<bool()>& leaves);
  void GoOn(const std::function<bool()>& leaves, const Line& line, int& credit);
  void AddDepths(RayScene& scene, RayScene& coarse) const;
  void Rename();
  void Publish();
  void PutPicture(bool exact, BytePicture picture);
  void Put(PictureParcel::Kinds kind, Bytes content);
  void Answer(const Line& line, int& credit);

  vtkBanyanVolumeMapper* Mapper;
  vtkVolume* Volume;
  std::unique_ptr<VolumeFrame> Drawn; ///< of the last scene
  PictureTicket Asked;                ///< with the last scene
  PlacedBody Body;                    ///< of the volume in it
  int Number = 0;                     ///< of the last ticket
  bool HasAnswered = false;           ///< the last ticket
  int Burst = 0;                      ///< of messages
  int DrawnScene = 0;                 ///< the last one that was drawn
  int ExactScene = 0;                 ///< that the client has, or will have, an exact picture of
  std::deque<Parcel> Waiting;         ///< on rank 0
};

} // namespace banyan

#endif
