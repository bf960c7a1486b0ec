// SPDX-License-Identifier: Apache-2.0
// `tactus-full`: all verbs and the window. `tactus` starts it for what it does not have itself.
#include "tools/analysis/beside.hpp"
#include "tools/command/catalogue.hpp"
#include "tools/command/standard_streams.hpp"

int main(int argc, char** argv) {
    tactus::command::hold_standard_streams();
    const int code = tactus::command::command_line(tactus::command::tactus_program(), argc, argv);
    tactus::analysis::end_beside();
    return code;
}
