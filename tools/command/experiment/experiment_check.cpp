// SPDX-License-Identifier: Apache-2.0
// tactus experiment check: the protocol, its orders, and whether the patch can present all levels.
#include "dsp/core/error.hpp"
#include "tools/analysis/experiment/run_experiment.hpp"
#include "tools/command/options.hpp"
#include "tools/counted.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct ExperimentCheck {
    std::string experiment;
    std::vector<std::string> settings;
    int subjects = 0;
    bool lists_orders = false;
};

std::string order_text(const experiment::Protocol& protocol, std::size_t row) {
    std::string text;
    for (const std::size_t condition : experiment::condition_order(protocol, row))
        text += (text.empty() ? "" : " ") + protocol.conditions[condition].name;
    if (protocol.tasks.empty()) return text;
    text += ";";
    for (const std::size_t task : experiment::task_order(protocol, row)) text += " " + protocol.tasks[task].name;
    return text;
}

int check_experiment(const ExperimentCheck& choice) {
    const experiment::Protocol protocol = experiment::load_protocol(run::find_experiment(choice.experiment));
    const auto subjects = static_cast<std::size_t>(choice.subjects > 0 ? choice.subjects : protocol.subjects);
    say(stdout, fmt::format("{}\n{}, {}\n", protocol.title, counted(protocol.conditions.size(), "condition"),
                            protocol.is_psychophysics() ? "psychophysics" : counted(protocol.tasks.size(), "task")));
    if (const std::string warning = experiment::balance_warning(protocol, subjects); !warning.empty())
        say(stdout, fmt::format("warning: {}\n", warning));
    if (choice.lists_orders)
        for (std::size_t row = 0; row < subjects; ++row)
            say(stdout, fmt::format("subject {}: {}\n", row + 1, order_text(protocol, row)));
    compile::AssetCache assets;
    analysis::check_levels(protocol, assets, choice.settings, [](const std::string& line) { say(stdout, line); });
    analysis::check_tasks(protocol, assets, choice.settings);
    say(stdout, "no errors\n");
    return done;
}

Action declare_experiment_check(VerbOptions& verb) {
    const auto choice = std::make_shared<ExperimentCheck>();
    verb.add("experiment", choice->experiment, "experiment file, or a name in the library").required();
    verb.add("--set", choice->settings, "NODE.PARAM=VALUE, for all trials; may be given again").one_each();
    verb.add("--subjects", choice->subjects, "number of subjects; default: as the file plans").range(1, 1000);
    verb.flag("--orders", choice->lists_orders, "list the order of conditions and tasks for each subject");
    return [choice] { return check_experiment(*choice); };
}

}  // namespace

Verb experiment_check_verb() {
    return {"check", "check an experiment file, its orders, and that the device can be commanded all levels",
            declare_experiment_check};
}

}  // namespace tactus::command
