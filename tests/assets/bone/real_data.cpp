// SPDX-License-Identifier: Apache-2.0
// Scans and meshes of real bones, where they are there: each must give the numbers that their publishers' files hold.
#include "assets/bone/import.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/volume/scan_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

using namespace tactus;

namespace {

// A file below the folder that TACTUS_SHARED_DATA names; none, with a message, when it is not there.
std::optional<std::filesystem::path> shared(const std::string& name) {
    const char* const folder = std::getenv("TACTUS_SHARED_DATA");
    if (folder && std::filesystem::exists(std::filesystem::path(folder) / name))
        return std::filesystem::path(folder) / name;
    tactus::test::skip("TACTUS_SHARED_DATA does not name a folder with " + name);
    return {};
}

struct Threshold {
    float hu;
    long voxels;  // that reach it
};

struct Scan {
    std::string file;
    std::array<int, 3> size;
    Vec3 spacing_mm;
    float low, high;
    volume::HuKind hu;
    std::vector<Threshold> thresholds;
};

const std::vector<Scan> scans{
    {"ct/head_phantom.nrrd",
     {192, 216, 113},
     {0.9766, 0.9766, 2.0},
     -1024,
     2970,
     volume::HuKind::calibrated,
     {{300, 349839}, {700, 125688}}},
    {"ct/headsq_quarter.nrrd", {64, 64, 93}, {3.2, 3.2, 1.5}, 0, 3926, volume::HuKind::scanner, {}},
    {"ct/skull_sawn_calotte.nrrd",
     {160, 214, 136},
     {0.90234, 0.90234, 1.0},
     -1024,
     1022,
     volume::HuKind::calibrated,
     {{300, 476522}, {700, 334896}}},
    {"ct/skull_saw_kerf_block.nrrd",
     {84, 240, 60},
     {0.45117, 0.45117, 1.0},
     -1024,
     1024,
     volume::HuKind::calibrated,
     {}},
    {"fragments/hip003_ct.nrrd", {176, 156, 237}, {0.9707, 0.9707, 1.0}, -69, 1439, volume::HuKind::masked, {}},
    {"fragments/hip003_intact_side_ct.nrrd",
     {146, 169, 240},
     {0.9707, 0.9707, 1.0},
     -63,
     1373,
     volume::HuKind::masked,
     {}},
};

struct Surface {
    std::string file;
    Vec3 extent_mm;     // 0 where none is stated
    double volume_mm3;  // 0 where none is stated
    std::size_t points, triangles, boundary_edges, components;
};

const std::vector<Surface> surfaces{
    {"fragments/hip003_frag1.stl", {130, 143, 221}, 0.0, 0, 20000, 0, 1},
    {"fragments/hip003_frag2.stl", {85, 63, 64}, 0.0, 0, 20000, 0, 1},
    // Stated as about 100 x 121 x 110 mm; in the file 99.6 x 122.1 x 111.1.
    {"fragments/hemipelvis_displaced.ply", {99.6, 122.1, 111.1}, 0.0, 32879, 65497, 289, 1},
    {"fragments/hemipelvis_reference.ply", {0, 0, 0}, 0.0, 32308, 64612, 0, 1},
    {"mesh/mandible.stl", {117.7, 87.2, 76.9}, 57600.0, 20882, 41760, 0, 1},
    {"mesh/mandible_resected.stl", {0, 0, 0}, 0.0, 14852, 29700, 0, 1},
    {"mesh/mandible_resected_with_graft.ply", {0, 0, 0}, 0.0, 22376, 44766, 23, 2},
    {"mesh/fibula_left_vhf.stl", {0, 0, 329.2}, 31700.0, 9461, 18918, 0, 1},
};

Vec3 extent_mm(const geometry::TriangleSurface& surface) {
    Vec3 low = surface.vertices.front(), high = low;
    for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    return (high - low) * 1e3;
}

// Stated to whole millimetres at the worst.
void check_extent(const Vec3& found, const Vec3& stated) {
    for (int a = 0; a < 3; ++a)
        if (stated[a] > 0.0) CHECK(found[a] == Approx(stated[a]).epsilon(0.01).margin(0.5));
}

}  // namespace

TEST_CASE("published scans have the size, spacing, range and voxels of bone that are stated with them") {
    for (const Scan& scan : scans) {
        const auto path = shared(scan.file);
        if (!path) continue;
        CAPTURE(scan.file);
        const volume::ScanVolume volume = volume::read_volume(*path);
        CHECK(volume.size == scan.size);
        for (int a = 0; a < 3; ++a) CHECK(volume.spacing()[a] * 1e3 == Approx(scan.spacing_mm[a]).epsilon(1e-4));
        const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
        CHECK(*low == scan.low);
        CHECK(*high == scan.high);
        CHECK(volume.hu == scan.hu);
        for (const Threshold& t : scan.thresholds)
            CHECK(std::count_if(volume.values.begin(), volume.values.end(), [&](float v) { return v >= t.hu; }) ==
                  t.voxels);
    }
}

TEST_CASE("the sawn skull has the volume of its voxels at half height, and less at 300 HU, where edges are steep") {
    const auto path = shared("ct/skull_sawn_calotte.nrrd");
    if (!path) return;
    // Air and cast meet in less than a voxel: only half way between their values does the surface between two samples lie,
    // on the mean, where counting voxels puts it. At 300 of -1000 to 760 HU it lies farther in.
    const auto share = [&](double threshold) {
        bone::ImportOptions options;
        options.input = *path;
        options.component = "all";
        options.threshold = threshold;
        bone::ImportSummary summary;
        bone::import_bone(options, {}, &summary);
        const volume::ScanVolume volume = volume::read_volume(*path);
        const auto voxels =
            std::count_if(volume.values.begin(), volume.values.end(), [&](float v) { return double(v) >= threshold; });
        const Vec3 h = volume.spacing() * 1e3;
        return summary.bone_volume_mm3 / (double(voxels) * h.x * h.y * h.z);
    };
    CHECK(share(-120.0) == Approx(1.0).margin(0.01));
    CHECK(share(300.0) == Approx(0.979).margin(0.005));
}

TEST_CASE("the fragments of a fractured hip have the voxels and, as bones, the volumes that are stated") {
    const auto path = shared("fragments/hip003_labels.nrrd");
    if (!path) return;
    const volume::ScanVolume map = volume::read_volume(*path);
    CHECK(map.kind == volume::VolumeKind::labels);
    CHECK(std::count(map.values.begin(), map.values.end(), 1.0f) == 338273);
    CHECK(std::count(map.values.begin(), map.values.end(), 2.0f) == 47694);
    bone::ImportOptions options;
    options.input = *path;
    options.label = "all";
    const std::vector<bone::ImportedBone> bones = bone::import_labels(options);
    REQUIRE(bones.size() == 2);
    CHECK(bones[0].summary.bone_volume_mm3 == Approx(318700.0).epsilon(0.01));
    CHECK(bones[1].summary.bone_volume_mm3 == Approx(44900.0).epsilon(0.01));
    check_extent(extent_mm(mesh::surface_of(bones[0].bone.distance)), {130, 143, 221});
}

TEST_CASE("published meshes become bones of the extent and volume that are stated with them") {
    for (const Surface& stated : surfaces) {
        const auto path = shared(stated.file);
        if (!path) continue;
        CAPTURE(stated.file);
        const mesh::Mesh mesh = mesh::load_mesh(*path, 1e-3);
        if (stated.points > 0) CHECK(mesh.vertices.size() == stated.points);
        CHECK(mesh.triangles.size() == stated.triangles);
        const mesh::MeshTopology topology = mesh::topology_of(mesh);
        CHECK(topology.boundary_edges == stated.boundary_edges);
        CHECK(topology.components == stated.components);
        check_extent(extent_mm(mesh), stated.extent_mm);
        bone::ImportOptions options;
        options.input = *path;
        options.component = "all";
        options.spacing = 0.8e-3;
        bone::ImportSummary summary;
        const bone::Bone bone = bone::import_bone(options, {}, &summary);
        const double volume = stated.volume_mm3 > 0.0      ? stated.volume_mm3
                              : stated.boundary_edges == 0 ? std::abs(mesh::volume_of(mesh)) * 1e9
                                                           : summary.bone_volume_mm3;
        CHECK(summary.bone_volume_mm3 == Approx(volume).epsilon(0.01));
        check_extent(extent_mm(mesh::surface_of(bone.distance)), extent_mm(mesh));
    }
}

TEST_CASE("the InVesalius example is a scan of the stated shape, low slices first, rows from back to front") {
    const std::filesystem::path path = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";
    if (!std::filesystem::exists(path)) {
        tactus::test::skip("the Debian package invesalius-examples is not installed");
        return;
    }
    const volume::ScanVolume volume = volume::read_volume(path);
    CHECK(volume.size == std::array<int, 3>{256, 256, 108});
    CHECK(volume.spacing().x * 1e3 == Approx(0.957031));
    CHECK(volume.spacing().z * 1e3 == Approx(1.5));
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    CHECK(*low == -1024.0f);
    CHECK(*high == 2986.0f);
    CHECK(volume.hu == volume::HuKind::calibrated);
    CHECK(volume.map.step[1].y < 0.0);
    CHECK(std::any_of(volume.notes.begin(), volume.notes.end(), [](const std::string& note) {
        return note.find("2 masks and 2 surfaces") != std::string::npos;
    }));
}
