// SPDX-License-Identifier: Apache-2.0
// A small patch that records a sound and a table.
#pragma once

#include <string>

namespace tactus::test {

inline const std::string recording_patch = R"(title = "recording"
wires = [
  "tone.signal -> sound.in",
  "half.value -> table.in",
]
[nodes.tone]
type = "sine"
rate = "48 kHz"
[nodes.sound]
type = "record"
rate = "48 kHz"
[nodes.half]
type = "constant"
rate = "1 kHz"
number = 0.5
[nodes.table]
type = "record"
rate = "1 kHz"
)";

}  // namespace tactus::test
