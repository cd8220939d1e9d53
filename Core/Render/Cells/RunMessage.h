// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_RunMessage_h
#define banyan_Render_Cells_RunMessage_h

#include "Base/Bytes.h"
#include "Render/Cells/RayRuns.h"

#include <cstddef>
#include <vector>

namespace banyan
{

/// Appends what a rank has of a tile: about 20 bytes per run, 30 to 55 per raw interval. A part
/// without anything takes none.
void PutRuns(Bytes& message, const TileRuns& runs);

/// The tiles of a message, in order.
/// Throws Error where it is none: elements of a tile are sorted, and numbers are finite.
std::vector<TileRuns> TakeRuns(const std::uint8_t* message, std::size_t bytes);

void PutAsked(Bytes& message, const AskedTile& asked);
std::vector<AskedTile> TakeAsked(const std::uint8_t* message, std::size_t bytes);

} // namespace banyan

#endif
