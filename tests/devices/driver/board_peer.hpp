// SPDX-License-Identifier: Apache-2.0
// Boards with motors at the other end of a pseudo-terminal.
#pragma once

#include "tests/devices/driver/peer.hpp"

#include <memory>
#include <string>

namespace tactus::test {

/// A pantograph whose board speaks Tactus' frames.
std::unique_ptr<Peer> make_frame_board_peer();
/// A pantograph with Haply's first board.
std::unique_ptr<Peer> make_diy_peer();
/// The line of one of these.
std::string line_of(Peer& board);

}  // namespace tactus::test
