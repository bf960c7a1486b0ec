// SPDX-License-Identifier: Apache-2.0
// The verbs of tactus-bench.
#pragma once

#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

#include <memory>

namespace tactus::bench {

using command::Action;
using command::Verb;
using command::VerbOptions;

/// Options shared by most benchmarks.
struct BenchChoice {
    int rounds = 3;  ///< number of repetitions; the best one counts
    bool json = false;
};

Verb engine_verb();
Verb nodes_verb();
Verb contact_verb();
Verb view_verb();
Verb pictures_verb();
Verb lateness_verb();
Verb scrub_verb();
Verb takes_verb();
Verb snap_verb();
Verb passivity_verb();
Verb device_verb();
Verb saw_verb();
Verb fits_verb();
Verb assembly_verb();
Verb shafts_verb();
Verb proposals_verb();
Verb segment_verb();
Verb vessel_verb();
Verb rope_verb();
Verb reconstruct_verb();
Verb guides_verb();
Verb peers_verb();
Verb fundamental_verb();
Verb identify_verb();
Verb verdicts_verb();
Verb experiments_verb();
Verb sweep_verb();

}  // namespace tactus::bench
