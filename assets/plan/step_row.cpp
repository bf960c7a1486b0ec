// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/step_row.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/snap/fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

namespace tactus {

const std::array<std::string_view, step_row_columns> step_row_names{
    "step", "after", "kind",  "by",      "fragment", "x",      "y",   "z",   "qw",          "qx",
    "qy",   "qz",    "other", "verdict", "score",    "margin", "rms", "gap", "penetration", "overlap"};

namespace {

int whole(double value, double low, double high, const char* what) {
    if (!(value >= low && value <= high) || value != std::floor(value))
        throw Error(fmt::format("recorded steps: {} is no {}", value, what));
    return static_cast<int>(value);
}

std::string free_group_name(const CasePlan& plan) {
    const PlanState state = state_of(plan);
    for (int n = 1;; ++n)
        if (std::string name = fmt::format("group {}", n); state.find_group(name) == Arrangement::none) return name;
}

PlanStep step_of(const CasePlan& plan, std::span<const StepRow> rows, double second) {
    const auto last = static_cast<double>(plan.fragments.size()) - 1.0;
    const StepRow& first = rows.front();
    PlanStep step;
    step.kind = static_cast<StepKind>(whole(first.kind, 0.0, static_cast<double>(StepKind::show), "kind of step"));
    step.by = first.by > 0.5 ? "settle" : "hand";
    step.run_second = second;
    for (const StepRow& row : rows) {
        step.fragments.push_back(whole(row.fragment, 0.0, last, "fragment"));
        if (step.kind == StepKind::place) step.poses.push_back(row.pose());
    }
    const int other = whole(first.other, -1.0, last, "fragment");
    if (step.kind == StepKind::group) {
        if (other >= 0) step.fragments.push_back(other);
        step.group = free_group_name(plan);
    }
    if (first.verdict >= 0.0 && other >= 0) {
        const auto verdict = static_cast<FitVerdict>(whole(first.verdict, 0.0, 4.0, "verdict"));
        step.fit = PlanFit{plan.fragments[static_cast<std::size_t>(other)].name,
                           std::string(name_of(verdict)),
                           first.score,
                           first.margin,
                           first.rms,
                           first.gap,
                           first.penetration,
                           first.overlap};
    }
    return step;
}

}  // namespace

void apply_steps(CasePlan& plan, std::span<const StepRow> rows, std::span<const double> seconds) {
    std::vector<int> numbers;  // in the plan, of the run's steps
    const int stood = plan.place().head;
    const auto head_of = [&](double number) {
        const int n = whole(number, -1.0, static_cast<double>(numbers.size()) - 1.0, "step before it");
        return n < 0 ? stood : numbers[static_cast<std::size_t>(n)];
    };
    for (std::size_t n = 0; n < rows.size();) {
        std::size_t end = n + 1;
        while (end < rows.size() && rows[end].step == rows[n].step && rows[end].kind == rows[n].kind &&
               rows[n].kind == static_cast<double>(StepKind::place))
            ++end;
        const int head = head_of(rows[n].after);
        if (rows[n].kind == row_goes_to) plan.place().head = head;
        else {
            plan.place() = after_step(head);
            add_step(plan, step_of(plan, rows.subspan(n, end - n), seconds[n]));
            numbers.push_back(plan.place().head);
        }
        n = end;
    }
}

std::vector<StepRow> read_step_rows(const std::filesystem::path& path, std::vector<double>& seconds) {
    const std::string text = read_whole_file(path);
    std::string header = "t_s";
    for (const std::string_view name : step_row_names) header += fmt::format(",{}", name);
    if (!text.starts_with(header + "\n"))
        throw Error(fmt::format("{}: holds no steps of a plan; it begins with other columns", path.string()));
    std::vector<StepRow> rows;
    // A line that has no end was being written when the run was cut off.
    for (std::size_t at = header.size() + 1; at < text.size();) {
        const std::size_t end = text.find('\n', at);
        if (end == std::string::npos) break;
        std::array<double, step_row_columns + 1> numbers{};
        const char* place = text.c_str() + at;
        for (std::size_t n = 0; n < numbers.size(); ++n) {
            char* next = nullptr;
            numbers[n] = std::strtod(place, &next);
            if (next == place || *next != (n + 1 < numbers.size() ? ',' : '\n') || !std::isfinite(numbers[n]))
                throw Error(fmt::format("{}: line {} is no step of a plan", path.string(), rows.size() + 2));
            place = next + 1;
        }
        seconds.push_back(numbers[0]);
        std::array<double, step_row_columns> columns{};
        std::copy(numbers.begin() + 1, numbers.end(), columns.begin());
        rows.push_back(std::bit_cast<StepRow>(columns));
        at = end + 1;
    }
    return rows;
}

}  // namespace tactus
