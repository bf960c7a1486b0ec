// SPDX-License-Identifier: Apache-2.0
#include "graph/node/event.hpp"

#include "dsp/core/hash.hpp"

namespace tactus {

std::uint32_t event_source(std::string_view node) {
    Hash hash;
    hash.add_text(node);
    return static_cast<std::uint32_t>(hash.value());
}

}  // namespace tactus
