// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/random_patches.hpp"

#include "dsp/core/random.hpp"
#include "dsp/core/units.hpp"
#include "engine/run/engine.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/support/virtual_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include <unistd.h>

namespace tactus::test {

namespace {

struct Draws {
    Random random;
    std::uint64_t at = 0;

    double uniform() { return random.uniform(at++); }
    bool chance(double probability) { return uniform() < probability; }
    std::size_t index(std::size_t count) {
        return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
    }
};

/// The ports and parameters of a node type.
struct Members final : MemberVisitor {
    struct Port {
        std::string name;
        const ValueType* type;
        InputKind kind;
        ValueKinds takes;
        bool is_optional;
    };
    struct Number {
        std::string name, unit;
        double value, min, max;
        bool is_driven;  // a wire may end at it
    };

    explicit Members(const NodeType& type) {
        void* const node = type.create();
        type.visit(node, *this);
        type.destroy(node);
    }
    void input(std::string_view name, Input& port) override {
        inputs.push_back({std::string(name), port.type, port.kind, port.takes, port.is_optional});
    }
    void output(std::string_view name, Output& port) override { outputs.emplace_back(name, port.type); }
    void param(std::string_view name, Param& p) override {
        if (!p.is_structural && !p.is_discrete)
            numbers.push_back({std::string(name), p.unit, p.value, p.min, p.max, !p.is_structural});
    }
    void choice(std::string_view name, Choice& c) override { choices.emplace_back(name, c.options); }
    void asset(std::string_view, AssetParam&) override { has_asset = true; }

    bool is_stream() const {
        const auto is_signal = [](const auto& port) { return port.kind == InputKind::stream; };
        return std::ranges::any_of(inputs, is_signal) ||
               std::ranges::any_of(outputs, [](const auto& port) { return port.second == &value::signal; });
    }

    std::vector<Port> inputs;
    std::vector<std::pair<std::string, const ValueType*>> outputs;
    std::vector<Number> numbers;
    std::vector<std::pair<std::string, std::vector<std::string>>> choices;
    bool has_asset = false;
};

struct Source {
    std::string port, rate;  // "node.port"
    const ValueType* type;
};

std::optional<compile::Schedule> compiled(const std::string& toml) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(toml, "random.toml", problems);
    if (!problems.empty()) return std::nullopt;
    std::optional<compile::Schedule> plan = compile::compile(patch, chaos_catalogue(), problems);
    if (!plan || !problems.empty()) return std::nullopt;
    compile::AssetCache assets;
    assets.load(*plan, problems);
    return problems.empty() ? std::move(plan) : std::nullopt;
}

/// It compiles, and all its nodes accept their settings.
bool can_run(const std::string& toml) {
    std::optional<compile::Schedule> plan = compiled(toml);
    if (!plan) return false;
    try {
        const run::Engine engine(std::move(*plan), {});
    } catch (const Error&) {
        return false;
    }
    return true;
}

class Maker {
public:
    explicit Maker(std::uint64_t seed) : draws_{Random{mix(seed ^ 0xb175)}} {
        patch_.extra = fmt::format("seed = {}", 1 + draws_.index(1000));
    }

    RandomPatch make() {
        start();
        const std::vector<const NodeType*> types = usable();
        const std::size_t wanted = patch_.nodes.size() + 6 + draws_.index(20);
        for (int tries = 0; patch_.nodes.size() < wanted && tries < 300; ++tries)
            add(*types[draws_.index(types.size())]);
        for (int n = 0; n < 4; ++n) lead_back();
        RandomPatch made;
        made.toml = patch_.toml();
        made.nodes = static_cast<int>(patch_.nodes.size());
        made.links = links_;
        for (const PatchText::Node& node : patch_.nodes) made.types.insert(node.type);
        return made;
    }

private:
    static constexpr std::array rates{"1 kHz", "1 kHz", "500 Hz", "200 Hz", "60 Hz", "4 kHz"};

    /// Inner types that need no file. Types of the tests that stall or fail are not among them.
    static std::vector<const NodeType*> usable() {
        std::vector<const NodeType*> all;
        for (const NodeType* type : chaos_catalogue()) {
            const bool is_planted =
                type->name == "planted" || type->name == "busy" || type->name == "faulty" || type->name == "keeper";
            if (type->role == NodeRole::inner && !is_planted && !Members(*type).has_asset) all.push_back(type);
        }
        return all;
    }

    /// Chaotic nodes at three rates, which carry a wrong bit to the end of the run, and a hand.
    void start() {
        put("a", "chaos", "1 kHz");
        put("slow", "chaos", draws_.chance(0.5) ? "60 Hz" : "200 Hz");
        put("voice", "chaos_signal", "48 kHz");
        patch_.wires = {"a.out -> slow.in", "a.out -> voice.glide as linear", "slow.out -> a.in as linear",
                        "voice.level -> slow.other"};
        links_ = 4;
        if (!draws_.chance(0.5)) return;
        patch_.extra +=
            "\n[devices.hand]\ndriver = \"scripted\"\ntargets = \"0 s: 0 0 0 mm; 0.1 s: 2 1 -1 mm; 0.2 s: -1 0 1 "
            "mm\"\n";
        put("in", "device_input", "1 kHz");
        put("pull", "spring", draws_.chance(0.5) ? "1 kHz" : "500 Hz");
        patch_.nodes.push_back({"out", "device_output", "1 kHz", {}});
        patch_.wires.insert(patch_.wires.end(),
                            {"in.pose -> pull.device", "a.pose -> pull.object", "pull.wrench -> out.wrench"});
    }

    void put(const std::string& name, const std::string& type, const std::string& rate) {
        patch_.nodes.push_back({name, type, rate, {}});
        for (const NodeType* known : chaos_catalogue())
            if (known->name == type) offer(name, Members(*known), rate, nullptr);
    }

    void offer(const std::string& node, const Members& members, const std::string& rate, const ValueType* decided) {
        for (const auto& [name, type] : members.outputs)
            sources_.push_back({node + "." + name, rate, type == &value::undecided ? decided : type});
    }

    /// The mode of a wire between these rates, " as …".
    std::string mode(const Source& from, const std::string& rate, const Members::Port* to) {
        if (to && to->kind == InputKind::batch) return " as batch";
        if (from.type == &value::event || (from.type == &value::signal && from.rate == rate))
            return draws_.chance(0.2) ? fmt::format(" as delay {}", 1 + draws_.index(9)) : "";
        if (draws_.chance(0.15)) return fmt::format(" as delay {}", 1 + draws_.index(9));
        return from.rate != rate && from.type->interpolate && draws_.chance(0.5) ? " as linear" : "";
    }

    bool fits(const Source& from, const Members::Port& to, const std::string& rate, const ValueType* decided) const {
        if (!from.type) return false;
        if (from.type == &value::signal && to.kind != InputKind::batch && from.rate != rate) return false;
        if (to.kind != InputKind::any) return from.type == to.type;
        return (kind_of(*from.type) & to.takes) && (!decided || decided == from.type);
    }

    /// Adds a node with wires to its inputs; nothing when no wires fit it, or the compiler or the node refuses them.
    void add(const NodeType& type) {
        const Members members(type);
        const std::string name = fmt::format("n{}", count_++);
        const std::string rate = members.is_stream() ? "48 kHz" : rates[draws_.index(rates.size())];
        const PatchText before = patch_;
        const int links_before = links_;
        PatchText::Node node{name, type.name, rate, {}};
        const ValueType* decided = nullptr;
        for (const Members::Port& port : members.inputs) {
            if (port.is_optional && draws_.chance(0.4)) continue;
            std::vector<const Source*> fitting;
            for (const Source& source : sources_)
                if (fits(source, port, rate, decided)) fitting.push_back(&source);
            if (fitting.empty()) {
                if (port.is_optional) continue;
                patch_ = before;
                links_ = links_before;
                return;
            }
            const Source& from = *fitting[draws_.index(fitting.size())];
            if (port.kind == InputKind::any) decided = from.type;
            patch_.wires.push_back(from.port + " -> " + name + "." + port.name + mode(from, rate, &port));
            links_ += from.rate != rate;
        }
        for (const Members::Number& number : members.numbers) set(number, name, rate, node);
        for (const auto& [choice, words] : members.choices)
            if (draws_.chance(0.3)) node.settings.emplace_back(choice, words[draws_.index(words.size())]);
        patch_.nodes.push_back(node);
        if (!can_run(patch_.toml())) {
            patch_ = before;
            links_ = links_before;
            return;
        }
        offer(name, members, rate, decided);
    }

    /// A value near the default, a wire, or neither.
    void set(const Members::Number& number, const std::string& node, const std::string& rate,
             PatchText::Node& settings) {
        if (draws_.chance(0.1) && number.is_driven) {
            std::vector<const Source*> numbers;
            for (const Source& source : sources_)
                if (source.type == &value::number) numbers.push_back(&source);
            const Source& from = *numbers[draws_.index(numbers.size())];
            patch_.wires.push_back(from.port + " -> " + node + "." + number.name + mode(from, rate, nullptr));
            links_ += from.rate != rate;
        } else if (draws_.chance(0.3)) {
            const double value = number.value != 0.0 ? number.value * std::pow(4.0, 2.0 * draws_.uniform() - 1.0)
                                                     : 0.1 * draws_.uniform() * std::min(number.max, 10.0);
            settings.settings.emplace_back(number.name,
                                           format_quantity(std::clamp(value, number.min, number.max), number.unit));
        }
    }

    /// A delayed wire to a node before its producer, where an input is open.
    void lead_back() {
        std::vector<std::pair<std::string, Members::Port>> open;
        std::vector<std::string> at;
        for (const PatchText::Node& node : patch_.nodes)
            for (const NodeType* type : chaos_catalogue()) {
                if (type->name != node.type) continue;
                for (const Members::Port& port : Members(*type).inputs) {
                    const std::string end = node.name + "." + port.name;
                    const bool is_wired = std::ranges::any_of(patch_.wires, [&](const std::string& wire) {
                        return (wire + " ").find("-> " + end + " ") != std::string::npos;
                    });
                    if (is_wired || port.kind != InputKind::value) continue;
                    open.emplace_back(end, port);
                    at.push_back(node.rate);
                }
            }
        if (open.empty()) return;
        const std::size_t which = draws_.index(open.size());
        std::vector<const Source*> fitting;
        for (const Source& source : sources_)
            if (fits(source, open[which].second, at[which], nullptr)) fitting.push_back(&source);
        if (fitting.empty()) return;
        const Source& from = *fitting[draws_.index(fitting.size())];
        const PatchText before = patch_;
        patch_.wires.push_back(fmt::format("{} -> {} as delay {}", from.port, open[which].first, 1 + draws_.index(5)));
        if (can_run(patch_.toml())) links_ += from.rate != at[which];
        else patch_ = before;
    }

    Draws draws_;
    PatchText patch_;
    std::vector<Source> sources_;
    int count_ = 0, links_ = 0;
};

// Runs.

using Hashes = run::Engine::PortHashes;

Hashes rendered(const std::string& toml, const run::EngineOptions& options, int threads) {
    run::Engine engine(*compiled(toml), options);
    engine.render(threads);
    return engine.port_hashes();
}

struct LiveRun {
    std::filesystem::path log;
    Hashes hashes;
    std::int64_t decisions = 0;
};

LiveRun run_live(const std::string& toml, double seconds, const VirtualClock::Lateness& lateness, std::uint64_t seed) {
    const VirtualClock clock(lateness, seed);
    LiveRun made;
    made.log = std::filesystem::temp_directory_path() / fmt::format("tactus_{}_bits_{}.log", ::getpid(), seed);
    run::EngineOptions options;
    options.seconds = seconds;
    options.live = true;
    options.audio.device = "none";
    run::Engine engine(*compiled(toml), options);
    engine.run_live({.dilate = 1.0, .log = made.log, .stop = nullptr, .watch = {}});
    made.hashes = engine.port_hashes();
    for (const auto& group : engine.groups())
        made.decisions += group->telemetry.misses + group->telemetry.skipped + group->telemetry.dropped;
    return made;
}

/// "": they are the same.
std::string difference(const Hashes& a, const Hashes& b) {
    if (a == b) return {};
    if (a.size() != b.size()) return fmt::format("{} outputs, not {}", b.size(), a.size());
    std::string first;
    int more = -1;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i] == b[i]) continue;
        if (first.empty()) first = a[i].first;
        ++more;
    }
    return fmt::format("{} and {} more of {}", first, more, a.size());
}

}  // namespace

RandomPatch random_patch(std::uint64_t seed) { return Maker(seed).make(); }

ComparedRuns compare_runs(const std::string& toml, double seconds, std::uint64_t seed) {
    ComparedRuns made;
    const auto compare = [&](const std::string& what, const Hashes& expected, const Hashes& got) {
        if (const std::string text = difference(expected, got); !text.empty())
            made.differences.push_back(what + ": " + text);
    };
    run::EngineOptions options;
    options.seconds = seconds;
    const Hashes offline = rendered(toml, options, 1);
    for (const int threads : {2, 4})
        compare(fmt::format("offline, {} threads", threads), offline, rendered(toml, options, threads));
    for (const int block : {1, 16, 480}) {
        options.block = block;
        compare(fmt::format("offline, blocks of {}", block), offline, rendered(toml, options, 1));
    }
    options.random_blocks = true;
    for (const int threads : {1, 3})
        compare(fmt::format("offline, random blocks, {} threads", threads), offline, rendered(toml, options, threads));
    const auto replayed = [&](const LiveRun& live, const std::string& what, int threads, bool has_random_blocks) {
        const take::TimingLog log = take::TimingLog::load(live.log);
        run::EngineOptions again;
        again.seconds = seconds;
        again.replay = &log;
        again.block = has_random_blocks ? 480 : 0;
        again.random_blocks = has_random_blocks;
        try {
            compare(what, live.hashes, rendered(toml, again, threads));
        } catch (const Error& error) {
            made.differences.push_back(what + ": " + error.what());
        }
    };
    const LiveRun prompt = run_live(toml, seconds, {}, seed);
    made.missed = prompt.decisions;
    if (prompt.decisions == 0) compare("live, on time", offline, prompt.hashes);
    replayed(prompt, "replay of the live run on time", 1, false);
    std::filesystem::remove(prompt.log);
    // Threads wake late by up to three periods of the hand, now and then by two of the slowest group.
    const LiveRun late =
        run_live(toml, seconds, {.max_ns = 3'000'000, .rare_fraction = 0.05, .max_rare_ns = 40'000'000}, seed);
    made.decisions = late.decisions;
    made.has_changed = late.hashes != offline;
    replayed(late, "replay of the late live run", 1, false);
    replayed(late, "replay of the late live run, random blocks, 3 threads", 3, true);
    std::filesystem::remove(late.log);
    return made;
}

}  // namespace tactus::test
