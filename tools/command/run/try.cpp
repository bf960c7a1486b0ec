// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/error.hpp"
#include "tools/command/options.hpp"
#include "tools/run/stop_signals.hpp"
#include "tools/terminal.hpp"
#include "tools/window/view.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <memory>

namespace tactus::command {

namespace {

bool has_display() {
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
        if (const char* value = std::getenv(name); value && *value) return true;
    return false;
}

int try_out(window::ViewedRunChoice choice) {
    if (!has_display())
        throw Error(
            fmt::format("this terminal has no display for a window; 'tactus run {0}' runs the patch with its own "
                        "hand and sound, 'tactus render {0}' computes the same offline",
                        choice.patch));
    choice.overrides.settings.push_back("hand.device=mouse");
    choice.view.wanted = true;
    say(stderr, "The mouse moves the hand; F1 in the window lists the keys. Close the window to end the run.\n");
    return window::view_run(choice, run::stop_on_signals());
}

Action declare_try(VerbOptions& verb) {
    const auto choice = std::make_shared<window::ViewedRunChoice>();
    choice->patch = "saw-training";
    verb.add("patch", choice->patch, "patch with a hand: a file, or a name in the library").shows_default();
    verb.add("--seconds", choice->seconds, "stop after this time, s").unit("s").range(1e-3, 1e6);
    verb.output("-o,--out", choice->out, OutputFormat::folder(),
                "folder for the results (default: PATCH-run, or PATCH-run-2 and so on)");
    return [choice] { return try_out(*choice); };
}

}  // namespace

Verb try_verb() { return {"try", "run a patch in a window with the mouse as hand, and with sound", declare_try}; }

}  // namespace tactus::command
