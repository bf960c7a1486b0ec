// SPDX-License-Identifier: Apache-2.0
#include "tools/view/view.hpp"
#include "tools/command/run/sight_options.hpp"
#include "tools/session/stop_signals.hpp"

#include <memory>

namespace tactus::command {

namespace {

int view_take(const view::TakeViewChoice& choice) { return view::view_take(choice, session::stop_on_signals()); }

Action add(VerbOptions& verb) {
    const auto choice = std::make_shared<view::TakeViewChoice>();
    verb.add("take", choice->take, "folder of a take, made with --record").required();
    add_view_options(verb, choice->view);
    return [choice] { return view_take(*choice); };
}

}  // namespace

Verb view_verb() { return {"view", "open a take in a window: its values and bones at any instant", add}; }

}  // namespace tactus::command
