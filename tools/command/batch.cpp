// SPDX-License-Identifier: Apache-2.0
#include "tools/command/batch.hpp"

#include "assets/file/outputs.hpp"
#include "dsp/core/error.hpp"
#include "tools/analysis/workers.hpp"
#include "tools/command/progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <mutex>
#include <new>

namespace tactus::command {

std::vector<std::string> run_batch(std::size_t count, int jobs, std::string_view what, const BatchJob& job,
                                   bool is_quiet) {
    std::vector<std::string> failures(count);
    std::size_t finished = 0;
    std::mutex telling;
    Progress shown(is_quiet);
    const auto tell = [&](double share) {
        const std::lock_guard lock(telling);
        if (count == 1) shown.show(share);
        else
            shown.show(static_cast<double>(finished) / static_cast<double>(count),
                       fmt::format("{} of {} {}", finished, count, what));
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
    shown.clear();
    return failures;
}

std::size_t tell_failures(const std::vector<std::string>& failures) {
    std::size_t bad = 0;
    for (const std::string& failure : failures)
        if (!failure.empty()) ++bad, fmt::print(stderr, "tactus: {}\n", failure);
    return bad;
}

void check_batch_output(const std::filesystem::path& out, const std::vector<std::string>& endings, bool has_several) {
    if (out.empty() || file::is_stream(out)) return;
    std::error_code failed;
    if (std::filesystem::is_directory(out, failed)) {
        if (has_several) return;
        throw Error(fmt::format("{}: is a folder; of one input a file is written, as {}", out.string(),
                                fmt::join(endings, ", ")));
    }
    const bool is_file = std::ranges::any_of(
        endings, [&](const std::string& ending) { return out.filename().string().ends_with(ending); });
    if (has_several && is_file)
        throw Error(fmt::format("{}: several inputs need a folder; choose a name without {}", out.string(),
                                out.extension().string()));
    if (!has_several && !is_file)
        throw Error(fmt::format("{}: of one input a file is written, as {}", out.string(), fmt::join(endings, ", ")));
}

}  // namespace tactus::command
