// SPDX-License-Identifier: Apache-2.0
// What import takes when nothing is said: threshold, unit of length, density.
#include "assets/bone/ct_threshold.hpp"
#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/volume/reoriented_volume.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

// A ball of 15 mm: `rim` HU to 2 mm depth, `core` inside, `outside` around it.
WrittenVolume ball(double rim, double core, double outside) {
    WrittenVolume v;
    v.size = {60, 60, 60};
    v.origin = Vec3(-29.5);
    v.fill([=](const Vec3& p) {
        const double depth = 15.0 - glm::length(p);
        return depth < 0.0 ? outside : depth < 2.0 ? rim : core;
    });
    return v;
}

bone::ImportSummary summary_of(const WrittenVolume& v, bone::ImportOptions options = {}) {
    const TemporaryFolder folder;
    options.input = folder / "ct.nrrd";
    file::write_whole_file(options.input, nrrd_bytes(v));
    bone::ImportSummary summary;
    bone::import_bone(options, {}, &summary);
    return summary;
}

// A limb along z: a ball of bone of 12 mm radius (cortex of 3 mm, cancellous bone in it), muscle to 28 mm, fat to
// 32 mm, air.
struct Limb {
    bool has_soft_tissue = true, has_metal = false;
    double half = 36.0;  // mm: half of the square that is kept of each slice
    double half_z = 15.0;
};

constexpr double bone_radius = 12.0;
const double bone_mm3 = 4.0 / 3.0 * std::numbers::pi * std::pow(bone_radius, 3);

WrittenVolume limb(const Limb& how) {
    WrittenVolume v;
    const int side = static_cast<int>(2.0 * how.half);
    v.size = {side, side, static_cast<int>(2.0 * how.half_z)};
    v.origin = Vec3(0.5 - how.half, 0.5 - how.half, 0.5 - how.half_z);
    v.fill([&](const Vec3& p) {
        const double r = glm::length(p), from_axis = std::hypot(p.x, p.y);
        if (how.has_metal && glm::length(p - Vec3(0.0, 5.0, 0.0)) < 2.5) return 12000.0;
        const auto part = [r](double radius) { return std::clamp((radius - r) / 0.8 + 0.5, 0.0, 1.0); };
        double hu = how.has_soft_tissue && from_axis < 32.0 ? (from_axis < 28.0 ? 50.0 : -90.0) : -1000.0;
        // Denser towards the middle of the cortex, as it is.
        hu += part(bone_radius) * (1000.0 + 500.0 * std::cos(r - 10.5) - hu);
        return hu + part(9.0) * (350.0 - hu);
    });
    return v;
}

std::string without_units(std::string header) {
    const std::size_t at = header.find("space units");
    return header.erase(at, header.find('\n', at) + 1 - at);
}

// The numbers of a shoebox; its longest side is x.
std::string box_obj(double x, const std::string& comment = "") {
    std::string text = comment;
    for (int n = 0; n < 8; ++n)
        text += fmt::format("v {} {} {}\n", n & 1 ? x : 0.0, n & 2 ? 0.4 * x : 0.0, n & 4 ? 0.3 * x : 0.0);
    return text +
           "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\nf 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 "
           "6\n";
}

bone::ImportSummary box_summary(double x, bone::ImportOptions options = {}, const std::string& comment = "") {
    const TemporaryFolder folder;
    options.input = folder / "box.obj";
    options.spacing = 1e-3;
    file::write_whole_file(options.input, box_obj(x, comment));
    bone::ImportSummary summary;
    bone::import_bone(options, {}, &summary);
    return summary;
}

}  // namespace

TEST_CASE("without a threshold a masked bone is taken at half its median, and keeps its core") {
    // The core is below the 300 HU that used to be the default.
    const WrittenVolume v = ball(900.0, 220.0, 0.0);
    const bone::ImportSummary found = summary_of(v);
    CHECK(found.hu == "masked");
    REQUIRE(found.threshold.hu);
    CHECK(*found.threshold.hu < 220.0);
    CHECK(found.threshold.from.find("suggested: half the median") == 0);
    REQUIRE(found.threshold.mask_mm3);
    CHECK(found.threshold.kept_mm3 == Approx(*found.threshold.mask_mm3));
    CHECK(*found.threshold.mask_mm3 == double(std::count_if(v.hu.begin(), v.hu.end(), [](auto h) { return h != 0; })));
    bone::ImportOptions options;
    options.threshold = 300.0;
    options.fill = false;
    const bone::ImportSummary given = summary_of(v, options);
    CHECK(given.threshold.from == "given");
    CHECK(given.threshold.kept_mm3 < 0.5 * *given.threshold.mask_mm3);
}

TEST_CASE("the suggested threshold is that of the whole volume: cropped, resampled or rescaled, it stays") {
    const WrittenVolume v = ball(1200.0, 700.0, -1000.0);
    bone::ImportOptions options;
    const double whole = *summary_of(v).threshold.hu;
    CHECK(whole > 100.0);
    CHECK(whole < 1000.0);
    options.crop = "-20:0,-20:20,-20:20";
    CHECK(*summary_of(v, options).threshold.hu == whole);
    options.crop.clear();
    options.spacing = 1.5e-3;
    CHECK(*summary_of(v, options).threshold.hu == whole);
    options.spacing.reset();
    WrittenVolume numbers = v;
    for (auto& value : numbers.hu) value = static_cast<std::int16_t>(value + 1024);
    options.rescale = {1.0, -1024.0};
    CHECK(*summary_of(numbers, options).threshold.hu == whole);
}

TEST_CASE("the suggested threshold keeps the bone, whatever the crop of the file leaves around it") {
    for (const bool has_metal : {false, true})
        for (const bool has_soft_tissue : {true, false})
            for (const double half : {36.0, 32.0, 28.0, 24.0, 20.0, 17.0, 15.0, 13.0}) {
                const WrittenVolume v = limb({has_soft_tissue, has_metal, half, 15.0});
                bone::ImportOptions options;
                options.rescale = {1.0, 0.0};
                const bone::ImportSummary found = summary_of(v, options);
                CAPTURE(has_metal, has_soft_tissue, half, *found.threshold.hu, found.threshold.from);
                CHECK(found.bone_volume_mm3 == Approx(bone_mm3).epsilon(0.06));
                CHECK(*found.threshold.hu >= 100.0);
                CHECK(*found.threshold.hu < 800.0);
            }
}

TEST_CASE("a block of bone alone is taken whole: its threshold does not split cortical from cancellous bone") {
    WrittenVolume v = limb({true, false, 6.0, 6.0});
    bone::ImportOptions options;
    options.rescale = {1.0, 0.0};
    const bone::ImportSummary found = summary_of(v, options);
    CHECK(found.bone_volume_mm3 == Approx(12.0 * 12.0 * 12.0).epsilon(0.03));
    CHECK_THAT(found.threshold.from, ContainsSubstring("no soft tissue"));
}

TEST_CASE("air with lungs, and padding below air, are split off before bone") {
    for (const double lowest : {-1000.0, -3024.0}) {
        WrittenVolume v = limb({});
        for (int k = 0; k < v.size[2]; ++k)
            for (int j = 0; j < v.size[1]; ++j)
                for (int i = 0; i < v.size[0]; ++i) {
                    const Vec3 p = v.position(i, j, k);
                    auto& hu = v.hu[static_cast<std::size_t>((k * v.size[1] + j) * v.size[0] + i)];
                    if (std::hypot(p.x - 20.0, p.y) < 7.0) hu = -820;
                    if (std::hypot(p.x, p.y) > 35.0) hu = static_cast<std::int16_t>(lowest);
                }
        const bone::ImportSummary found = summary_of(v);
        CAPTURE(lowest, *found.threshold.hu);
        CHECK(found.bone_volume_mm3 == Approx(bone_mm3).epsilon(0.06));
    }
}

TEST_CASE("a scan of soft tissue gives no bone: its threshold is 300 HU, not one between fat and muscle") {
    CHECK_THROWS_WITH(summary_of(ball(60.0, -100.0, -1000.0)), ContainsSubstring("300 HU"));
    CHECK_THROWS_WITH(summary_of(ball(-1000.0, -1000.0, -1000.0)), ContainsSubstring("300 HU"));
}

TEST_CASE("a mesh whose size no bone has in mm is asked for its unit, with the units that would do") {
    CHECK_THROWS_WITH(box_summary(13.9), ContainsSubstring("13.9 units across") &&
                                             ContainsSubstring("--unit mm, cm or m (--unit cm makes it 139 mm)"));
    CHECK_THROWS_WITH(box_summary(0.139), ContainsSubstring("--unit m makes it 139 mm"));
    CHECK_THROWS_WITH(box_summary(45.0), ContainsSubstring("--unit cm makes it 450 mm"));
    CHECK_THROWS_WITH(box_summary(139000.0), ContainsSubstring("--unit"));
    bone::ImportOptions options;
    options.unit = "cm";
    CHECK(box_summary(13.9, options).bone_volume_mm3 == Approx(0.12 * std::pow(139.0, 3)).epsilon(0.02));
    options.unit = "mm";
    CHECK(box_summary(20.0, options).bone_volume_mm3 == Approx(0.12 * 8000.0).epsilon(0.1));
    CHECK(box_summary(20.0, {}, "# unit=mm\n").bone_volume_mm3 == Approx(0.12 * 8000.0).epsilon(0.1));
    CHECK(box_summary(139.0).bone_volume_mm3 == Approx(0.12 * std::pow(139.0, 3)).epsilon(0.02));
}

TEST_CASE("a scan in cm or m that states no unit is asked for it, and taken with it") {
    const TemporaryFolder folder;
    for (const auto& [unit, scale] : {std::pair<std::string, double>{"cm", 0.1}, {"m", 1e-3}}) {
        CAPTURE(unit);
        WrittenVolume v = ball(1200.0, 700.0, -1000.0);
        v.step *= scale;
        v.origin *= scale;
        bone::ImportOptions options;
        options.input = folder / "ct.nrrd";
        file::write_whole_file(options.input, without_units(nrrd_bytes(v)));
        CHECK_THROWS_WITH(bone::import_bone(options), ContainsSubstring("--unit " + unit + " makes it 60 mm"));
        options.unit = unit;
        bone::ImportSummary summary;
        bone::import_bone(options, {}, &summary);
        CHECK(summary.voxel_mm[0] == Approx(1.0));
        CHECK(summary.bone_volume_mm3 == Approx(4.0 / 3.0 * 3.14159 * std::pow(15.0, 3)).epsilon(0.05));
        file::write_whole_file(options.input, nrrd_bytes(v));
        CHECK_THROWS_WITH(bone::import_bone(options), ContainsSubstring("leave out --unit"));
    }
}

TEST_CASE("a mesh takes a density, a scan has its own") {
    bone::ImportOptions options;
    options.mesh_density = 1100.0;
    const bone::ImportSummary found = box_summary(60.0, options);
    CHECK(found.density.min == Approx(1100.0));
    CHECK(found.density.max == Approx(1100.0));
    CHECK_FALSE(found.threshold.hu);
    CHECK_THROWS_WITH(summary_of(ball(1200.0, 700.0, -1000.0), options), ContainsSubstring("--density is for meshes"));
}

TEST_CASE("a sternum whose shell leaks becomes one solid plate, with the density of its core") {
    // 12 mm thick: cortices of 2 mm at 900 HU, cancellous bone of 100 HU between them, and a hole of 2 mm. The threshold is
    // between both.
    WrittenVolume v;
    v.size = {60, 60, 40};
    v.origin = Vec3(-29.5, -29.5, -19.5);
    double core_mm3 = 0.0;
    const auto is_core = [](const Vec3& p) {
        return std::abs(p.x) < 18.0 && std::abs(p.y) < 10.0 && std::abs(p.z) < 4.0;
    };
    v.fill([&](const Vec3& p) {
        if (is_core(p)) return 100.0;
        const bool is_hole = p.z > 0.0 && std::hypot(p.x, p.y) < 1.0;
        const bool is_cortex = std::abs(p.x) < 20.0 && std::abs(p.y) < 12.0 && std::abs(p.z) < 6.0;
        if (is_cortex && !is_hole) return 900.0;
        return glm::length(p) < 28.0 ? 40.0 : -1000.0;
    });
    for (double z = -19.5; z < 20.0; z += 1.0)
        for (double y = -29.5; y < 30.0; y += 1.0)
            for (double x = -29.5; x < 30.0; x += 1.0) core_mm3 += is_core({x, y, z});
    bone::ImportOptions options;
    options.threshold = 300.0;
    const bone::ImportSummary solid = summary_of(v, options);
    options.fill = false;
    const bone::ImportSummary hollow = summary_of(v, options);
    CAPTURE(solid.marrow_mm3, solid.hollow_mm3, core_mm3, solid.bone_volume_mm3, hollow.bone_volume_mm3);
    CHECK(solid.marrow_mm3 == Approx(core_mm3).epsilon(0.02));
    CHECK(solid.hollow_mm3 == 0.0);
    CHECK(hollow.marrow_mm3 == 0.0);
    // The surface of 300 HU lies 0.2 mm outside of the middle between a voxel of cortex and one of tissue.
    CHECK(solid.bone_volume_mm3 == Approx(40.4 * 24.4 * 12.4).epsilon(0.02));
    CHECK(solid.bone_volume_mm3 - hollow.bone_volume_mm3 == Approx(35.6 * 19.6 * 7.6).epsilon(0.02));
    // 1.067 · HU + 131
    CHECK(solid.density.min == Approx(1.067 * 100.0 + 131.0).epsilon(0.1));
    CHECK(hollow.density.min > 1.067 * 200.0 + 131.0);
}
