// SPDX-License-Identifier: Apache-2.0
#include "tests/check_node/node_checks.hpp"

#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/realtime_check.hpp"

#include <fmt/format.h>

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::check_node {

using test::Feed;
using test::HarnessOptions;
using test::NodeHarness;

namespace {

constexpr int longest_s = 60;  // of one check

/// What there is to set on a type.
struct Settings final : MemberVisitor {
    void param(std::string_view name, Param& p) override { ranges.push_back({std::string(name), p.min, p.max}); }
    void choice(std::string_view name, Choice& c) override {
        for (const std::string& option : c.options) words.emplace_back(name, option);
    }
    void flag(std::string_view name, Flag& f) override { words.emplace_back(name, f ? "false" : "true"); }

    struct Range {
        std::string name;
        double min, max;
    };
    std::vector<Range> ranges;
    std::vector<std::pair<std::string, std::string>> words;
};

Settings settings_of(const NodeType& type) {
    Settings settings;
    void* const node = type.create();
    type.visit(node, settings);
    type.destroy(node);
    return settings;
}

/// The types that an input of any type is tried with; one that means nothing where there is no such input.
std::vector<const ValueType*> wires_of(const NodeType& type) {
    const ValueKinds takes = NodeHarness(type).takes();
    if (takes == 0) return {&value::number};
    std::vector<const ValueType*> wires;
    for (const ValueType* any : value::plain_types())
        if (takes & kind_of(*any)) wires.push_back(any);
    return wires;
}

std::string on(const ValueType& wire, std::size_t count) {
    return count > 1 ? fmt::format(" on a wire of {}", wire.name) : "";
}

/// The first fault, or "".
using Check = std::function<std::string(const NodeType&)>;

template <class Each>
std::string for_each_wire(const NodeType& type, const Each& each) {
    const std::vector<const ValueType*> wires = wires_of(type);
    for (const ValueType* wire : wires)
        if (const std::string fault = each(wire); !fault.empty()) return fault + on(*wire, wires.size());
    return "";
}

std::uint64_t hash_of(const NodeType& type, const HarnessOptions& options, std::uint64_t partition) {
    NodeHarness harness(type, options);
    harness.prepare();
    harness.run(2000, partition);
    return harness.output_hash();
}

std::string real_time(const NodeType& type) {
    return for_each_wire(type, [&](const ValueType* wire) -> std::string {
        for (const Feed feed : {Feed::ordinary, Feed::hostile})
            for (const bool is_open : {false, true}) {
                NodeHarness harness(type, {.feed = feed, .drive_params = true, .any = wire});
                if (is_open) harness.disconnect_optional();
                harness.prepare();
                const RealtimeViolations seen = watch_scopes([&] {
                    harness.run(3);
                    harness.run(500, 1);
                });
                if (!seen.none()) return fmt::format("{} in `process`", seen.describe());
            }
        return "";
    });
}

std::string blocks(const NodeType& type) {
    return for_each_wire(type, [&](const ValueType* wire) -> std::string {
        for (const Feed feed : {Feed::ordinary, Feed::hostile}) {
            const HarnessOptions options{.max_frames = 17, .feed = feed, .drive_params = true, .any = wire};
            const std::uint64_t whole = hash_of(type, options, 0);
            if (hash_of(type, options, 0) != whole) return "two runs differ: it depends on something outside of it";
            for (const std::uint64_t partition : {1, 2, 3})
                if (hash_of(type, options, partition) != whole)
                    return "a run in blocks of other lengths gives other values: does something happen once per call?";
        }
        return "";
    });
}

std::string finite(const NodeType& type) {
    return for_each_wire(type, [&](const ValueType* wire) -> std::string {
        NodeHarness harness(type, {.drive_params = true, .any = wire});
        harness.prepare();
        harness.run(3000);
        return harness.finite() ? "" : "finite inputs give an output that is not";
    });
}

std::string recovers(const NodeType& type) {
    return for_each_wire(type, [&](const ValueType* wire) -> std::string {
        NodeHarness harness(type, {.feed = Feed::hostile, .any = wire});
        harness.prepare();
        harness.run(3000);
        harness.feed_with(Feed::ordinary);
        harness.run(3000);
        harness.forget();
        harness.run(3000);
        return harness.finite()
                   ? ""
                   : "outputs are not finite long after an input was NaN or infinite: it stays in the state";
    });
}

std::string extremes(const NodeType& type) {
    const Settings settings = settings_of(type);
    const auto with = [&](const std::string& what, const std::function<void(NodeHarness&)>& set) -> std::string {
        NodeHarness harness(type, {.any = wires_of(type).front()});
        try {
            set(harness);
            harness.prepare();
        } catch (const Error&) {
            return "";  // it refuses that, with a reason
        }
        harness.run(500, 1);
        return harness.finite() ? "" : fmt::format("with {} an output is not finite", what);
    };
    for (const bool is_max : {false, true}) {
        const auto value_of = [&](const Settings::Range& range) { return is_max ? range.max : range.min; };
        for (const Settings::Range& range : settings.ranges)
            if (const std::string fault = with(fmt::format("{} = {:g}", range.name, value_of(range)),
                                               [&](NodeHarness& node) { node.set_value(range.name, value_of(range)); });
                !fault.empty())
                return fault;
        const std::string fault =
            with(is_max ? "all parameters at their largest" : "all parameters at their least", [&](NodeHarness& node) {
                for (const Settings::Range& range : settings.ranges) node.set_value(range.name, value_of(range));
            });
        if (!fault.empty()) return fault;
    }
    for (const auto& [name, word] : settings.words)
        if (const std::string fault =
                with(fmt::format("{} = {}", name, word), [&](NodeHarness& node) { node.set(name, word); });
            !fault.empty())
            return fault;
    return "";
}

std::string two_at_once(const NodeType& type) {
    const HarnessOptions options{.max_frames = 17, .drive_params = true, .any = wires_of(type).front()};
    HarnessOptions other_options = options;
    other_options.seed = 2;
    NodeHarness alone(type, options), one(type, options), other(type, other_options);
    alone.prepare();
    for (int part = 0; part < 20; ++part) alone.run(100);
    one.prepare();
    other.prepare();
    for (int part = 0; part < 20; ++part) {
        one.run(100);
        other.run(70);
    }
    return one.output_hash() == alone.output_hash()
               ? ""
               : "two nodes of the type disturb each other: is there a static variable?";
}

/// Durations of calls of the longest blocks, ns; a process runs one check.
struct Clocked {
    const NodeType* type = nullptr;
    std::vector<std::int64_t> durations;
    int frames = 1;
};
Clocked clocked;

void call_clocked(void* node, const Tick& tick) noexcept {
    const std::int64_t begin = steady_ns();
    clocked.type->process(node, tick);
    const std::int64_t end = steady_ns();
    clocked.frames = std::max(clocked.frames, tick.frames);
    if (tick.frames == clocked.frames && clocked.durations.size() < clocked.durations.capacity())
        clocked.durations.push_back(end - begin);
}

std::int64_t median(std::vector<std::int64_t>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The text of what a call costs.
std::string cost(const NodeType& type) {
    clocked.type = &type;
    clocked.durations.reserve(100'000);
    NodeType watched = type;
    watched.process = call_clocked;
    NodeHarness harness(watched, {.any = wires_of(type).front()});
    harness.prepare();
    harness.run(1000);  // warm
    clocked.durations.clear();
    harness.run(20'000);
    std::vector<std::int64_t> idle(1000);
    for (std::int64_t& duration : idle) {
        const std::int64_t begin = steady_ns();
        duration = steady_ns() - begin;
    }
    const std::int64_t most = *std::ranges::max_element(clocked.durations);
    const std::int64_t typical = std::max<std::int64_t>(median(clocked.durations) - median(idle), 0);
    if (clocked.frames == 1) return fmt::format("{} ns a call, at most {} ns", typical, most);
    return fmt::format("{} ns a call of {} samples, {:.1f} ns a sample, at most {} ns", typical, clocked.frames,
                       static_cast<double>(typical) / clocked.frames, most);
}

struct Outcome {
    bool has_failed = false;
    std::string text;
};

/// What the process wrote, and how it ended.
Outcome outcome_of(pid_t process, int pipe) {
    std::string text;
    std::array<char, 4096> block{};
    for (ssize_t count = 0; (count = ::read(pipe, block.data(), block.size())) > 0;)
        text.append(block.data(), static_cast<std::size_t>(count));
    int status = 0;
    ::waitpid(process, &status, 0);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM)
        return {true, fmt::format("did not return within {} s", longest_s)};
    if (WIFSIGNALED(status)) return {true, fmt::format("crashed: {}", ::strsignal(WTERMSIG(status)))};
    return {WEXITSTATUS(status) != 0, text};
}

/// Runs a check in a process of its own. `is_fault`: its text is a fault.
Outcome apart(const NodeType& type, const Check& check, bool is_fault) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw Error("no pipe to a process is left");
    std::fflush(nullptr);
    const pid_t process = ::fork();
    if (process < 0) throw Error("no process can be started");
    if (process == 0) {
        ::close(ends[0]);
        ::alarm(longest_s);
        Outcome outcome{true, ""};
        try {
            outcome.text = check(type);
            outcome.has_failed = is_fault && !outcome.text.empty();
        } catch (const std::exception& error) {
            outcome.text = error.what();
        }
        static_cast<void>(!::write(ends[1], outcome.text.data(), outcome.text.size()));
        ::_exit(outcome.has_failed ? 1 : 0);
    }
    ::close(ends[1]);
    const Outcome outcome = outcome_of(process, ends[0]);
    ::close(ends[0]);
    return outcome;
}

}  // namespace

int check(const NodeType& type) {
    fmt::print("{}\n", type.name);
    const auto row = [](const char* name, const std::string& text) { fmt::print("  {:<18} {}\n", name, text); };
    // Without what it needs, nothing can be run.
    const Outcome begins = apart(
        type,
        [](const NodeType& of) {
            NodeHarness harness(of, {.any = wires_of(of).front()});
            harness.prepare();
            return std::string();
        },
        true);
    if (begins.has_failed) {
        row("prepare", "FAILED: " + begins.text);
        return 1;
    }
    struct Row {
        const char* name;
        Check check;
        const char* passed;
    };
    const std::vector<Row> rows{
        {"real time", real_time, "no allocation, lock, wait or system call"},
        {"blocks", blocks, "the same bits in blocks of any length"},
        {"finite", finite, "finite values in give finite values out"},
        {"bad values", recovers, "recovers from NaN, infinite, huge and denormal values"},
        {"extreme values", extremes, "finite with each parameter at its limits, and all of them"},
        {"two at once", two_at_once, "independent of each other"},
    };
    if (const std::string missing = realtime_watch().missing; !missing.empty()) row("note", missing);
    int faults = 0;
    for (const Row& one : rows) {
        const Outcome outcome = apart(type, one.check, true);
        faults += outcome.has_failed;
        row(one.name, outcome.has_failed ? "FAILED: " + outcome.text : one.passed);
    }
    const Outcome price = apart(type, cost, false);
    faults += price.has_failed;
    row("cost", price.has_failed ? "FAILED: " + price.text : price.text);
    return faults;
}

}  // namespace tactus::check_node
