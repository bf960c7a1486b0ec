// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh_readers.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <charconv>

namespace tactus::mesh {

namespace {

// The point of "7", "7/1", "7//3" or "-1" (the last one so far), counted from 0.
int index_of(std::string_view word, std::size_t points, const std::string& file) {
    long long number = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), number);
    const long long index = number < 0 ? static_cast<long long>(points) + number : number - 1;
    if (code != std::errc{} || (end != word.data() + word.size() && *end != '/') || number == 0 || index < 0 ||
        index >= 2147483647)
        throw Error(fmt::format("{}: '{}' does not refer to a point", file, word.substr(0, 40)));
    return static_cast<int>(index);
}

}  // namespace

MeshText read_obj(const std::string& bytes, const std::string& file) {
    MeshText mesh;
    for (std::size_t at = 0; at < bytes.size();) {
        leave_if_stopped();
        const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
        const std::string_view line = std::string_view(bytes).substr(at, end - at);
        at = end + 1;
        Words words(line);
        const std::string_view first = words.next();
        if (first.starts_with('#')) {
            if (const auto stated = stated_frame(line)) mesh.frame = stated;
            if (const auto stated = stated_unit(line)) mesh.unit = stated;
        } else if (first == "v") {
            Vec3 point;
            for (int n = 0; n < 3; ++n) point[n] = words.number(file);
            mesh.surface.vertices.push_back(point);
        } else if (first == "f") {
            int start = 0, last = 0;
            std::size_t corner = 0;
            for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++corner) {
                const int index = index_of(word, mesh.surface.vertices.size(), file);
                if (corner == 0) start = index;
                if (corner >= 2) mesh.surface.triangles.push_back({start, last, index});
                last = index;
            }
        }
    }
    return mesh;
}

}  // namespace tactus::mesh
