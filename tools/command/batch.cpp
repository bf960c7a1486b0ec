// SPDX-License-Identifier: Apache-2.0
#include "tools/command/batch.hpp"

#include "tools/analysis/workers.hpp"
#include "tools/terminal.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <mutex>
#include <new>

namespace tactus::command {

std::string progress_bar(std::size_t finished, std::size_t count, std::string_view what) {
    constexpr std::size_t width = 30;
    const std::size_t filled = count == 0 ? width : width * finished / count;
    return fmt::format("[{}{}] {} of {} {}", std::string(filled, '#'), std::string(width - filled, ' '), finished,
                       count, what);
}

std::vector<std::string> run_batch(std::size_t count, int jobs, std::string_view what, const BatchJob& job) {
    std::vector<std::string> failures(count);
    std::size_t finished = 0;
    std::mutex telling;
    LiveLine line;
    const auto tell = [&](double share) {
        const std::lock_guard lock(telling);
        line.show(count == 1 ? fmt::format("{:3.0f} %", 100.0 * share) : progress_bar(finished, count, what));
    };
    analysis::on_threads(jobs)(static_cast<int>(count), [&](int n) {
        const auto index = static_cast<std::size_t>(n);
        try {
            job(index, tell);
        } catch (const std::bad_alloc& error) {
            // Too little memory is not a fault of the file and has another exit code; with several files the other
            // results are kept.
            if (count == 1) throw;
            failures[index] = error.what();
        } catch (const std::exception& error) {
            failures[index] = error.what();
        }
        {
            const std::lock_guard lock(telling);
            ++finished;
        }
        tell(1.0);
    });
    line.clear();
    return failures;
}

std::size_t tell_failures(const std::vector<std::string>& failures) {
    std::size_t bad = 0;
    for (const std::string& failure : failures)
        if (!failure.empty()) ++bad, fmt::print(stderr, "tactus: {}\n", failure);
    return bad;
}

}  // namespace tactus::command
