// SPDX-License-Identifier: Apache-2.0
// Scans as they come: thick slices, tilted axes, rescaled samples, several series, damaged files.
#include "assets/volume/scan_volume.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <numbers>

using namespace tactus;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;

namespace {

constexpr double radius = 9.0;  // mm
const Vec3 left(-11.0, 0.0, 0.0), right(11.0, 0.0, 0.0);  // mm, about the middle
const Vec3 middle(20.0, -30.0, 400.0);

double two_balls(const Vec3& p) {
    const double a = glm::length(p - middle - left), b = glm::length(p - middle - right);
    return std::min(a, b) < radius ? 700.0 : -1000.0;
}

/// Around both balls, with voxels of that size and axes turned like that, mm.
WrittenVolume scan_of(const Vec3& spacing, const Mat3& axes = Mat3(1.0)) {
    WrittenVolume scan;
    const Vec3 extent(56.0, 32.0, 32.0);
    for (int axis = 0; axis < 3; ++axis) {
        scan.size[static_cast<std::size_t>(axis)] = static_cast<int>(extent[axis] / spacing[axis]);
        scan.step[axis] = spacing[axis] * axes[axis];
    }
    scan.origin = middle - scan.step * (0.5 * Vec3(scan.size[0] - 1, scan.size[1] - 1, scan.size[2] - 1));
    scan.fill(two_balls);
    return scan;
}

void write_seeds(const Folder& folder) {
    const auto at = [](const Vec3& p) { return json{p.x, p.y, p.z}; };
    json labels = json::array();
    for (const auto& [name, place] : {std::pair{"left", left}, std::pair{"right", right}})
        labels.push_back(
            {{"name", name}, {"strokes", {{{"radius_mm", 3.0}, {"points_mm", json::array({at(middle + place)})}}}}});
    folder.write("seeds.json", json{{"labels", labels}}.dump());
}

Outcome segment(const Folder& folder, const std::string& scan, const std::string& more = "") {
    return folder.tactus(
        fmt::format("segment {0}/{1} --threshold 200 --seeds {0}/seeds.json -o {0}/out.nrrd --json {2}",
                    folder.path.string(), scan, more));
}

void check_balls(const Outcome& done) {
    INFO(done.err);
    REQUIRE(done.code == 0);
    const json found = json::parse(done.out);
    REQUIRE(found["labels"].size() == 2);
    const double ball = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    for (const json& label : found["labels"]) CHECK(label["volume_mm3"].get<double>() == Approx(ball).epsilon(0.03));
    CHECK(found["unseeded_islands"].empty());
}

void check_refused(const Folder& folder, const Outcome& done, const std::string& why) {
    INFO(done.err);
    CHECK(done.code == 2);
    CHECK(done.err.find(why) != std::string::npos);
    CHECK(std::ranges::count(done.err, '\n') == 1);
    CHECK_FALSE(std::filesystem::exists(folder.path / "out.nrrd"));
}

std::string replaced(std::string bytes, const std::string& what, const std::string& by) {
    const auto at = bytes.find(what);
    REQUIRE(at != std::string::npos);
    REQUIRE(what.size() == by.size());
    return bytes.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("thick slices, oblique and tilted axes, and rescaled samples give the same fragments", "[slow]") {
    const Folder folder;
    write_seeds(folder);
    write_dicom_folder(scan_of({0.5, 0.5, 2.0}), folder.path / "thick");
    check_balls(segment(folder, "thick"));
    // The labels lie where the bone is, and not on its mirror image.
    const volume::Grid labels = volume::lps_grid(volume::read_volume(folder.path / "out.nrrd"));
    const auto label_at = [&](const Vec3& mm) {
        const Vec3 at = (1e-3 * mm - labels.origin) / labels.spacing + 0.5;
        return labels.at(static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z));
    };
    CHECK(label_at(middle + left) == 1.0f);
    CHECK(label_at(middle + right) == 2.0f);
    CHECK(label_at(middle) == 0.0f);

    const Mat3 turned = glm::mat3_cast(glm::angleAxis(0.35, glm::normalize(Vec3(0.2, 1.0, 0.4))));
    write_dicom_folder(scan_of({0.7, 0.7, 1.0}, turned), folder.path / "oblique");
    const Outcome oblique = segment(folder, "oblique");
    check_balls(oblique);
    CHECK(json::parse(oblique.out)["notes"].dump().find("axes of the scan are turned") != std::string::npos);

    // A gantry that is tilted by 15 degrees: slices stay parallel and slide.
    Mat3 tilted(1.0);
    tilted[1] = {0.0, std::cos(0.26), std::sin(0.26)};
    write_dicom_folder(scan_of({0.7, 0.7, 1.0}, tilted), folder.path / "gantry");
    check_balls(segment(folder, "gantry"));

    SliceStyle coarse;
    coarse.slope = 4.0;
    coarse.intercept = -2000.0;
    write_dicom_folder(scan_of({0.5, 0.5, 2.0}), folder.path / "rescaled", coarse);
    check_balls(segment(folder, "rescaled"));
    CHECK(volume::lps_grid(volume::read_volume(folder.path / "out.nrrd")).values == labels.values);
}

TEST_CASE("a folder of two series asks which, and takes the named one") {
    const Folder folder;
    write_seeds(folder);
    write_dicom_folder(scan_of(Vec3(1.0)), folder.path / "ct/a");
    SliceStyle other;
    other.series = "1.2.3.5";
    WrittenVolume dark = scan_of(Vec3(1.0));
    std::ranges::fill(dark.hu, std::int16_t{-1000});
    write_dicom_folder(dark, folder.path / "ct/b", other);
    const Outcome asked = segment(folder, "ct");
    INFO(asked.err);
    CHECK(asked.code == 2);
    CHECK(asked.err.find("there are 2 series; choose one with --series UID:") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder.path / "out.nrrd"));
    check_balls(segment(folder, "ct", "--series 1.2.3.4"));
}

TEST_CASE("scans that cannot be segmented are refused with one line that says why", "[slow]") {
    const Folder folder;
    write_seeds(folder);
    const WrittenVolume good = scan_of(Vec3(1.0));
    // One that is cut, one without spacing, one of eight voxels.
    const auto damaged = [&](const std::string& name, const auto& damage) {
        write_dicom_folder(good, folder.path / name);
        std::filesystem::path first;
        for (const auto& entry : std::filesystem::directory_iterator(folder.path / name))
            if (first.empty() || entry.path() < first) first = entry.path();
        const std::string bytes = damage(test::slurp(first));
        std::ofstream(first, std::ios::binary | std::ios::trunc) << bytes;
        return segment(folder, name);
    };
    check_refused(folder, damaged("cut", [](const std::string& all) { return all.substr(0, all.size() / 2); }), "cut");
    check_refused(folder,
                  damaged("flat",
                          [](const std::string& all) {
                              const std::string plain = "1\\1 ";
                              return replaced(all, plain, "0\\0 ");
                          }),
                  "no pixel spacing");
    WrittenVolume tiny = good;
    tiny.size = {2, 2, 2};
    tiny.fill([](const Vec3&) { return 700.0; });
    write_dicom_folder(tiny, folder.path / "tiny");
    check_refused(folder, segment(folder, "tiny"), "touches no voxel of bone");
    // More samples than any file here holds: refused by the header, before memory is taken.
    folder.write("huge.nrrd",
                 "NRRD0005\ntype: short\ndimension: 3\nsizes: 8000 8000 8000\nspace: left-posterior-superior\n"
                 "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nendian: "
                 "little\nencoding: raw\n\n1234");
    const auto begin = std::chrono::steady_clock::now();
    check_refused(folder, segment(folder, "huge.nrrd"), "huge.nrrd");
    CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(60));
    std::string metres = nrrd_bytes(good);
    for (auto at = metres.find("\"mm\""); at != std::string::npos; at = metres.find("\"mm\"", at + 1))
        metres.replace(at, 4, "\"km\"");
    folder.write("km.nrrd", metres);
    check_refused(folder, segment(folder, "km.nrrd"), "km");
}
