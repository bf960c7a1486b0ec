// SPDX-License-Identifier: Apache-2.0
// Boards with motors at the other end of a pseudo-terminal.
#pragma once

#include "tests/devices/driver/peer.hpp"

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>

namespace tactus::test {

/// A pantograph whose board speaks Tactus' frames.
std::unique_ptr<Peer> make_frame_board_peer();
/// A pantograph with Haply's first board.
std::unique_ptr<Peer> make_diy_peer();
/// The line of one of these.
std::string line_of(Peer& board);

/// What happens to a board's answers on the line, and noise of its own.
struct LineFaults {
    std::atomic<int> cut_percent{0};      ///< some bytes of an answer are lost
    std::atomic<int> drop_percent{0};     ///< all are
    std::atomic<int> noise_percent{0};    ///< foreign bytes come before it
    std::atomic<int> late_answers{0};     ///< so many wait in the line
    std::atomic<int> bytes_per_s{0};      ///< the board hears no more than that; 0: all at once
    std::atomic<int> burst{0};            ///< so many foreign bytes come now
};
LineFaults& faults_of(Peer& board);

}  // namespace tactus::test
