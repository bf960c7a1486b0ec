// SPDX-License-Identifier: Apache-2.0
// A patch with three errors: a unit, a node type and a port.
#pragma once

#include <string>

namespace tactus::test {

inline std::string patch_text(const std::string& unit, const std::string& type, const std::string& port) {
    return "title = \"Errors\"\nwires = [\n  \"hand.pose -> ball.pose\",\n  \"ball.wrench -> hand_out.wrench\",\n"
           "  \"ball.penetration -> tone.amplitude\",\n  \"tone.signal -> speaker.signal\",\n  \"ball." +
           port +
           " -> depth.in\",\n]\n\n[devices.simulated]\ndriver = \"simulated\"\n\n[nodes.hand]\ntype = "
           "\"device_input\"\n"
           "rate = \"1 kHz\"\n\n[nodes.ball]\ntype = \"sphere_contact\"\nrate = \"1 kHz\"\nstiffness = \"0.8 " +
           unit + "\"\n\n[nodes.hand_out]\ntype = \"device_output\"\nrate = \"1 kHz\"\n\n[nodes.tone]\ntype = \"" +
           type +
           "\"\nrate = \"48 kHz\"\n\n[nodes.speaker]\ntype = \"audio_output\"\nrate = \"48 kHz\"\n\n[nodes.depth]\n"
           "type = \"record\"\nrate = \"1 kHz\"\nfile = \"depth.csv\"\n";
}

inline const std::string broken_patch = patch_text("N/m/s", "sin", "penetraton"),
                         sound_patch = patch_text("N/mm", "sine", "penetration");

}  // namespace tactus::test
