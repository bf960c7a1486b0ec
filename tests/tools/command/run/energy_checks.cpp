// SPDX-License-Identifier: Apache-2.0
// What the command says of energy: the cap that is off, granted power, which walls a device bears, devices as they are.
#include "dsp/control/stated_hand.hpp"
#include "dsp/simulate/device_model.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

using nlohmann::json;
namespace control = tactus::control;
namespace simulate = tactus::simulate;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

TEST_CASE("check warns when the energy cap of an output is off") {
    const Folder folder;
    const json on = json::parse(folder.tactus("check touch-sphere --json").out);
    CHECK(on["outputs"][0]["energy_cap"] == true);
    CHECK(on["outputs"][0]["energy_bound_mJ"].get<double>() > 0.0);
    CHECK(on["outputs"][0]["energy_bound_mJ"].get<double>() < 2.0);
    CHECK(on["warnings"].empty());
    CHECK(tactus::test::broken_schema(folder, "check", on) == "");
    const json wrong = json::parse(folder.tactus("check --json " + folder.write("w.toml", "wires = 3").string()).out);
    CHECK(wrong["errors"].size() == 1);
    CHECK(tactus::test::broken_schema(folder, "check", wrong) == "");
    const json off = json::parse(folder.tactus("check touch-sphere --json --set hand_out.energy_cap=false").out);
    CHECK(off["outputs"][0]["energy_cap"] == false);
    CHECK(off["outputs"][0]["energy_bound_mJ"].is_null());
    REQUIRE(off["warnings"].size() == 1);
    CHECK(off["warnings"][0].get<std::string>().find("energy cap is off") != std::string::npos);
}

// Costly: the stiffness that each device bears is found by simulation.
TEST_CASE("check lists and draws which walls a device bears", "[slow]") {
    const Folder folder;
    const std::string figure = (folder.path / "walls.svg").string();
    const Outcome o = folder.tactus("check touch-sphere --json --z-width --z-width-figure " + figure);
    REQUIRE(o.code == 0);
    const json answer = json::parse(o.out);
    CHECK(tactus::test::broken_schema(folder, "check", answer) == "");
    const json rows = answer["z_width"];
    REQUIRE(rows.size() > 20);
    for (const json& row : rows)
        if (row["device"] == "simulated, ideal" && row["delay_ms"] == 0.0) {
            INFO(row.dump());
            CHECK(row["passive_N_per_mm"].get<double>() == Approx(row["bound_N_per_mm"].get<double>()).epsilon(0.1));
        }
    // Each row states (b - |B|) / (T / 2 + delay) for its device, with the press at which the simulated one fails.
    for (const simulate::DeviceModel& model : simulate::device_models()) {
        int found = 0;
        for (const json& row : rows) {
            if (row["device"] != model.name) continue;
            INFO(row.dump());
            ++found;
            const double period = 1.0 / row["rate_hz"].get<double>(), delay = 1e-3 * row["delay_ms"].get<double>();
            const double b = model.viscous + control::StatedHand::damping;
            CHECK(delay >= model.delay - 1e-9);
            CHECK(row["bound_N_per_mm"].get<double>() ==
                  Approx(1e-3 * std::max(0.0, b - row["damping_N_s_per_m"].get<double>()) / (0.5 * period + delay)));
            CHECK(row["friction_N_per_mm"].get<double>() == Approx(1e-3 * 2.0 * model.friction / model.resolution));
            CHECK(row["simulated_press_N"].get<double>() <= 0.8 * model.max_force + 1e-9);
            CHECK(row["simulated_approach_m_per_s"].get<double>() <= 0.3);
        }
        CAPTURE(model.name);
        CHECK(found >= 4);
    }
    CHECK(slurp(figure).find("falcon") != std::string::npos);
}

TEST_CASE("check states the delay of the whole loop, and the stiffness that it permits") {
    const Folder folder;
    for (const simulate::DeviceModel& model : simulate::device_models()) {
        const std::string name(model.name);
        const json checked =
            json::parse(folder.tactus("check touch-sphere --json --set devices.simulated.model=" + name).out);
        int found = 0;
        for (const json& path : checked["paths"]) {
            if (!path.contains("stiffness_limit_N_per_mm")) continue;
            INFO(name << ": " << path.dump());
            ++found;
            const double delay = 1e-3 * path["latency_ms"].get<double>();
            const double b = path["damping_N_s_per_m"].get<double>();
            CHECK(delay == Approx(model.delay).margin(1e-9));  // the graph of this patch adds none
            CHECK(b >= control::StatedHand::damping);
            CHECK(path["stiffness_limit_N_per_mm"].get<double>() == Approx(1e-3 * b / (0.5e-3 + delay)));
        }
        CHECK(found == 1);
    }
}

TEST_CASE("a patch runs on a device as it is, and says what it can do") {
    const Folder folder;
    const Outcome o = folder.tactus("render touch-sphere --seconds 1 --set devices.simulated.model=touch --out " +
                                    (folder.path / "out").string());
    INFO(o.err);
    REQUIRE(o.code == 0);
    const json summary = json::parse(slurp(folder.path / "out/summary.json"));
    CHECK(summary["force"]["energy_cap"] == "on");
    CHECK(summary["force"]["max_N"].get<double>() <= 3.3);
    const Outcome wrong = folder.tactus("check touch-sphere --set devices.simulated.model=tuch");
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("did you mean 'touch'") != std::string::npos);
}
