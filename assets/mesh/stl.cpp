// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh_readers.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>

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

MeshText read_stl(const std::string& bytes, const std::string& file) {
    MeshText mesh;
    mesh.frame = stated_frame(std::string_view(bytes).substr(0, 300));
    mesh.unit = stated_unit(std::string_view(bytes).substr(0, 300));
    const bool text =
        bytes.starts_with("solid") && bytes.find("facet") != std::string::npos && bytes.find('\0') == std::string::npos;
    if (text) {
        read_text(bytes, file, mesh.surface);
        return mesh;
    }
    std::uint32_t triangles = 0;
    if (bytes.size() >= 84) std::memcpy(&triangles, bytes.data() + 80, 4);
    if (bytes.size() < 84 || bytes.size() < 84 + std::uint64_t{50} * triangles)
        throw Error(
            fmt::format("{}: cut short or not an STL file: the header states {} triangles, but the file has {} bytes",
                        file, triangles, bytes.size()));
    if (triangles > 500'000'000) throw Error(fmt::format("{}: {} triangles are too many", file, triangles));
    for (std::uint32_t n = 0; n < triangles; ++n) {
        if (n % 4096 == 0) leave_if_stopped();
        std::array<float, 9> numbers;  // the corners; the stored normal is skipped
        std::memcpy(numbers.data(), bytes.data() + 84 + std::size_t{50} * n + 12, sizeof numbers);
        std::array<Vec3, 3> corners;
        for (std::size_t c = 0; c < 3; ++c)
            corners[c] = Vec3(double(numbers[3 * c]), double(numbers[3 * c + 1]), double(numbers[3 * c + 2]));
        add_triangle(mesh.surface, corners);
    }
    return mesh;
}

}  // namespace tactus::mesh
