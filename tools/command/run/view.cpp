// SPDX-License-Identifier: Apache-2.0
#include "tools/window/view.hpp"
#include "tools/command/run/run.hpp"
#include "tools/command/run/sight_options.hpp"
#include "tools/run/stop_signals.hpp"

#include <memory>

namespace tactus::command {

namespace {

int view_file(const window::FileViewChoice& choice) { return window::view_file(choice, run::stop_on_signals()); }

Action declare_view(VerbOptions& verb) {
    const auto choice = std::make_shared<window::FileViewChoice>();
    verb.add(
        "file", choice->file,
        "folder of a take, made with --record, or a patch or a plan of a case, which is opened and not run (default: a "
        "page to choose from)");
    add_view_options(verb, choice->view);
    return [choice] { return view_file(*choice); };
}

}  // namespace

int run_in_window(const window::ViewedRunChoice& choice, const std::atomic<bool>& interrupted) {
    return window::view_run(choice, interrupted);
}

Verb view_verb() {
    return {"view", "open a window: on a take, with its values and bones at any instant, on a patch, or to choose",
            declare_view};
}

}  // namespace tactus::command
