// SPDX-License-Identifier: Apache-2.0
// One line per verb, in the order of the help text. The file of a verb defines it: `Verb render_verb()`.
#include "tools/command/catalogue.hpp"

// name, folder, heading of the help text
#define TACTUS_VERBS(X)                  \
    X(new, run, run_and_patch)           \
    X(try, run, run_and_patch)           \
    X(run, run, run_and_patch)           \
    X(render, run, run_and_patch)        \
    X(check, run, run_and_patch)         \
    X(draw, run, run_and_patch)          \
    X(nodes, machine, run_and_patch)     \
    X(set, run, run_and_patch)           \
    X(trigger, run, run_and_patch)       \
    X(replay, run, run_and_patch)        \
    X(view, run, run_and_patch)          \
    X(spectrum, vibration, vibrations)   \
    X(orders, vibration, vibrations)     \
    X(response, vibration, vibrations)   \
    X(compare, vibration, vibrations)    \
    X(validate, vibration, vibrations)   \
    X(measure, vibration, vibrations)    \
    X(equalise, vibration, vibrations)   \
    X(model, vibration, vibrations)      \
    X(exposure, vibration, vibrations)   \
    X(import, bone, bones)               \
    X(info, bone, bones)                 \
    X(segment, bone, bones)              \
    X(export, bone, bones)               \
    X(register, bone, bones)             \
    X(vessel, bone, bones)               \
    X(fracture, bone, fractures)         \
    X(fracture_surface, bone, fractures) \
    X(snap, bone, fractures)             \
    X(flap, bone, fractures)             \
    X(plan, plan, fractures)             \
    X(session, training, training)       \
    X(score, training, training)         \
    X(experiment, experiment, research)  \
    X(sweep, sweep, research)            \
    X(gripper, gripper, grippers)        \
    X(calibrate, display, displays)      \
    X(devices, machine, machine)         \
    X(cache, machine, machine)           \
    X(bench, machine, machine)           \
    X(generate, machine, machine)

#define TACTUS_PLAN_VERBS(X)            \
    X(plan_new, plan)                   \
    X(plan_show, plan)                  \
    X(plan_check, plan)                 \
    X(plan_move, plan)                  \
    X(plan_group, plan)                 \
    X(plan_add, plan)                   \
    X(plan_remove, plan)                \
    X(plan_ungroup, plan)               \
    X(plan_lock, plan)                  \
    X(plan_unlock, plan)                \
    X(plan_hide, plan)                  \
    X(plan_unhide, plan)                \
    X(plan_repaint, plan)               \
    X(plan_undo, plan)                  \
    X(plan_redo, plan)                  \
    X(plan_alternative, plan)           \
    X(plan_snap, plan)                  \
    X(plan_settle, plan)                \
    X(plan_accept, plan)                \
    X(plan_assemble, plan)              \
    X(plan_mirror, plan)                \
    X(plan_gap, plan)                   \
    X(plan_export, plan)                \
    X(plan_report, plan)                \
    X(plan_fibula, reconstruction)      \
    X(plan_reconstruct, reconstruction) \
    X(plan_cuts, reconstruction)        \
    X(plan_plate, reconstruction)       \
    X(plan_implant, reconstruction)     \
    X(plan_vessel, reconstruction)      \
    X(plan_site, reconstruction)        \
    X(plan_margin, reconstruction)      \
    X(plan_limits, reconstruction)      \
    X(plan_paddle, reconstruction)      \
    X(plan_reach, reconstruction)       \
    X(plan_guide, reconstruction)       \
    X(plan_template, reconstruction)

#define TACTUS_EXPERIMENT_VERBS(X)    \
    X(experiment_run, experiment)     \
    X(experiment_check, experiment)   \
    X(experiment_analyse, experiment) \
    X(experiment_withdraw, experiment)

#define TACTUS_SWEEP_VERBS(X) \
    X(sweep_run, sweep)       \
    X(sweep_work, sweep)      \
    X(sweep_status, sweep)    \
    X(sweep_plot, sweep)      \
    X(sweep_report, sweep)    \
    X(sweep_verify, sweep)

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
TACTUS_SWEEP_VERBS(TACTUS_DECLARE)
#undef TACTUS_DECLARE

#define TACTUS_LIST(name, folder, job) under(job, name##_verb()),

const Verbs& all_verbs() {
    static const Verbs all{TACTUS_VERBS(TACTUS_LIST)};
    return all;
}

#undef TACTUS_LIST
#define TACTUS_LIST(name, folder) name##_verb(),

Program tactus_program() {
    return {"tactus", "Tactus: patches of nodes for haptics, from 60 Hz to audio rate", all_verbs(),
            "Tactus: patches of nodes for haptics, from 60 Hz to audio rate.\n"
            "\n"
            "  tactus try                            saw a jaw with the mouse, in a window with sound\n"
            "  tactus view                           the window: choose an example, a patch, a plan or a take\n"
            "  tactus render saw-training --out DIR  the same without window, mouse and sound card: files and numbers\n"
            "  tactus new my-patch.toml              begin a patch of your own\n"
            "  tactus --help                         all verbs; 'tactus VERB --help' explains one\n"};
}

const Verbs& plan_verbs() {
    static const Verbs all{TACTUS_PLAN_VERBS(TACTUS_LIST)};
    return all;
}

const Verbs& experiment_verbs() {
    static const Verbs all{TACTUS_EXPERIMENT_VERBS(TACTUS_LIST)};
    return all;
}

const Verbs& sweep_verbs() {
    static const Verbs all{TACTUS_SWEEP_VERBS(TACTUS_LIST)};
    return all;
}

#undef TACTUS_LIST

}  // namespace tactus::command
