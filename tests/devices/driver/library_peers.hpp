// SPDX-License-Identifier: Apache-2.0
// The vendors' libraries as tests have them: tests/devices/fakes.
#pragma once

#include "tests/devices/driver/peer.hpp"

#include <memory>

namespace tactus::test {

std::unique_ptr<Peer> make_dhd_peer();
std::unique_ptr<Peer> make_hd_peer();

/// A function of the library that a peer has loaded.
void* function_of(Peer& peer, const char* name);

/// Calls it: `tell<int>(peer, "fake_watchdog")`.
template <class Result = void, class... Arguments>
Result tell(Peer& peer, const char* name, Arguments... arguments) {
    return reinterpret_cast<Result (*)(Arguments...)>(function_of(peer, name))(arguments...);
}

}  // namespace tactus::test
