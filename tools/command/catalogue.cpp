// SPDX-License-Identifier: Apache-2.0
// One line per verb, in the order of the help text. The file of a verb defines it: `Verb render_verb()`.
#include "tools/command/catalogue.hpp"

// name, folder, heading of the help text
#define TACTUS_VERBS(X)                   \
    X(new, run, run_and_patch)            \
    X(run, run, run_and_patch)            \
    X(render, run, run_and_patch)         \
    X(check, run, run_and_patch)          \
    X(draw, run, run_and_patch)           \
    X(nodes, machine, run_and_patch)      \
    X(set, run, run_and_patch)            \
    X(trigger, run, run_and_patch)        \
    X(replay, run, run_and_patch)         \
    X(view, run, run_and_patch)           \
    X(spectrum, vibration, vibrations)    \
    X(orders, vibration, vibrations)      \
    X(response, vibration, vibrations)    \
    X(compare, vibration, vibrations)     \
    X(validate, vibration, vibrations)    \
    X(measure, vibration, vibrations)     \
    X(equalise, vibration, vibrations)    \
    X(model, vibration, vibrations)       \
    X(exposure, vibration, vibrations)    \
    X(import, bones, bones)               \
    X(info, bones, bones)                 \
    X(segment, bones, bones)              \
    X(export, bones, bones)               \
    X(register, bones, bones)             \
    X(vessel, bones, bones)               \
    X(fracture, bones, fractures)         \
    X(fracture_surface, bones, fractures) \
    X(snap, bones, fractures)             \
    X(flap, bones, fractures)             \
    X(plan, planning, fractures)          \
    X(session, training, training)        \
    X(score, training, training)          \
    X(experiment, experiment, research)   \
    X(gripper, grippers, grippers)        \
    X(calibrate, displays, displays)      \
    X(devices, machine, machine)          \
    X(cache, machine, machine)            \
    X(bench, machine, machine)            \
    X(generate, machine, machine)

#define TACTUS_PLAN_VERBS(X)         \
    X(plan_new, planning)            \
    X(plan_show, planning)           \
    X(plan_check, planning)          \
    X(plan_move, planning)           \
    X(plan_group, planning)          \
    X(plan_add, planning)            \
    X(plan_remove, planning)         \
    X(plan_ungroup, planning)        \
    X(plan_lock, planning)           \
    X(plan_unlock, planning)         \
    X(plan_hide, planning)           \
    X(plan_unhide, planning)         \
    X(plan_repaint, planning)        \
    X(plan_undo, planning)           \
    X(plan_redo, planning)           \
    X(plan_alternative, planning)    \
    X(plan_snap, planning)           \
    X(plan_settle, planning)         \
    X(plan_accept, planning)         \
    X(plan_assemble, planning)       \
    X(plan_mirror, planning)         \
    X(plan_gap, planning)            \
    X(plan_export, planning)         \
    X(plan_report, planning)         \
    X(plan_fibula, reconstruct)      \
    X(plan_reconstruct, reconstruct) \
    X(plan_plate, reconstruct)       \
    X(plan_implant, reconstruct)     \
    X(plan_vessel, reconstruct)      \
    X(plan_site, reconstruct)        \
    X(plan_margin, reconstruct)      \
    X(plan_limits, reconstruct)      \
    X(plan_paddle, reconstruct)      \
    X(plan_reach, reconstruct)       \
    X(plan_guide, reconstruct)

#define TACTUS_EXPERIMENT_VERBS(X)    \
    X(experiment_run, experiment)     \
    X(experiment_check, experiment)   \
    X(experiment_analyse, experiment) \
    X(experiment_withdraw, experiment)

namespace tactus::command {

namespace {

constexpr const char *run_and_patch = "Run and patch", *vibrations = "Vibration", *bones = "Bones",
                     *fractures = "Fractures and plans", *training = "Training", *research = "Experiments",
                     *grippers = "Grippers", *displays = "Displays", *machine = "This machine";

Verb under(const char* job, Verb verb) {
    verb.job = job;
    return verb;
}

}  // namespace

#define TACTUS_DECLARE(name, ...) Verb name##_verb();
TACTUS_VERBS(TACTUS_DECLARE)
TACTUS_PLAN_VERBS(TACTUS_DECLARE)
TACTUS_EXPERIMENT_VERBS(TACTUS_DECLARE)
#undef TACTUS_DECLARE

#define TACTUS_LIST(name, folder, job) under(job, name##_verb()),

const Verbs& all_verbs() {
    static const Verbs all{TACTUS_VERBS(TACTUS_LIST)};
    return all;
}

#undef TACTUS_LIST
#define TACTUS_LIST(name, folder) name##_verb(),

Program tactus_program() {
    return {"tactus", "Tactus: patches of nodes for haptics, from 60 Hz to audio rate", all_verbs()};
}

const Verbs& plan_verbs() {
    static const Verbs all{TACTUS_PLAN_VERBS(TACTUS_LIST)};
    return all;
}

const Verbs& experiment_verbs() {
    static const Verbs all{TACTUS_EXPERIMENT_VERBS(TACTUS_LIST)};
    return all;
}

#undef TACTUS_LIST

}  // namespace tactus::command
