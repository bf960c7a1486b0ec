// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/point_bytes.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

namespace tactus::bone {

namespace {

constexpr std::string_view mark = "TACTUSPOINTS0001";
constexpr std::size_t head_size = mark.size() + 8, point_size = 7 * 8 + 1;
static_assert(std::endian::native == std::endian::little, "bone files are little-endian");

}  // namespace

std::string to_bytes(std::span<const contact::SurfacePoint> points) {
    std::string bytes(mark);
    bytes.reserve(head_size + points.size() * point_size);
    const std::uint64_t count = points.size();
    bytes.append(reinterpret_cast<const char*>(&count), 8);
    for (const contact::SurfacePoint& p : points) {
        const double numbers[7] = {p.position.x, p.position.y, p.position.z, p.normal.x,
                                   p.normal.y,   p.normal.z,   p.area};
        bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
        bytes.push_back(static_cast<char>(p.label));
    }
    return bytes;
}

std::vector<contact::SurfacePoint> points_from(std::string_view bytes, const std::string& file) {
    if (!bytes.starts_with(mark))
        throw Error(fmt::format("{}: its surface points have a format that this program does not read", file));
    std::uint64_t count = 0;
    if (bytes.size() >= head_size) std::memcpy(&count, bytes.data() + mark.size(), 8);
    if (bytes.size() < head_size || (bytes.size() - head_size) % point_size != 0 ||
        (bytes.size() - head_size) / point_size != count)
        throw Error(fmt::format("{}: the number of surface points differs from the stated count", file));
    std::vector<contact::SurfacePoint> points(count);
    const char* at = bytes.data() + head_size;
    for (contact::SurfacePoint& p : points) {
        double numbers[7];
        std::memcpy(numbers, at, sizeof numbers);
        for (const double number : numbers)
            if (!std::isfinite(number)) throw Error(fmt::format("{}: a surface point is not a number", file));
        p = {{numbers[0], numbers[1], numbers[2]},
             {numbers[3], numbers[4], numbers[5]},
             numbers[6],
             static_cast<std::uint8_t>(at[sizeof numbers])};
        at += point_size;
    }
    return points;
}

}  // namespace tactus::bone
