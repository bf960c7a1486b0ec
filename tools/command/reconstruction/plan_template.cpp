// SPDX-License-Identifier: Apache-2.0
// tactus plan template: a printed strip on which a plate of the plan is bent, as STL or 3MF.
#include "tools/analysis/cutting_guide/plan_template.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/cutting_guide/template_report.hpp"
#include "tools/report/result/printers.hpp"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace tactus::command {

namespace {

struct TemplateOptions : PlanChoice {
    std::string plate, label, marks = "pins";
    double margin = 2.0, thickness = 8.0, height = 2.0, clearance = 0.15, voxel = 0.35, min_bone = 90.0;
};

int write_template(const TemplateOptions& o) {
    check_plan_results(o);
    const std::vector<std::filesystem::path> meshes = o.result.products();
    if (meshes.empty()) throw Error("a template is written as .stl, .3mf or .ply: -o TEMPLATE.stl");
    analysis::TemplateChoice choice;
    choice.plate = o.plate, choice.label = o.label, choice.min_bone_share = 0.01 * o.min_bone;
    choice.settings.margin = o.margin * mm, choice.settings.thickness = o.thickness * mm;
    choice.settings.mark = o.height * mm, choice.settings.clearance = o.clearance * mm;
    choice.settings.voxel = o.voxel * mm;
    choice.settings.marks = o.marks == "pins" ? cutting_guide::HoleMarks::pins : cutting_guide::HoleMarks::dimples;
    const plan::CasePlan plan = plan::load_case_plan(o.plan);
    const analysis::FlapStudy study(plan, plan::state_of(plan), o.plan.parent_path());
    const analysis::PlannedTemplate made = analysis::plan_template(study, plan.title, choice);
    report::Result result = report::template_fields().of({&made, plan.title, meshes.front().string()});
    draw_pictures(result, o.result);
    for (const std::filesystem::path& out : meshes)
        mesh::write_mesh(std::array{mesh::ColouredSurface{made.made.surface, Vec3(0.72, 0.55, 0.35)}}, out);
    write_result(result, o.result);
    return done;
}

Action declare_plan_template(VerbOptions& verb) {
    const auto o = std::make_shared<TemplateOptions>();
    add_plan_report_options(verb, *o, {{".stl", ".3mf", ".ply"}, "the template, mm, LPS"}).required();
    verb.add("--plate", o->plate, "of the plan (default: its only one)");
    verb.add("--marks", o->marks, "of the plate's holes: pins that stand in them, or dimples in the bed below them")
        .one_of({"pins", "dimples"})
        .shows_default();
    verb.add("--height", o->height, "mm of a pin above the bed, or depth of a dimple").range(0.3, 5.0).shows_default();
    verb.add("--clearance", o->clearance, "mm by which the radius of a pin is less than that of its hole")
        .range(0.0, 1.0)
        .shows_default();
    verb.add("--margin", o->margin, "mm of bed beyond the plate").range(0.0, 10.0).shows_default();
    verb.add("--thickness", o->thickness, "mm below the plate").range(3.0, 30.0).shows_default();
    verb.add("--label", o->label, "pseudonym to engrave (default: the plan's title)");
    verb.add("--min-bone", o->min_bone,
             "% of the bed below the plate that has bone below it; less is refused (a "
             "placeholder)")
        .range(0.0, 100.0)
        .shows_default();
    verb.add("--voxel", o->voxel, "mm of the grid behind the mesh").range(0.1, 0.5).shows_default();
    return [o] { return write_template(*o); };
}

}  // namespace

Verb plan_template_verb() {
    return {.name = "template",
            .about = "make a printed template on which a plate of the plan is bent, and check it",
            .add = declare_plan_template,
            .schema = [] { return report::schema_of_output({report::template_fields().schema()}); }};
}

}  // namespace tactus::command
