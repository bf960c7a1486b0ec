// SPDX-License-Identifier: Apache-2.0
#include "tools/command/catalogue.hpp"

int main(int argc, char** argv) {
    return tactus::command::command_line(
        {"tactus", "Tactus: patches of nodes for haptics, from 60 Hz to audio rate", tactus::command::all_verbs()},
        argc, argv);
}
