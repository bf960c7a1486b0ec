// SPDX-License-Identifier: Apache-2.0
// tactus bench: runs the program tactus-bench.
#include "tools/command/options.hpp"
#include "tools/command/other_program.hpp"

namespace tactus::command {

Verb bench_verb() {
    return {"bench", "benchmarks of this machine, compared with other programs if they are installed", nullptr, nullptr,
            [](const std::vector<std::string>& arguments) -> int {
                run_beside("tactus-bench", "the benchmarks", arguments);
            }};
}

}  // namespace tactus::command
