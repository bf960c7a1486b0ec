// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/export.hpp"

#include "assets/bone/from_hu.hpp"
#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/volume/surface_distance.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <zlib.h>

#include <fmt/format.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numbers>
#include <sstream>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

const Vec3 far_off(1.0, -0.9, 1.1);

// A ball of 8 mm whose upper part a saw has taken away at z = 3 mm above its middle.
bone::Bone cut_ball() {
    volume::Grid hu{{44, 42, 40}, {}, Vec3(0.5 * mm, 0.5 * mm, 0.6 * mm), {}};
    hu.origin = far_off - 0.5 * Vec3(43, 41, 39) * hu.spacing;
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 42; ++j)
            for (int i = 0; i < 44; ++i)
                hu.values.push_back(static_cast<float>(std::clamp(
                    300.0 - 1.5e6 * (glm::length(hu.position(i, j, k) - far_off) - 8.0 * mm), -1000.0, 1300.0)));
    bone::Bone bone = bone::bone_from_hu(hu, {300.0f, 1, true}).bone;
    bone.name = "ball";
    for (int k = 0; k < bone.distance.size[2]; ++k)
        for (int j = 0; j < bone.distance.size[1]; ++j)
            for (int i = 0; i < bone.distance.size[0]; ++i) {
                float& d = bone.distance.at(i, j, k);
                d = std::max(d, static_cast<float>(bone.distance.position(i, j, k).z - far_off.z - 3.0 * mm));
            }
    return bone;
}

const double cut_volume = std::numbers::pi * (2.0 / 3.0 * 512.0 + 64.0 * 3.0 - 9.0);  // mm³

}  // namespace

TEST_CASE("an exported surface read by assimp is closed, in LPS mm, of the bone's volume, 1 m from the origin") {
    const TemporaryFolder folder;
    const bone::Bone bone = cut_ball();
    const geometry::TriangleSurface surface = mesh::export_surface(bone.distance);
    CHECK(mesh::topology_of(surface).is_watertight());
    CHECK(mesh::volume_of(surface) * 1e9 == Approx(cut_volume).epsilon(0.01));
    for (const char* name : {"ball.stl", "ball.ply"}) {
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{surface, Vec3(1, 0, 0)}}, folder / name);
        const std::string bytes = file::read_whole_file(folder / name);
        CHECK_THAT(bytes.substr(0, 300), ContainsSubstring("SPACE=LPS"));
        const mesh::Mesh back = mesh::load_mesh(folder / name, mm);
        CHECK(mesh::topology_of(back).is_watertight());
        CHECK(back.triangles.size() == surface.triangles.size());
        CHECK(mesh::volume_of(back) == Approx(mesh::volume_of(surface)).epsilon(1e-4));
        double worst = 0.0;
        for (const Vec3& v : back.vertices) {
            const double z = v.z - far_off.z;
            const double ball = glm::length(v - far_off) - 8.0 * mm;
            if (z < 2.0 * mm) worst = std::max(worst, std::abs(ball));
        }
        // A few micrometres of interpolation; single precision at 1 m is 0.06 of one.
        CHECK(worst < 0.03 * 0.5 * mm);
    }
}

TEST_CASE("several bones go into one mesh file, and what cannot be written is refused") {
    const TemporaryFolder folder;
    const bone::Bone bone = cut_ball();
    const geometry::TriangleSurface surface = mesh::export_surface(bone.distance);
    geometry::TriangleSurface moved = surface;
    for (Vec3& v : moved.vertices) v.x += 0.1;
    mesh::write_mesh(std::vector<mesh::ColouredSurface>{{surface, {}}, {moved, {}}}, folder / "two.ply");
    CHECK(mesh::topology_of(mesh::load_mesh(folder / "two.ply")).components == 2);
    CHECK_THROWS_WITH(mesh::write_mesh(std::vector<mesh::ColouredSurface>{{surface, {}}}, folder / "ball.obj"),
                      ContainsSubstring(".stl, .ply or .3mf"));
    CHECK_THROWS_WITH(mesh::write_mesh({}, folder / "none.stl"), ContainsSubstring("no triangles"));
    CHECK_THROWS_AS(mesh::write_mesh(std::vector<mesh::ColouredSurface>{{surface, {}}}, folder / "absent" / "ball.stl"),
                    Error);
    CHECK_FALSE(std::filesystem::exists(folder / "none.stl"));
}

TEST_CASE("an exported NRRD has the bone's place, and its threshold gives the cut bone again") {
    const TemporaryFolder folder;
    const bone::Bone bone = cut_ball();
    const volume::Grid hu = bone::volume_of_bones({&bone, 1}, bone::BoneQuantity::hu);
    volume::write_volume(hu, volume::WrittenType::int16, folder / "ball.nrrd");
    // The definition of the format, without the reader: lines of the header, an empty line, gzip.
    const std::string bytes = file::read_whole_file(folder / "ball.nrrd");
    const std::string header = bytes.substr(0, bytes.find("\n\n") + 1);
    const auto field = [&](const std::string& name) {
        const std::size_t at = header.find("\n" + name + ": ");
        REQUIRE(at != std::string::npos);
        return header.substr(at + name.size() + 3, header.find('\n', at + 1) - at - name.size() - 3);
    };
    CHECK(field("type") == "short");
    CHECK(field("space") == "left-posterior-superior");
    CHECK(field("sizes") == fmt::format("{} {} {}", hu.size[0], hu.size[1], hu.size[2]));
    volume::Grid back = hu;
    Vec3 x, y, z;
    REQUIRE(std::sscanf(field("space directions").c_str(), "(%lf,0,0) (0,%lf,0) (0,0,%lf)", &x.x, &y.y, &z.z) == 3);
    back.spacing = Vec3(x.x, y.y, z.z) * mm;
    REQUIRE(std::sscanf(field("space origin").c_str(), "(%lf,%lf,%lf)", &back.origin.x, &back.origin.y,
                        &back.origin.z) == 3);
    back.origin *= mm;
    CHECK(glm::length(back.origin - hu.origin) < 1e-12);
    CHECK(glm::length(back.spacing - hu.spacing) < 1e-12);
    CHECK(field("encoding") == "gzip");
    CHECK(field("endian") == "little");
    file::write_whole_file(folder / "samples.gz", std::string_view(bytes).substr(header.size() + 1));
    std::vector<std::int16_t> samples(hu.count());
    gzFile packed = gzopen((folder / "samples.gz").c_str(), "rb");
    REQUIRE(packed != nullptr);
    const int size = static_cast<int>(2 * samples.size());
    REQUIRE(gzread(packed, samples.data(), static_cast<unsigned>(size)) == size);
    gzclose(packed);
    std::ranges::copy(samples, back.values.begin());
    const bone::Bone again = bone::bone_from_hu(back, {300.0f, 1, true}).bone;
    CHECK(mesh::volume_of(mesh::surface_of(again.distance)) * 1e9 == Approx(cut_volume).epsilon(0.02));
    std::vector<double> off;
    for (const Vec3& v : mesh::surface_of(again.distance).vertices)
        off.push_back(std::abs(std::max(glm::length(v - far_off) - 8.0 * mm, v.z - far_off.z - 3.0 * mm)));
    std::sort(off.begin(), off.end());
    CHECK(off[off.size() * 95 / 100] < 0.15 * 0.5 * mm);
}

TEST_CASE("export and import give the same bone: each format, voxel size, density and threshold") {
    const TemporaryFolder folder;
    // A shell of cortical bone around cancellous bone, in muscle or in air.
    for (const Vec3& voxel : {Vec3(0.4), Vec3(1.0), Vec3(0.8, 0.8, 1.6)})
        for (const double threshold : {150.0, 300.0, 620.0})
            for (const double cortex : {700.0, 1600.0})
                for (const double around : {50.0, -1000.0}) {
                    // Less than a fifth of the contrast: the surface lies in the middle of the shell.
                    if (threshold > 600.0 && cortex < 1000.0) continue;
                    volume::Grid hu{{}, {}, voxel * mm, {}};
                    for (std::size_t a = 0; a < 3; ++a)
                        hu.size[a] = static_cast<int>(34.0 / voxel[static_cast<int>(a)]) + 1;
                    hu.origin = -0.5 * Vec3(hu.size[0] - 1, hu.size[1] - 1, hu.size[2] - 1) * hu.spacing;
                    for (int k = 0; k < hu.size[2]; ++k)
                        for (int j = 0; j < hu.size[1]; ++j)
                            for (int i = 0; i < hu.size[0]; ++i) {
                                const Vec3 p = hu.position(i, j, k) / mm;
                                const double r = glm::length(p);
                                const auto part = [r](double radius) {
                                    return std::clamp((radius - r) / 1.5 + 0.5, 0.0, 1.0);
                                };
                                double value = around + part(13.0) * (cortex - around);
                                value += part(9.0) * (180.0 - value);
                                hu.values.push_back(static_cast<float>(value));
                            }
                    const bone::Bone bone = bone::bone_from_hu(hu, {static_cast<float>(threshold), 1, true}).bone;
                    const double before = mesh::volume_of(mesh::surface_of(bone.distance));
                    for (const char* name : {"bone.nrrd", "bone.nii", "bone.nii.gz"}) {
                        volume::write_volume(bone::volume_of_bones({&bone, 1}, bone::BoneQuantity::hu),
                                             volume::WrittenType::int16, folder / name, bone::surface_hu({&bone, 1}));
                        bone::ImportOptions options;
                        options.input = folder / name;
                        bone::ImportSummary found;
                        const bone::Bone again = bone::import_bone(options, {}, &found);
                        CAPTURE(voxel.x, voxel.z, threshold, cortex, around, name);
                        CHECK(*found.threshold.hu == threshold);
                        CHECK_THAT(found.threshold.from, ContainsSubstring("exported bone"));
                        CHECK(mesh::volume_of(mesh::surface_of(again.distance)) == Approx(before).epsilon(0.02));
                    }
                }
}

TEST_CASE("the stated surface of an exported bone does not apply to values that are rescaled") {
    const TemporaryFolder folder;
    const bone::Bone bone = cut_ball();
    volume::Grid hu = bone::volume_of_bones({&bone, 1}, bone::BoneQuantity::hu);
    volume::write_volume(hu, volume::WrittenType::int16, folder / "ball.nrrd", bone::surface_hu({&bone, 1}));
    bone::ImportOptions options;
    options.input = folder / "ball.nrrd";
    options.rescale = {1.1, 0.0};
    bone::ImportSummary found;
    bone::import_bone(options, {}, &found);
    CHECK_THAT(found.threshold.from, !ContainsSubstring("exported bone"));
}

TEST_CASE("an exported NIfTI holds the same samples with the axes of RAS in its header") {
    const TemporaryFolder folder;
    const bone::Bone bone = cut_ball();
    const volume::Grid distance = bone::volume_of_bones({&bone, 1}, bone::BoneQuantity::distance);
    volume::write_volume(distance, volume::WrittenType::float32, folder / "ball.nii.gz");
    volume::write_volume(distance, volume::WrittenType::float32, folder / "ball.nii");
    const std::string plain = file::read_whole_file(folder / "ball.nii");
    // zlib itself is the independent reader of the compression.
    std::string bytes(plain.size() + 1, '\0');
    gzFile file = gzopen((folder / "ball.nii.gz").c_str(), "rb");
    REQUIRE(file != nullptr);
    const int read = gzread(file, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(file);
    REQUIRE(read == static_cast<int>(plain.size()));
    bytes.pop_back();
    CHECK(bytes == plain);
    const auto number = [&plain](std::size_t at, auto kind) {
        std::memcpy(&kind, plain.data() + at, sizeof kind);
        return kind;
    };
    CHECK(number(0, std::int32_t{}) == 348);
    CHECK(plain.substr(344, 4) == std::string("n+1\0", 4));
    CHECK(number(70, std::int16_t{}) == 16);
    for (std::size_t a = 0; a < 3; ++a) CHECK(number(42 + 2 * a, std::int16_t{}) == distance.size[a]);
    const auto start = static_cast<std::size_t>(number(108, float{}));
    REQUIRE(plain.size() == start + distance.count() * 4);
    CHECK(std::memcmp(plain.data() + start, distance.values.data(), distance.count() * 4) == 0);
    // Where the header puts sample (1, 2, 3): RAS is LPS with x and y turned round.
    const Vec3 at = distance.position(1, 2, 3) / mm, wanted(-at.x, -at.y, at.z);
    for (int row = 0; row < 3; ++row) {
        double place = 0.0;
        const double index[4] = {1, 2, 3, 1};
        for (std::size_t c = 0; c < 4; ++c)
            place += index[c] * double(number(280 + 16 * std::size_t(row) + 4 * c, float{}));
        CHECK(place == Approx(wanted[row]).epsilon(1e-6));
    }
}

TEST_CASE("an exported NIfTI read by nibabel has the samples and their places") {
    if (std::system("/usr/bin/python3 -c 'import nibabel' >/dev/null 2>&1") != 0) {
        tactus::test::skip("there is no nibabel (package python3-nibabel)");
        return;
    }
    const TemporaryFolder folder;
    const bone::Bone bone = cut_ball();
    const volume::Grid distance = bone::volume_of_bones({&bone, 1}, bone::BoneQuantity::distance);
    volume::write_volume(distance, volume::WrittenType::float32, folder / "ball.nii.gz");
    const std::string command =
        "/usr/bin/python3 -c 'import nibabel; v = nibabel.load(\"" + (folder / "ball.nii.gz").string() +
        "\"); d = v.get_fdata(); p = v.affine @ [3, 5, 7, 1]; print(*d.shape, *p[:3], d[3, 5, 7], d.sum())' >" +
        (folder / "said.txt").string();
    REQUIRE(std::system(command.c_str()) == 0);
    std::array<double, 8> said{};
    std::istringstream text(file::read_whole_file(folder / "said.txt"));
    for (double& number : said) REQUIRE(text >> number);
    for (std::size_t a = 0; a < 3; ++a) CHECK(said[a] == distance.size[a]);
    const Vec3 at = distance.position(3, 5, 7) / mm;
    CHECK(said[3] == Approx(-at.x).epsilon(1e-6));
    CHECK(said[4] == Approx(-at.y).epsilon(1e-6));
    CHECK(said[5] == Approx(at.z).epsilon(1e-6));
    CHECK(said[6] == Approx(double(distance.at(3, 5, 7))).epsilon(1e-6));
    double sum = 0.0;
    for (const float value : distance.values) sum += double(value);
    CHECK(said[7] == Approx(sum).epsilon(1e-6));
}

TEST_CASE("bones on one lattice become one volume, others are asked for one by one") {
    std::vector<bone::Bone> bones(2, cut_ball());
    bones[1].distance.origin.x += 10.0 * bones[1].distance.spacing.x;
    bones[1].density.origin = bones[1].distance.origin;
    const volume::Grid both = bone::volume_of_bones(bones, bone::BoneQuantity::density);
    CHECK(both.size[0] == bones[0].distance.size[0] + 10);
    const volume::Grid distance = bone::volume_of_bones(bones, bone::BoneQuantity::distance);
    CHECK(*std::min_element(distance.values.begin(), distance.values.end()) > -9.0f);
    CHECK(*std::max_element(distance.values.begin(), distance.values.end()) <= 1000.0f);
    bones[1].distance.origin.x += 0.4 * bones[1].distance.spacing.x;
    CHECK_THROWS_WITH(bone::volume_of_bones(bones, bone::BoneQuantity::hu), ContainsSubstring("--bone"));
    CHECK_THROWS_WITH(bone::volume_of_bones({}, bone::BoneQuantity::hu), ContainsSubstring("no bone"));
    const TemporaryFolder folder;
    CHECK_THROWS_WITH(volume::write_volume(both, volume::WrittenType::int16, folder / "ball.mha"),
                      ContainsSubstring(".nrrd"));
}
