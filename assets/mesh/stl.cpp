// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh_readers.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

namespace tactus::mesh {

namespace {

void add_triangle(geometry::TriangleSurface& surface, const std::array<Vec3, 3>& corners) {
    const int first = static_cast<int>(surface.vertices.size());
    surface.vertices.insert(surface.vertices.end(), corners.begin(), corners.end());
    surface.triangles.push_back({first, first + 1, first + 2});
}

void read_text(const std::string& bytes, const std::string& file, geometry::TriangleSurface& surface) {
    Words words(bytes);
    std::array<Vec3, 3> corners;
    std::size_t corner = 0;
    bool ended = false;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (word == "vertex") {
            if (corner == 3) throw Error(fmt::format("{}: a facet with more than three points", file));
            for (int n = 0; n < 3; ++n) corners[corner][n] = words.number(file);
            ++corner;
        } else if (word == "endfacet") {
            if (corner != 3) throw Error(fmt::format("{}: a facet with {} points", file, corner));
            leave_if_stopped();
            add_triangle(surface, corners);
            corner = 0;
        }
        ended = word == "endsolid" || (ended && word != "facet");
    }
    if (!ended) throw Error(fmt::format("{}: cut short: no 'endsolid'; copy the file again", file));
}

}  // namespace

namespace {

/// Text in any case: "SOLID" and "Facet" are written, too.
bool is_text(const std::string& bytes) {
    const std::size_t start = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    return lower(std::string_view(bytes).substr(start, 5)) == "solid" && bytes.find('\0') == std::string::npos &&
           lower(std::string_view(bytes).substr(0, 4096)).find("facet") != std::string::npos;
}

/// The triangles of a binary body at `at`; none when no whole body lies there.
std::optional<std::uint32_t> triangles_at(const std::string& bytes, std::size_t at) {
    std::uint32_t triangles = 0;
    if (bytes.size() < at + 84) return std::nullopt;
    std::memcpy(&triangles, bytes.data() + at + 80, 4);
    if (bytes.size() - at < 84 + std::uint64_t{50} * triangles) return std::nullopt;
    return triangles;
}

void read_body(const std::string& bytes, std::size_t at, std::uint32_t triangles, geometry::TriangleSurface& surface) {
    for (std::uint32_t n = 0; n < triangles; ++n) {
        if (n % 4096 == 0) leave_if_stopped();
        std::array<float, 9> numbers;  // the corners; the stored normal is skipped
        std::memcpy(numbers.data(), bytes.data() + at + 84 + std::size_t{50} * n + 12, sizeof numbers);
        std::array<Vec3, 3> corners;
        for (std::size_t c = 0; c < 3; ++c)
            corners[c] = Vec3(double(numbers[3 * c]), double(numbers[3 * c + 1]), double(numbers[3 * c + 2]));
        add_triangle(surface, corners);
    }
}

}  // namespace

MeshText read_stl(const std::string& bytes, const std::string& file) {
    MeshText mesh;
    mesh.frame = stated_frame(std::string_view(bytes).substr(0, 300));
    mesh.unit = stated_unit(std::string_view(bytes).substr(0, 300));
    if (is_text(bytes)) {
        read_text(lower(bytes), file, mesh.surface);
        return mesh;
    }
    std::uint32_t stated = 0;
    if (bytes.size() >= 84) std::memcpy(&stated, bytes.data() + 80, 4);
    if (!triangles_at(bytes, 0))
        throw Error(
            fmt::format("{}: cut short or not an STL file: the header states {} triangles, but the file has {} bytes",
                        file, stated, bytes.size()));
    if (stated > 500'000'000) throw Error(fmt::format("{}: {} triangles are too many", file, stated));
    // Bodies may follow each other, each with its own header.
    std::size_t at = 0, bodies = 0;
    for (std::optional<std::uint32_t> triangles; (triangles = triangles_at(bytes, at)); ++bodies) {
        if (bodies > 0 && *triangles == 0) break;
        read_body(bytes, at, *triangles, mesh.surface);
        at += 84 + std::size_t{50} * *triangles;
    }
    if (bodies > 1) mesh.notes.push_back(fmt::format("{} bodies follow each other in the file; all were read", bodies));
    if (at < bytes.size())
        mesh.notes.push_back(
            fmt::format("{} bytes behind the last triangle were not read: no body begins there", bytes.size() - at));
    return mesh;
}

}  // namespace tactus::mesh
