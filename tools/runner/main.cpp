// SPDX-License-Identifier: Apache-2.0
// `tactus`: the verbs that a patch needs to be written, run and replayed without a window. It starts tactus-full for all
// others: a newcomer's first run does not wait until the window, the analyses and their reports are compiled, and a run
// without a window does not load their libraries.
#include "tools/command/options.hpp"
#include "tools/command/other_program.hpp"
#include "tools/command/run/run.hpp"
#include "tools/command/standard_streams.hpp"
#include "tools/exit_code.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

namespace tactus::command {

// CMakeLists.txt names their files.
#define TACTUS_RUNNER_VERBS(X) \
    X(new)                     \
    X(run)                     \
    X(render)                  \
    X(check)                   \
    X(draw)                    \
    X(nodes)                   \
    X(set)                     \
    X(trigger)                 \
    X(replay)                  \
    X(measure)                 \
    X(equalise)                \
    X(devices)                 \
    X(cache)                   \
    X(bench)

#define TACTUS_DECLARE(name) Verb name##_verb();
TACTUS_RUNNER_VERBS(TACTUS_DECLARE)
#undef TACTUS_DECLARE

namespace {

std::vector<std::string> given;  // the words of the command line

/// The first word that is not an option of the program; "": none.
std::string verb_given() {
    for (std::size_t i = 0; i < given.size(); ++i) {
        const std::string& word = given[i];
        if (word == "--nodes" || word == "--memory") ++i;
        else if (!word.starts_with("--nodes=") && !word.starts_with("--memory=")) return word;
    }
    return "";
}

int run_full() {
    const std::string verb = verb_given();
    const bool is_help = verb.empty() || verb.starts_with('-');
    run_beside("tactus-full", (is_help ? "the help of all verbs" : fmt::format("'{}'", verb)) + " and the window",
               given);
}

}  // namespace

int run_in_window(const window::ViewedRunChoice&, const std::atomic<bool>&) { return run_full(); }

}  // namespace tactus::command

int main(int argc, char** argv) {
    using namespace tactus;
    using namespace tactus::command;
    hold_standard_streams();
    given.assign(argv + std::min(argc, 1), argv + argc);
#define TACTUS_LIST(name) name##_verb(),
    const Verbs verbs{TACTUS_RUNNER_VERBS(TACTUS_LIST)};
#undef TACTUS_LIST
    const auto is_own = [name = verb_given()](const Verb& verb) { return name == verb.name; };
    if (std::any_of(verbs.begin(), verbs.end(), is_own))
        return command_line({"tactus", "Tactus: patches of nodes for haptics, from 60 Hz to audio rate", verbs}, argc,
                            argv);
    try {
        return run_full();
    } catch (const std::exception& error) {
        say(stderr, fmt::format("tactus: {}\n", error.what()));
        return bad_input;
    }
}
