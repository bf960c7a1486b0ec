// SPDX-License-Identifier: Apache-2.0
// tactus plan export: placed meshes, ITK transforms and 3D Slicer landmarks.
#include "tools/analysis/plan/plan_export.hpp"
#include "assets/file/json.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/command/pose_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tactus::command {

namespace {

using file::Json;

struct ExportChoice : PlanChoice {
    std::string format = "stl", transform_format = "tfm";
    std::filesystem::path out;
};

int export_plan(const ExportChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    Json written = Json::array();
    const analysis::ExportedPlan exported =
        analysis::export_plan(plan, choice.plan.parent_path(), choice.out, choice.format, choice.transform_format);
    for (const analysis::ExportedFragment& one : exported.written) {
        written.push_back({{"fragment", one.name}, {"files", one.files}, {"pose", pose_json<Json>(one.pose)}});
        if (!choice.result.json) fmt::print("{}\n", fmt::join(one.files, ", "));
    }
    if (choice.result.json) fmt::print("{}\n", written.dump(2));
    if (!exported.left_out.empty())
        fmt::print(stderr, "note: hidden, so not written: {}; show them with 'tactus plan unhide'\n",
                   fmt::join(exported.left_out, ", "));
    return done;
}

Action declare_plan_export(VerbOptions& verb) {
    const auto choice = std::make_shared<ExportChoice>();
    add_plan_options(verb, *choice);
    verb.add("-o,--out", choice->out, "folder for meshes and tables").required();
    verb.add("--format", choice->format, "format of the meshes").one_of({"stl", "ply"}).shows_default();
    verb.add("--transform-format", choice->transform_format, "format of the transforms: ITK's text, or HDF5")
        .one_of({"tfm", "h5"})
        .shows_default();
    return [choice] { return export_plan(*choice); };
}

}  // namespace

Verb plan_export_verb() {
    return {"export", "write the shown fragments as placed, vessels, transforms and landmarks for other programs",
            declare_plan_export};
}

}  // namespace tactus::command
