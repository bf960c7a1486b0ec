// SPDX-License-Identifier: Apache-2.0
// tactus trigger: presses buttons of a running patch.
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/control_socket.hpp"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <thread>

namespace tactus::command {

namespace {

struct TriggerChoice {
    std::vector<std::string> nodes;
    int process = 0;  // 0: the only run
};

int trigger(const TriggerChoice& choice) {
    for (std::size_t i = 0; i < choice.nodes.size(); ++i) {
        const std::string& node = choice.nodes[i];
        // A button is down for 20 ms. Without a pause a second press of the same button would only prolong the first.
        if (i > 0) std::this_thread::sleep_for(std::chrono::milliseconds(60));
        if (node.find('\n') != std::string::npos) throw Error("the name of a button must be one line");
        const std::string answer = run::ask_run(choice.process, "trigger " + node);
        if (answer.starts_with("error ")) throw Error(answer.substr(6));
        fmt::print("{}\n", answer);
    }
    return done;
}

Action declare_trigger(VerbOptions& verb) {
    const auto choice = std::make_shared<TriggerChoice>();
    verb.add("node", choice->nodes, "the button: a node with a parameter 'press', such as undo").required();
    verb.add("--process", choice->process, "process number of the run, when there are several");
    return [choice] { return trigger(*choice); };
}

}  // namespace

Verb trigger_verb() { return {"trigger", "press a button of a running patch", declare_trigger}; }

}  // namespace tactus::command
