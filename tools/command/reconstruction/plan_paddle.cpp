// SPDX-License-Identifier: Apache-2.0
// tactus plan paddle: places the skin paddle of a flap, and drapes it over a defect.
#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/plan/paddle_study.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/plan_result.hpp"
#include "tools/report/reconstruction/flap_result.hpp"
#include "tools/report/reconstruction/paddle_picture.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace tactus::command {

namespace {

namespace fs = std::filesystem;

struct PaddleChoice : PlanChoice {
    fs::path defect, picture;
    std::vector<double> at;
    std::optional<double> length, width;
    double rope = 50.0, thickness = 10.0, pressure = 500.0, young = 100.0;
    bool remove = false;
};

/// Adds a step when the plan's paddle changes.
void place(const PaddleChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const plan::PlanState state = plan::state_of(plan);
    if (!state.reconstruction)
        throw Error(
            fmt::format("{}: the plan has no reconstruction, so it has no skin paddle; 'tactus plan reconstruct' makes "
                        "one",
                        choice.plan.string()));
    const bool is_asked = choice.remove || !choice.at.empty() || choice.length || choice.width;
    if (!is_asked && state.reconstruction->flap.paddle) return;
    Vec3 middle(0.0);
    if (!choice.at.empty()) middle = Vec3(choice.at[0], choice.at[1], choice.at[2]) * mm;
    else if (state.reconstruction->flap.paddle) middle = state.reconstruction->flap.paddle->at;
    else if (!choice.remove) {
        const analysis::FlapStudy study(plan, state, choice.plan.parent_path());
        middle = analysis::default_paddle_place(study.inputs(), study.fibula(), study.flap());
    }
    analysis::change_reconstruction(choice.plan, [&](reconstruction::Reconstruction& all, const plan::CasePlan&) {
        if (choice.remove) {
            if (!all.flap.paddle) throw Error("the plan has no skin paddle to remove");
            all.flap.paddle.reset();
            return;
        }
        if (!all.flap.paddle) all.flap.paddle.emplace();
        all.flap.paddle->at = middle;
        if (choice.length) all.flap.paddle->length = *choice.length * mm;
        if (choice.width) all.flap.paddle->width = *choice.width * mm;
        (void)skin::paddle_in_leg(*all.flap.paddle, all.inputs);
    });
}

int paddle(const PaddleChoice& choice) {
    check_plan_results(choice, {choice.defect}, {choice.picture});
    if (choice.defect.empty() && (!choice.result.out.empty() || !choice.picture.empty()))
        throw Error("-o and --picture are about the draped paddle; give --defect CURVE.mrk.json, too");
    if (choice.remove && (!choice.defect.empty() || !choice.at.empty() || choice.length || choice.width))
        throw Error("--remove excludes --defect, --at, --length and --width");
    place(choice);
    if (choice.defect.empty()) return show_change(choice);
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    analysis::FlapStudy study(plan, plan::state_of(plan), choice.plan.parent_path());
    skin::DrapeSettings settings;
    settings.rope_length = choice.rope * mm;
    settings.sheet.thickness = choice.thickness * mm;
    settings.sheet.young = choice.young * 1e3;
    settings.sheet.shear = 0.5 * settings.sheet.young;
    settings.sheet.bending_young = 0.1 * settings.sheet.young;
    settings.pressure = choice.pressure;
    const analysis::PaddleStudy found = analysis::study_paddle(study, choice.defect, settings);
    for (const std::string& note : found.notes) fmt::print(stderr, "note: {}\n", note);
    const geometry::TriangleSurface shell = skin::shell_of(found.draped, settings.sheet.thickness);
    const std::vector<mesh::ColouredSurface> shells{{shell, report::paddle_colour}};
    for (const fs::path& out : choice.result.products()) mesh::write_mesh(shells, out);
    if (!choice.picture.empty()) report::write_paddle_picture(study, found, choice.picture);
    write_result(report::paddle_fields().of({&found, &*study.flap().paddle}), choice.result);
    return found.warnings.empty() ? done : answer_is_no;
}

}  // namespace

Verb plan_paddle_verb() {
    return {.name = "paddle",
            .about = "place a flap's skin paddle, and drape it over a defect; 1: there are warnings",
            .add = [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<PaddleChoice>();
                add_plan_report_options(verb, *choice, {{".stl", ".ply"}, "the draped paddle as a closed mesh"});
                verb.add("--at", choice->at,
                         "middle of the paddle on the skin of the leg: X Y Z, mm, frame of the donor (default: at the "
                         "perforators, 20 mm behind the bone's posterior border)")
                    .count(3);
                verb.add("--length", choice->length, "mm along the leg (a new paddle: 60)").range(5.0, 400.0);
                verb.add("--width", choice->width, "mm (a new paddle: 40)").range(5.0, 200.0);
                verb.flag("--remove", choice->remove, "take it away");
                const Option defect =
                    verb.add("--defect", choice->defect,
                             "closed curve to be covered, .mrk.json or .fcsv of 3D Slicer, frame of the jaw");
                verb.add("--rope", choice->rope, "length of a perforator from bone to skin, mm")
                    .range(1.0, 200.0)
                    .needs(defect)
                    .shows_default();
                verb.add("--thickness", choice->thickness, "of the skin with its fat, mm; assumed")
                    .range(0.5, 50.0)
                    .needs(defect)
                    .shows_default();
                verb.add("--young", choice->young, "Young's modulus of the skin, kPa; assumed")
                    .range(1.0, 1e5)
                    .needs(defect)
                    .shows_default();
                verb.add("--pressure", choice->pressure, "that presses it on the defect, Pa; assumed")
                    .range(1.0, 1e5)
                    .needs(defect)
                    .shows_default();
                verb.output("--picture", choice->picture, {{".png"}}, "bone, paddle and perforators: .png");
                return [choice] { return paddle(*choice); };
            },
            // Without --defect: the plan.
            .schema =
                [] {
                    return report::schema_of_output({report::paddle_fields().schema(), report::plan_fields().schema()});
                }};
}

}  // namespace tactus::command
