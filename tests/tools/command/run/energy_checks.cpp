// SPDX-License-Identifier: Apache-2.0
// What the command says of energy: the cap that is off, granted power, which walls a device bears, devices as they are.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <string>

using nlohmann::json;
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
    const json off = json::parse(folder.tactus("check touch-sphere --json --set hand_out.energy_cap=false").out);
    CHECK(off["outputs"][0]["energy_cap"] == false);
    CHECK(off["outputs"][0]["energy_bound_mJ"].is_null());
    REQUIRE(off["warnings"].size() == 1);
    CHECK(off["warnings"][0].get<std::string>().find("energy cap is off") != std::string::npos);
}

TEST_CASE("check lists and draws which walls a device bears", "[slow]") {
    const Folder folder;
    const std::string figure = (folder.path / "walls.svg").string();
    const Outcome o = folder.tactus("check touch-sphere --json --z-width --z-width-figure " + figure);
    REQUIRE(o.code == 0);
    const json rows = json::parse(o.out)["z_width"];
    REQUIRE(rows.size() > 20);
    for (const json& row : rows)
        if (row["device"] == "simulated, ideal" && row["delay_ms"] == 0.0) {
            INFO(row.dump());
            CHECK(row["passive_N_per_mm"].get<double>() == Approx(row["bound_N_per_mm"].get<double>()).epsilon(0.1));
        }
    CHECK(slurp(figure).find("falcon") != std::string::npos);
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
