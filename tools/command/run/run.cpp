// SPDX-License-Identifier: Apache-2.0
#include "tools/session/live_table.hpp"
#include "tools/session/run_session.hpp"
#include "tools/command/terminal.hpp"
#include "tools/view/view.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <csignal>

namespace tactus {

namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

int run_verb(const RunChoice& choice) {
    std::signal(SIGINT, [](int) { interrupted = true; });
    std::signal(SIGTERM, [](int) { interrupted = true; });
    if (choice.view.wanted) return view::view_run(choice, interrupted);
    AssetCache assets;
    RunSession session(choice, assets);
    LiveLine line;
    auto next_table = std::chrono::steady_clock::now();
    const auto tend = [&] {
        const auto now = std::chrono::steady_clock::now();
        if (choice.json || !line.is_terminal() || now < next_table) return;
        next_table = now + std::chrono::milliseconds(200);
        line.show(live_table(session.engine()));
    };
    const auto say = [&line](const std::string& said) {
        line.clear();
        fmt::print(stderr, "{}\n", said);
    };
    if (!choice.json)
        fmt::print(stderr, "running {} for {}; Ctrl-C ends it\n", session.engine().plan().patch.title,
                   choice.seconds ? fmt::format("{} s", *choice.seconds) : "as long as you like");
    session.run({tend, say}, interrupted);
    line.clear();
    session.finish();
    if (choice.json) fmt::print("{}", session.summary_json());
    else fmt::print("{}  results in {}/\n", session.summary_text(), session.folder().string());
    return done;
}

}  // namespace tactus
