// SPDX-License-Identifier: Apache-2.0
// `tactus-bench`, which `tactus bench` runs: figures of this machine.
#include "tools/bench/bench.hpp"

int main(int argc, char** argv) {
    using namespace tactus;
    const command::Verbs verbs{bench::engine_verb(), bench::contact_verb(), bench::view_verb(),
                               bench::scrub_verb(),  bench::snap_verb(),    bench::device_verb()};
    return command::command_line(
        {"tactus bench", "figures of this machine, beside other programs where they are installed", verbs}, argc, argv);
}
