// SPDX-License-Identifier: Apache-2.0
// Whether a peer that behaves badly delays the ticks: their lateness in live runs with hostile peers, between runs with
// ones that behave.
#include "assets/file/json.hpp"
#include "devices/hosted/hosted_device.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "engine/run/engine.hpp"
#include "graph/compile/compile.hpp"
#include "nodes/catalogue.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/hostile_peer.hpp"

#include <fmt/format.h>

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

constexpr int idle_runs = 5;
constexpr double allowed_us = 50.0;

struct PeersChoice {
    double seconds = 3.0, exchange = 0.0;
    bool own_process = false, json = false;
};

struct Opponent {
    Line line;
    const char* name;
    const char* driver;
};
constexpr Opponent opponents[] = {{Line::web_socket, "WebSocket", "haply"},
                                  {Line::openigtlink, "OpenIGTLink", "openigtlink"},
                                  {Line::serial, "serial line", "serial_board"}};
constexpr std::pair<Attack, const char*> attacks[] = {{Attack::half, "half messages"},
                                                      {Attack::huge, "16 MB message"},
                                                      {Attack::slow, "a byte each 10 ms"},
                                                      {Attack::flood, "flood"}};

struct Measured {
    double p99_us = 0.0, max_us = 0.0;
    std::int64_t ticks = 0, skipped = 0;
    std::uint64_t bytes = 0, connections = 0;
};

/// A hand at 1 kHz that touches a plane.
std::string patch_for(const Opponent& opponent, const HostilePeer& peer, const PeersChoice& choice) {
    const std::string place = opponent.line == Line::serial ? fmt::format("port = \"{}\"", peer.path())
                                                            : fmt::format("port = {}", peer.port());
    return fmt::format(R"(wires = [ "in.pose -> wall.pose", "in.twist -> wall.twist", "wall.wrench -> out.wrench" ]
[devices.hand]
driver = "{}"
process = {}
{}
[nodes]
in = {{ type = "device_input", rate = "1 kHz" }}
wall = {{ type = "plane_guide", rate = "1 kHz", stiffness = "100 N/m" }}
out = {{ type = "device_output", rate = "1 kHz" }}
)",
                       opponent.driver, choice.own_process, place);
}

Measured measure(const Opponent& opponent, Attack attack, const PeersChoice& choice) {
    const HostilePeer peer(opponent.line, attack);
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(patch_for(opponent, peer, choice), "peers.toml", problems);
    std::optional<compile::Schedule> plan = compile::compile(patch, nodes::catalogue(), problems);
    if (!plan || !problems.empty()) throw Error(problems.empty() ? "no plan" : problems.list.front().what());
    run::EngineOptions options;
    options.seconds = choice.seconds;
    options.live = true;
    run::Engine engine(std::move(*plan), options);
    engine.run_live({});
    const auto& telemetry = engine.groups().front()->telemetry;
    return {telemetry.lateness.quantile_ns(0.99) * 1e-3,
            static_cast<double>(telemetry.lateness.max_ns()) * 1e-3,
            telemetry.ticks.load(),
            telemetry.skipped.load(),
            peer.bytes(),
            peer.connections()};
}

Json json_of(const Measured& m) {
    return {{"p99_us", m.p99_us},   {"max_us", m.max_us}, {"ticks", m.ticks},
            {"skipped", m.skipped}, {"bytes", m.bytes},   {"connections", m.connections}};
}

void print(const char* what, const Measured& m, const char* verdict) {
    fmt::print(
        "  {:<20} p99 {:8.1f} us   max {:9.1f} us   {:6} ticks, {:4} left out   {:9.2f} MB in {:3} connections{}\n",
        what, m.p99_us, m.max_us, m.ticks, m.skipped, 1e-6 * static_cast<double>(m.bytes), m.connections, verdict);
}

constexpr std::int64_t ms = 1'000'000;
constexpr int above_driver = 10;  // priority of a service: a driver of a socket has 5, ticks have more

/// Ticks without a valid sample, by what kept it away.
struct Gaps {
    std::int64_t all = 0;
    std::int64_t tick_late = 0;  ///< the tick itself came more than 10 ms late: the machine stood still
    std::int64_t service_halted = 0;  ///< the service's thread was not let run
    std::int64_t driver = 0;  ///< all else is the driver's

    void count(std::int64_t now, std::int64_t due, std::int64_t service_ran) {
        ++all;
        if (now - due > 10 * ms) ++tick_late;
        else if (now - service_ran > 10 * ms) ++service_halted;
        else ++driver;
    }
};

struct Exchanged {
    Gaps gaps;
    std::int64_t ticks = 0, stale = 0, unread = 0;
    std::vector<std::int64_t> replies_ns;  ///< in order

    double reply_us(double share) const {
        return 1e-3 * static_cast<double>(
                          replies_ns[static_cast<std::size_t>(share * static_cast<double>(replies_ns.size() - 1))]);
    }
};

/// Haply's service as a peer that behaves, and the driver with ticks at 1 kHz.
Exchanged exchange(const PeersChoice& choice) {
    HostilePeer peer(Line::web_socket, Attack::none, above_driver);
    const std::unique_ptr<HapticDevice> device = hosted::open_placed(
        {"haply",
         "device 'bench'",
         {{"port", fmt::format("{}", peer.port()), {}}, {"process", choice.own_process ? "true" : "false", {}}},
         {}},
        [](const std::string& name) { return std::filesystem::path(name); });
    device->prepare(1e-3);
    sched_param parameters{};
    parameters.sched_priority = 60;
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
    std::int64_t next = steady_ns();
    for (const std::int64_t latest = next + 10'000 * ms; !device->acquire(1e-3).valid;) {
        if (next > latest) throw Error("the driver gave no valid sample within 10 s");
        sleep_until(next += ms);
    }
    Exchanged found;
    std::int64_t counter = device->acquire(1e-3).counter;
    const std::int64_t counter_before = counter, answers_before = peer.answers();
    for (const std::int64_t end = next + std::llround(1e9 * choice.exchange); next < end; ++found.ticks) {
        const DeviceSample sample = device->acquire(1e-3);
        if (!sample.valid) found.gaps.count(steady_ns(), next, peer.ran_ns());
        found.stale += sample.counter == std::exchange(counter, sample.counter);
        device->commit({{0.1, 0.0, 0.0}, {}});
        sleep_until(next += ms);
    }
    // One state may be on its way at each end.
    found.unread = std::max<std::int64_t>(peer.answers() - answers_before - (counter - counter_before) - 2, 0);
    peer.stop();
    found.replies_ns = peer.replies_ns();
    if (found.replies_ns.empty()) throw Error("the driver asked for nothing");
    std::ranges::sort(found.replies_ns);
    return found;
}

int bench_exchange(const PeersChoice& choice) {
    const Exchanged found = exchange(choice);
    const Gaps& gaps = found.gaps;
    const auto states = static_cast<double>(found.replies_ns.size());
    if (choice.json)
        fmt::print("{}\n",
                   Json{{"seconds", choice.exchange},
                        {"states", found.replies_ns.size()},
                        {"states_per_s", states / choice.exchange},
                        {"states_not_read", found.unread},
                        {"ticks", found.ticks},
                        {"ticks_without_a_valid_sample", gaps.all},
                        {"of_these",
                         {{"tick_was_late", gaps.tick_late},
                          {"service_did_not_run", gaps.service_halted},
                          {"driver", gaps.driver}}},
                        {"ticks_with_the_sample_before", found.stale},
                        {"reply_us",
                         {{"p50", found.reply_us(0.5)}, {"p99", found.reply_us(0.99)}, {"max", found.reply_us(1.0)}}}}
                       .dump(2));
    else
        fmt::print(
            "Inverse3 by a stand-in for its service: {:.0f} states in {:.4g} s ({:.0f}/s), {} not read; {} ticks, {} "
            "with "
            "the "
            "sample of the tick before, {} without a valid sample ({} because the tick was late, {} because the "
            "service "
            "did not run, {} by the driver); from a state to the next force p50 {:.0f} us, p99 {:.0f} us, max {:.0f} "
            "us\n",
            states, choice.exchange, states / choice.exchange, found.unread, found.ticks, found.stale, gaps.all,
            gaps.tick_late, gaps.service_halted, gaps.driver, found.reply_us(0.5), found.reply_us(0.99),
            found.reply_us(1.0));
    return gaps.all == 0 && found.unread == 0 ? done : answer_is_no;
}

int bench_peers(const PeersChoice& choice) {
    if (choice.exchange > 0.0) return bench_exchange(choice);
    Json all = Json::array();
    bool holds = true;
    for (const Opponent& opponent : opponents) {
        if (!choice.json) fmt::print("{}, driver {}\n", opponent.name, opponent.driver);
        double worst = 0.0;
        Json idle = Json::array(), attacked = Json::array();
        const auto behave = [&] {
            const Measured m = measure(opponent, Attack::none, choice);
            worst = std::max(worst, m.p99_us);
            idle.push_back(json_of(m));
            if (!choice.json) print("behaves", m, "");
        };
        std::vector<Measured> found;
        behave();
        for (const auto& [attack, name] : attacks) {
            found.push_back(measure(opponent, attack, choice));
            if (!choice.json) print(name, found.back(), "");
            behave();
        }
        for (std::size_t i = 0; i < found.size(); ++i) {
            const bool is_good = found[i].p99_us <= worst + allowed_us;
            holds = holds && is_good;
            Json row = json_of(found[i]);
            row["attack"] = attacks[i].second;
            row["holds"] = is_good;
            attacked.push_back(row);
            if (!choice.json && !is_good) fmt::print("  {} delays ticks\n", attacks[i].second);
        }
        if (!choice.json)
            fmt::print("  worst of {} runs with a peer that behaves: {:.1f} us; allowed {:.1f} us\n", idle_runs, worst,
                       worst + allowed_us);
        all.push_back({{"line", opponent.name},
                       {"driver", opponent.driver},
                       {"idle", idle},
                       {"attacks", attacked},
                       {"allowed_us", worst + allowed_us}});
    }
    if (choice.json) fmt::print("{}\n", Json{{"holds", holds}, {"peers", all}}.dump(2));
    else fmt::print("{}\n", holds ? "no peer delays a tick" : "a peer delays ticks");
    return holds ? done : answer_is_no;
}

}  // namespace

Verb peers_verb() {
    return {"peers", "lateness of ticks while a device's socket or line is attacked, beside peers that behave",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<PeersChoice>();
                verb.add("--seconds", choice->seconds, "length of each of the 27 runs, s")
                    .unit("s")
                    .shows_default()
                    .range(0.5, 600.0);
                verb.add("--exchange", choice->exchange, "instead: states and forces with a service for this long, s")
                    .unit("s")
                    .range(1.0, 3600.0);
                verb.flag("--process", choice->own_process, "drivers in a process of their own, as in 'tactus run'");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_peers(*choice); };
            }};
}

}  // namespace tactus::bench
