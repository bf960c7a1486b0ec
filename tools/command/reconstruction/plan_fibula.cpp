// SPDX-License-Identifier: Apache-2.0
// tactus plan fibula: where a fibula is cut so that its segments fill a gap between planes of a jaw.
#include "assets/reconstruction/fibula_inputs.hpp"
#include "tools/command/result_options.hpp"
#include "tools/exit_code.hpp"
#include "tools/report/reconstruction/fibula_result.hpp"
#include "tools/report/result/printers.hpp"

#include <filesystem>
#include <memory>

namespace tactus::command {

namespace {

struct FibulaChoice {
    std::filesystem::path inputs;
    ResultChoice result;
};

int fibula(const FibulaChoice& choice) {
    check_result_files(choice.result, {choice.inputs});
    const reconstruction::FibulaInputs inputs = reconstruction::read_fibula_inputs(choice.inputs);
    const reconstruction::FibulaPlan plan = reconstruction::plan_fibula(inputs);
    write_result(report::fibula_fields().of({&inputs, &plan}), choice.result);
    return done;
}

Action declare_plan_fibula(VerbOptions& verb) {
    const auto choice = std::make_shared<FibulaChoice>();
    verb.add("inputs", choice->inputs, "planes of the jaw, line and surface of the fibula (.json)").required();
    add_result_options(verb, choice->result, ResultFigure::none);
    return [choice] { return fibula(*choice); };
}

}  // namespace

Verb plan_fibula_verb() {
    return {.name = "fibula",
            .about = "cuts of a fibula whose segments fill a gap of a jaw: lengths, angles, poses, warnings",
            .add = declare_plan_fibula,
            .schema = [] { return report::schema_of_output({report::fibula_fields().schema()}); }};
}

}  // namespace tactus::command
