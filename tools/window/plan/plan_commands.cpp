// SPDX-License-Identifier: Apache-2.0
// What the buttons of the plan do, for those who have no mouse.
#include "tools/window/plan/plan_panel.hpp"

namespace tactus::window {

void PlanPanel::on_chosen(const char* input) {
    const std::vector<int> chosen = scene_.chosen_places();
    if (chosen.empty()) case_.press(input);
    for (const int place : chosen) case_.press(input, place);
}

void PlanPanel::add_commands(std::vector<Command>& all) {
    if (!case_.is_there()) return;
    const auto add = [&](const char* name, const char* about, std::function<bool()> may, std::function<void()> run) {
        all.push_back({"plan", name, "", about, std::move(run), std::move(may)});
    };
    struct OfHand {
        const char *what, *name, *about;
    };
    for (const OfHand& each : {OfHand{"grasp", "Grasp the fragment, or let it go", "hold take"},
                               OfHand{"snap", "Snap: look for a fit, or no longer", "match pull"},
                               OfHand{"settle", "Settle: put it where it fits, or no longer", "place step"}})
        if (const auto number = case_.hand_button(each.what); number && scene_.hand().is_there())
            add(each.name, each.about, nullptr,
                [this, number = *number] { scene_.hand().hold(number, !scene_.hand().is_held(number)); });
    const auto can = [this](const char* input) { return [this, input] { return case_.can_press(input); }; };
    add("Group the chosen fragments", "join together", can("join"), [this] {
        const std::vector<int> chosen = scene_.chosen_places();
        if (chosen.size() > 1) case_.join(chosen);
        else if (chosen.empty()) case_.press("join");
        else
            bench_.tell("choose two fragments or more, by the list of the scene or by 'Choose' in the list of commands",
                        true);
    });
    add("Split the chosen fragments", "group apart", can("split"), [this] { on_chosen("split"); });
    add("Lock or unlock the chosen fragments", "fix", can("lock"), [this] { on_chosen("lock"); });
    add("Hide the chosen fragments in the plan", "remove", can("hide"), [this] { on_chosen("hide"); });
    add("Show the fragments that the plan hides", "all", can("show"), [this] { case_.press("show"); });
    add("Undo a step of the plan", "back", can("undo"), [this] { case_.press("undo"); });
    add("Redo a step of the plan", "again", can("redo"), [this] { case_.press("redo"); });
    add(
        "Another name for the alternative", "rename",
        [this] { return case_.plan() && (case_.is_live() || case_.changes_document()); },
        [this] { alternatives_.ask_name(); });
    const auto free = [this] { return case_.plan() && !case_.is_busy(); };
    const auto study = [&](const char* name, const char* about, CaseRun::Study what) {
        add(name, about, free, [this, what] { case_.begin(what); });
    };
    study("Gaps between the fragments", "measure distance", CaseRun::Study::gaps);
    study("Distance from the mirrored healthy side", "measure", CaseRun::Study::healthy);
    study("Report of the plan", "page html", CaseRun::Study::report);
    study("Export the plan", "meshes transforms slicer stl", CaseRun::Study::files);
    const auto map = [&](const char* name, PlanMap::Kind kind) {
        add(
            name, "colours", [this] { return case_.plan() != nullptr; },
            [this, kind] { map_.show(map_.shown() == kind ? std::nullopt : std::optional(kind)); });
    };
    map("Map of gaps, or none", PlanMap::Kind::gaps);
    map("Map of the distance from the healthy side, or none", PlanMap::Kind::healthy);
}

}  // namespace tactus::window
