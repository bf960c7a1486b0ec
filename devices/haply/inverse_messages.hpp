// SPDX-License-Identifier: Apache-2.0
// The messages of Haply's Inverse Service (3.x): JSON texts. The service answers each text with one state.
#pragma once

#include "devices/driver/exchange.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace tactus::haply {

/// State of the first Inverse3 (or Minverse) of the service.
struct InverseState {
    std::string device, type, version;  ///< id; "inverse3" and alike; of the service, "" if not given
    bool has_pose = false;
    driver::Reading reading;  ///< without velocity, which is estimated as for every device
    std::string changed_axes;  ///< the axis settings that differ from the maker's defaults; empty: none
};

/// Returns nothing for a text that is not such a message. Missing fields and fields of another type keep their values.
std::optional<InverseState> read_inverse(std::string_view text);

/// The name of the service's field for a force changed between its versions.
enum class ForceKey { vector, values };
ForceKey force_key_of(std::string_view version);

/// Returns the text that sends a force in N. `first`: with the name of this program, for the first text of a
/// connection.
std::string force_text(std::string_view device, const Vec3& newton, ForceKey key, bool first);

}  // namespace tactus::haply
