// SPDX-License-Identifier: Apache-2.0
// `tactus-bench`: the benchmarks, started by `tactus bench`.
#include "tools/bench/bench.hpp"

int main(int argc, char** argv) {
    using namespace tactus;
    const command::Verbs verbs{
        bench::engine_verb(),      bench::nodes_verb(),       bench::contact_verb(),     bench::view_verb(),
        bench::pictures_verb(),    bench::lateness_verb(),    bench::scrub_verb(),       bench::snap_verb(),
        bench::passivity_verb(),   bench::device_verb(),      bench::saw_verb(),         bench::fits_verb(),
        bench::assembly_verb(),    bench::shafts_verb(),      bench::proposals_verb(),   bench::segment_verb(),
        bench::vessel_verb(),      bench::rope_verb(),        bench::reconstruct_verb(), bench::guides_verb(),
        bench::peers_verb(),       bench::fundamental_verb(), bench::identify_verb(),    bench::verdicts_verb(),
        bench::experiments_verb(), bench::sweep_verb(),       bench::takes_verb()};
    return command::command_line(
        {"tactus bench", "benchmarks of this machine, compared with other programs if they are installed", verbs}, argc,
        argv);
}
