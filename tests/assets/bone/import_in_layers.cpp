// SPDX-License-Identifier: Apache-2.0
// A CT is never in memory as a whole; what comes out must not show it.
#include "assets/bone/bone.hpp"
#include "assets/bone/import.hpp"
#include "assets/bone/sparse_bone.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/reoriented_volume.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"

#include <zlib.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <thread>

using namespace tactus;

namespace {

// A bent tube with a closed hollow and a pebble beside it, noise; 40 x 36 x 90
// samples.
WrittenVolume scan(const Vec3& voxel_mm) {
    WrittenVolume v;
    v.size = {40, 36, 90};
    v.step = Mat3(Vec3(voxel_mm.x, 0, 0), Vec3(0, voxel_mm.y, 0), Vec3(0, 0, voxel_mm.z));
    v.origin = {-10.0, 40.0, -300.0};
    const Random random{3};
    std::uint64_t n = 0;
    v.fill([&](const Vec3& p) {
        const Vec3 u = (p - v.origin) / voxel_mm;
        const double bend = 18.0 + 5.0 * std::sin(u.z / 20.0);
        const double tube = 11.0 - std::hypot(u.x - bend, u.y - 17.0);
        const double hollow = glm::length((u - Vec3(bend, 17.0, 45.0)) * Vec3(1.0, 1.0, 0.3)) - 7.0;
        const double ends = std::min(u.z - 6.0, 80.0 - u.z);
        const double pebble = 3.5 - glm::length(u - Vec3(35.0, 31.0, 40.0));
        const double inside = std::max(std::min({tube, hollow, ends}), pebble);
        return 2.0 *
               std::round(0.5 * (std::clamp(300.0 + 700.0 * inside, -1000.0, 1400.0) + 30.0 * random.normal(n++)));
    });
    return v;
}

RunJobs on_three_threads() {
    return [](int count, const std::function<void(int)>& job) {
        std::vector<std::thread> all;
        for (int t = 0; t < 3; ++t)
            all.emplace_back([&job, count, t] {
                for (int n = t; n < count; n += 3) job(n);
            });
        for (std::thread& thread : all) thread.join();
    };
}

void check_same(const bone::Bone& a, const bone::Bone& b) {
    CHECK(a.distance.size == b.distance.size);
  // Not as vectors: a failure would print millions of numbers.
    const bool same_distance = a.distance.values == b.distance.values,
               same_density = a.density.values == b.density.values;
    CHECK(same_distance);
    CHECK(same_density);
}

std::string packed(const std::string& bytes, const std::filesystem::path& through) {
    const gzFile file = gzopen(through.c_str(), "wb");
    gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(file);
    return file::read_whole_file(through);
}

/// Imports a CT of such voxels in one piece and in slabs of some layers; `changed`: cropped, with other voxels.
void check_layers(const Vec3& voxel, bool changed, std::initializer_list<int> slabs) {
    const TemporaryFolder folder;
    file::write_whole_file(folder / "ct.nrrd", nrrd_bytes(scan(voxel)));
    bone::ImportOptions options;
    options.input = folder / "ct.nrrd";
    if (changed) {
        options.spacing = 0.7e-3 * voxel.z;
        options.crop = "-1000:1000,-1000:1000,-299:-200";
        options.component = "all";
    }
    options.layers_at_once = 10000;
    bone::ImportSummary all;
    const bone::Bone whole = bone::import_bone(options, {}, &all);
    CHECK(all.components == 2);
    for (const int layers : slabs) {
        CAPTURE(voxel.z, changed, layers);
        options.layers_at_once = layers;
        options.run = layers == 8 ? on_three_threads() : run_in_turn;
        bone::ImportSummary part;
        check_same(bone::import_bone(options, {}, &part), whole);
        CHECK(part.bone_volume_mm3 == all.bone_volume_mm3);
        CHECK(part.density.mean == all.density.mean);
    }
}

}  // namespace

// Smoothed three times, once, not at all.
TEST_CASE("a CT gives the same bone to the bit however many of its layers are worked on at one time, on any threads",
          "[slow]") {
    check_layers(Vec3(0.45, 0.45, 0.5), false, {8});
    check_layers(Vec3(0.8, 0.8, 1.0), true, {1, 0});
}

TEST_CASE("a CT of any voxels gives the same bone to the bit in layers of any number", "[long]") {
    for (const Vec3 voxel : {Vec3(0.25), Vec3(0.45, 0.45, 0.5), Vec3(0.8, 0.8, 1.0)})
        for (const bool changed : {false, true}) check_layers(voxel, changed, {1, 8, 40, 0});
}

TEST_CASE(
    "layers of a packed, mirrored, permuted, tilted or turned file are "
    "those of the whole, in any order",
    "[slow]") {
    const TemporaryFolder folder;
    const WrittenVolume plain = scan(Vec3(0.45, 0.45, 0.5));
    const auto with = [&](const Mat3& step) {
        WrittenVolume v = plain;
        v.step = step;
        return v;
    };
    const WrittenVolume volumes[] = {plain, with(Mat3(Vec3(-0.45, 0, 0), Vec3(0, 0.45, 0), Vec3(0, 0, -0.5))),
                                     with(Mat3(Vec3(0, 0.45, 0), Vec3(0, 0, -0.45), Vec3(0.5, 0, 0))),
                                     with(Mat3(Vec3(0.45, 0, 0), Vec3(0, 0.45, 0), Vec3(0, 0.15, 0.5))),
                                     with(Mat3(Vec3(0.4, 0.2, 0), Vec3(-0.2, 0.4, 0.1), Vec3(0.05, -0.1, -0.5)))};
    for (const WrittenVolume& v : volumes) {
        const std::string bytes = nrrd_bytes(v);
        const std::size_t end = bytes.find("\n\n") + 2;
        std::string header = bytes.substr(0, end);
        header.replace(header.find("encoding: raw"), 13, "encoding: gzip");
        file::write_whole_file(folder / "packed.nrrd", header + packed(bytes.substr(end), folder / "samples.gz"));
        file::write_whole_file(folder / "plain.nrrd", bytes);
        const volume::Grid whole = volume::lps_grid(volume::read_volume(folder / "plain.nrrd"));
        for (const char* name : {"plain.nrrd", "packed.nrrd"}) {
            const auto reader = volume::open_volume(folder / name);
            volume::ReorientedVolume layers(*reader, on_three_threads());
            layers.settle();
            REQUIRE(layers.layout().size == whole.size);
            for (const int first : {0, 3, 20, 5, whole.size[2] - 4}) {
                CAPTURE(name, first, v.step[2].z);
                const volume::Grid part = layers.layers(first, 4);
                const auto from = whole.values.begin() + static_cast<std::ptrdiff_t>(whole.index(0, 0, first));
                CHECK(std::equal(part.values.begin(), part.values.end(), from));
            }
            CHECK(layers.tally().count == v.hu.size());
        }
    }
}

TEST_CASE(
    "a bone file that is written from a CT holds what is near the bone, "
    "and is read back as the import gives it") {
    const TemporaryFolder folder;
    file::write_whole_file(folder / "ct.nrrd", nrrd_bytes(scan(Vec3(0.45, 0.45, 0.5))));
    bone::ImportOptions options;
    options.input = folder / "ct.nrrd";
    options.pointshell = 1e-3;
    const bone::ImportSummary summary = bone::import_bone_file(options, folder / "bone.vdb");
    const bone::Bone bone = bone::import_bone(options), read = bone::load_bone(folder / "bone.vdb");
    check_same(read, bone);
    CHECK(read.provenance == bone.provenance);
    CHECK(read.points.size() == summary.points);
    CHECK(read.name == "ct");
    bone::import_bone_file(options, folder / "again.vdb");
    CHECK(file::read_whole_file(folder / "bone.vdb") == file::read_whole_file(folder / "again.vdb"));
  // Nothing is farther than 5 mm away; what is not stored is so far.
    CHECK(*std::max_element(bone.distance.values.begin(), bone.distance.values.end()) == 5e-3f);
}

TEST_CASE(
    "an import that would lose its source, or could not be written, is "
    "refused before it begins") {
    const TemporaryFolder folder;
    const std::string bytes = nrrd_bytes(scan(Vec3(0.8)));
    file::write_whole_file(folder / "ct.nrrd", bytes);
    bone::ImportOptions options;
    options.input = folder / "ct.nrrd";
    bool began = false;
    const bone::ImportProgress progress = [&began](double, std::string_view) { began = true; };
    using Catch::Matchers::ContainsSubstring;
    std::filesystem::create_symlink(folder / "ct.nrrd", folder / "same.vdb");
    for (const char* out : {"ct.nrrd", "./ct.nrrd", "same.vdb"})
        CHECK_THROWS_WITH(bone::import_bone_file(options, folder / out, progress),
                          ContainsSubstring("the bone would overwrite it"));
    CHECK_THROWS_WITH(bone::import_bone_file(options, folder / "none/bone.vdb", progress),
                      ContainsSubstring("there is no folder"));
    CHECK_THROWS_WITH(bone::import_bone_file(options, folder.path, progress), ContainsSubstring("is a folder"));
    CHECK_FALSE(began);
    CHECK(file::read_whole_file(folder / "ct.nrrd") == bytes);
}
