// SPDX-License-Identifier: Apache-2.0
// The other side of a driver, as a test has it: a vendor's library, a service or a board. Everything is said in the frame
// that users know: x to the right, y away from them, z up. The peer knows its own units and axes by itself.
#pragma once

#include "devices/driver/backend.hpp"
#include "devices/driver/threaded_device.hpp"
#include "graph/node/options.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tactus::test {

class Peer {
public:
    virtual ~Peer() = default;

    virtual std::unique_ptr<driver::Backend> backend() = 0;

    /// Where the handle is, m. Orientation: only of peers that turn.
    virtual void place(const Vec3& position, const Quat& orientation) = 0;
    virtual void press(std::uint32_t mask) = 0;  ///< bit n: button n, in the maker's order
    /// What the motors give now.
    virtual Wrench given() = 0;
    virtual void hang(bool on) = 0;  ///< the vendor's code, or the peer, does not return or answer
    virtual void unplug(bool on) = 0;
    virtual void send_nan(bool on) = 0;
    /// Sends a lot at once, where the other side decides what is sent.
    virtual void burst() {}

    bool turns = true;  ///< senses rotation
    int moves_along = 3;  ///< axes: 1: x; 2: and y; 3: and z
    bool twists = false;  ///< gives torque
    int buttons = 4;
    double exact = 1e-15;  ///< m, error of a pose that is due to the peer's own format
    double exact_force = 1e-12;  ///< N
};

/// A kind of peer, by its driver's name.
struct PeerKind {
    std::string driver;
    std::function<std::unique_ptr<Peer>()> make;
    bool has_line = false;  ///< a terminal or a socket, which the kernel serves in its own time
};

/// Every driver of a device that pushes: those with a line, or those without.
std::vector<PeerKind> peer_kinds(bool has_line);

/// Options as a patch gives them.
Options options_of(std::vector<OptionText> given);

/// A device as a run opens it, whose pushes were confirmed.
std::unique_ptr<driver::ThreadedDevice> open_peer(Peer& peer, driver::OpenMode mode = driver::OpenMode::run,
                                                  bool is_untested = false);

}  // namespace tactus::test
