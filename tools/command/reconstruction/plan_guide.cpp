// SPDX-License-Identifier: Apache-2.0
// tactus plan guide: a printed guide for the cuts of a plan, or for its fragments in their places, as STL or 3MF.
#include "assets/bone/bone.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/cutting_guide/guide_limits.hpp"
#include "tools/analysis/cutting_guide/guide_task.hpp"
#include "tools/analysis/cutting_guide/reduction_guide.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/report/cutting_guide/guide_report.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace tactus::command {

namespace {

struct GuideOptions : PlanChoice {
    std::filesystem::path task;
    std::string bone = "fibula", printer = "sla", label;
    int cut = 0, sides = 3;
    std::optional<double> blade, clearance, offset;
    double thickness = 4.0, wrap = 120.0, depth = 15.0, wall = 3.0, screw = 3.0, turn = 0.0, voxel = 0.35;
    std::vector<std::string> fragments;
    std::vector<double> limits;  // of guide_limits(), in their units
};

/// Throws Error for options that do not belong together.
void check_options(const GuideOptions& o) {
    const bool is_reduction = o.bone == "reduction";
    if (o.cut > 0 && o.bone != "jaw") throw Error("--cut chooses one of the two cuts of the jaw; give --bone jaw");
    if (!o.fragments.empty() && !is_reduction)
        throw Error("--fragments names those that a guide for a reduction holds; give --bone reduction");
    if (is_reduction && !o.task.empty()) throw Error("--task: a guide for a reduction has no slot to saw in");
    if (is_reduction && (o.blade || o.clearance))
        throw Error("--blade and --clearance are of slots, which a guide for a reduction does not have");
}

/// `blade`: m, of the plan; none: no blade is guided.
analysis::GuideChoice choice_of(const GuideOptions& o, std::optional<double> blade) {
    analysis::GuideChoice choice;
    choice.bone = o.bone == "jaw"      ? analysis::GuideBone::jaw
                  : o.bone == "fibula" ? analysis::GuideBone::fibula
                                       : analysis::GuideBone::reduction;
    choice.fragments = o.fragments;
    choice.cut = o.cut;
    choice.label = o.label;
    choice.turn = o.turn * degree;
    if (o.offset) choice.offset = *o.offset * mm;
    cutting_guide::GuideSettings& set = choice.settings;
    if (o.blade) set.blade = *o.blade * mm;
    else if (blade) set.blade = *blade;
    set.clearance = o.clearance ? *o.clearance * mm : (o.printer == "fdm" ? 0.4 : 0.25) * mm;
    set.thickness = o.thickness * mm, set.wrap = o.wrap * degree, set.depth = o.depth * mm, set.wall = o.wall * mm;
    set.screw_radius = 0.5 * o.screw * mm, set.voxel = o.voxel * mm;
    for (std::size_t n = 0; n < o.limits.size(); ++n)
        analysis::guide_limits()[n].in(choice) = o.limits[n] * analysis::guide_limits()[n].si;
    set.sides = static_cast<cutting_guide::Sides>(o.sides);
    return choice;
}

/// SAW.toml has its bones in SAW-bone.vdb and SAW-guide.vdb; empty: no task.
std::filesystem::path beside_task(const std::filesystem::path& task, const char* what) {
    if (task.empty()) return {};
    return task.parent_path() / fmt::format("{}-{}.vdb", task.stem().string(), what);
}

int make_guide(const GuideOptions& options) {
    check_options(options);
    const std::filesystem::path bone = beside_task(options.task, "bone"), body = beside_task(options.task, "guide");
    check_plan_results(options, {}, {options.task, bone, body});
    const std::vector<std::filesystem::path> meshes = options.result.products();
    if (meshes.empty()) throw Error("a guide is written as .stl, .3mf or .ply: -o GUIDE.stl");
    const plan::CasePlan plan = plan::load_case_plan(options.plan);
    const std::filesystem::path folder = options.plan.parent_path();
    const analysis::PlannedGuide guide = [&] {
        if (options.bone == "reduction")
            return analysis::plan_reduction_guide(plan, folder, choice_of(options, std::nullopt));
        const analysis::FlapStudy study(plan, plan::state_of(plan), folder);
        return analysis::plan_guide(study, plan.title, choice_of(options, study.inputs().kerf));
    }();
    report::Result result =
        report::guide_fields().of({&guide, plan.title, meshes.front().string(), options.task.string()});
    draw_pictures(result, options.result);
    if (!options.task.empty()) {
        const analysis::GuideTask task = analysis::guide_task(guide, plan.title, bone.filename(), body.filename());
        bone::save_bone(task.bone, bone);
        bone::save_bone(task.guide, body);
        file::write_whole_file(options.task, task.text);
    }
    for (const std::filesystem::path& out : meshes)
        mesh::write_mesh(std::array{mesh::ColouredSurface{guide.made.surface, Vec3(0.35, 0.62, 0.72)}}, out);
    write_result(result, options.result);
    return done;
}

Action declare_plan_guide(VerbOptions& verb) {
    const auto o = std::make_shared<GuideOptions>();
    add_plan_report_options(verb, *o, {{".stl", ".3mf", ".ply"}, "the guide, mm, LPS"}).required();
    verb.old("--report", "--out");
    verb.output("--task", o->task, {{".toml"}},
                "TOML file: a task for 'tactus session', to saw in the guide; its bones are written beside it");
    verb.add("--bone", o->bone,
             "the donor with its osteotomies, the jaw with its resection, or the fragments of a reduction in their "
             "places")
        .one_of({"fibula", "jaw", "reduction"})
        .shows_default();
    verb.add("--fragments", o->fragments, "of a reduction: those that the guide holds together (default: all shown)");
    verb.add("--cut", o->cut, "of the jaw: 1, the first plane only; 2, the last; 0, both in one guide")
        .range(0, 2)
        .shows_default();
    verb.add("--sides", o->sides, "walls of a slot: 1, a ledge on the kept side; 2, both; 3, one end too")
        .range(1, 3)
        .shows_default();
    verb.add("--blade", o->blade, "mm that the blade cuts (default: the plan's kerf)").range(0.1, 3.0);
    verb.add("--printer", o->printer, "which clearance: 0.25 mm per side of the blade for sla, 0.4 mm for fdm")
        .one_of({"sla", "fdm"})
        .shows_default();
    verb.add("--clearance", o->clearance, "mm per side of the blade, instead of the printer's").range(0.02, 2.0);
    verb.add("--offset", o->offset, "mm between base and bone (default: 0.5 over a fibula's periosteum, else 0.3)")
        .range(0.05, 3.0);
    verb.add("--thickness", o->thickness, "mm of the base").range(1.0, 10.0).shows_default();
    verb.add("--wrap", o->wrap, "degrees of the bone's outline that the base covers")
        .range(40.0, 300.0)
        .shows_default();
    verb.add("--depth", o->depth, "mm of a slot above the bone").range(3.0, 40.0).shows_default();
    verb.add("--wall", o->wall, "mm of a slot's walls").range(1.0, 10.0).shows_default();
    verb.add("--screw", o->screw, "mm, diameter of the holes that fix the guide").range(0.5, 6.0).shows_default();
    verb.add("--turn", o->turn,
             "degrees by which the approach is turned: of a fibula from lateral to the front, of a jaw about its cuts, "
             "of a reduction about the line along its fragments")
        .range(-180.0, 180.0)
        .shows_default();
    verb.add("--label", o->label, "pseudonym to engrave (default: the plan's title)");
    verb.add("--voxel", o->voxel, "mm of the grid behind the mesh").range(0.1, 0.5).shows_default();
    const analysis::GuideChoice usual;
    for (const analysis::GuideLimit& limit : analysis::guide_limits()) o->limits.push_back(limit.of(usual) / limit.si);
    for (std::size_t n = 0; n < o->limits.size(); ++n) {
        const analysis::GuideLimit& limit = analysis::guide_limits()[n];
        verb.add(std::string(limit.option), o->limits[n],
                 fmt::format("{} {} ({})", limit.unit, limit.about, limit.source))
            .range(limit.low, limit.high)
            .shows_default();
    }
    return [o] { return make_guide(*o); };
}

}  // namespace

Verb plan_guide_verb() {
    return {
        .name = "guide",
        .about = "make a printed guide for the cuts of a reconstruction or the fragments of a reduction, and check it",
        .add = declare_plan_guide,
        .schema = [] { return report::schema_of_output({report::guide_fields().schema()}); }};
}

}  // namespace tactus::command
