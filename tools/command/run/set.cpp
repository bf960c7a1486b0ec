// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "tools/session/control_socket.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>

namespace tactus {

int set_verb(const SetChoice& choice) {
    for (const std::string& setting : choice.settings) {
        if (setting.find('\n') != std::string::npos) throw Error("a setting is one line: NODE.PARAM=VALUE");
        const std::string answer = ask_run(choice.process, "set " + setting);
        if (answer.starts_with("error ")) throw Error(answer.substr(6));
        fmt::print("{}\n", answer);
    }
    return done;
}

}  // namespace tactus
