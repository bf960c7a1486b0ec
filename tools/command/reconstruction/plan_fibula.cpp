// SPDX-License-Identifier: Apache-2.0
// tactus plan fibula: where a fibula is cut so that its segments fill a gap between planes of a jaw.
#include "assets/reconstruction/fibula_inputs.hpp"
#include "tools/command/options.hpp"
#include "tools/command/reconstruction/fibula_text.hpp"
#include "tools/exit_code.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

namespace tactus::command {

namespace {

struct FibulaChoice {
    std::filesystem::path inputs;
    bool json = false;
};

int fibula(const FibulaChoice& choice) {
    const reconstruction::FibulaInputs inputs = reconstruction::read_fibula_inputs(choice.inputs);
    const reconstruction::FibulaPlan plan = reconstruction::plan_fibula(inputs);
    if (choice.json) fmt::print("{}\n", fibula_json(inputs, plan).dump(2));
    else print_fibula(inputs, plan);
    return done;
}

Action declare_plan_fibula(VerbOptions& verb) {
    const auto choice = std::make_shared<FibulaChoice>();
    verb.add("inputs", choice->inputs, "planes of the jaw, line and surface of the fibula (.json)").required();
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return fibula(*choice); };
}

}  // namespace

Verb plan_fibula_verb() {
    return {"fibula", "cuts of a fibula whose segments fill a gap of a jaw: lengths, angles, poses, warnings",
            declare_plan_fibula};
}

}  // namespace tactus::command
