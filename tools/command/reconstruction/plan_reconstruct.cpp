// SPDX-License-Identifier: Apache-2.0
// tactus plan reconstruct: cuts jaw and fibula as planned, and makes the plan of the case with the pieces in place.
#include "tools/analysis/plan/plan_reconstruct.hpp"
#include "assets/reconstruction/flap_files.hpp"
#include "tools/command/plan/plan_options.hpp"

#include <fmt/format.h>

namespace tactus::command {

namespace {

struct ReconstructChoice : PlanChoice {
    std::filesystem::path inputs;
    std::string alternative;
};

int run(const ReconstructChoice& choice) {
    const reconstruction::ReconstructionInputs inputs = reconstruction::read_reconstruction_inputs(choice.inputs);
    for (const std::string& note : inputs.notes) fmt::print(stderr, "note: {}\n", note);
    const analysis::MadeReconstruction made = analysis::make_reconstruction(inputs, choice.plan, choice.alternative);
    if (choice.result.json) return show_change(choice);
    fmt::print("{}:", choice.plan.string());
    for (const int piece : plan::state_of(made.plan).pieces)
        fmt::print(" {}", made.plan.fragments[static_cast<std::size_t>(piece)].name);
    fmt::print("\n");
    for (const reconstruction::FibulaWarning& w : made.fibula.warnings) fmt::print("warning: {}\n", w.text);
    fmt::print("for research, not a medical device\n");
    return done;
}

Action declare_plan_reconstruct(VerbOptions& verb) {
    const auto choice = std::make_shared<ReconstructChoice>();
    add_plan_options(verb, *choice);
    verb.add("inputs", choice->inputs, "inputs as of 'plan fibula', with 'donor' and, if wanted, 'jaw' (.json)")
        .required();
    verb.add("--alternative", choice->alternative,
             "add the reconstruction to the plan that is there, as an alternative of this name");
    return [choice] { return run(*choice); };
}

}  // namespace

Verb plan_reconstruct_verb() {
    return {"reconstruct", "cut jaw and fibula as planned; a new plan has the pieces, each segment in place",
            declare_plan_reconstruct};
}

}  // namespace tactus::command
