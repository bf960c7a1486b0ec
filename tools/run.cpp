// SPDX-License-Identifier: Apache-2.0
#include "tools/live_table.hpp"
#include "tools/run_session.hpp"
#include "tools/stop_signals.hpp"
#include "tools/terminal.hpp"
#include "tools/view/view.hpp"

#include <fmt/format.h>

#include <chrono>

namespace tactus {

int run_verb(const RunChoice& choice) {
    const std::atomic<bool>& interrupted = stop_on_signals();
    if (choice.view.wanted) return view::view_run(choice, interrupted);
    AssetCache assets;
    RunSession session(choice, assets);
    LiveLine line;
    auto next_table = std::chrono::steady_clock::now();
    std::size_t told = 0;
    const auto tell_losses = [&] {
        for (const auto losses = session.losses(); told < losses.size(); ++told) {
            line.clear();
            say(stderr, fmt::format("tactus: {}\n", losses[told]));
        }
    };
    const auto tend = [&] {
        tell_losses();
        const auto now = std::chrono::steady_clock::now();
        if (choice.json || !line.is_terminal() || now < next_table) return;
        next_table = now + std::chrono::milliseconds(200);
        line.show(live_table(session.engine()));
    };
    const auto tell = [&line](const std::string& said) {
        line.clear();
        say(stderr, said + "\n");
    };
    if (!choice.json)
        say(stderr, fmt::format("running {} for {}; Ctrl-C ends it\n", session.engine().plan().patch.title,
                                choice.seconds ? fmt::format("{} s", *choice.seconds) : "as long as you like"));
    session.run({tend, tell}, interrupted);
    line.clear();
    session.finish();
    tell_losses();
    if (choice.json) say(stdout, session.summary_json());
    else say(stdout, fmt::format("{}  results in {}/\n", session.summary_text(), session.folder().string()));
    return session.losses().empty() ? done : output_lost;
}

}  // namespace tactus
