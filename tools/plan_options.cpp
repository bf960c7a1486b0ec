// SPDX-License-Identifier: Apache-2.0
#include "tools/plan_options.hpp"

#include "dsp/core/error.hpp"

#include <CLI/CLI.hpp>

namespace tactus {

namespace {

CLI::App* add(CLI::App& group, PlanChoice& choice, const char* name, const char* about) {
    CLI::App* verb = group.add_subcommand(name, about);
    verb->add_option("plan", choice.plan, "the plan, a JSON file")->required();
    verb->add_flag("--json", choice.json, "as JSON");
    return verb;
}

CLI::Option* add_fragments(CLI::App* verb, PlanChoice& choice, const char* about) {
    return verb->add_option("fragments", choice.names, about)->required();
}

void add_fitting(CLI::App& plan, PlanChoice& choice) {
    CLI::App* snap = add(plan, choice, "snap", "bring a fragment to where its fracture fits another; 1: it does not");
    add_fragments(snap, choice,
                  "the one that moves, with its group, and the one that stands (default: the best of all)")
        ->expected(1, 2);
    snap->add_option("--mode", choice.mode, "extended starts from where it is, global from anywhere")
        ->check(CLI::IsMember({"extended", "global"}))
        ->capture_default_str();
    CLI::App* settle =
        add(plan, choice, "settle",
            "seat fitted fragments once more, each on all of its neighbours together; 1: one does not fit");
    settle->add_option("fragments", choice.names, "which ones (default: all that were fitted)");
    settle->add_option("--passes", choice.steps, "how often")->check(CLI::Range(1, 20));
    CLI::App* mirror = add(plan, choice, "mirror", "the healthy side, mirrored and laid on a fragment, as a target");
    mirror->add_option("healthy", choice.healthy, "bone file or mesh of the other side")->required();
    add_fragments(mirror, choice, "the one that stands; more of them are compared, or moved with --settle");
    mirror->add_flag("--settle", choice.settle, "move the others to where they lie best on the target");
    CLI::App* gap = add(plan, choice, "gap", "gap, contact and overlap of fragments as they are placed");
    gap->add_option("fragments", choice.names, "two of them (default: all pairs that face each other)");
}

}  // namespace

void add_plan_verbs(CLI::App& app, PlanChoice& choice) {
    CLI::App* plan = app.add_subcommand("plan", "keep the plan of a case: fragments, their places, and every step");
    plan->require_subcommand(1);
    CLI::App* made = add(*plan, choice, "new", "a plan of fragments as they were scanned");
    made->add_option("files", choice.names, "bone files or closed meshes, FILE or NAME=FILE")->required();
    made->add_option("--title", choice.title, "what the case is called");
    add(*plan, choice, "show", "fragments, groups, alternatives, and what is wrong with the files");
    CLI::App* move = add(*plan, choice, "move", "place a fragment and all that is grouped with it");
    add_fragments(move, choice, "which one")->expected(1);
    move->add_option("--pose", choice.pose, "X,Y,Z,QW,QX,QY,QZ: p_case = R p_file + t, in mm")->required();
    CLI::App* group = add(*plan, choice, "group", "let fragments, and the groups they are in, move as one");
    add_fragments(group, choice, "which ones");
    group->add_option("--name", choice.group, "of the group (default: a number)");
    CLI::App* into = add(*plan, choice, "add", "fragments, and the groups they are in, become part of a group");
    into->add_option("group", choice.group, "which group")->required();
    add_fragments(into, choice, "which ones");
    add_fragments(add(*plan, choice, "remove", "fragments leave all groups"), choice, "which ones");
    add(*plan, choice, "ungroup", "the parts of a group stand on their own")
        ->add_option("group", choice.group, "which group")
        ->required();
    add_fragments(add(*plan, choice, "lock", "fragments, and what is grouped with them, stay"), choice, "which ones");
    add_fragments(add(*plan, choice, "unlock", "they may move again"), choice, "which ones");
    add_fragments(add(*plan, choice, "hide", "fragments are left out of pictures and fits"), choice, "which ones");
    add_fragments(add(*plan, choice, "unhide", "they are there again"), choice, "which ones");
    for (const char* name : {"undo", "redo"})
        add(*plan, choice, name, name == std::string("undo") ? "steps back; none is lost" : "steps on again")
            ->add_option("--steps", choice.steps, "how many")
            ->check(CLI::PositiveNumber);
    CLI::App* alternative = add(*plan, choice, "alternative", "begin one where the plan stands, or go to another");
    alternative->add_option("name", choice.alternative, "which (default: list them)");
    alternative->add_option("--from", choice.from, "begin it where this one stands");
    alternative->add_flag("--remove", choice.remove, "forget the name; its steps stay in the file");
    add_fitting(*plan, choice);
    CLI::App* out = add(*plan, choice, "export", "placed fragments, transforms and landmarks for other programs");
    out->add_option("--out", choice.out, "folder")->required();
    out->add_option("--format", choice.format, "of the meshes")
        ->check(CLI::IsMember({"stl", "ply"}))
        ->capture_default_str();
    add(*plan, choice, "report", "one page with pictures, gaps, fits and the order of steps")
        ->add_option("-o,--out", choice.out, "HTML file (default: beside the plan)");
}

int plan_verb(const CLI::App& app, const PlanChoice& choice) {
    const std::string verb = app.get_subcommand("plan")->get_subcommands().front()->get_name();
    if (verb == "new") return plan_new(choice);
    if (verb == "show") return plan_show(choice);
    if (verb == "move") return plan_move(choice);
    if (verb == "undo") return plan_undo(choice);
    if (verb == "redo") return plan_redo(choice);
    if (verb == "alternative") return plan_alternative(choice);
    if (verb == "snap") return plan_snap(choice);
    if (verb == "settle") return plan_settle(choice);
    if (verb == "mirror") return plan_mirror(choice);
    if (verb == "gap") return plan_gap(choice);
    if (verb == "export") return plan_export(choice);
    if (verb == "report") return plan_report(choice);
    return plan_arrange(choice, verb);
}

}  // namespace tactus
