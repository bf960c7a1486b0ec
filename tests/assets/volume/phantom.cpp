// SPDX-License-Identifier: Apache-2.0
// A CT of shapes that are known by formula: what comes back as a bone is compared with them.
#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

using namespace tactus;

namespace {

constexpr int shapes = 3;
constexpr double ball_radius = 9.0, ring_radius = 9.0, tube_radius = 4.5;  // mm
const Vec3 ball_centre(-12.0, 0.0, 0.0), ring(11.5, 0.0, 0.0), wall(0.0, 17.0, 0.0), wall_half(20.0, 1.25, 8.0);

// Signed distance to sphere, torus (axis z) and a wall of 2.5 mm, mm.
double distance_mm(const Vec3& p) {
    const Vec3 r = p - ring, w = glm::abs(p - wall) - wall_half;
    const double tube = std::hypot(std::hypot(r.x, r.y) - ring_radius, r.z) - tube_radius;
    const double slab = glm::length(glm::max(w, 0.0)) + std::min(std::max({w.x, w.y, w.z}), 0.0);
    return std::min({glm::length(p - ball_centre) - ball_radius, tube, slab});
}

// 1200 HU in air, blurred with a Gaussian of 0.4 mm, noise of 25 HU.
WrittenVolume scan(double tilt_deg) {
    WrittenVolume v;
    v.size = {146, 124, 38};
    const double lean = std::tan(tilt_deg * std::numbers::pi / 180.0) * 0.6;
    v.step = Mat3(Vec3(0.35, 0.0, 0.0), Vec3(0.0, 0.35, 0.0), Vec3(0.0, lean, 0.6));
    v.origin = Vec3(-22.5, -19.0 - 19.0 * lean, -11.2);
    const Random random{7};
    std::uint64_t n = 0;
    v.fill([&](const Vec3& p) {
        const double share = 0.5 * std::erfc(distance_mm(p) / (0.4 * std::numbers::sqrt2));
        return 2.0 * std::round(0.5 * (-1000.0 + 2200.0 * share + 25.0 * random.normal(n++)));
    });
    return v;
}

struct Found {
    bone::Bone bone;
    double volume_mm3 = 0.0, p95_mm = 0.0;
};

double exact_volume() {
    return 4.0 / 3.0 * std::numbers::pi * std::pow(ball_radius, 3) +
           2.0 * std::numbers::pi * std::numbers::pi * ring_radius * tube_radius * tube_radius +
           8.0 * wall_half.x * wall_half.y * wall_half.z;
}

Found measured(bone::Bone bone, const bone::ImportSummary& summary) {
    Found found{std::move(bone), summary.bone_volume_mm3, 0.0};
    std::vector<double> errors;
    for (const Vec3& vertex : mesh::surface_of(found.bone.distance).vertices)
        errors.push_back(std::abs(distance_mm(vertex * 1e3)));
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 95 / 100);
    std::nth_element(errors.begin(), at, errors.end());
    found.p95_mm = *at;
    return found;
}

Found import_of(const std::filesystem::path& path) {
    bone::ImportOptions options;
    options.input = path;
    options.threshold = 100.0;  // half way
    options.component = std::to_string(shapes);
    bone::ImportSummary summary;
    bone::Bone bone = bone::import_bone(options, {}, &summary);
    return measured(std::move(bone), summary);
}

}  // namespace

TEST_CASE("a CT of known shapes comes back within 0.15 voxel and 1 % of volume, the gantry level or tilted", "[slow]") {
    const double exact = exact_volume();
    for (const double tilt : {0.0, 15.0}) {
        const TemporaryFolder folder;
        const WrittenVolume v = scan(tilt);
        file::write_whole_file(folder / "ct.nrrd", nrrd_bytes(v));
        const Found nrrd = import_of(folder / "ct.nrrd");
        CAPTURE(tilt, nrrd.p95_mm, nrrd.volume_mm3, exact);
        CHECK(nrrd.p95_mm < 0.15 * 0.35);
        CHECK(nrrd.volume_mm3 == Approx(exact).epsilon(0.01));

        write_dicom_folder(v, folder / "series");
        file::write_whole_file(folder / "ct.nii", nifti_bytes(v));
        for (const char* name : {"series", "ct.nii"}) {
            const Found other = import_of(folder / name);
            CAPTURE(name);
            CHECK(other.volume_mm3 == Approx(nrrd.volume_mm3).epsilon(1e-4));
            CHECK(other.p95_mm == Approx(nrrd.p95_mm).epsilon(1e-2));
            CHECK(glm::length(other.bone.distance.origin - nrrd.bone.distance.origin) < 1e-7);
        }
    }
}

TEST_CASE(
    "the same shapes as a label map come back with its CT as well as from the CT, without it within a third of a "
    "voxel",
    "[slow]") {
    const TemporaryFolder folder;
    const WrittenVolume v = scan(0.0);
    WrittenVolume labels = v;
    labels.fill([](const Vec3& p) { return distance_mm(p) < 0.0 ? 1.0 : 0.0; });
    file::write_whole_file(folder / "ct.nrrd", nrrd_bytes(v));
    file::write_whole_file(folder / "labels.nrrd", nrrd_bytes(labels));
    const auto found = [&](const std::filesystem::path& ct) {
        bone::ImportOptions options;
        options.input = folder / "labels.nrrd";
        options.label = "all";
        options.ct = ct;
        bone::ImportedBone made = std::move(bone::import_labels(options).front());
        return measured(std::move(made.bone), made.summary);
    };
    const double exact = exact_volume();
    const Found with = found(folder / "ct.nrrd"), without = found({});
    CAPTURE(with.p95_mm, with.volume_mm3, without.p95_mm, without.volume_mm3, exact);
    CHECK(with.p95_mm < 0.15 * 0.35);
    CHECK(with.volume_mm3 == Approx(exact).epsilon(0.01));
    CHECK(without.p95_mm < 0.6 / 3.0);
    CHECK(without.volume_mm3 == Approx(exact).epsilon(0.01));
}
