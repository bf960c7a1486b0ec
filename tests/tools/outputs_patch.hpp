// SPDX-License-Identifier: Apache-2.0
// The command as a shell calls it, and a patch for it.
#pragma once

#include "tests/support/recording_patch.hpp"
#include "tests/tools/run_command.hpp"

#include <string>

namespace tactus::test {

/// In `folder`; $T is the command. Standard output and error are apart.
inline Outcome shell(const Folder& folder, const std::string& script) {
    const fs::path out = folder.path / "shell.out", err = folder.path / "shell.err";
    const fs::path file = folder.write("shell.sh", "cd " + folder.path.string() + "\nT=" + command() + "\n" + script);
    const int status = std::system(("sh " + file.string() + " >" + out.string() + " 2>" + err.string()).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(out), slurp(err)};
}

}  // namespace tactus::test
