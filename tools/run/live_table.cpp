// SPDX-License-Identifier: Apache-2.0
#include "tools/run/live_table.hpp"

#include "tools/run/force_news.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::run {

namespace {

constexpr const char* cause_names[observe::late_causes] = {"woken late", "preempted", "ran long"};

std::string describe_counts(const char* what, std::int64_t all, const observe::LateCounts& counts) {
    if (all == 0) return {};
    std::string causes;
    for (std::size_t c = 0; c < observe::late_causes; ++c)
        if (const std::int64_t n = counts[static_cast<observe::LateCause>(c)]; n > 0)
            causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", n, cause_names[c]);
    return fmt::format("{} {}{}", all, what, causes.empty() ? "" : " (" + causes + ")");
}

double force_of(const run::Engine& engine) {
    double force = 0.0;
    for (const auto& group : engine.groups())
        force = std::max(force, group->telemetry.force_N.load(std::memory_order_relaxed));
    return force;
}

std::string group_row(const run::GroupRuntime& group) {
    const observe::GroupTelemetry& t = group.telemetry;
    const double rate = rate_of(group.plan->period);
    return fmt::format("\n{:>10} {:>9.6g} {:>10} {:>7} {:>9.3f} {:>9.1f} {:>9.1f} {:>9.1f} {:>6.1f}", group.plan->name,
                       rate, t.ticks.load(), t.misses.load() + t.skipped.load(),
                       static_cast<double>(t.lateness.max_ns()) * 1e-6, t.execution.quantile_ns(0.5) * 1e-3,
                       t.execution.quantile_ns(0.99) * 1e-3, static_cast<double>(t.execution.max_ns()) * 1e-3,
                       t.execution.quantile_ns(0.5) * 1e-7 * rate / group.max_frames);
}

}  // namespace

std::vector<NodeTime> slowest_nodes(const run::Engine& engine, std::size_t count) {
    std::vector<NodeTime> all;
    for (const auto& node : engine.nodes()) {
        if (node->time.calls.load() == 0) continue;
        const double period_ns = seconds(node->group->plan->period) * 1e9 * node->group->max_frames;
        const double mean = node->time.mean_ns();
        all.push_back({node->name, node->group->plan->name, mean * 1e-3,
                       static_cast<double>(node->time.max_ns.load()) * 1e-3, mean / period_ns});
    }
    std::ranges::stable_sort(all, [](const NodeTime& a, const NodeTime& b) { return a.share > b.share; });
    if (all.size() > count) all.resize(count);
    return all;
}

std::string describe_lateness(const run::GroupRuntime& group) {
    const observe::GroupTelemetry& t = group.telemetry;
    std::int64_t withheld = 0;
    for (std::size_t c = 0; c < observe::late_causes; ++c) withheld += t.withheld[static_cast<observe::LateCause>(c)];
    const std::string skipped = describe_counts("skipped", t.skipped.load(), t.skip_causes);
    const std::string late = describe_counts("values too late for others", withheld, t.withheld);
    return skipped + (skipped.empty() || late.empty() ? "" : ", ") + late;
}

std::string describe_sound(const io::SoundCard& card) {
    const AudioStatistics s = card.statistics();
    return fmt::format("{}{:+.0f} ppm, {} underflows ({} frames of silence), {} frames dropped, {} left out",
                       card.is_lost() ? "LOST, " : "", 1e6 * card.follower().loop().rate_error(), s.underflows,
                       s.frames_underflowed, s.frames_dropped, s.frames_left_out);
}

std::string live_table(const run::Engine& engine, LetReturn way) {
    std::string text = fmt::format("{:.1f} s, {:.1f} N on the hand", engine.progress_seconds(), force_of(engine));
    for (const HandForces& forces : forces_of(engine, way))
        if (const std::string state = forces.text(); !state.empty())
            text += fmt::format("; '{}': {}", forces.device, state);
    for (const auto& card : engine.host().cards) text += "; sound " + describe_sound(*card);
    text += fmt::format("\n{:>10} {:>9} {:>10} {:>7} {:>9} {:>9} {:>9} {:>9} {:>6}", "group", "Hz", "ticks", "missed",
                        "late ms", "p50 µs", "p99 µs", "max µs", "load %");
    for (const auto& group : engine.groups()) text += group_row(*group);
    text += fmt::format("\n{:>10} {:>20} {:>38} {:>9} {:>6}", "node", "", "mean µs", "max µs", "load %");
    for (const NodeTime& node : slowest_nodes(engine, 5))
        text += fmt::format("\n{:>10} {:<48} {:>8.1f} {:>10.1f} {:>6.1f}", node.group, " " + node.node, node.mean_us,
                            node.max_us, 100.0 * node.share);
    return text;
}

}  // namespace tactus::run
