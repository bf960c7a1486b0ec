// SPDX-License-Identifier: Apache-2.0
// Real devices as a user has them: probed, confirmed, and under the hand of library patches, with stand-ins for the
// vendors' libraries.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>

using namespace tactus::test;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

/// The stand-ins where the drivers look, a folder of settings, and devices that move by themselves.
class Bench {
public:
    Bench() {
        const fs::path built = fs::path(command()).parent_path() / "tests";
        fs::create_directories(folder.path / "sdk/lib");
        fs::create_symlink(built / "libfake_dhd.so", folder.path / "sdk/lib/libdhd.so.3");
        fs::create_symlink(built / "libfake_hd.so", folder.path / "sdk/lib/libHD.so.3.4");
        ::setenv("FDSDK", (folder.path / "sdk").c_str(), 1);
        ::setenv("OH_SDK_BASE", (folder.path / "sdk").c_str(), 1);
        ::setenv("XDG_CONFIG_HOME", (folder.path / "config").c_str(), 1);
        ::setenv("FAKE_DEVICE_MOVES", "1", 1);
    }
    ~Bench() {
        for (const char* name : {"FDSDK", "OH_SDK_BASE", "XDG_CONFIG_HOME", "FAKE_DEVICE_MOVES"}) ::unsetenv(name);
    }
    Folder folder;
};

/// A live run of that patch with the device of that driver, and its take again.
void run_and_replay(const Bench& bench, const std::string& patch, const std::string& driver) {
    CAPTURE(driver, patch);
    // A busy machine makes ticks late; such a run ends with a fault, and is made again.
    Outcome run;
    fs::path take;
    for (int attempt = 0; attempt < 3 && run.code != 0; ++attempt) {
        take = bench.folder.path / (driver + patch + std::to_string(attempt));
        run = bench.folder.tactus(
            "run " + patch +
            (patch == "gripper-on-arm" ? " --set arm.device=" + driver + " --set arm_out.device=" + driver
                                       : " --set hand.device=" + driver) +
            " --audio none --seconds 1 --record " + take.string() + " --out " + take.string() + "-out");
    }
    INFO(run.out << run.err);
    REQUIRE(run.code == 0);
    CHECK_THAT(run.err, ContainsSubstring("untested on hardware: at most 0.5 N"));
    // The saw is stronger than the device, of which the patch knows nothing: its forces are fitted to it.
    if (patch == "saw-training") CHECK_THAT(run.out, ContainsSubstring("forces on the device are 0.0"));
    const Outcome replay = bench.folder.tactus("replay " + take.string() + " --json");
    INFO(replay.out << replay.err);
    REQUIRE(replay.code == 0);
    CHECK(json::parse(replay.out)["identical"] == true);
}

}  // namespace

TEST_CASE("a probe prints pose, rate and versions, or the step that failed", "[kernel]") {
    const Bench bench;
    const Outcome found = bench.folder.tactus("devices --probe force_dimension --json");
    INFO(found.out << found.err);
    REQUIRE(found.code == 0);
    const json report = json::parse(found.out);
    CHECK(report["serial"] == "4711");
    CHECK(report["versions"][1] == "SDK 3.17.5.0");
    CHECK(report["valid"] == true);
    CHECK(report["rate_hz"].get<double>() > 0.0);
    CHECK(report["directions_confirmed"] == false);
    CHECK(std::abs(report["position_mm"][2].get<double>()) <= 40.0);
    const Outcome missing = bench.folder.tactus("devices --probe touch --option library=/none/libHD.so");
    CHECK(missing.code == 1);
    CHECK_THAT(missing.out, ContainsSubstring("FAILED  load OpenHaptics"));
    CHECK_THAT(missing.out, ContainsSubstring("/none/libHD.so"));
    CHECK(bench.folder.tactus("devices --probe simulated").code == 2);
    CHECK(bench.folder.tactus("devices --probe touch --option librari=x").code == 2);
    CHECK(bench.folder.tactus("devices --option library=x").code == 2);
    CHECK_THAT(bench.folder.tactus("devices").out, ContainsSubstring("untested on hardware"));
}

TEST_CASE("right answers about pushes lift the cap of that device, a wrong one keeps it", "[kernel]") {
    const Bench bench;
    const fs::path wrong = bench.folder.write("wrong", "right\naway\n"),
                   right = bench.folder.write("right", "what\nright\ntowards\nup\n");
    const Outcome no = bench.folder.tactus("devices --verify force_dimension < " + wrong.string());
    INFO(no.out << no.err);
    CHECK(no.code == 1);
    CHECK_THAT(no.out, ContainsSubstring("it should have pushed to 'towards'"));
    CHECK_FALSE(json::parse(bench.folder.tactus("devices --probe force_dimension --json").out)["directions_confirmed"]);
    const Outcome yes = bench.folder.tactus("devices --verify force_dimension < " + right.string());
    INFO(yes.out << yes.err);
    CHECK(yes.code == 0);
    CHECK(json::parse(bench.folder.tactus("devices --probe force_dimension --json").out)["directions_confirmed"]);
    const Outcome ended = bench.folder.tactus("devices --verify touch < /dev/null");
    CHECK(ended.code == 1);
    CHECK(json::parse(slurp(bench.folder.path / "config/tactus/devices.json"))["confirmed"].size() == 1);
}

// Costly: a live run and its replay.
TEST_CASE("a library patch runs with a device by its driver's name alone, and its take repeats it", "[kernel]") {
    const Bench bench;
    run_and_replay(bench, "saw-training", "force_dimension");
    run_and_replay(bench, "planning-trauma", "touch");
}

TEST_CASE("every library patch for a hand runs with every vendor's device, and its take repeats it", "[long][kernel]") {
    const Bench bench;
    for (const char* patch : {"saw-training", "planning-trauma", "gripper-on-arm"})
        for (const char* driver : {"force_dimension", "touch"}) run_and_replay(bench, patch, driver);
}
