// SPDX-License-Identifier: Apache-2.0
// What the buttons of the plan do, for those who have no mouse.
#include "tools/window/plan/plan_panel.hpp"

namespace tactus::window {

std::vector<int> PlanPanel::meant() const {
    std::vector<int> chosen = scene_.chosen_places();
    if (chosen.empty() && case_.held_last() >= 0) chosen.push_back(case_.held_last());
    return chosen;
}

void PlanPanel::on_meant(const std::function<void(const std::vector<int>&)>& what) {
    const std::vector<int> all = meant();
    if (all.empty()) return bench_.tell("choose a fragment first, in the scene or in its list", true);
    what(all);
}

void PlanPanel::split() {
    on_meant([this](const std::vector<int>& all) { case_.give(plan::SplitFragments{plan::set_of(all)}); });
}

void PlanPanel::lock() {
    on_meant([this](const std::vector<int>& all) { case_.toggle_lock(all); });
}

void PlanPanel::hide() {
    on_meant([this](const std::vector<int>& all) { case_.give(plan::HideFragments{plan::set_of(all)}); });
}

/// The chosen fragments, or the one held last and the partner of its fit.
void PlanPanel::group() {
    std::vector<int> all = scene_.chosen_places();
    if (const auto fit = case_.fit(); all.empty() && fit && fit->partner >= 0 && fit->fragment >= 0)
        all = {fit->fragment, fit->partner};
    if (all.size() > 1) return case_.give(plan::JoinFragments{plan::set_of(all)});
    bench_.tell("choose two fragments or more, by the list of the scene or by 'Choose' in the list of commands", true);
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
    const auto can = [this] { return case_.can_give(); };
    const auto can_place = [this] { return this->can_place(); };
    add("Snap the chosen fragment to where it fits", "match place fracture", can_place, [this] { snap(); });
    add("Put the chosen fragment back to where the scan has it", "original", can_place, [this] { put_back(); });
    add(
        "Put the chosen fragment on the mirrored side", "healthy", [this] { return this->can_place() && has_mirror(); },
        [this] { put_on_mirror(); });
    add("Accept the place of the chosen fragment", "decision", can_place, [this] { accept(); });
    add("Group the chosen fragments", "join together", can, [this] { group(); });
    add("Split the chosen fragments", "group apart", can, [this] { split(); });
    add("Lock or unlock the chosen fragments", "fix", can, [this] { lock(); });
    add("Hide the chosen fragments in the plan", "remove", can, [this] { hide(); });
    add("Show the fragments that the plan hides", "all", can, [this] { case_.show_hidden(); });
    add("Undo a step of the plan", "back", can, [this] { case_.give(plan::UndoStep{}); });
    add("Redo a step of the plan", "again", can, [this] { case_.give(plan::RedoStep{}); });
    const auto can_change_flap = [this] { return flap_.flap().reconstruction() && !flap_.flap().is_changing(); };
    add("Make a cutting guide", "print saw slot", can_change_flap, [this] { flap_.ask_guide(); });
    add("Skin paddle of the flap", "perforator leg place", can_change_flap, [this] { flap_.ask_paddle(); });
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
