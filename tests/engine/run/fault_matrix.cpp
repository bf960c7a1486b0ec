// SPDX-License-Identifier: Apache-2.0
// What each kind of fault does to the force on a hand, for each place that a group may have in a patch, on one core and
// on more.
#include "assets/bone/bone.hpp"
#include "graph/node/assets.hpp"
#include "tests/devices/hosted/with_host.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/live_case.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/virtual_clock.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr double fault_at_s = 0.5;

/// What the force must do after a fault.
enum class Demand {
    zero,  ///< 0 N within 20 ms
    steady,  ///< it stays as it is: it does not depend on what failed
    gentle,  ///< an edit: 0 N, by a fade
    cannot,  ///< nobody can keep the bound; the reason is stated
};

struct Place {
    const char *name, *group, *wires;  ///< wires of a node 'bad' there to the force, or to who uses it
};

const std::vector<Place>& places() {
    static const std::vector<Place> all{{"device's group", "device", "\"bad.wrench -> sum.in2\", "},
                                        {"upstream, force", "upstream", "\"bad.wrench -> sum.in2\", "},
                                        {"upstream, world", "world", "\"bad.pose -> spring.object\", "},
                                        {"downstream", "downstream", "\"bad.wrench -> after.in\", "},
                                        {"sound group", "sound", "\"bad.number -> level.in\", "},
                                        {"observer", "observer", "\"bad.number -> ear.in\", "}};
    return all;
}

/// A hand on a spring in a group of its own; the other end of the spring is in a third group. Behind the spring a node,
/// beside them sound and an observer.
struct FaultPatch {
    std::string driver = "driver = \"left\"";
    std::string wires, nodes, assets;  ///< of what fails
    std::string place;  ///< its group
    std::string latency;  ///< of that group
    bool has_end = true;  ///< the spring's other end is not the node that fails

    std::string toml() const {
        const auto group = [this](const std::string& name, const std::string& rate) {
            return name + " = {rate = \"" + rate + "\"" +
                   (name == place && !latency.empty() ? ", latency = \"" + latency + "\"" : "") + "}\n";
        };
        return "wires = [\"hand.pose -> spring.device\", \"spring.wrench -> sum.in1\", \"sum.out -> out.wrench\", " +
               std::string(has_end ? "\"end.pose -> spring.object\", " : "") + wires +
               "\"tone.signal -> loud.in\", \"spring.wrench -> probe.in\"]\n[devices.left]\n" + driver + "\n" +
               (assets.empty() ? "" : "[assets]\n" + assets) + "[groups]\n" + group("device", "1 kHz") +
               group("upstream", "500 Hz") + group("world", "50 Hz") + group("downstream", "250 Hz") +
               group("sound", "48 kHz") + group("observer", "100 Hz") +
               "[nodes]\n"
               "hand = {type = \"device_input\", group = \"device\", device = \"left\"}\n"
               "out = {type = \"device_output\", group = \"device\", device = \"left\"}\n"
               "sum = {type = \"wrench_sum\", group = \"device\"}\n"
               "spring = {type = \"spring\", group = \"upstream\", stiffness = \"1 N/mm\"}\n"
               "end = {type = \"still\", group = \"world\"}\ntone = {type = \"sine\", group = \"sound\"}\n"
               "loud = {type = \"gain\", group = \"sound\"}\nprobe = {type = \"probe\", group = \"observer\"}\n" +
               nodes;
    }
};

FaultPatch busy_patch(const Place& place, const std::string& cost, const std::string& lasts) {
    FaultPatch patch;
    patch.place = place.group;
    patch.nodes =
        fmt::format("bad = {{type = \"busy\", group = \"{}\", from = \"{} s\", lasts = \"{}\", cost = \"{}\"}}\n",
                    place.group, fault_at_s, lasts, cost);
    return patch;
}

FaultPatch faulty_patch(const Place& place, const std::string& fault, double at_s = fault_at_s) {
    FaultPatch patch;
    const std::string group = place.group;
    patch.place = group;
    patch.wires = place.wires;
    patch.has_end = group != "world";
    patch.nodes = fmt::format("bad = {{type = \"faulty\", group = \"{}\", fault = \"{}\", from = \"{} s\"}}\n", group,
                              fault, at_s);
    if (group == "downstream") patch.nodes += "after = {type = \"force_shaping\", group = \"downstream\"}\n";
    if (group == "observer") patch.nodes += "ear = {type = \"probe\", group = \"observer\"}\n";
    if (group == "sound") patch.nodes += "level = {type = \"to_signal\", group = \"sound\"}\n";
    return patch;
}

/// Another hand, read in the group.
FaultPatch hand_patch(const Place& place) {
    FaultPatch patch = faulty_patch(place, "nan");
    patch.has_end = true;
    patch.wires.clear();
    patch.nodes = fmt::format("bad = {{type = \"device_input\", group = \"{}\", device = \"right\"}}\n", place.group);
    patch.driver += "\n[devices.right]\ndriver = \"right\"";
    if (std::string_view(place.group) == "world") {
        patch.has_end = false;
        patch.wires = place.wires;
    } else if (std::string_view(place.group) == "upstream") {
        patch.wires = "\"bad.pose -> second.device\", \"end.pose -> second.object\", \"second.wrench -> sum.in2\", ";
        patch.nodes += "second = {type = \"spring\", group = \"upstream\", stiffness = \"1 N/mm\"}\n";
    }
    return patch;
}

/// A node that reads a file.
FaultPatch asset_patch(const Place& place, const std::string& file) {
    FaultPatch patch;
    const std::string group = place.group;
    patch.place = group;
    patch.assets = "bone = \"" + file + "\"\n";
    const bool is_world = group == "world";
    patch.wires = std::string("\"hand.pose -> blade.pose\", ") +
                  (is_world ? "\"cut.bone -> blade.bone\", " : "\"bone -> blade.bone\", ") +
                  (is_world || group == "device" || group == "upstream" ? "\"blade.wrench -> sum.in3\", " : "");
    patch.nodes = "blade = {type = \"blade_contact\", group = \"" + (is_world ? "upstream" : group) + "\"}\n";
    if (is_world) patch.nodes += "cut = {type = \"carve\", group = \"world\", source = \"bone\"}\n";
    return patch;
}

/// All threads of this process that begin from now on run on one core, until it is destroyed.
struct OnOneCore {
    OnOneCore() {
        sched_getaffinity(0, sizeof before, &before);
        cpu_set_t one;
        CPU_ZERO(&one);
        for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
            if (CPU_ISSET(cpu, &before)) {
                CPU_SET(cpu, &one);
                break;
            }
        sched_setaffinity(0, sizeof one, &one);
    }
    ~OnOneCore() { sched_setaffinity(0, sizeof before, &before); }
    OnOneCore(const OnOneCore&) = delete;
    OnOneCore& operator=(const OnOneCore&) = delete;

    cpu_set_t before{};
};

struct CellOutcome {
    double before_N = 0.0, after_N = 0.0, to_zero_ms = 1e9, largest_step_N = 0.0;
    double min_N = 1e9, first_zero_ms = 1e9;  ///< in the 200 ms after the fault
    std::vector<std::string> faults;
};

using Deed = std::function<void(run::Engine&, WatchedHand& left, WatchedHand& right, VirtualClock*)>;

struct Cell {
    std::string text;
    Demand demand = Demand::zero;
    std::string reason;  ///< why it cannot be kept
    Deed deed;  ///< by the control thread; none: the patch fails by itself
    bool is_clock = false;  ///< the time counts from the end of the deed
    double bound_ms = prompt_ms;
    std::shared_ptr<compile::AssetCache> assets = std::make_shared<compile::AssetCache>();  ///< of the run
};

/// One run in this process, on one real core, or in virtual time, in which every thread has a core.
CellOutcome run_cell(const Cell& cell, bool is_alone) {
    std::optional<OnOneCore> one_core;
    std::optional<VirtualClock> clock;
    if (is_alone) one_core.emplace();
    else clock.emplace();
    busy_clock = clock && VirtualClock::is_virtual() ? &*clock : nullptr;
    WatchedHand& hand = watched_hand("left");
    WatchedHand& other = watched_hand("right");
    other.depth = 0.5e-3;
    std::atomic<std::int64_t> fault_ns{0};
    const auto acquire = hand.performance.acquire;
    hand.performance.acquire = [&](std::int64_t count, double elapsed, const Wrench& force) {
        const DeviceSample sample = acquire(count, elapsed, force);
        if (!cell.deed && fault_ns == 0 && hand.logical_s >= fault_at_s) fault_ns = steady_now();
        return sample;
    };
    run::EngineOptions options;
    options.seconds = fault_at_s + 0.3;
    options.live = true;
    options.audio.device = "none";
    run::Engine engine(compile_text(cell.text, cell.assets.get()), options);
    std::atomic<bool> stop{false};
    run::LiveOptions live;
    live.stop = &stop;
    live.watch = [&] {
        if (fault_ns != 0 && steady_now() > fault_ns + 250'000'000) stop = true;  // a pause does not end by itself
        if (!cell.deed || fault_ns != 0 || hand.logical_s < fault_at_s) return;
        if (!cell.is_clock) fault_ns = steady_now();
        cell.deed(engine, hand, other, clock ? &*clock : nullptr);
        if (cell.is_clock) fault_ns = steady_now();
    };
    engine.run_live(live);
    busy_clock = nullptr;
    hand.performance.acquire = acquire;
    CellOutcome outcome;
    outcome.before_N = hand.force_at(fault_ns - 1'000'000);
    outcome.after_N = hand.force_at(fault_ns + 120'000'000);
    outcome.to_zero_ms = hand.ms_to_zero(fault_ns);
    double last = outcome.before_N;
    for (const WatchedHand::Given& given : hand.given())
        if (given.ns >= fault_ns && given.ns < fault_ns + 200'000'000) {
            outcome.largest_step_N = std::max(outcome.largest_step_N, std::abs(given.force_N - last));
            last = given.force_N;
            outcome.min_N = std::min(outcome.min_N, last);
            if (last == 0.0) outcome.first_zero_ms = std::min(outcome.first_zero_ms, ms_between(fault_ns, given.ns));
        }
    for (const auto& slot : engine.host().devices)
        for (const io::DeviceFault& fault : slot->guard.faults())
            if (slot->name == "left") outcome.faults.push_back(fault.text());
    return outcome;
}

bool holds(const Cell& cell, const CellOutcome& outcome) {
    if (!(outcome.before_N > 1.0)) return false;
    switch (cell.demand) {
        case Demand::zero: return outcome.to_zero_ms <= cell.bound_ms;
        case Demand::steady: return outcome.faults.empty() && outcome.after_N > 0.95 * outcome.before_N;
        case Demand::gentle: return outcome.min_N == 0.0 && outcome.largest_step_N < 0.5 * outcome.before_N;
        case Demand::cannot: return true;
    }
    return false;
}

std::string text_of(const Cell& cell, const CellOutcome& outcome) {
    if (cell.demand == Demand::cannot) return "cannot: " + cell.reason;
    const double zero = outcome.to_zero_ms;
    if (cell.demand == Demand::gentle && outcome.min_N == 0.0)
        return fmt::format("{:.0f} ms, {:.2g} N a step", std::ceil(outcome.first_zero_ms), outcome.largest_step_N);
    if (outcome.faults.empty() && outcome.after_N > 0.95 * outcome.before_N) return "stays";
    if (zero >= 1e9) return fmt::format("{:.1f} N of {:.1f} N left", outcome.after_N, outcome.before_N);
    return fmt::format("{:.0f} ms", std::ceil(zero));
}

/// Others may keep the machine busy: a cell in real time that does not hold is run again.
CellOutcome settled(const Cell& cell, bool is_alone) {
    CellOutcome outcome;
    if (cell.demand == Demand::cannot) return outcome;
    for (int attempt = 1; attempt <= attempts; ++attempt) {
        outcome = run_cell(cell, is_alone);
        if (!is_alone || holds(cell, outcome)) break;
    }
    return outcome;
}

bool is_on_path(const Place& place) {
    const std::string_view group = place.group;
    return group == "device" || group == "upstream";
}

Demand fades_on_path(const Place& place) { return is_on_path(place) ? Demand::zero : Demand::steady; }

std::string periods(const Place& place, double count) {
    const std::string_view group = place.group;
    const double rate = group == "device"       ? 1000.0
                        : group == "upstream"   ? 500.0
                        : group == "world"      ? 50.0
                        : group == "downstream" ? 250.0
                        : group == "sound"      ? 48000.0
                                                : 100.0;
    return fmt::format("{:.6f} ms", count / rate * 1e3);
}

/// One period and a little: one tick falls into it.
Cell hang(const Place& place) {
    return {busy_patch(place, "120 ms", periods(place, 1.0)).toml(), fades_on_path(place), "", {}, false};
}
Cell overrun(const Place& place) {
    return {busy_patch(place, periods(place, 5.0), "120 ms").toml(), fades_on_path(place), "", {}, false};
}
Cell load(const Place& place) {
    return {busy_patch(place, periods(place, 0.6), "120 ms").toml(), Demand::steady, "", {}, false};
}
Cell not_a_number(const Place& place) {
    const bool is_world = std::string_view(place.group) == "world";
    return {faulty_patch(place, "nan").toml(), is_world ? Demand::zero : fades_on_path(place), "", {}, false};
}
Cell cable(const Place& place) {
    const std::string_view group = place.group;
    if (group == "sound")
        return {"", Demand::cannot, "a card counts as lost after 0.5 s without a request; 30 ms after that", {}, false};
    if (group == "device")
        return {busy_patch(place, "0 ms", "0 ms").toml(), Demand::zero, "",
                [](run::Engine&, WatchedHand& left, WatchedHand&, VirtualClock*) { left.is_stale = true; }, false};
    // A hand that another device no longer sees stands still for this one: that is passive.
    return {hand_patch(place).toml(), Demand::steady, "",
            [](run::Engine&, WatchedHand&, WatchedHand& right, VirtualClock*) { right.is_stale = true; }, false};
}
Cell clock_jump(const Place& place) {
    return {busy_patch(place, "0 ms", "0 ms").toml(), Demand::zero, "",
            [](run::Engine&, WatchedHand&, WatchedHand&, VirtualClock* clock) {
                if (clock) clock->stop_machine(120'000'000);
            },
            true};
}
/// Edits that are refused change no force.
void is_made(const run::EditOutcome& outcome) { CHECK_FALSE(outcome.error); }

/// The control thread edits the run to another text, with the assets that the run has.
Cell edited(const std::string& before, const std::string& after, Demand demand) {
    Cell cell{before, demand, "", {}, false};
    cell.deed = [after, assets = cell.assets](run::Engine& engine, WatchedHand&, WatchedHand&, VirtualClock*) {
        engine.edit([after, assets] { return compile_text(after, assets.get()); }, is_made);
    };
    return cell;
}
Demand fades_where_it_depends(const Place& place) {
    return is_on_path(place) || std::string_view(place.group) == "world" ? Demand::gentle : Demand::steady;
}
Cell edit(const Place& place) {
    FaultPatch patch = busy_patch(place, "0 ms", "0 ms"), after = patch;
    after.latency = std::string_view(place.group) == "world" ? "40 ms" : periods(place, 3.0);
    return edited(patch.toml(), after.toml(), fades_where_it_depends(place));
}
Cell paused(const Place& place) {
    // The group is in a tick of 120 ms when the pause comes.
    const std::string_view group = place.group;
    const bool hangs = !is_on_path(place) && group != "sound";
    return {busy_patch(place, hangs ? "120 ms" : "0 ms", "25 ms").toml(), Demand::zero, "",
            [](run::Engine& engine, WatchedHand&, WatchedHand&, VirtualClock*) { engine.pause(true); }, false};
}
/// The file is written anew, in place, and the patch saved: a run keeps what it has loaded.
Cell asset_overwritten(const Place& place, const std::filesystem::path& folder) {
    const auto file = folder / "bone.vdb", next = folder / "next.vdb";
    const std::string text = asset_patch(place, file).toml();
    Cell cell = edited(text, text, Demand::steady);
    cell.deed = [file, next, edit = cell.deed](run::Engine& engine, WatchedHand& left, WatchedHand& right,
                                               VirtualClock* clock) {
        std::filesystem::copy_file(next, file, std::filesystem::copy_options::overwrite_existing);
        edit(engine, left, right, clock);
    };
    return cell;
}
Cell asset_replaced(const Place& place, const std::filesystem::path& folder) {
    return edited(asset_patch(place, folder / "bone.vdb").toml(), asset_patch(place, folder / "next.vdb").toml(),
                  fades_where_it_depends(place));
}

/// Two bones that differ, far from the hand: `bone.vdb`, which a patch reads, and `next.vdb`, which replaces it.
void write_bones(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    bone::Bone bone = *std::static_pointer_cast<const bone::Bone>(sample_asset(AssetLoader<bone::Bone>::name));
    bone.distance.origin.x += 0.2;
    bone.density.origin.x += 0.2;
    bone::save_bone(bone, folder / "bone.vdb");
    bone.density.at(0, 0, 0) += 1.0f;
    bone::save_bone(bone, folder / "next.vdb");
}

// Processes that end.

/// Written by the process that ends, read by the other.
struct Ended {
    std::atomic<std::int64_t> at_ns{0};  // boot_ns
};

Ended* ended_memory() {
    static auto* const memory =
        static_cast<Ended*>(::mmap(nullptr, sizeof(Ended), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    return memory;
}

/// An engine in a process of its own whose device has one, too. What the device gave after `signal`, or after an error
/// that a node throws by itself; ms to zero.
double ms_after_end(const FaultPatch& patch, int signal, bool is_alone) {
    const WatchedHost host;
    FaultPatch hosted = patch;
    hosted.driver = "driver = \"watched\"\nprocess = true\nlog = \"" + host.path() + "\"";
    compile::Schedule plan = compile_text(hosted.toml());
    Ended* const ended = ended_memory();
    ended->at_ns = 0;
    const pid_t process = ::fork();
    if (process == 0) {
        const rlimit none{0, 0};
        ::setrlimit(RLIMIT_CORE, &none);
        std::set_terminate([] {
            ended_memory()->at_ns = boot_ns();
            ::_exit(1);
        });
        std::optional<OnOneCore> one_core;
        if (is_alone) one_core.emplace();
        try {
            run::EngineOptions options;
            options.seconds = 20.0;
            options.live = true;
            options.audio.device = "none";
            run::Engine engine(std::move(plan), options);
            engine.run_live({});
        } catch (const std::exception& error) {
            fmt::print(stderr, "{}\n", error.what());
        }
        ::_exit(0);
    }
    bool has_force = false;
    if (signal != 0) {
        has_force = wait_until([&] { return host.log->last() > 2.0; });
        ended->at_ns = boot_ns();
        ::kill(process, signal);
    } else has_force = wait_until([&] { return ended->at_ns != 0; });
    const bool is_zero =
        wait_until([&] { return boot_ns() > ended->at_ns + 100 * ms && host.log->last() == 0.0; }, 2000);
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    wait_until([&] { return ::waitpid(-1, nullptr, WNOHANG) < 0; });
    const bool had_force = host.log->max_after(0) > 1.0;
    const double ms_to_zero = static_cast<double>(host.log->last_force_ns() - ended->at_ns) * 1e-6;
    // A late tick may have taken the force away before.
    const bool had_force_then = ms_to_zero > -2.0;
    return has_force && had_force && had_force_then && is_zero ? ms_to_zero : 1e9;
}

double settled_end(const FaultPatch& patch, int signal, bool is_alone) {
    double ms_to_zero = 1e9;
    for (int attempt = 1; attempt <= attempts && ms_to_zero > prompt_ms; ++attempt)
        ms_to_zero = ms_after_end(patch, signal, is_alone);
    return ms_to_zero;
}

using CellMaker = std::function<Cell(const Place&)>;

}  // namespace

// Costly: each kind of fault in each place of a patch.
TEST_CASE("a fault in a group takes a force away within 20 ms when the force depends on it, and leaves it alone else",
          "[slow][virtual]") {
    for (const CellMaker& make : {CellMaker(hang), CellMaker(overrun), CellMaker(not_a_number), CellMaker(load)})
        for (const Place& place : places()) {
            const Cell cell = make(place);
            CAPTURE(place.name, cell.text);
            const CellOutcome outcome = run_cell(cell, false);
            CAPTURE(outcome.before_N, outcome.after_N, outcome.to_zero_ms, outcome.faults);
            CHECK(holds(cell, outcome));
        }
}

TEST_CASE("on one core, too, a fault in a group takes a force away within 20 ms", "[live][slow]") {
    for (const CellMaker& make : {CellMaker(hang), CellMaker(overrun)})
        for (const Place& place : places()) {
            const Cell cell = make(place);
            CAPTURE(place.name, cell.text);
            const CellOutcome outcome = settled(cell, true);
            CAPTURE(outcome.before_N, outcome.after_N, outcome.to_zero_ms, outcome.faults);
            CHECK(holds(cell, outcome));
        }
}

// Costly: each kind of fault in each place of a patch.
TEST_CASE("cables, clocks, edits and pauses take a force away as the table of safety states", "[slow][virtual]") {
    for (const CellMaker& make : {CellMaker(cable), CellMaker(clock_jump), CellMaker(edit), CellMaker(paused)})
        for (const Place& place : places()) {
            const Cell cell = make(place);
            if (cell.demand == Demand::cannot) continue;
            CAPTURE(place.name, cell.text);
            const CellOutcome outcome = run_cell(cell, false);
            CAPTURE(outcome.before_N, outcome.after_N, outcome.to_zero_ms, outcome.largest_step_N, outcome.faults);
            CHECK(holds(cell, outcome));
        }
}

TEST_CASE("the fault matrix", "[.]") {
    const auto folder = std::filesystem::temp_directory_path() / "tactus-fault-matrix";
    const std::vector<std::pair<const char*, CellMaker>> rows{
        {"hang of 120 ms", hang},
        {"overrun, 5 periods a tick", overrun},
        {"NaN", not_a_number},
        {"cable", cable},
        {"clock jump of 120 ms", clock_jump},
        {"edit", edit},
        {"asset file overwritten", [&](const Place& place) { return asset_overwritten(place, folder); }},
        {"another asset file", [&](const Place& place) { return asset_replaced(place, folder); }},
        {"pause", paused},
        {"load, 0.6 of each period", load}};
    int broken = 0;
    const auto print_row = [](const std::string& name, const std::vector<std::string>& cells) {
        fmt::print("| {} | {} |\n", name, fmt::join(cells, " | "));
        std::fflush(stdout);
    };
    const auto in_ms = [&](double zero) {
        broken += zero > prompt_ms;
        return zero > prompt_ms ? std::string("BEYOND") : fmt::format("{:.0f} ms", std::ceil(zero));
    };
    const std::size_t count = places().size();
    for (const bool is_alone : {false, true}) {
        std::vector<std::string> names;
        for (const Place& place : places()) names.emplace_back(place.name);
        fmt::print("\n");
        print_row(is_alone ? "one core" : "two cores and more", names);
        print_row("---", std::vector<std::string>(count, "---"));
        for (const auto& [name, make] : rows) {
            std::vector<std::string> cells;
            for (const Place& place : places()) {
                if (is_alone && make(place).is_clock) {
                    cells.emplace_back("as above");  // no core is used while the machine stands still
                    continue;
                }
                write_bones(folder);
                const Cell cell = make(place);
                const CellOutcome outcome = settled(cell, is_alone);
                const bool is_right = cell.demand == Demand::cannot || holds(cell, outcome);
                broken += !is_right;
                cells.push_back(text_of(cell, outcome) + (is_right ? "" : " BEYOND"));
            }
            print_row(name, cells);
        }
        std::vector<std::string> thrown;
        // The hand of the device's process presses once a second.
        for (const Place& place : places())
            thrown.push_back(in_ms(settled_end(faulty_patch(place, "throw", 1.5), 0, is_alone)));
        print_row("error thrown by a node", thrown);
        // All groups are in one process.
        for (const auto& [name, signal] : {std::pair{"killed process", SIGKILL}, std::pair{"SIGSTOP", SIGSTOP}})
            print_row(name,
                      std::vector<std::string>(
                          count, in_ms(settled_end(busy_patch(places().front(), "0 ms", "0 ms"), signal, is_alone))));
        const auto print_cannot = [&](const char* name, const std::string& reason) {
            std::vector<std::string> cells(count, "as before");
            cells.front() = "cannot: " + reason;
            print_row(name, cells);
        };
        print_cannot("killed or stopped, `process = false`", "no process is left that could reach the device");
        print_cannot("the driver hangs in `commit`", "a driver is not re-entrant; 0 N 11 ms after it comes back");
    }
    std::filesystem::remove_all(folder);
    CHECK(broken == 0);
}
