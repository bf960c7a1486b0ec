// SPDX-License-Identifier: Apache-2.0
// One line per verb, in the order of the help text. The file of a verb defines it: `Verb render_verb()`.
#include "tools/command/catalogue.hpp"

// name, folder
#define TACTUS_VERBS(X)        \
    X(render, run)             \
    X(rig, grippers)           \
    X(run, run)                \
    X(set, run)                \
    X(replay, run)             \
    X(view, run)               \
    X(check, run)              \
    X(draw, run)               \
    X(nodes, machine)          \
    X(devices, machine)        \
    X(calibrate, displays)     \
    X(import, bones)           \
    X(info, bones)             \
    X(export, bones)           \
    X(compare, vibration)      \
    X(validate, vibration)     \
    X(measure, vibration)      \
    X(equalise, vibration)     \
    X(spectrum, vibration)     \
    X(orders, vibration)       \
    X(exposure, vibration)     \
    X(fracture, bones)         \
    X(fracture_surface, bones) \
    X(snap, bones)             \
    X(register, bones)         \
    X(plan, planning)          \
    X(bench, machine)

#define TACTUS_PLAN_VERBS(X)      \
    X(plan_new, planning)         \
    X(plan_show, planning)        \
    X(plan_move, planning)        \
    X(plan_group, planning)       \
    X(plan_add, planning)         \
    X(plan_remove, planning)      \
    X(plan_ungroup, planning)     \
    X(plan_lock, planning)        \
    X(plan_unlock, planning)      \
    X(plan_hide, planning)        \
    X(plan_unhide, planning)      \
    X(plan_undo, planning)        \
    X(plan_redo, planning)        \
    X(plan_alternative, planning) \
    X(plan_snap, planning)        \
    X(plan_settle, planning)      \
    X(plan_mirror, planning)      \
    X(plan_gap, planning)         \
    X(plan_export, planning)      \
    X(plan_report, planning)

namespace tactus::command {

#define TACTUS_DECLARE(name, folder) Verb name##_verb();
TACTUS_VERBS(TACTUS_DECLARE)
TACTUS_PLAN_VERBS(TACTUS_DECLARE)
#undef TACTUS_DECLARE

#define TACTUS_LIST(name, folder) name##_verb(),

const Verbs& all_verbs() {
    static const Verbs all{TACTUS_VERBS(TACTUS_LIST)};
    return all;
}

const Verbs& plan_verbs() {
    static const Verbs all{TACTUS_PLAN_VERBS(TACTUS_LIST)};
    return all;
}

#undef TACTUS_LIST

}  // namespace tactus::command
