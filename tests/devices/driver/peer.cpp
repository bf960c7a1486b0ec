// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/driver/peer.hpp"

#include "tests/devices/driver/board_peer.hpp"
#include "tests/devices/driver/event_peer.hpp"
#include "tests/devices/driver/library_peers.hpp"
#include "tests/devices/driver/service_peer.hpp"

namespace tactus::test {

std::vector<PeerKind> peer_kinds(bool has_line) {
    std::vector<PeerKind> kinds{{"force_dimension", make_dhd_peer},  {"touch", make_hd_peer},
                                {"haply", make_haply_peer, true},    {"serial_board", make_frame_board_peer, true},
                                {"haply_2diy", make_diy_peer, true}, {"wheel", make_wheel_peer}};
    std::erase_if(kinds, [has_line](const PeerKind& kind) { return kind.has_line != has_line; });
    return kinds;
}

Options options_of(std::vector<OptionText> given) {
    return Options("device 'hand'", std::move(given), {"p.toml", 3, 1});
}

std::unique_ptr<driver::ThreadedDevice> open_peer(Peer& peer, driver::OpenMode mode, bool is_untested) {
    driver::DeviceOptions how{.driver = "test", .mode = mode, .is_untested = is_untested};
    how.open_timeout = std::chrono::milliseconds(1500);
    how.reopen_every = std::chrono::milliseconds(20);
    auto device = std::make_unique<driver::ThreadedDevice>(peer.backend(), how);
    device->prepare(1e-3);
    return device;
}

}  // namespace tactus::test
