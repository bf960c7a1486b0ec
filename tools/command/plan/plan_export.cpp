// SPDX-License-Identifier: Apache-2.0
// tactus plan export: placed meshes, ITK transforms and 3D Slicer landmarks.
#include "tools/analysis/plan/plan_export.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/plan/export_result.hpp"
#include "tools/report/result/printers.hpp"

#include <memory>
#include <string>

namespace tactus::command {

namespace {

struct ExportChoice : PlanChoice {
    std::string format = "stl", transform_format = "tfm";
    std::filesystem::path out;
};

int export_plan(const ExportChoice& choice) {
    const plan::CasePlan plan = plan::load_case_plan(choice.plan);
    const analysis::ExportedPlan exported =
        analysis::export_plan(plan, choice.plan.parent_path(), choice.out, choice.format, choice.transform_format);
    write_result(report::exported_plan_fields().of(exported), choice.result);
    return done;
}

Action declare_plan_export(VerbOptions& verb) {
    const auto choice = std::make_shared<ExportChoice>();
    add_plan_options(verb, *choice);
    verb.output("-o,--out", choice->out, OutputFormat::folder(), "folder for meshes and tables").required();
    verb.add("--format", choice->format, "format of the meshes").one_of({"stl", "ply"}).shows_default();
    verb.add("--transform-format", choice->transform_format, "format of the transforms: ITK's text, or HDF5")
        .one_of({"tfm", "h5"})
        .shows_default();
    return [choice] { return export_plan(*choice); };
}

}  // namespace

Verb plan_export_verb() {
    return {.name = "export",
            .about = "write the shown fragments as placed, vessels, transforms and landmarks for other programs",
            .add = declare_plan_export,
            .schema = [] { return report::schema_of_output({report::exported_plan_fields().schema()}); }};
}

}  // namespace tactus::command
