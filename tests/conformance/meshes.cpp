// SPDX-License-Identifier: Apache-2.0
// Meshes: STL, PLY, OBJ, and formats that are not read.
#include "tests/conformance/cases.hpp"
#include "tests/support/box_faces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace tactus::conformance {

namespace {

using Bytes = std::string;
using Point = std::array<double, 3>;
using Triangle = std::array<Point, 3>;
using Triangles = std::vector<Triangle>;

using test::box_faces;

Point corner(int n, double low = 0.0, double high = 20.0) {
    return {n & 1 ? high : low, n & 2 ? high : low, n & 4 ? high : low};
}

/// A cube with its faces outwards, or inwards, moved along x.
Triangles cube(double low = 0.0, double high = 20.0, bool is_inwards = false, double x = 0.0) {
    Triangles out;
    for (const auto& face : box_faces) {
        Triangle t{corner(face[0], low, high), corner(face[1], low, high), corner(face[2], low, high)};
        if (is_inwards) std::swap(t[1], t[2]);
        for (Point& p : t) p[0] += x;
        out.push_back(t);
    }
    return out;
}

/// Each triangle in four.
Triangles finer(const Triangles& triangles) {
    const auto middle = [](const Point& a, const Point& b) {
        return Point{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2])};
    };
    Triangles out;
    for (const auto& [a, b, c] : triangles) {
        const Point ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return out;
}

Triangles together(Triangles a, const Triangles& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

Bytes raw(const void* at, std::size_t size, bool big = false) {
    Bytes out(static_cast<const char*>(at), size);
    if (big) std::ranges::reverse(out);
    return out;
}
template <class T>
Bytes number(T value, bool big = false) {
    return raw(&value, sizeof value, big);
}

Bytes binary_stl(const Triangles& triangles) {
    Bytes out = Bytes(80, 'h') + number(std::uint32_t(triangles.size()));
    for (const Triangle& t : triangles) {
        out += Bytes(12, '\0');
        for (const Point& p : t)
            for (const double x : p) out += number(float(x));
        out += Bytes(2, '\0');
    }
    return out;
}

Bytes text_stl(const Triangles& triangles) {
    Bytes out = "solid bone\n";
    for (const Triangle& t : triangles) {
        out += " facet normal 0 0 0\n  outer loop\n";
        for (const Point& p : t) out += fmt::format("   vertex {:e} {} {}\n", p[0], p[1], p[2]);
        out += "  endloop\n endfacet\n";
    }
    return out + "endsolid bone\n";
}

Bytes in_capitals(Bytes text) {
    for (char& c : text) c = char(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    return text;
}

Bytes obj(const Bytes& before = {}, const Bytes& behind = {}) {
    Bytes out = before;
    for (int n = 0; n < 8; ++n) out += fmt::format("v {} {} {}\n", corner(n)[0], corner(n)[1], corner(n)[2]);
    for (const auto& f : box_faces) out += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    return out + behind;
}

Bytes ply_header(const Bytes& format, const Bytes& more = {}, std::size_t faces = 12) {
    return fmt::format(
        "ply\nformat {} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar int vertex_indices\n{}end_header\n",
        format, faces, more);
}
Bytes ply_points() {
    Bytes out;
    for (int n = 0; n < 8; ++n) out += fmt::format("{} {} {}\n", corner(n)[0], corner(n)[1], corner(n)[2]);
    return out;
}
Bytes ply(const Bytes& more_header = {}, const Bytes& more = {}) {
    Bytes out = ply_header("ascii", more_header) + ply_points();
    for (const auto& f : box_faces) out += fmt::format("3 {} {} {}\n", f[0], f[1], f[2]);
    return out + more;
}
Bytes binary_ply(bool big) {
    Bytes out = ply_header(big ? "binary_big_endian" : "binary_little_endian");
    for (int n = 0; n < 8; ++n)
        for (const double x : corner(n)) out += number(float(x), big);
    for (const auto& f : box_faces) {
        out += '\3';
        for (const int n : f) out += number(std::int32_t(n), big);
    }
    return out;
}
/// The six faces as quadrangles.
Bytes square_ply() {
    return ply_header("ascii", "", 6) + ply_points() +
           "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
}
/// A tetrahedron as one strip.
Bytes strip_ply() {
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
           "0 0 0\n20 0 0\n0 20 0\n0 0 20\n6 0 2 1 3 0 2\n";
}

Check volume_of(double mm3) {
    return [mm3](const Json& found) {
        if (found["components"].empty()) return std::string("there are no bodies");
        double sum = 0.0;
        for (const Json& part : found["components"]) sum += part["volume_mm3"].get<double>();
        return differs("the volume", sum, mm3, 1e-3);
    };
}

/// The bone that `import` makes.
Check bone_volume_of(double mm3) {
    return [mm3](const Json& found) { return differs("the volume", found["bone_volume_mm3"], mm3, 0.02); };
}

const Check is_cube = volume_of(8000.0);

Format stl() {
    const Bytes binary = binary_stl(cube());
    Bytes wrong = text_stl(cube());
    wrong.replace(wrong.find("vertex 0"), 8, "vertex x");
    return {
        "STL",
        {"info", "FILE", "--json"},
        {},
        is_cube,
        {
            {"binary", "a.stl", bytes(binary)},
            {"binary, whose header begins with `solid`", "a.stl", bytes(Bytes(binary).replace(0, 6, "solid "))},
            {"text", "a.stl", bytes(text_stl(cube()))},
            {"a name in capitals (`A.STL`)", "A.STL", bytes(binary)},
            {"text in capitals with a byte-order mark", "a.stl", bytes("\xef\xbb\xbf" + in_capitals(text_stl(cube())))},
            {"text of several solids",
             "a.stl",
             bytes(text_stl(cube()) + text_stl(cube(0, 20, false, 40))),
             Result::read,
             "",
             {},
             volume_of(16000.0)},
            {"a second body behind the first, binary",
             "a.stl",
             bytes(binary + binary_stl(cube(0, 20, false, 40))),
             Result::note,
             "2 bodies",
             {},
             volume_of(16000.0)},
            {"bytes behind the last triangle", "a.stl", bytes(binary + "attributes"), Result::note, "10 bytes"},

            {"cut short", "a.stl", bytes(binary.substr(0, binary.size() - 60)), Result::refused, "a.stl"},
            {"text that is no number", "a.stl", bytes(wrong), Result::refused, "not a number"},
            {"a coordinate beyond the range of a number", "a.stl",
             bytes("solid a\nfacet normal 0 0 1\nouter loop\nvertex -1e400 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                   "endfacet\nendsolid a\n"),
             Result::refused, "not numbers"},
            {"no triangles", "a.stl", bytes(binary_stl({})), Result::refused, "no triangles"},
            {"a coordinate that is not a number", "a.stl",
             bytes(Bytes(binary).replace(96, 4, Bytes("\0\0\xc0\x7f", 4))), Result::refused, "not numbers"},
        }};
}

Format ply_format() {
    return {
        "PLY",
        {"info", "FILE", "--json"},
        {},
        is_cube,
        {
            {"text", "a.ply", bytes(ply())},
            {"binary, little endian", "a.ply", bytes(binary_ply(false))},
            {"binary, big endian", "a.ply", bytes(binary_ply(true))},
            {"faces of four points", "a.ply", bytes(square_ply())},
            {"triangle strips", "a.ply", bytes(strip_ply()), Result::read, "", {}, volume_of(8000.0 / 6.0)},
            {"edges", "a.ply", bytes(ply("element edge 1\nproperty int a\nproperty int b\n", "0 1\n")), Result::note,
             "1 elements 'edge'"},
            {"more faces than the header states", "a.ply", bytes(ply("", "3 0 1 2\n")), Result::note, "4 words behind"},
            {"points without faces", "a.ply", bytes(ply_header("ascii", "", 0) + ply_points()), Result::refused,
             "point cloud"},
            {"a point that does not exist", "a.ply", bytes(ply_header("ascii", "", 1) + ply_points() + "3 0 1 9\n"),
             Result::refused, "does not exist"},
            {"cut short", "a.ply", bytes(binary_ply(false).substr(0, 400)), Result::refused, "cut short"},
        }};
}

Format obj_format() {
    return {"OBJ",
            {"info", "FILE", "--json"},
            {},
            is_cube,
            {
                {"points and faces", "a.obj", bytes(obj())},
                {"negative numbers of points", "a.obj", bytes([] {
                     Bytes out = obj();
                     out.resize(out.find("f "));
                     for (const auto& f : box_faces) out += fmt::format("f {} {} {}\n", f[0] - 8, f[1] - 8, f[2] - 8);
                     return out;
                 }())},
                {"texture and normal numbers, groups and materials", "a.obj",
                 bytes(obj("mtllib a.mtl\no bone\ng one\nvt 0 0\nvn 0 0 1\n", "usemtl white\nf 1/1/1 3/1/1 2/1/1\n")),
                 Result::note, "3 non-manifold"},
                {"lines continued by a backslash", "a.obj", bytes(obj("", "f 1 \\\n 3 \\\n 2\n")), Result::note,
                 "3 non-manifold"},
                {"a byte-order mark, and lines that end with CR LF", "a.obj", bytes([] {
                     Bytes out = "\xef\xbb\xbf";
                     for (const char c : obj()) out += c == '\n' ? Bytes("\r\n") : Bytes(1, c);
                     return out;
                 }())},
                {"faces of four points", "a.obj", bytes([] {
                     Bytes out = obj();
                     out.resize(out.find("f "));
                     return out + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
                 }())},
                {"lines and points", "a.obj", bytes(obj("", "l 1 2\np 1\n")), Result::note, "1 lines"},
                {"a point that does not exist", "a.obj", bytes(obj("", "f 1 2 99\n")), Result::refused, "a.obj"},
            }};
}

Format bodies() {
    Triangles open = cube(), fine = finer(finer(cube()));
    open.resize(10);
    fine.pop_back();
    Triangles flipped = cube();
    std::swap(flipped[3][0], flipped[3][1]);
    return {"`import` of all",
            {"import", "FILE", "--unit", "mm", "-o", "bone.vdb", "--json"},
            {},
            bone_volume_of(8000.0),
            {
                {"a hole in half of a percent of the surface", "a.stl", bytes(binary_stl(fine)), Result::note, "hole"},
                {"a hole in a fifth of the surface", "a.stl", bytes(binary_stl(open)), Result::refused, "1 hole"},
                {"a flipped triangle", "a.stl", bytes(binary_stl(flipped)), Result::note, "triangle"},
                {"a triangle that comes twice", "a.stl", bytes(binary_stl(together(cube(), {cube()[0]}))), Result::note,
                 "triangle"},
                {"an inner shell that looks inwards",
                 "a.stl",
                 bytes(binary_stl(together(cube(), cube(5, 15, true)))),
                 Result::note,
                 "1 inner shell",
                 {},
                 bone_volume_of(7000.0)},
                {"a smaller body beside the first: the largest is kept",
                 "a.stl",
                 bytes(binary_stl(together(cube(), cube(0, 10, false, 40)))),
                 Result::note,
                 "1 of 2 bodies kept",
                 {},
                 bone_volume_of(8000.0)},
                {"the same, all kept",
                 "a.stl",
                 bytes(binary_stl(together(cube(), cube(0, 10, false, 40)))),
                 Result::read,
                 "",
                 {"--component", "all"},
                 bone_volume_of(9000.0)},
            }};
}

Format unread_meshes() {
    const auto unread = [](const std::string& feature, const std::string& name, const Bytes& content) {
        return Case{feature, name, bytes(content), Result::refused, name};
    };
    return {"others",
            {"info", "FILE", "--json"},
            {},
            is_cube,
            {unread("3MF", "a.3mf", Bytes("PK\3\4", 4)), unread("VTK XML", "a.vtp", "<VTKFile type=\"PolyData\"/>\n"),
             unread("VTK", "a.vtk", "# vtk DataFile Version 3.0\n"), unread("glTF", "a.glb", "glTF"),
             unread("an empty file", "a.stl", "")}};
}

}  // namespace

Table mesh_table() {
    Table table{"meshes", {stl(), ply_format(), obj_format(), bodies(), unread_meshes()}};
    for (Format& format : table.formats)
        format.notes = [](const Json& found) {
            std::vector<std::string> notes = strings_of(found["notes"]);
            // What is stated of each mesh.
            std::erase_if(notes, [](const std::string& note) {
                return note.starts_with("coordinates ") || note.find(" points, ") != std::string::npos;
            });
            return notes;
        };
    return table;
}

}  // namespace tactus::conformance
