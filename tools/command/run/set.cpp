// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/exit_code.hpp"
#include "tools/run/control_socket.hpp"

#include <fmt/format.h>

#include <memory>

namespace tactus::command {

namespace {

struct SetChoice {
    std::vector<std::string> settings;  // "node.param=value"
    int process = 0;                    // 0: the only run
};

int set(const SetChoice& choice) {
    for (const std::string& setting : choice.settings) {
        if (setting.find('\n') != std::string::npos) throw Error("a setting must be one line: NODE.PARAM=VALUE");
        const std::string answer = run::ask_run(choice.process, "set " + setting);
        if (answer.starts_with("error ")) throw Error(answer.substr(6));
        fmt::print("{}\n", answer);
    }
    return done;
}

Action declare_set(VerbOptions& verb) {
    const auto choice = std::make_shared<SetChoice>();
    verb.add("setting", choice->settings, "NODE.PARAM=VALUE, as in blade.stiffness=\"0.8 N/mm\"").required();
    verb.add("--process", choice->process, "process number of the run, when there are several");
    return [choice] { return set(*choice); };
}

}  // namespace

Verb set_verb() { return {"set", "change a parameter of a running patch", declare_set}; }

}  // namespace tactus::command
