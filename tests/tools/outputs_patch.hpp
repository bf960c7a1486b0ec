// SPDX-License-Identifier: Apache-2.0
// A small patch that records a sound and a table, and the command as a shell calls it.
#pragma once

#include "tests/tools/run_command.hpp"

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

/// In `folder`; $T is the command. Standard output and error are apart.
inline Outcome shell(const Folder& folder, const std::string& script) {
    const fs::path out = folder.path / "shell.out", err = folder.path / "shell.err";
    const fs::path file = folder.write("shell.sh", "cd " + folder.path.string() + "\nT=" + command() + "\n" + script);
    const int status = std::system(("sh " + file.string() + " >" + out.string() + " 2>" + err.string()).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(out), slurp(err)};
}

}  // namespace tactus::test
