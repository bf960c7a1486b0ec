// SPDX-License-Identifier: Apache-2.0
// Driver "haply": Inverse3 and Minverse with a VerseGrip, through Haply's Inverse Service on this machine.
#pragma once

#include "devices/driver/backend.hpp"
#include "graph/node/options.hpp"

#include <memory>

namespace tactus::haply {

/// Options: address, port, force_key, max_force. Throws Error.
std::unique_ptr<driver::Backend> make_inverse3(Options& options);

}  // namespace tactus::haply
