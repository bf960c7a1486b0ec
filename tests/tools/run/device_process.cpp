// SPDX-License-Identifier: Apache-2.0
// The command with a device that has a process of its own, and the ways in which one of the two may end.
#include "dsp/core/clock.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/force_log.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <fmt/format.h>
#include <sys/prctl.h>

#include <chrono>
#include <memory>

using namespace tactus;
using namespace tactus::test;
using nlohmann::json;

namespace {

constexpr std::int64_t ms = 1'000'000;

/// A run with the watched device of tests/support/fake_device_host.cpp, pressed into a ball.
class Watched {
public:
    explicit Watched(const std::string& fault = "none", int at = 0) {
        ::setenv("TACTUS_DEVICE_HOST", fake_device_host().c_str(), 1);
        ::prctl(PR_SET_CHILD_SUBREAPER, 1);
        log = std::make_unique<ForceLog>((folder.path / "log").string());
        patch = folder
                    .write("p.toml", fmt::format(R"(
title = "Pressed"
wires = ["hand.pose -> ball.pose", "ball.wrench -> out.wrench"]
[devices.watched]
driver = "watched"
process = true
open_timeout = "1 s"
log = "{}"
fault = "{}"
at = {}
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
centre = "0 mm, 0 mm, -20 mm"
radius = "20 mm"
tool_radius = "0 mm"
stiffness = "1 N/mm"
[nodes.out]
type = "device_output"
rate = "1 kHz"
engage_time = "1 ms"
)",
                                                 (folder.path / "log").string(), fault, at))
                    .string();
    }
    ~Watched() { ::unsetenv("TACTUS_DEVICE_HOST"); }

    std::string arguments() const { return patch + " --audio none --out " + (folder.path / "out").string(); }
    bool presses() const {
        return wait_for([&] { return log->last() > 1.0; });
    }
    /// The device's process, which came to this one when the engine was gone.
    bool ends() const {
        return wait_for([&] { return ::waitpid(log->process(), nullptr, WNOHANG) != 0; });
    }

    Folder folder;
    std::unique_ptr<ForceLog> log;
    std::string patch;
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

TEST_CASE("a run whose device's process is killed ends by itself and says so", "[kernel]") {
    Watched watched;
    pid_t run = ::fork();
    if (run == 0) {
        const Outcome outcome = watched.folder.tactus("run --seconds 60 " + watched.arguments());
        std::ofstream(watched.folder.path / "outcome") << outcome.code << "\n" << outcome.err;
        ::_exit(0);
    }
    CHECK(watched.presses());
    const auto begin = std::chrono::steady_clock::now();
    ::kill(watched.log->process(), SIGKILL);
    ::waitpid(run, nullptr, 0);
    CHECK(seconds_since(begin) < 20.0);
    const std::string outcome = slurp(watched.folder.path / "outcome");
    CAPTURE(outcome);
    CHECK(outcome.starts_with("3\n"));
    CHECK(outcome.find("device 'watched' was lost: its process was killed by signal 9") != std::string::npos);
    const json summary = json::parse(slurp(watched.folder.path / "out" / "summary.json"));
    CHECK(summary["seconds"].get<double>() < 50.0);
}

TEST_CASE("a run whose driver never returns ends by itself and says so", "[kernel]") {
    for (const std::string fault : {"hang in acquire", "hang in commit"}) {
        CAPTURE(fault);
        const Watched watched(fault, 4000);
        const auto begin = std::chrono::steady_clock::now();
        const Outcome outcome = watched.folder.tactus("run --seconds 60 " + watched.arguments());
        CAPTURE(outcome.err);
        CHECK(outcome.code == 3);
        CHECK(outcome.err.find("its driver did not return for 500 ms; its process was killed") != std::string::npos);
        CHECK(seconds_since(begin) < 30.0);
        CHECK(::kill(watched.log->process(), 0) != 0);
    }
    const Watched watched("hang in open");
    const Outcome outcome = watched.folder.tactus("run --seconds 60 " + watched.arguments());
    CHECK(outcome.code == 2);
    CHECK(outcome.err.find("device 'watched': the driver did not answer within 1 s") != std::string::npos);
    CHECK(::kill(watched.log->process(), 0) != 0);
}

TEST_CASE("a run that is killed or stopped leaves no force on the hand after 20 ms", "[live]") {
    for (const int signal : {SIGKILL, SIGSTOP}) {
        CAPTURE(signal);
        const Watched watched;
        {
            Run run(watched.folder, watched.arguments());
            REQUIRE(watched.presses());
            const std::int64_t ended = boot_ns();
            if (signal == SIGKILL) run.stop(SIGKILL);
            else run.signal(SIGSTOP);
            CHECK(wait_for([&] { return watched.log->is_closed(); }));
            CHECK(watched.log->last() == 0.0);
            CHECK(watched.log->last_force_ns() - ended <= 20 * ms);
        }
        CHECK(watched.ends());
    }
}

TEST_CASE("a run with a device in a process of its own can be replayed to the bit", "[kernel]") {
    const Watched watched;
    const std::string take = (watched.folder.path / "take").string();
    const Outcome run = watched.folder.tactus("run --seconds 2 --record " + take + " " + watched.arguments());
    CAPTURE(run.err);
    CHECK(run.code == 0);
    CHECK(watched.log->is_closed());
    CHECK(watched.log->max_after(0) > 1.0);
    CHECK(watched.folder.tactus("replay " + take).code == 0);
}

TEST_CASE("a process of its own changes no bit of a render, and check names what it costs") {
    const Folder folder;
    const auto hash_with = [&](const std::string& more) {
        const Outcome outcome = folder.tactus("render touch-sphere --seconds 1 --json --overwrite --out " +
                                              (folder.path / "out").string() + more);
        CAPTURE(outcome.err);
        REQUIRE(outcome.code == 0);
        return json::parse(outcome.out)["output_hash"].get<std::string>();
    };
    ::setenv("TACTUS_DEVICE_HOST", "/none/such", 1);  // a render starts none
    CHECK(hash_with("") == hash_with(" --set devices.simulated.process=true"));
    const auto checked = [&](const std::string& more) {
        return json::parse(folder.tactus("check touch-sphere --json " + more).out);
    };
    const json plain = checked(""), own = checked("--set devices.simulated.process=true"),
               faster = checked("--set devices.simulated.process=true --set 'devices.simulated.process_rate=8 kHz'");
    ::unsetenv("TACTUS_DEVICE_HOST");
    CHECK(plain["processes"].empty());
    REQUIRE(own["processes"].size() == 1);
    CHECK(own["processes"][0]["rate_hz"].get<double>() == Approx(4000.0));
    CHECK(own["processes"][0]["added_latency_ms"].get<double>() == Approx(0.5));
    CHECK(faster["processes"][0]["added_latency_ms"].get<double>() == Approx(0.25));
    const auto loop = [](const json& said) {
        for (const json& path : said["paths"])
            if (path.contains("stiffness_limit_N_per_mm")) return path;
        return json();
    };
    REQUIRE_FALSE(loop(plain).is_null());
    const double latency = loop(plain)["latency_ms"], damping = loop(plain)["damping_N_s_per_m"];
    CHECK(loop(own)["latency_ms"].get<double>() == Approx(latency + 0.5));
    CHECK(loop(own)["stiffness_limit_N_per_mm"].get<double>() ==
          Approx(damping / (0.5e-3 + 1e-3 * (latency + 0.5)) * 1e-3));
}
