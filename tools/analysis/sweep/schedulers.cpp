// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/schedulers.hpp"

#include "dsp/core/error.hpp"
#include "tools/analysis/sweep/results.hpp"
#include "tools/run/child_process.hpp"
#include "tools/run/shell_word.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <sstream>

namespace tactus::analysis {

namespace fs = std::filesystem;

namespace {

std::string without_line_end(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

/// Standard output of a program; throws Error with what it wrote to standard error when it fails.
std::string output_of(const std::vector<std::string>& words) {
    const run::Capture out("output"), err("errors");
    const run::Finished finished = run::run_process(words, {}, out, err);
    if (finished.code == 0 && finished.signal == 0) return without_line_end(out.text());
    const std::string message = without_line_end(err.text());
    throw Error(message.starts_with(words.front() + ":") ? message
                : message.empty()                        ? words.front() + ": failed without a message"
                                                         : fmt::format("{}: {}", words.front(), message));
}

/// Largest number of elements of an array, from the configuration.
std::size_t max_array_size() {
    std::istringstream config(output_of({"scontrol", "show", "config"}));
    for (std::string line; std::getline(config, line);) {
        if (!line.starts_with("MaxArraySize")) continue;
        const std::size_t begin = line.find_first_of("0123456789");
        std::size_t size = 0;
        if (begin != std::string::npos) std::from_chars(line.data() + begin, line.data() + line.size(), size);
        if (size > 1) return size - 1;  // indices stay below it
    }
    throw Error("scontrol show config: states no MaxArraySize");
}

/// Sorted indices as Slurm writes them: "0-3,7,9-12".
std::string index_list(const std::vector<std::size_t>& indices) {
    std::string text;
    for (std::size_t i = 0; i < indices.size();) {
        std::size_t end = i;
        while (end + 1 < indices.size() && indices[end + 1] == indices[end] + 1) ++end;
        text += fmt::format("{}{}", text.empty() ? "" : ",", indices[i]);
        if (end > i) text += fmt::format("-{}", indices[end]);
        i = end + 1;
    }
    return text;
}

}  // namespace

SubmittedJob submit_to_slurm(const SweepFolder& folder, const SlurmJob& job) {
    const std::size_t points = folder.tasks().size(), max_elements = max_array_size();
    constexpr std::size_t least = 10;
    const std::size_t needed = (points + max_elements - 1) / max_elements;
    const std::size_t per_element = job.points_per_element > 0 ? job.points_per_element : std::max(needed, least);
    if (per_element < needed)
        throw Error(
            fmt::format("--chunk {}: {} points need at least {} per element, because this Slurm allows {} elements",
                        per_element, points, needed, max_elements));
    SubmittedJob submitted;
    submitted.shares = (points + per_element - 1) / per_element;
    const std::vector<bool> finished = finished_points(folder);
    std::vector<bool> is_open(submitted.shares, false);
    for (std::size_t i = 0; i < points; ++i)
        if (!finished[i]) is_open[i % submitted.shares] = true;
    std::vector<std::size_t> open;
    for (std::size_t s = 0; s < submitted.shares; ++s)
        if (is_open[s]) open.push_back(s);
    submitted.elements = open.size();
    if (open.empty()) return submitted;
    const fs::path script = folder.path() / "slurm" / "job.sh";
    std::error_code failure;
    fs::create_directories(script.parent_path(), failure);
    if (failure)
        throw Error(fmt::format("{}: cannot make the folder: {}", script.parent_path().string(), failure.message()));
    write_renamed(script, fmt::format("#!/bin/sh\n"
                                      "# An element of the array: share I of N.\n"
                                      "exec {} sweep work {} --share $((SLURM_ARRAY_TASK_ID + 1))/{} --jobs {}\n",
                                      run::shell_word(job.program.string()), run::shell_word(folder.path().string()),
                                      submitted.shares, job.jobs));
    std::vector<std::string> words{"sbatch",
                                   "--parsable",
                                   "--requeue",
                                   "--open-mode=append",
                                   "--job-name=tactus-sweep",
                                   "--ntasks=1",
                                   fmt::format("--cpus-per-task={}", job.jobs),
                                   "--array=" + index_list(open),
                                   fmt::format("--output={}/out-%A_%a.txt", script.parent_path().string())};
    words.insert(words.end(), job.options.begin(), job.options.end());
    words.push_back(script.string());
    // "17" or "17;cluster"
    submitted.id = output_of(words);
    submitted.id = submitted.id.substr(0, submitted.id.find(';'));
    return submitted;
}

std::size_t elements_in_slurm(const std::string& id) {
    std::string states;
    try {
        states = output_of({"squeue", "--noheader", "--array", "--jobs", id, "--format=%T"});
    } catch (const Error& error) {
        // Slurm purges ended jobs after MinJobAge (default: 5 minutes).
        if (std::string_view(error.what()).find("Invalid job id") != std::string_view::npos) return 0;
        throw;
    }
    return states.empty() ? 0 : static_cast<std::size_t>(std::ranges::count(states, '\n')) + 1;
}

std::size_t write_makefile(const SweepFolder& folder, std::size_t points_per_target, int jobs,
                           const fs::path& program) {
    const std::size_t points = folder.tasks().size(), per = std::max<std::size_t>(points_per_target, 1);
    const std::size_t shares = std::max<std::size_t>((points + per - 1) / per, 1);
    std::string all;
    for (std::size_t s = 1; s <= shares; ++s) all += fmt::format(" share-{}", s);
    const auto escaped = [](std::string text) {
        for (std::size_t at = 0; (at = text.find('$', at)) != std::string::npos; at += 2) text.insert(at, 1, '$');
        return text;
    };
    // Shares are no files: each call skips what is finished.
    write_renamed(
        folder.path() / "Makefile",
        fmt::format("# {} points in {} shares; 'make -j 8 -k' runs eight at a time. Finished points are skipped.\n"
                    "all:{}\n\n"
                    ".PHONY: all{}\n\n"
                    "{}:\n\t{} sweep work {} --share $(@:share-%=%)/{} --jobs {}\n",
                    points, shares, all, all, all.substr(1), escaped(run::shell_word(program.string())),
                    escaped(run::shell_word(folder.path().string())), shares, jobs));
    return shares;
}

}  // namespace tactus::analysis
