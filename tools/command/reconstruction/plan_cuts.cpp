// SPDX-License-Identifier: Apache-2.0
// tactus plan cuts: the cuts of a reconstruction, as planned or as its pieces were placed.
#include "tools/analysis/plan/plan_cuts.hpp"
#include "assets/file/json.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/constants.hpp"
#include "tools/analysis/plan/flap_study.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/reconstruction/fibula_text.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

using file::Json;

struct CutsChoice : PlanChoice {
    bool from_pieces = false;
    std::string alternative = "from-pieces";
};

Json cuts_json(const analysis::CutsOfPieces& found, const std::string& alternative) {
    Json segments = Json::array(), warnings = Json::array();
    for (std::size_t n = 0; n < found.segments.size(); ++n)
        segments.push_back({{"segment", found.segments[n]},
                            {"length_before_mm", found.before.segments[n].length_centre / mm},
                            {"length_mm", found.cuts.plan.segments[n].length_centre / mm},
                            {"from_placed_mm", found.cuts.moved[n] / mm},
                            {"from_placed_deg", found.cuts.turned[n] / degree}});
    for (const reconstruction::FibulaWarning& w : found.made.fibula.warnings)
        warnings.push_back({{"code", reconstruction::name_of(w.code)}, {"text", w.text}});
    return {{"alternative", alternative},
            {"other_parts_of_donor", found.cuts.is_spaced_anew},
            {"segments", segments},
            {"warnings", warnings}};
}

int list_cuts(const CutsChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const analysis::FlapStudy study(plan, plan::state_of(plan), choice.plan.parent_path());
    if (choice.json) fmt::print("{}\n", fibula_json(study.inputs(), study.fibula()).dump(2));
    else print_fibula(study.inputs(), study.fibula());
    return done;
}

int derive_cuts(const CutsChoice& choice) {
    if (!choice.from_pieces) return list_cuts(choice);
    const analysis::CutsOfPieces found = analysis::cut_as_placed(choice.plan, choice.alternative);
    if (choice.json) {
        fmt::print("{}\n", cuts_json(found, choice.alternative).dump(2));
        return done;
    }
    fmt::print("{}: alternative '{}'\n", choice.plan.string(), choice.alternative);
    for (std::size_t n = 0; n < found.segments.size(); ++n)
        fmt::print("  {}: {:.2f} mm, {:.2f} mm before; {:.2f} mm and {:.2f}° from where it was placed\n",
                   found.segments[n], found.cuts.plan.segments[n].length_centre / mm,
                   found.before.segments[n].length_centre / mm, found.cuts.moved[n] / mm,
                   found.cuts.turned[n] / degree);
    if (found.cuts.is_spaced_anew)
        fmt::print(stderr,
                   "note: the placed pieces overlap in the donor: the segments are cut from other parts of it\n");
    for (const reconstruction::FibulaWarning& w : found.made.fibula.warnings) fmt::print("warning: {}\n", w.text);
    fmt::print("for research, not a medical device\n");
    return done;
}

Action declare_plan_cuts(VerbOptions& verb) {
    const auto choice = std::make_shared<CutsChoice>();
    add_plan_options(verb, *choice);
    verb.flag("--from-pieces", choice->from_pieces,
              "derive the cuts from where the segments are placed, and cut new pieces there");
    verb.add("--alternative", choice->alternative, "with --from-pieces: name of the alternative that the plan gets")
        .shows_default();
    return [choice] { return derive_cuts(*choice); };
}

}  // namespace

Verb plan_cuts_verb() {
    return {"cuts", "list the cuts of a reconstruction, or derive them from where its segments were placed by hand",
            declare_plan_cuts};
}

}  // namespace tactus::command
