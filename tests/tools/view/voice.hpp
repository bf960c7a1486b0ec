// SPDX-License-Identifier: Apache-2.0
// A patch without a device, for the window and what stands behind it.
#pragma once

#include <string>

namespace tactus::test {

inline const std::string voice = R"(# a voice and what makes it loud
title = "voice"
wires = [
  "tone.signal -> loud.in",    # the way of the sound
  "level.value -> loud.factor",
]
[nodes.tone]
type = "sine"
rate = "48 kHz"
frequency = "440 Hz"   # a
[nodes.loud]
type = "gain"
rate = "48 kHz"
[nodes.level]
type = "constant"
rate = "60 Hz"
number = 0.5
)";

}  // namespace tactus::test
