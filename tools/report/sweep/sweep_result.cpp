// SPDX-License-Identifier: Apache-2.0
#include "tools/report/sweep/sweep_result.hpp"

#include "tools/counted.hpp"
#include "tools/run/shell_word.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::report {

namespace {

using analysis::Results;

std::vector<std::string> failures_of(const SweepState& s) {
    std::vector<std::string> all;
    for (const Results::Failure& failure : s.failures)
        all.push_back(fmt::format("{}: {}; such as point {}: {}", counted(failure.count, "point"), failure.reason,
                                  failure.example + 1, point_text(s.results->folder(), failure.example, failure.step)));
    return all;
}

std::vector<std::string> sweep_notes_of(const SweepState& s) {
    const Results& r = *s.results;
    std::vector<std::string> all;
    if (r.repeated() > r.conflicts().size())
        all.push_back(fmt::format("{} run more than once, with equal results",
                                  counted(r.repeated() - r.conflicts().size(), "point")));
    if (r.foreign() > 0)
        all.push_back(
            fmt::format("{} in the logs of points that the sweep no longer has", counted(r.foreign(), "row")));
    if (r.damaged() > 0) all.push_back(fmt::format("{} in the logs ignored", counted(r.damaged(), "damaged line")));
    if (const auto left = s.work_left(); left && r.unfinished() > 0)
        all.push_back(s.workers > 0 ? fmt::format("about {} left with {} that wrote in the last minutes",
                                                  duration_text(*s.seconds_left()), counted(s.workers, "worker"))
                                    : fmt::format("no worker wrote in the last minutes; {} of work are left",
                                                  duration_text(*left)));
    return all;
}

const Fields<Results::Failure>& failure_fields() {
    using F = Results::Failure;
    static const Fields<F> all = Fields<F>("points that failed for the same reason")
                                     .text("reason", "reason", &F::reason)
                                     .integer("points", "points", &F::count)
                                     .integer("example", "such as point", [](const F& f) { return f.example + 1; });
    return all;
}

}  // namespace

std::string point_text(const analysis::SweepFolder& folder, std::size_t index, int step) {
    const sweep::Sweep& sweep = folder.sweep();
    if (sweep.steps.empty()) return "no step";
    const sweep::Step& shown =
        sweep.steps[std::min(sweep.steps.size(), static_cast<std::size_t>(std::max(step, 1))) - 1];
    std::string text = shown.is_own ? "tactus" : "";
    for (const std::string& word :
         sweep::words_of(sweep, shown, folder.tasks().point(index), folder.tasks().id(index), "OUT", "tactus"))
        text += (text.empty() ? "" : " ") + run::short_shell_word(word);
    return text;
}

SweepState::SweepState(const Results& results_)
    : results(&results_),
      failures(results_.failures()),
      seconds_per_point(results_.mean_seconds()),
      workers(results_.unfinished() > 0 ? results_.active_workers() : 0) {}

std::optional<double> SweepState::work_left() const {
    if (!seconds_per_point) return std::nullopt;
    return *seconds_per_point * static_cast<double>(results->unfinished());
}

std::optional<double> SweepState::seconds_left() const {
    const std::optional<double> work = work_left();
    if (!work || workers == 0) return std::nullopt;
    return *work / static_cast<double>(workers);
}

std::string duration_text(double seconds) {
    if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
    if (seconds < 90.0 * 60.0) return fmt::format("{:.1f} min", seconds / 60.0);
    if (seconds < 36.0 * 3600.0) return fmt::format("{:.1f} h", seconds / 3600.0);
    return fmt::format("{:.1f} days", seconds / 86400.0);
}

const Fields<SweepState>& sweep_state_fields() {
    using S = SweepState;
    const auto of = [](auto member) { return [member](const S& s) { return (s.results->*member)(); }; };
    static const Fields<S> all =
        Fields<S>("state of a sweep")
            .titled([](const S& s) {
                const Results& r = *s.results;
                return fmt::format("{} of {} done, {} failed, {} to run", r.done(), counted(r.size(), "point"),
                                   r.failed(), r.unfinished());
            })
            .warnings("", failures_of, "failed")
            .warnings("conflicts", of(&Results::conflicts), "conflict")
            .integer("points", "", of(&Results::size))
            .integer("done", "", of(&Results::done))
            .integer("failed", "", of(&Results::failed))
            .integer("unfinished", "", of(&Results::unfinished))
            .integer("repeated", "", of(&Results::repeated))
            .integer("damaged_lines", "", of(&Results::damaged))
            .integer("workers", "", &S::workers)
            .number("seconds_per_point", "time of a point", significant(3, "s"), &S::seconds_per_point)
            .number("seconds_left", "", significant(3, "s"), &S::seconds_left)
            .rows("failures", "", failure_fields(), &S::failures)
            .notes("", "note", sweep_notes_of)
            .text("hash", "results", [](const S& s) { return fmt::format("{:016x}", s.results->hash()); });
    return all;
}

}  // namespace tactus::report
