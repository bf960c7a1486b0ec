// SPDX-License-Identifier: Apache-2.0
// tactus plan repaint: takes corrected paint into a plan.
#include "tools/analysis/plan/plan_repaint.hpp"
#include "tools/command/plan/plan_options.hpp"
#include "tools/counted.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

struct RepaintChoice : PlanChoice {
    std::string fragment;
    std::filesystem::path file;
    bool is_same_bone = false;
};

int repaint_fragment(const RepaintChoice& choice) {
    analysis::OpenPlan open(choice.plan);
    const std::string& name = choice.fragment;
    analysis::Repainted made = analysis::repaint(
        open.plan, choice.plan.parent_path(), plan::find_fragment(open.plan, name), choice.file, choice.is_same_bone);
    analysis::do_step(open.plan, std::move(made.step), choice.plan);
    if (!choice.result.json)
        fmt::print("{}: {}, {}; poses stay, 'tactus plan undo' takes the file before back\n", name,
                   choice.file.string(),
                   made.faces > 0 ? counted(made.faces, "painted face")
                                  : "no painted fracture, so that it is proposed where a fit needs it");
    return show_change(choice);
}

Action declare_plan_repaint(VerbOptions& verb) {
    const auto choice = std::make_shared<RepaintChoice>();
    add_plan_options(verb, *choice);
    verb.add("fragment", choice->fragment, "which one").required();
    verb.add("file", choice->file, "bone file or closed mesh of the same bone, with its paint").required();
    verb.flag("--same-bone", choice->is_same_bone,
              "the file that the plan was made of is gone or has changed: the new one is the same bone at the same "
              "place");
    return [choice] { return repaint_fragment(*choice); };
}

}  // namespace

Verb plan_repaint_verb() {
    return {"repaint", "take a file with corrected paint for a fragment; poses stay", declare_plan_repaint};
}

}  // namespace tactus::command
