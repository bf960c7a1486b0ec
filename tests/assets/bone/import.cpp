// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/import.hpp"

#include "assets/bone/from_hu.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

const std::string lps =
    "space: left-posterior-superior\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\n"
    "space origin: (-10,-10,-10)\n";

struct Ct {
    std::array<int, 3> size{41, 41, 41};
    std::string geometry = lps;
    std::string type = "short";
    std::string endian = "little";
    // HU at a position in file axes counted in samples.
    std::function<double(const Vec3&)> hu = [](const Vec3& u) {
        return std::min(1500.0, std::max(-1000.0, 300.0 + 1300.0 * (12.0 - glm::length(u - Vec3(20.0)))));
    };
};

template <typename T>
void append(std::string& bytes, double value, bool swap) {
    const T number = static_cast<T>(value);
    char raw[sizeof(T)];
    std::memcpy(raw, &number, sizeof(T));
    for (std::size_t n = 0; n < sizeof(T); ++n) bytes += raw[swap ? sizeof(T) - 1 - n : n];
}

std::string header_of(const Ct& ct) {
    return fmt::format("NRRD0005\ntype: {}\ndimension: 3\nsizes: {} {} {}\n{}endian: {}\nencoding: raw\n", ct.type,
                       ct.size[0], ct.size[1], ct.size[2], ct.geometry, ct.endian);
}

std::string samples_of(const Ct& ct) {
    std::string bytes;
    for (int k = 0; k < ct.size[2]; ++k)
        for (int j = 0; j < ct.size[1]; ++j)
            for (int i = 0; i < ct.size[0]; ++i) {
                const double value = ct.hu(Vec3(i, j, k));
                const bool swap = ct.endian == "big";
                if (ct.type == "short") append<std::int16_t>(bytes, value, swap);
                if (ct.type == "ushort") append<std::uint16_t>(bytes, value, swap);
                if (ct.type == "float") append<float>(bytes, value, swap);
                if (ct.type == "double") append<double>(bytes, value, swap);
            }
    return bytes;
}

struct Imported {
    bone::Bone bone;
    bone::ImportSummary summary;
};

Imported import_of(const Ct& ct, bone::ImportOptions options = {}) {
    const TemporaryFolder folder;
    options.input = folder / "ct.nrrd";
    // The volumes are smaller than a scan, and their shapes are defined by 300 HU.
    if (!options.unit) options.unit = "mm";
    if (!options.threshold) options.threshold = 300.0;
    file::write_whole_file(options.input, header_of(ct) + "\n" + samples_of(ct));
    Imported result;
    result.bone = bone::import_bone(options, {}, &result.summary);
    return result;
}

// Where a bone's inside has its middle, m.
Vec3 middle_of(const bone::Bone& bone) {
    Vec3 sum(0.0);
    double count = 0.0;
    for (int k = 0; k < bone.distance.size[2]; ++k)
        for (int j = 0; j < bone.distance.size[1]; ++j)
            for (int i = 0; i < bone.distance.size[0]; ++i)
                if (bone.distance.at(i, j, k) < 0.0f) sum += bone.distance.position(i, j, k), count += 1.0;
    return sum / count;
}

Ct corner_ball() {
    Ct ct;
    ct.hu = [](const Vec3& u) { return glm::length(u - Vec3(10.0, 20.0, 28.0)) < 8.0 ? 1200.0 : -1000.0; };
    return ct;
}

bool is_at(const Vec3& found, const Vec3& wanted_mm) { return glm::length(found - wanted_mm * 1e-3) < 2e-5; }

// A cube of 20 mm at (5, 0, 0), its twelve triangles counter-clockwise from outside.
std::string cube_stl(double size = 20.0, int triangles = 12) {
    const int index[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                              {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    std::string text = "solid cube\n";
    for (int t = 0; t < triangles; ++t) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const int c : index[t])
            text +=
                fmt::format("vertex {} {} {}\n", (c & 1 ? size : 0.0) + 5.0, c & 2 ? size : 0.0, c & 4 ? size : 0.0);
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid cube\n";
}

Imported import_mesh_text(const std::string& text, const std::string& name, bone::ImportOptions options = {}) {
    const TemporaryFolder folder;
    options.input = folder / name;
    file::write_whole_file(options.input, text);
    Imported result;
    result.bone = bone::import_bone(options, {}, &result.summary);
    return result;
}

bone::ImportOptions in_mm() {
    bone::ImportOptions options;
    options.unit = "mm";
    return options;
}

}  // namespace

TEST_CASE("a CT sphere becomes a bone of its volume, area and density") {
    const Imported ball = import_of(Ct{});
    const double radius = 6.0;
    CHECK(ball.summary.frame == "LPS");
    CHECK(ball.summary.hu == "calibrated");
    CHECK(ball.summary.components == 1);
    CHECK(ball.summary.voxel_mm[1] == Approx(0.5));
    CHECK(ball.summary.bone_volume_mm3 == Approx(4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3)).epsilon(0.02));
    CHECK(ball.summary.surface_area_mm2 == Approx(4.0 * std::numbers::pi * radius * radius).epsilon(0.02));
    CHECK(ball.summary.density.max == Approx(1.067 * 1500.0 + 131.0).epsilon(1e-3));
    CHECK(is_at(middle_of(ball.bone), {0.0, 0.0, 0.0}));
    CHECK_THAT(ball.bone.provenance.at("calibration"), ContainsSubstring("without a density phantom"));
}

TEST_CASE("asked for, an import has points spread over its surface") {
    bone::ImportOptions options;
    options.pointshell = 0.5e-3;
    const Imported ball = import_of(Ct{}, options);
    CHECK(ball.summary.points == ball.bone.points.size());
    CHECK(static_cast<double>(ball.summary.points) == Approx(4.0 * std::numbers::pi * 36.0 / 0.25).epsilon(0.12));
    double area = 0.0;
    for (const contact::SurfacePoint& p : ball.bone.points) area += p.area;
    CHECK(area * 1e6 == Approx(ball.summary.surface_area_mm2).epsilon(0.01));
    CHECK(import_of(Ct{}).bone.points.empty());
}

TEST_CASE("sample type and byte order do not change a bone") {
    const Imported plain = import_of(Ct{});
    for (const std::string type : {"short", "float", "double"})
        for (const std::string endian : {"little", "big"}) {
            Ct ct;
            ct.type = type;
            ct.endian = endian;
            const auto exact = ct.hu;
            ct.hu = [exact](const Vec3& u) { return std::trunc(exact(u)); };
            CHECK(import_of(ct).bone.distance.values == plain.bone.distance.values);
        }
}

TEST_CASE("RAS and LPS files of the same head give the same place, whichever way their axes run") {
    Ct ct = corner_ball();
    CHECK(is_at(middle_of(import_of(ct).bone), {-5.0, 0.0, 4.0}));
    ct.geometry =
        "space: right-anterior-superior\nspace directions: (-0.5,0,0) (0,-0.5,0) (0,0,0.5)\n"
        "space origin: (10,10,-10)\n";
    CHECK(is_at(middle_of(import_of(ct).bone), {-5.0, 0.0, 4.0}));
    ct.geometry = "space: RAS\nspace directions: (0.5,0,0) (0,0.5,0) (0,0,0.5)\nspace origin: (-10,-10,-10)\n";
    CHECK(is_at(middle_of(import_of(ct).bone), {5.0, 0.0, 4.0}));
    ct.geometry = "space: LPS\nspace directions: (0,0,-0.5) (0.5,0,0) (0,0.5,0)\nspace origin: (-10,-10,10)\n";
    CHECK(is_at(middle_of(import_of(ct).bone), {0.0, 4.0, 5.0}));
}

TEST_CASE("turned and sheared axes are resampled to LPS") {
    Ct ct = corner_ball();
    ct.geometry = "space: LPS\nspace directions: (0.4,0.3,0) (-0.3,0.4,0) (0,0,0.5)\nspace origin: (0,0,0)\n";
    const Imported turned = import_of(ct);
    CHECK(glm::length(middle_of(turned.bone) - Vec3(-2e-3, 11e-3, 14e-3)) < 5e-5);
    CHECK_THAT(turned.bone.provenance.at("axes"), ContainsSubstring("LPS"));
    ct.geometry = "space: LPS\nspace directions: (0.5,0,0) (0,0.5,0) (0,0.1,0.5)\nspace origin: (0,0,0)\n";
    const Imported sheared = import_of(ct);
    CHECK(glm::length(middle_of(sheared.bone) - Vec3(5e-3, 12.8e-3, 14e-3)) < 5e-5);
    CHECK_THAT(sheared.bone.provenance.at("axes"), ContainsSubstring("LPS"));
}

TEST_CASE("geometry that is missing is refused with what to write") {
    Ct ct;
    ct.geometry = "";
    CHECK_THROWS_WITH(import_of(ct), ContainsSubstring("space directions") && ContainsSubstring("space origin"));
}

TEST_CASE("numbers that are not HU are refused, rescaled ones and masked ones accepted") {
    Ct ct;
    ct.type = "ushort";
    const auto hu = ct.hu;
    ct.hu = [hu](const Vec3& u) { return hu(u) + 1024.0; };
    CHECK_THROWS_WITH(import_of(ct), ContainsSubstring("not HU"));
    bone::ImportOptions options;
    options.rescale = {1.0, -1024.0};
    const Imported rescaled = import_of(ct, options);
    CHECK(rescaled.summary.hu == "calibrated");
    CHECK(rescaled.summary.bone_volume_mm3 == Approx(import_of(Ct{}).summary.bone_volume_mm3).epsilon(1e-3));
    ct.type = "short";
    ct.hu = [hu](const Vec3& u) { return hu(u) > 0.0 ? hu(u) : 0.0; };
    CHECK(import_of(ct).summary.hu == "masked");
}

TEST_CASE("a crop box cuts in LPS mm and leaves a closed flat face") {
    bone::ImportOptions options;
    options.crop = "-10:0,-10:10,-10:10";
    const Imported half = import_of(Ct{}, options);
    const double whole = import_of(Ct{}).summary.bone_volume_mm3;
    // The face lies half a voxel outside the last samples.
    CHECK(half.summary.bone_volume_mm3 == Approx(0.5 * whole + 0.25 * std::numbers::pi * 36.0).epsilon(0.03));
    options.crop = "50:60,0:1,0:1";
    CHECK_THROWS_WITH(import_of(Ct{}, options), ContainsSubstring("-10.0 to 10.0 mm"));
    for (const std::string wrong : {"1:2,3:4", "2:1,0:1,0:1", "a:b,c:d,e:f", "0:1,0:1,0:1,", "0:1,0:1,0:nan"}) {
        options.crop = wrong;
        CHECK_THROWS_WITH(import_of(Ct{}, options), ContainsSubstring("x0:x1,y0:y1,z0:z1"));
    }
}

TEST_CASE("components are counted and the small ones left out") {
    Ct ct;
    ct.hu = [](const Vec3& u) {
        const double large = 9.0 - glm::length(u - Vec3(13.0, 20.0, 20.0));
        const double small = 4.0 - glm::length(u - Vec3(33.0, 20.0, 20.0));
        return std::min(1500.0, std::max(-1000.0, 300.0 + 1300.0 * std::max(large, small)));
    };
    bone::ImportOptions options;
    const Imported one = import_of(ct, options);
    options.component = "all";
    const Imported all = import_of(ct, options);
    CHECK(one.summary.components == 2);
    CHECK(all.summary.bone_volume_mm3 - one.summary.bone_volume_mm3 ==
          Approx(4.0 / 3.0 * std::numbers::pi * 8.0).epsilon(0.12));
    options.component = "none";
    CHECK_THROWS_WITH(import_of(ct, options), ContainsSubstring("'largest', 'all'"));
}

TEST_CASE("how much air a scan holds around a bone does not change the bone, smoothed or not") {
    for (const double voxel : {0.25, 0.7}) {
        INFO("voxels of " << voxel << " mm");
        const auto ball = [voxel](int air) {
            const int n = 31 + 2 * air;
            volume::Grid hu{{n, n, n}, Vec3(-1e-3 * voxel * (15 + air)), Vec3(1e-3 * voxel), {}};
            for (int k = 0; k < n; ++k)
                for (int j = 0; j < n; ++j)
                    for (int i = 0; i < n; ++i) {
                        const double away = glm::length(Vec3(i, j, k) - Vec3(15 + air));
                        hu.values.push_back(
                            static_cast<float>(std::clamp(300.0 + 900.0 * (9.0 - away), -1000.0, 1500.0)));
                    }
            return bone::bone_from_hu(std::move(hu), {300.0f, 1, true}).bone;
        };
        // 27 and 50 samples leave more air than a bone is given: the volume is cut to the same room.
        const bone::Bone some = ball(27), more = ball(50);
        REQUIRE(some.distance.size == more.distance.size);
        for (std::size_t n = 0; n < some.distance.values.size(); ++n) {
            REQUIRE(more.distance.values[n] == Approx(some.distance.values[n]).margin(1e-7));
            REQUIRE(more.density.values[n] == some.density.values[n]);
        }
        CHECK(glm::length(some.distance.origin - more.distance.origin) < 1e-12);
    }
}

TEST_CASE("a volume without bone is refused") {
    Ct ct;
    ct.hu = [](const Vec3&) { return -1000.0; };
    CHECK_THROWS_WITH(import_of(ct), ContainsSubstring("300 HU"));
}

TEST_CASE("a file that is shorter than its header says is refused before memory is taken") {
    const TemporaryFolder folder;
    const std::string whole = header_of(Ct{}) + "\n" + samples_of(Ct{});
    for (const std::size_t length :
         {whole.size() - 200, whole.size() / 2, std::size_t{150}, std::size_t{20}, std::size_t{0}}) {
        file::write_whole_file(folder / "cut.nrrd", std::string_view(whole).substr(0, length));
        CHECK_THROWS_AS(volume::read_volume(folder / "cut.nrrd"), Error);
    }
    Ct huge;
    huge.size = {2000000, 2000000, 2000000};
    for (const std::string encoding : {"raw", "gzip"}) {
        std::string header = header_of(huge);
        header.replace(header.find("encoding: raw"), 13, "encoding: " + encoding);
        file::write_whole_file(folder / "huge.nrrd", header + "\nfew bytes");
        CHECK_THROWS_WITH(volume::read_volume(folder / "huge.nrrd"), ContainsSubstring("huge.nrrd"));
    }
}

TEST_CASE("a detached header reads the same volume") {
    const TemporaryFolder folder;
    file::write_whole_file(folder / "ct.nhdr", header_of(Ct{}) + "data file: ct.raw\n");
    CHECK_THROWS_AS(volume::read_volume(folder / "ct.nhdr"), Error);
    file::write_whole_file(folder / "ct.raw", samples_of(Ct{}));
    file::write_whole_file(folder / "ct.nrrd", header_of(Ct{}) + "\n" + samples_of(Ct{}));
    CHECK(volume::read_volume(folder / "ct.nhdr").values == volume::read_volume(folder / "ct.nrrd").values);
}

TEST_CASE("a closed mesh becomes a bone with an exact distance and an assumed density") {
    const Imported cube = import_mesh_text(cube_stl(), "cube.stl", in_mm());
    CHECK(cube.summary.hu == "none");
    CHECK(cube.summary.bone_volume_mm3 == Approx(8000.0).epsilon(0.01));
    CHECK(glm::length(middle_of(cube.bone) - Vec3(15e-3, 10e-3, 10e-3)) < 2.5e-4);
    const auto& deep = *std::min_element(cube.bone.distance.values.begin(), cube.bone.distance.values.end());
    CHECK(deep == Approx(-0.01).epsilon(0.03));
    CHECK(cube.summary.density.max == Approx(1800.0));
    CHECK(cube.summary.density.min == Approx(400.0));
    CHECK_THAT(cube.bone.provenance.at("calibration"), ContainsSubstring("assumed"));
}

TEST_CASE("meshes that are open, damaged or of unlikely size are refused with what to do") {
    CHECK_THROWS_WITH(import_mesh_text(cube_stl(20.0, 11), "open.stl", in_mm()), ContainsSubstring("3 boundary edges"));
    CHECK_THROWS_WITH(import_mesh_text(cube_stl(0.2), "metres.stl"), ContainsSubstring("--unit m makes it 200 mm"));
    bone::ImportOptions metres;
    metres.unit = "cm";
    CHECK(import_mesh_text(cube_stl(2.0), "cm.stl", metres).summary.bone_volume_mm3 == Approx(8000.0).epsilon(0.01));
    metres.unit = "inch";
    CHECK_THROWS_WITH(import_mesh_text(cube_stl(), "inch.stl", metres), ContainsSubstring("mm, cm or m"));
    const std::string whole = cube_stl();
    CHECK_THROWS_AS(import_mesh_text(whole.substr(0, whole.size() / 2), "cut.stl", in_mm()), Error);
    std::string binary(80, ' ');
    binary += std::string("\xff\xff\xff\x7f", 4) + std::string(50, '\0');
    CHECK_THROWS_WITH(import_mesh_text(binary, "huge.stl"), ContainsSubstring("cut short"));
    std::string wrong = whole;
    wrong.replace(wrong.find("vertex 5"), 8, "vertex nan");
    CHECK_THROWS_AS(import_mesh_text(wrong, "nan.stl"), Error);
    CHECK_THROWS_AS(import_mesh_text("v 0 0 0\n", "points.obj"), Error);
    CHECK_THROWS_WITH(import_mesh_text("text", "mesh.txt"), ContainsSubstring(".stl"));
}
