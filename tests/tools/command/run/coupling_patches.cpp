// SPDX-License-Identifier: Apache-2.0
// The patches of contact and coupling, run by the command as their readers are told to.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

json rendered(const Folder& folder, const std::string& patch, double seconds, const std::string& settings = "") {
    const Outcome o = folder.tactus("render " + patch + " --seconds " + std::to_string(seconds) +
                                    " --overwrite --out " + (folder.path / "out").string() + " " + settings);
    INFO(o.err);
    REQUIRE(o.code == 0);
    return json::parse(slurp(folder.path / "out/summary.json"));
}

}  // namespace

TEST_CASE("render peg-in-hole: in and out at 0.1 and 0.0 mm, not in at -0.1 mm", "[slow]") {
    const Folder folder;
    for (const char* clearance : {"0.1 mm", "0.0 mm"}) {
        const json s = rendered(folder, "peg-in-hole", 6.0, "--set hole.clearance=\"" + std::string(clearance) + "\"");
        CAPTURE(clearance, s["peg"].dump(), s["coupling"].dump());
        CHECK(s["peg"]["inserted"] == 1.0);
        CHECK(s["peg"]["axial_force_N"] <= 10.0);
        CHECK(s["peg"]["depth_at_end_mm"] < 0.0);
        CHECK(s["peg"]["lateral_error_mm"] <= (clearance[2] == '1' ? 0.12 : 0.02));
        CHECK(s["coupling"]["residual_p99_N"] < 1.0);
        CHECK(s["coupling"]["penetration_max_mm"] < 0.15);
        CHECK(s["coupling"]["iterations_mean"] > 0.0);
        CHECK(s["faults"].empty());
    }
    CHECK(rendered(folder, "peg-in-hole", 6.0, "--set hole.clearance=\"-0.1 mm\"")["peg"]["inserted"] == 0.0);
}

TEST_CASE("render pop-through: the direct force turns over, the proxy's never does") {
    const Folder folder;
    const json s = rendered(folder, "pop-through", 3.0);
    CHECK(s["direct_range"]["min"][2] < -0.3);
    CHECK(s["direct_range"]["max"][2] > 0.3);
    CHECK(s["proxy_range"]["min"][2] > -1e-5);
    CHECK(s["proxy_range"]["max"][2] > 3.0);
}

TEST_CASE("render fragments, press-fragments and touch-sphere: balanced, nothing faulty", "[slow]") {
    const Folder folder;
    for (const char* patch : {"fragments", "press-fragments", "touch-sphere"}) {
        const json s = rendered(folder, patch, 9.5);
        CAPTURE(patch, s["coupling"].dump(), s["force"].dump());
        CHECK(s["coupling"]["in_contact"] > 0.2);
        CHECK(s["coupling"]["balanced"] > 0.9);
        CHECK(s["coupling"]["penetration_max_mm"] < 0.45);
        CHECK(s["faults"].empty());
    }
}

TEST_CASE("check warns of a device that gives no torque") {
    const Folder folder;
    const Outcome o = folder.tactus("check touch-sphere --json --set devices.simulated.torque=false");
    INFO(o.err);
    REQUIRE(o.code == 0);
    const json checked = json::parse(o.out);
    REQUIRE(checked["warnings"].size() == 1);
    CHECK(checked["warnings"][0].get<std::string>().find("gives forces only") != std::string::npos);
    bool has_loop = false;
    for (const json& path : checked["paths"])
        if (path.contains("ok")) {
            has_loop = true;
            CHECK(path["ok"] == true);
        }
    CHECK(has_loop);
    CHECK(json::parse(folder.tactus("check touch-sphere --json").out)["warnings"].empty());
}

TEST_CASE("a folder that is named like a patch does not hide the one of the library") {
    const Folder folder;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::create_directory(folder.path / "touch-sphere");
    std::filesystem::create_directory(folder.path / "nothing");
    std::filesystem::current_path(folder.path);
    const Outcome found = folder.tactus("check touch-sphere"), missing = folder.tactus("check nothing");
    std::filesystem::current_path(before);
    INFO(found.err);
    CHECK(found.code == 0);
    CHECK(missing.code == 2);
    CHECK(missing.err.find("'nothing': a folder, and not one of the library") != std::string::npos);
}
