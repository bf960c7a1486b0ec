// SPDX-License-Identifier: Apache-2.0
// Patches that several tests of the command and its window use.
#pragma once

#include <string>

namespace tactus::test {

/// Without a device.
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

/// A hand feels a ball, beside a sound.
inline const std::string touch = R"(title = "touch"
wires = [
  "hand.pose -> ball.pose",
  "ball.wrench -> out.wrench",
  "tone.signal -> loud.in",
  "level.value -> loud.factor as linear",
]
[nodes.hand]
type = "device_input"
rate = "1 kHz"
device = "simulated"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
stiffness = "0.5 N/mm"
[nodes.out]
type = "device_output"
rate = "1 kHz"
device = "simulated"
[nodes.tone]
type = "sine"
rate = "48 kHz"
[nodes.loud]
type = "gain"
rate = "48 kHz"
[nodes.level]
type = "constant"
rate = "60 Hz"
number = 0.5
)";

}  // namespace tactus::test
