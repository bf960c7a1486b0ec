// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/point_bytes.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace tactus::bone {

namespace {

constexpr std::string_view mark = "TACTUSPOINTS0001", border_mark = "TACTUSBORDER0001";
constexpr std::size_t head_size = mark.size() + 8, point_size = 7 * 8 + 1;
constexpr std::size_t place_size = 3 * 8;
static_assert(std::endian::native == std::endian::little, "bone files are little-endian");

void append(std::string& bytes, const Vec3& place) {
    const double numbers[3] = {place.x, place.y, place.z};
    bytes.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
}

Vec3 place_at(const char* bytes) {
    double numbers[3];
    std::memcpy(numbers, bytes, sizeof numbers);
    return {numbers[0], numbers[1], numbers[2]};
}

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

std::string border_bytes(const contact::ScannedBorder& border) {
    std::string bytes(border_mark);
    bytes.reserve(head_size + (border.faces.size() + 1) * place_size);
    const std::uint64_t count = border.faces.size();
    bytes.append(reinterpret_cast<const char*>(&count), 8);
    append(bytes, border.voxel);
    for (const Vec3& face : border.faces) append(bytes, face);
    return bytes;
}

contact::ScannedBorder border_from(std::string_view bytes, const std::string& file) {
    if (!bytes.starts_with(border_mark))
        throw Error(fmt::format("{}: its scanned border has a format that this program does not read", file));
    std::uint64_t count = 0;
    if (bytes.size() >= head_size) std::memcpy(&count, bytes.data() + border_mark.size(), 8);
    if (bytes.size() < head_size + place_size || (bytes.size() - head_size) % place_size != 0 ||
        (bytes.size() - head_size) / place_size - 1 != count)
        throw Error(fmt::format("{}: the number of faces of its scanned border differs from the stated count", file));
    const char* at = bytes.data() + head_size;
    contact::ScannedBorder border{std::vector<Vec3>(count), place_at(at)};
    if (!is_finite(border.voxel) || !(std::min({border.voxel.x, border.voxel.y, border.voxel.z}) > 0.0))
        throw Error(fmt::format("{}: the voxels of its scanned border have no size", file));
    for (Vec3& face : border.faces) {
        at += place_size;
        face = place_at(at);
        if (!is_finite(face)) throw Error(fmt::format("{}: a face of its scanned border is not a number", file));
    }
    return border;
}

}  // namespace tactus::bone
