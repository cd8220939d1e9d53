// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_ParcelAssembly_h
#define banyan_Parallel_Composite_ParcelAssembly_h

#include "Base/Bytes.h"

#include <cstdint>
#include <optional>

namespace banyan
{

/// The head of a message from the server: of a part of something for a client.
struct PictureParcel
{
  /// The number of our messages among those that ParaView sends between processes.
  static constexpr int Tag = 745019;
  static constexpr std::uint32_t ThisVersion = 2;
  static constexpr std::size_t MostBytes = 12000; ///< of a message: more blocks a slow line

  enum Kinds : std::int32_t
  {
    Answer, ///< the ticket was seen; no content
    Coarse, ///< PackPicture
    Exact,  ///< the same
    Same,   ///< the scene's picture is the one that was sent before; no content
    Failure ///< a sentence
  };

  std::uint32_t Version = ThisVersion;
  std::int32_t Display = 0;
  std::int32_t Kind = Answer;
  std::int32_t Ticket = 0; ///< number of the last one that was seen
  std::int32_t Scene = 0;  ///< of the content
  std::int32_t Burst = 0;  ///< of messages that are sent one right after the other
  std::uint32_t Begin = 0; ///< in the content
  std::uint32_t Bytes = 0; ///< of the whole content
};

/// Puts together what comes from the server in parts.
class ParcelAssembly
{
public:
  struct Whole
  {
    PictureParcel Head; ///< of the last part
    Bytes Content;
  };

  /// The head of a message; nothing where it is none, or one of another version of this project.
  static std::optional<PictureParcel> HeadOf(const void* message, std::size_t bytes);

  /// Takes a message with such a head.
  /// @return what it is the last part of
  /// Throws Error when it does not fit those before it: what was begun is forgotten then.
  std::optional<Whole> Take(const void* message, std::size_t bytes);

  /// Whether parts of something have come, and not yet the last.
  bool HasBegun() const { return !this->Begun.empty(); }

private:
  Bytes Begun;
};

} // namespace banyan

#endif
