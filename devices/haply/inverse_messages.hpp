// SPDX-License-Identifier: Apache-2.0
// The messages of Haply's Inverse Service (3.x): JSON texts, one state for each text that was sent.
#pragma once

#include "devices/driver/exchange.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace tactus::haply {

/// What the service says of its first Inverse3 (or Minverse).
struct InverseState {
    std::string device, type, version;  ///< id; "inverse3" and alike; of the service, "" when it does not say
    bool has_pose = false;
    driver::Reading reading;  ///< no velocity: it is estimated as that of every device
    std::string changed_axes;  ///< why its axes are not the maker's own; empty: they are
};

/// Nothing for a text that is no such message. Fields that are missing or of another kind are left as they were.
std::optional<InverseState> read_inverse(std::string_view text);

/// The name of the service's field for a force changed between its versions.
enum class ForceKey { vector, values };
ForceKey force_key_of(std::string_view version);

/// The text that gives a force in N. `first`: with the name of this program, as the first text of a connection.
std::string force_text(std::string_view device, const Vec3& newton, ForceKey key, bool first);

}  // namespace tactus::haply
