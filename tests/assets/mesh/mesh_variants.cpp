// SPDX-License-Identifier: Apache-2.0
// Meshes as programs write them: several bodies, shells, strips, and text in all its forms.
#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/box_faces.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

/// A box with its faces outwards, or inwards.
Triangles box_of(const Vec3& low, const Vec3& high, bool is_inwards = false) {
    const auto corner = [&](int n) {
        return Vec3(n & 1 ? high.x : low.x, n & 2 ? high.y : low.y, n & 4 ? high.z : low.z);
    };
    Triangles out;
    for (const auto& f : test::box_faces)
        out.push_back(is_inwards ? std::array{corner(f[0]), corner(f[2]), corner(f[1])}
                                 : std::array{corner(f[0]), corner(f[1]), corner(f[2])});
    return out;
}

std::string binary_stl(const Triangles& triangles) {
    std::string out(80, 'h');
    const auto count = static_cast<std::uint32_t>(triangles.size());
    out.append(reinterpret_cast<const char*>(&count), 4);
    for (const auto& t : triangles) {
        out += std::string(12, '\0');
        for (const Vec3& v : t)
            for (int n = 0; n < 3; ++n) {
                const auto number = static_cast<float>(v[n]);
                out.append(reinterpret_cast<const char*>(&number), 4);
            }
        out += std::string(2, '\0');
    }
    return out;
}

std::string text_stl(const Triangles& triangles) {
    std::string out = "SOLID Bone\n";
    for (const auto& t : triangles) {
        out += " FACET NORMAL 0 0 0\n  OUTER LOOP\n";
        for (const Vec3& v : t) out += fmt::format("   VERTEX {:E} {} {}\n", v.x, v.y, v.z);
        out += "  ENDLOOP\n ENDFACET\n";
    }
    return out + "ENDSOLID Bone\n";
}

Triangles together(Triangles a, const Triangles& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

bone::ImportSummary imported(const std::filesystem::path& file, const std::string& component = {}) {
    bone::ImportOptions options;
    options.input = file;
    options.unit = "mm";
    options.component = component;
    bone::ImportSummary summary;
    bone::import_bone(options, {}, &summary);
    return summary;
}

}  // namespace

TEST_CASE("a hollow body keeps its hollow, whichever way the whole is turned, and other bodies are noted") {
    const TemporaryFolder place;
    const Triangles outer = box_of({0, 0, 0}, {20, 20, 20}), inner = box_of({5, 5, 5}, {15, 15, 15}, true),
                    other = box_of({40, 0, 0}, {50, 10, 10});
    const auto turned = [](Triangles triangles) {
        for (auto& t : triangles) std::swap(t[1], t[2]);
        return triangles;
    };
    const Triangles all = together(together(inner, outer), other);
    for (const bool is_turned : {false, true}) {
        CAPTURE(is_turned);
        file::write_whole_file(place / "hollow.stl", binary_stl(is_turned ? turned(all) : all));
        const bone::ImportSummary largest = imported(place / "hollow.stl"),
                                  whole = imported(place / "hollow.stl", "all");
        CHECK(largest.bone_volume_mm3 == Approx(7000.0).epsilon(0.02));
        CHECK(largest.components == 2);
        CHECK(largest.components_kept == 1);
        const std::string notes = fmt::format("{}", fmt::join(largest.notes, "; "));
        CHECK_THAT(notes, ContainsSubstring("1 inner shell") && ContainsSubstring("1000 mm³ are hollow") &&
                              ContainsSubstring("1 of 2 bodies kept; 1000 mm³ left out"));
        CHECK(whole.bone_volume_mm3 == Approx(8000.0).epsilon(0.02));
        CHECK(whole.components_kept == 2);
    }
}

TEST_CASE("every body of an STL is read, in text of any case, and bytes that are none are noted") {
    const TemporaryFolder place;
    const Triangles a = box_of({0, 0, 0}, {10, 10, 10}), b = box_of({20, 0, 0}, {30, 10, 10});
    mesh::MeshOrigin origin;
    file::write_whole_file(place / "two.stl", binary_stl(a) + binary_stl(b));
    CHECK(mesh::load_mesh(place / "two.stl", 1.0, &origin).triangles.size() == 24);
    CHECK_THAT(fmt::format("{}", fmt::join(origin.notes, ";")), ContainsSubstring("2 bodies"));
    file::write_whole_file(place / "more.stl", binary_stl(a) + "attributes");
    CHECK(mesh::load_mesh(place / "more.stl", 1.0, &origin).triangles.size() == 12);
    CHECK_THAT(fmt::format("{}", fmt::join(origin.notes, ";")), ContainsSubstring("10 bytes"));
    file::write_whole_file(place / "text.stl", "\xef\xbb\xbf" + text_stl(a) + text_stl(b));
    CHECK(mesh::load_mesh(place / "text.stl").triangles.size() == 24);
}

TEST_CASE("triangle strips of a PLY are read with their turns, other elements are counted") {
    const TemporaryFolder place;
    // A tetrahedron as one strip and a face.
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string points = "0 0 0\n10 0 0\n0 10 0\n0 0 10\n";
    file::write_whole_file(place / "strip.ply", head +
                                                    "element tristrips 1\nproperty list int int vertex_indices\n"
                                                    "element edge 1\nproperty int a\nproperty int b\nend_header\n" +
                                                    points + "10 0 2 1 3 -1 0 1 3 -1 3\n0 1\n");
    mesh::MeshOrigin origin;
    const mesh::Mesh strip = mesh::load_mesh(place / "strip.ply", 1.0, &origin);
    CHECK(strip.triangles.size() == 3);
    CHECK_THAT(fmt::format("{}", fmt::join(origin.notes, ";")), ContainsSubstring("1 elements 'edge'"));
    file::write_whole_file(
        place / "closed.ply",
        head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + points + "6 0 2 1 3 0 2\n");
    const mesh::Mesh closed = mesh::load_mesh(place / "closed.ply");
    CHECK(mesh::topology_of(closed).is_watertight());
    CHECK(mesh::volume_of(closed) == Approx(1000.0 / 6.0));
    file::write_whole_file(
        place / "wrong.ply",
        head + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" + points + "3 0 1 9\n");
    CHECK_THROWS_AS(mesh::load_mesh(place / "wrong.ply"), Error);
}

TEST_CASE("coordinates beyond the range of a number are refused, and those too small for one are 0") {
    const TemporaryFolder folder;
    const auto load = [&](const std::string& name, const std::string& x) {
        const bool is_stl = name.ends_with("stl");
        file::write_whole_file(folder / name,
                               (is_stl ? "solid a\nfacet normal 0 0 1\nouter loop\nvertex " + x +
                                             " 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
                                       : "v " + x + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
        return mesh::load_mesh(folder / name);
    };
    for (const char* const name : {"a.stl", "a.obj"}) {
        CAPTURE(name);
        for (const char* const huge : {"1e400", "-1e400", "1e300"})
            CHECK_THROWS_WITH(load(name, huge), ContainsSubstring("coordinates are not numbers"));
        CHECK(load(name, "1e-400").triangles.size() == 1);
        CHECK_THROWS_WITH(load(name, "1e400x"), ContainsSubstring("is not a number"));
    }
}

TEST_CASE("faces of a PLY that its header does not count are noted") {
    const TemporaryFolder folder;
    const std::string head =
                          "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nend_header\n",
                      body = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n";
    const auto notes = [&](const std::string& bytes) {
        file::write_whole_file(folder / "a.ply", bytes);
        mesh::MeshOrigin origin;
        mesh::load_mesh(folder / "a.ply", 1.0, &origin);
        return origin.notes.empty() ? std::string() : origin.notes.front();
    };
    CHECK(notes("ply\nformat ascii 1.0\n" + head + body + "\n").empty());
    CHECK_THAT(notes("ply\nformat ascii 1.0\n" + head + body + "3 0 1 3\n"),
               ContainsSubstring("4 words behind the last"));
    std::string binary;
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f})
        binary.append(reinterpret_cast<const char*>(&x), 4);
    const auto face = [](int a, int b, int c) {
        std::string bytes = "\3";
        for (const int n : {a, b, c}) bytes.append(reinterpret_cast<const char*>(&n), 4);
        return bytes;
    };
    binary = "ply\nformat binary_little_endian 1.0\n" + head + binary + face(0, 1, 2);
    CHECK(notes(binary + "\n").empty());
    CHECK_THAT(notes(binary + face(0, 1, 3)), ContainsSubstring("13 bytes behind the last"));
}

TEST_CASE("an OBJ with continued lines and a byte-order mark is read, its lines and points are counted") {
    const TemporaryFolder place;
    file::write_whole_file(
        place / "a.obj",
        "\xef\xbb\xbfv 0 0 0\nv 1 0 \\\n0\r\nv 0 1 0\nv 0 0 1\nf 1 \\\r\n 2 \\\n3\nf 1 3 4 # a comment\nl 1 2\np 1\n");
    mesh::MeshOrigin origin;
    const mesh::Mesh mesh = mesh::load_mesh(place / "a.obj", 1.0, &origin);
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.vertices.size() == 4);
    CHECK_THAT(fmt::format("{}", fmt::join(origin.notes, ";")),
               ContainsSubstring("1 lines") && ContainsSubstring("1 points"));
}

TEST_CASE("overlapping segments in layers become one bone each, from its own layer, and empty ones are noted") {
    const TemporaryFolder place;
    std::string bytes =
        "NRRD0004\ntype: unsigned char\ndimension: 4\nsizes: 2 16 16 16\nspace: left-posterior-superior\n"
        "kinds: list domain domain domain\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
        "encoding: raw\nSegment0_ID:=a\nSegment0_Name:=Jaw/left: \xc3\xa4\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
        "Segment1_ID:=b\nSegment1_Name:=Inner\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n"
        "Segment2_ID:=c\nSegment2_Name:=Nothing\nSegment2_LabelValue:=7\nSegment2_Layer:=1\n\n";
    for (int k = 0; k < 16; ++k)
        for (int j = 0; j < 16; ++j)
            for (int i = 0; i < 16; ++i) {
                const auto within = [&](int low, int high) {
                    return i >= low && i < high && j >= low && j < high && k >= low && k < high;
                };
                bytes += static_cast<char>(within(2, 14)), bytes += static_cast<char>(within(5, 11));
            }
    file::write_whole_file(place / "s.seg.nrrd", bytes);
    bone::ImportOptions options;
    options.input = place / "s.seg.nrrd";
    options.unit = "mm";
    options.label = "all";
    const std::vector<bone::ImportedBone> made = bone::import_labels(options);
    REQUIRE(made.size() == 2);
    CHECK(made[0].bone.name == "Jaw/left: \xc3\xa4");
    CHECK(made[0].summary.bone_volume_mm3 == Approx(1728.0).epsilon(0.03));
    CHECK(made[1].summary.bone_volume_mm3 == Approx(216.0).epsilon(0.06));
    CHECK_THAT(fmt::format("{}", fmt::join(made[0].summary.notes, ";")),
               ContainsSubstring("of 3 named segments 1 have no voxels: Nothing"));
    options.label = "Inner";
    CHECK(bone::import_labels(options).size() == 1);
}
