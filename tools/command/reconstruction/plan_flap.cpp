// SPDX-License-Identifier: Apache-2.0
// tactus plan plate, implant, vessel, site, margin, limits: each changes the reconstruction of a plan by one step; vessel
// also a plan without one.
#include "assets/file/extension.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/reconstruction/plate_line.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/plan_vessels.hpp"
#include "tools/command/plan/plan_options.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;
using reconstruction::Flap;
using reconstruction::Reconstruction;

struct FlapChoice : PlanChoice {
    std::string name, kind, of_scan;
    fs::path file;
    int branch = 0;
    bool remove = false, perforators = false;
    std::vector<double> at, axis;
    std::optional<double> along, radius, margin, clearance, perforator, over, kink, twist;
    double diameter = 4.0, length = 14.0, height = 0.0, screw_length = 12.0;
    int screws = 2;
};

template <class Named>
auto find_named(std::vector<Named>& all, const std::string& name) {
    return std::ranges::find(all, name, &Named::name);
}

/// Replaces what has that name, or adds it.
template <class Named>
void put(std::vector<Named>& all, Named one) {
    if (const auto found = find_named(all, one.name); found != all.end()) *found = std::move(one);
    else all.push_back(std::move(one));
}

template <class Named>
void take_away(std::vector<Named>& all, const std::string& name, const char* what) {
    const auto found = find_named(all, name);
    if (found != all.end()) {
        all.erase(found);
        return;
    }
    std::vector<std::string> names;
    for (const Named& one : all) names.push_back(one.name);
    throw Error(fmt::format("the plan has no {} '{}'{}", what, name, did_you_mean(name, names)));
}

Vec3 in_metres(const std::vector<double>& mm_values) { return Vec3(mm_values[0], mm_values[1], mm_values[2]) * mm; }

int changed(const FlapChoice& choice, const std::function<void(Reconstruction&, const plan::CasePlan&)>& change) {
    analysis::change_reconstruction(choice.plan, change);
    return show_change(choice);
}

int plate(const FlapChoice& choice) {
    return changed(choice, [&](Reconstruction& all, const plan::CasePlan& plan) {
        if (choice.remove) return take_away(all.flap.plates, choice.name, "plate");
        const analysis::FlapStudy study(plan, plan::state_of(plan), choice.plan.parent_path());
        reconstruction::PlateSettings settings;
        settings.screws_per_segment = choice.screws;
        settings.screw_length = choice.screw_length * mm;
        settings.height = choice.height * mm;
        reconstruction::Plate made = reconstruction::plate_on(study.inputs(), study.fibula(), settings);
        made.name = choice.name;
        put(all.flap.plates, std::move(made));
    });
}

int implant(const FlapChoice& choice) {
    return changed(choice, [&](Reconstruction& all, const plan::CasePlan&) {
        if (choice.remove) return take_away(all.flap.implants, choice.name, "implant");
        if (choice.at.empty() || choice.axis.empty()) throw Error("an implant needs --at and --axis");
        const Vec3 axis = in_metres(choice.axis);
        if (!(glm::length(axis) > 0.0)) throw Error("--axis: 0, 0, 0 is no direction");
        put(all.flap.implants,
            {choice.name, in_metres(choice.at), glm::normalize(axis), choice.diameter * mm, choice.length * mm});
    });
}

reconstruction::VesselKind kind_of(const FlapChoice& choice, const std::string& name, const char* what) {
    if (choice.kind.empty()) return reconstruction::kind_in(name, fmt::format("without --kind, the {}'s name", what));
    return choice.kind == "vein" ? reconstruction::VesselKind::vein : reconstruction::VesselKind::artery;
}

bool is_table(const fs::path& file) { return file::extension_of(file) == ".csv"; }

void print(const std::vector<std::string>& notes) {
    for (const std::string& note : notes) fmt::print(stderr, "note: {}\n", note);
}

/// One of the scan, or from a file.
reconstruction::FlapVessel found_vessel(const FlapChoice& choice) {
    if (choice.of_scan.empty()) {
        std::vector<std::string> notes;
        reconstruction::FlapVessel found =
            reconstruction::read_vessel(choice.file, reconstruction::VesselKind::artery, choice.branch, notes);
        print(notes);
        return found;
    }
    if (choice.branch != 0) throw Error("--branch is of a file: give --file VESSEL.csv instead of --of-scan");
    return analysis::vessel_of_scan(plan::load_case_plan(choice.plan), choice.of_scan);
}

int vessel(const FlapChoice& choice) {
    if (!choice.remove && choice.file.empty() == choice.of_scan.empty())
        throw Error(
            "a vessel needs --file, a table (.csv) or a curve (.mrk.json), or --of-scan, the name of one that the "
            "plan has of its scan");
    analysis::change_vessels(choice.plan, [&](std::vector<reconstruction::FlapVessel>& vessels) {
        if (choice.remove) return take_away(vessels, choice.name, "vessel");
        reconstruction::FlapVessel found = found_vessel(choice);
        if (choice.of_scan.empty() || !choice.kind.empty()) found.kind = kind_of(choice, choice.name, "vessel");
        found.name = choice.name;
        if (choice.radius) found.radius = *choice.radius * mm;
        put(vessels, std::move(found));
    });
    return show_change(choice);
}

void add_site(Flap& flap, const FlapChoice& choice, const std::string& name, const Vec3& at) {
    if (choice.perforators) return put(flap.perforators, {name, at});
    put(flap.sites, {name, kind_of(choice, name, "site"), at});
}

/// On a vessel that was followed in a scan of the neck.
void add_site_on_vessel(Flap& flap, const FlapChoice& choice) {
    if (choice.name.empty()) throw Error("a site on a vessel needs a name");
    const reconstruction::FlapVessel on = found_vessel(choice);
    const Vec3 at = analysis::place_along(on, choice.along ? *choice.along * mm : analysis::length_of(on));
    if (choice.of_scan.empty() || !choice.kind.empty() || choice.perforators)
        return add_site(flap, choice, choice.name, at);
    put(flap.sites, {choice.name, on.kind, at});
}

int site(const FlapChoice& choice) {
    return changed(choice, [&](Reconstruction& all, const plan::CasePlan&) {
        if (choice.remove)
            return choice.perforators ? take_away(all.flap.perforators, choice.name, "perforator")
                                      : take_away(all.flap.sites, choice.name, "site");
        if (!choice.file.empty() + !choice.at.empty() + !choice.of_scan.empty() != 1)
            throw Error(
                "a site needs a place: --at X Y Z, --file MARKS.mrk.json for all of its marks, or a vessel: --file "
                "VESSEL.csv or --of-scan NAME");
        if (!choice.of_scan.empty() || is_table(choice.file)) return add_site_on_vessel(all.flap, choice);
        if (choice.along) throw Error("--along is a way on a vessel: give --file VESSEL.csv or --of-scan NAME");
        if (!choice.at.empty()) {
            if (choice.name.empty()) throw Error("--at needs a name");
            return add_site(all.flap, choice, choice.name, in_metres(choice.at));
        }
        std::vector<std::string> names, notes;
        bool is_found = false;
        const std::vector<reconstruction::MarkedPoint> marks = reconstruction::read_marks(choice.file, notes);
        print(notes);
        for (const reconstruction::MarkedPoint& mark : marks) {
            names.push_back(mark.name);
            if (!choice.name.empty() && mark.name != choice.name) continue;
            is_found = true;
            add_site(all.flap, choice, mark.name, mark.at);
        }
        if (!is_found)
            throw Error(fmt::format("{}: has no mark '{}'{}", choice.file.string(), choice.name,
                                    did_you_mean(choice.name, names)));
    });
}

int margin(const FlapChoice& choice) {
    return changed(choice, [&](Reconstruction& all, const plan::CasePlan&) {
        if (choice.remove) all.tumour.reset();
        if (!choice.file.empty()) {
            reconstruction::read_surface(choice.file);  // refuses what is no mesh
            all.tumour = analysis::mesh_file(choice.file, choice.plan.parent_path());
        }
        if (choice.margin) all.flap.margin = *choice.margin * mm;
        if (!choice.remove && choice.file.empty() && !choice.margin)
            throw Error("give the tumour's mesh, --margin, or --remove");
    });
}

int limits(const FlapChoice& choice) {
    if (!choice.clearance && !choice.perforator && !choice.over && !choice.kink && !choice.twist)
        throw Error("give one of --clearance, --perforator, --over, --kink, --twist");
    return changed(choice, [&](Reconstruction& all, const plan::CasePlan&) {
        reconstruction::FlapLimits& to = all.flap.limits;
        if (choice.clearance) to.clearance = *choice.clearance * mm;
        if (choice.perforator) to.perforator_to_cut = *choice.perforator * mm;
        if (choice.over) to.over_in_situ = *choice.over * 0.01;
        if (choice.kink) to.kink = *choice.kink;
        if (choice.twist) to.twist = *choice.twist * std::numbers::pi / 180.0;
    });
}

std::shared_ptr<FlapChoice> choice_of(VerbOptions& verb) {
    auto choice = std::make_shared<FlapChoice>();
    add_plan_options(verb, *choice);
    return choice;
}

}  // namespace

Verb plan_plate_verb() {
    return {"plate", "lay a plate on the outer contour of the segments and the jaw's stumps, with screws",
            [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb);
                verb.add("name", choice->name, "name of the plate; one of that name is replaced").required();
                verb.add("--screws", choice->screws, "screws per segment").range(0, 6).shows_default();
                verb.add("--screw-length", choice->screw_length, "mm; the default is a placeholder")
                    .range(1.0, 40.0)
                    .shows_default();
                verb.add("--height", choice->height, "mm by which it lies above the segments' axes")
                    .range(-15.0, 15.0)
                    .shows_default();
                verb.flag("--remove", choice->remove, "take it away");
                return [choice] { return plate(*choice); };
            }};
}

Verb plan_implant_verb() {
    return {"implant", "place a dental implant, in the frame of the jaw", [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb);
                verb.add("name", choice->name, "name of the implant; one of that name is replaced").required();
                verb.add("--at", choice->at, "its head: X Y Z, mm").count(3);
                verb.add("--axis", choice->axis, "direction into the bone: X Y Z").count(3);
                verb.add("--diameter", choice->diameter, "mm").range(0.5, 15.0).shows_default();
                verb.add("--length", choice->length, "mm").range(1.0, 40.0).shows_default();
                verb.flag("--remove", choice->remove, "take it away");
                return [choice] { return implant(*choice); };
            }};
}

Verb plan_vessel_verb() {
    return {
        "vessel", "add a vessel that 'tactus vessel' followed: of a reconstruction the donor's, else of the case",
        [](VerbOptions& verb) -> Action {
            const auto choice = choice_of(verb);
            verb.add("name", choice->name, "name of the vessel; one of that name is replaced").required();
            verb.add("--file", choice->file, "table of 'tactus vessel' (.csv) or curve of 3D Slicer (.mrk.json)");
            verb.add("--branch", choice->branch, "branch of the table, or curve of the markups")
                .range(0, 10000)
                .shows_default();
            verb.add(
                "--of-scan", choice->of_scan,
                "take a vessel that the plan has of its scan into its reconstruction, which must be in that frame");
            verb.add("--kind", choice->kind, "default: as its name says, or as in the scan").one_of({"artery", "vein"});
            verb.add("--radius", choice->radius, "mm (default: of the table; of a curve 1.5)").range(0.1, 10.0);
            verb.flag("--remove", choice->remove, "take it away");
            return [choice] { return vessel(*choice); };
        }};
}

Verb plan_site_verb() {
    return {
        "site", "mark vessels of the neck to which the flap's can be joined, or perforators of the leg",
        [](VerbOptions& verb) -> Action {
            const auto choice = choice_of(verb);
            verb.add("name", choice->name, "name of the mark; one of that name is replaced");
            verb.add("--at", choice->at, "X Y Z, mm; sites in the frame of the jaw, perforators in the donor's")
                .count(3);
            verb.add(
                "--file", choice->file,
                "take the mark of that name from a file of 3D Slicer (.mrk.json, .fcsv), or all of its marks; or a "
                "place on a vessel of a table of 'tactus vessel' (.csv)");
            verb.add("--branch", choice->branch, "branch of the table").range(0, 10000).shows_default();
            verb.add("--of-scan", choice->of_scan, "a place on a vessel that the plan has of its scan");
            verb.add("--along", choice->along,
                     "mm on the vessel from its first point to the site (default: its last point)")
                .range(0.0, 10000.0);
            verb.add("--kind", choice->kind, "default: as its name says, or as in the scan").one_of({"artery", "vein"});
            verb.flag("--perforator", choice->perforators, "perforators of the leg instead of sites of the neck");
            verb.flag("--remove", choice->remove, "take it away");
            return [choice] { return site(*choice); };
        }};
}

Verb plan_margin_verb() {
    return {"margin", "set the tumour of the jaw and the margin that its cuts keep", [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb);
                verb.add("tumour", choice->file, "closed mesh, in the frame of the jaw");
                verb.add("--margin", choice->margin, "mm").range(0.0, 100.0);
                verb.flag("--remove", choice->remove, "take the tumour away");
                return [choice] { return margin(*choice); };
            }};
}

Verb plan_limits_verb() {
    return {"limits", "set the thresholds of the flap's warnings", [](VerbOptions& verb) -> Action {
                const auto choice = choice_of(verb);
                verb.add(
                        "--clearance", choice->clearance,
                        "mm between plates, screws, implants, cuts and vessels; at first 1 (BoneReconstructionPlanner)")
                    .range(0.0, 100.0);
                verb.add("--perforator", choice->perforator,
                         "mm between a perforator and an osteotomy; at first 3, a placeholder")
                    .range(0.0, 100.0);
                verb.add("--over", choice->over,
                         "% over its length in the leg at which a vessel no longer reaches; at first 10, a placeholder")
                    .range(0.0, 100.0);
                verb.add("--kink", choice->kink,
                         "radii of a vessel below which a bend is a kink; at first 3, no source seen")
                    .range(0.0, 100.0);
                verb.add("--twist", choice->twist, "degrees; at first 90 (rat, Guven 2012)").range(0.0, 180.0);
                return [choice] { return limits(*choice); };
            }};
}

}  // namespace tactus::command
