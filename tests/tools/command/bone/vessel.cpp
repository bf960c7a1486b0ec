// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/simulate/vessel_cases.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>

#include <cstdlib>

using namespace tactus;

namespace {

/// A scan in HU with a vessel of 400, as a file; returns its seed as text.
std::string write_scan(const std::filesystem::path& path) {
    simulate::VesselCase one = simulate::ends_case(2.5, 0.2, 3);
    for (float& value : one.scan.values) value = 50.0f + 350.0f * value;
    // Air, as around a patient.
    for (int k = 0; k < one.scan.size[2]; ++k)
        for (int j = 0; j < one.scan.size[1]; ++j)
            for (int i = 0; i < 5; ++i) one.scan.at(i, j, k) = -1000.0f;
    volume::write_volume(one.scan, volume::WrittenType::int16, path);
    return fmt::format("{:.1f},{:.1f},{:.1f}", one.seed.x * 1e3, one.seed.y * 1e3, one.seed.z * 1e3);
}

/// Commands run in a folder as long as it lives.
struct WorkingFolder {
    explicit WorkingFolder(const std::filesystem::path& path) { std::filesystem::current_path(path); }
    ~WorkingFolder() { std::filesystem::current_path(before); }
    std::filesystem::path before = std::filesystem::current_path();
};

bool is_one_line(const std::string& text) { return !text.empty() && text.find('\n') == text.size() - 1; }

}  // namespace

TEST_CASE("tactus vessel writes the line in every format, and a straightened view", "[slow]") {
    const test::Folder folder;
    const WorkingFolder here(folder.path);
    const std::string seed = write_scan(folder.path / "cta.nrrd");
    const auto seen =
        folder.tactus("vessel cta.nrrd --seed " + seed +
                      " -o line.csv -o line.vtp -o line.mrk.json -o tubes.ply --straightened straight.png --json");
    INFO(seen.err);
    REQUIRE(seen.code == 0);
    const file::Json json = file::Json::parse(seen.out);
    CHECK(json["found"].get<bool>());
    CHECK(json["branches"][0]["length_mm"].get<double>() > 42.0);
    CHECK(json["branches"][0]["length_mm"].get<double>() < 52.0);
    CHECK(json["branches"][0]["mean_radius_mm"].get<double>() == Approx(2.5).epsilon(0.05));
    CHECK(test::slurp(folder.path / "line.csv")
              .starts_with("branch,x_mm,y_mm,z_mm,radius_mm,contrast,confidence,parent\n0,"));
    CHECK(test::slurp(folder.path / "line.vtp").find("PolyData") != std::string::npos);
    CHECK(test::slurp(folder.path / "line.mrk.json").find("\"Curve\"") != std::string::npos);
    CHECK(test::slurp(folder.path / "tubes.ply").starts_with("ply"));
    CHECK(test::slurp(folder.path / "straight.png").substr(1, 3) == "PNG");
}

TEST_CASE("tactus vessel warns of a narrowing, of a lost stretch and of a missing peroneal artery", "[slow]") {
    const test::Folder folder;
    const WorkingFolder here(folder.path);
    const auto warnings_of = [&](simulate::VesselCase one, const std::string& rest) {
        for (float& value : one.scan.values) value = 50.0f + 350.0f * value;
        volume::write_volume(one.scan, volume::WrittenType::int16, folder.path / "cta.nrrd");
        const auto seen = folder.tactus(fmt::format("vessel cta.nrrd --seed {:.1f},{:.1f},{:.1f} {} --json",
                                                    one.seed.x * 1e3, one.seed.y * 1e3, one.seed.z * 1e3, rest));
        INFO(seen.err);
        REQUIRE(seen.code == 0);
        const file::Json warnings = file::Json::parse(seen.out)["warnings"];
        std::string lines;  // the same for people, first
        for (const file::Json& warning : warnings) lines += "warning: " + warning.as_text() + "\n";
        CHECK(folder
                  .tactus(fmt::format("vessel cta.nrrd --seed {:.1f},{:.1f},{:.1f} {}", one.seed.x * 1e3,
                                      one.seed.y * 1e3, one.seed.z * 1e3, rest))
                  .out.starts_with(lines));
        return warnings;
    };
    const file::Json narrow = warnings_of(simulate::stenosis_case({}, 5), "");
    REQUIRE(narrow.size() == 3);
    CHECK(narrow[0].as_text().starts_with("branch 0 is narrowed by "));
    const file::Json gap = warnings_of(simulate::gap_case(3.0, 5), "");
    CHECK(gap.dump().find("no contrast from") != std::string::npos);
    // One vessel in front of both bones: the anterior tibial artery alone.
    const file::Json leg = warnings_of(simulate::ends_case(2.5, 0.2, 3),
                                       "--leg right --tibia=25,40,96:25,40,-6 --fibula=-5,45,96:-5,45,-6");
    CHECK(leg.dump().find("peroneal") != std::string::npos);
    // A vessel that ends within the scan may be closed there, at both ends.
    const file::Json ends = warnings_of(simulate::ends_case(2.5, 0.2, 3), "");
    REQUIRE(ends.size() == 2);
    for (const file::Json& end : ends) CHECK(end.as_text().starts_with("branch 0 ends at "));
}

TEST_CASE("tactus vessel says in one line what is wrong with a seed") {
    const test::Folder folder;
    const WorkingFolder here(folder.path);
    write_scan(folder.path / "cta.nrrd");
    for (const char* const seed : {"500,0,0", "1e300,0,0", "nan,1,2", "1,2", "1,2,x", "2,20,20"}) {
        CAPTURE(seed);
        const auto seen = folder.tactus(fmt::format("vessel cta.nrrd '--seed={}' -o line.csv", seed));
        CHECK(seen.code == 2);
        CHECK(is_one_line(seen.err));
        CHECK_FALSE(std::filesystem::exists(folder.path / "line.csv"));
    }
    // No vessel: the answer is no.
    const auto none = folder.tactus("vessel cta.nrrd --seed 32,8,45 -o line.csv");
    INFO(none.err);
    CHECK(none.code == 1);
    CHECK_FALSE(std::filesystem::exists(folder.path / "line.csv"));
    for (const char* const rest :
         {"-o line.xyz", "--leg right", "--straightened view.svg", "--min-radius 9 --max-radius 3"}) {
        CAPTURE(rest);
        const auto seen = folder.tactus(fmt::format("vessel cta.nrrd --seed 19,19,44 {}", rest));
        CHECK(seen.code == 2);
        CHECK(is_one_line(seen.err));
    }
}

TEST_CASE("tactus vessel never writes over the scan, nor one result over another") {
    const test::Folder folder;
    const WorkingFolder here(folder.path);
    const std::string seed = write_scan(folder.path / "cta.nrrd");
    std::filesystem::rename(folder.path / "cta.nrrd", folder.path / "cta.csv");
    const std::string before = test::slurp(folder.path / "cta.csv");
    for (const char* const rest : {"-o cta.csv", "-o line.csv -o none/line.vtp", "-o line.csv -o ./line.csv"}) {
        CAPTURE(rest);
        const auto seen = folder.tactus(fmt::format("vessel cta.csv --seed {} {}", seed, rest));
        CHECK(seen.code == 2);
        CHECK(is_one_line(seen.err));
        CHECK(test::slurp(folder.path / "cta.csv") == before);
        CHECK_FALSE(std::filesystem::exists(folder.path / "line.csv"));
    }
    const auto huge = folder.tactus("vessel cta.csv --seed 1e300,0,0");
    CHECK(huge.code == 2);
    CHECK(huge.err.size() < 200);
}

TEST_CASE("one seed in the aorta of a real scan follows both iliac arteries", "[slow]") {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    if (!data || !std::filesystem::exists(std::filesystem::path(data) / "vessels/aorta_mra_vmtk.nrrd")) {
        test::skip("TACTUS_SHARED_DATA does not name a folder with vessels/aorta_mra_vmtk.nrrd");
        return;
    }
    const test::Folder folder;
    const WorkingFolder here(folder.path);
    const auto seen =
        folder.tactus(fmt::format("vessel {}/vessels/aorta_mra_vmtk.nrrd --seed=-221.4,-148.5,23.3 -o line.csv", data));
    REQUIRE(seen.code == 0);
    std::istringstream rows(test::slurp(folder.path / "line.csv"));
    bool right = false, left = false;
    for (std::string row; std::getline(rows, row);) {
        double x = 0.0, y = 0.0;
        if (std::sscanf(row.c_str(), "%*d,%lf,%lf", &x, &y) != 2 || std::abs(y + 100.0) > 4.0) continue;
        right = right || std::abs(x + 235.0) < 6.0;
        left = left || std::abs(x + 209.0) < 6.0;
    }
    CHECK(right);
    CHECK(left);
}
