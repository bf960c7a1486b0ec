// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/nrrd.hpp"

#include "assets/bone/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <teem/nrrd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>

namespace tactus {

namespace {

using NrrdPointer = std::unique_ptr<Nrrd, Nrrd* (*)(Nrrd*)>;
using IoPointer = std::unique_ptr<NrrdIoState, NrrdIoState* (*)(NrrdIoState*)>;

std::string teem_message() {
    char* text = biffGetDone(NRRD);
    std::string message = text ? text : "";
    std::free(text);
    while (!message.empty() && message.back() == '\n') message.pop_back();
    return message.substr(message.rfind('\n') == std::string::npos ? 0 : message.rfind('\n') + 1);
}

// Bytes that hold samples, over all data files of the header.
double bytes_on_disk(const std::filesystem::path& path, const NrrdIoState& io) {
    std::error_code failure;
    double sum = 0.0;
    const auto add = [&](const std::filesystem::path& file) {
        const auto size = std::filesystem::file_size(file, failure);
        if (failure) throw Error(fmt::format("{}: its data file {} is not there", path.string(), file.string()));
        sum += static_cast<double>(size);
    };
    if (io.dataFNFormat) throw Error(fmt::format("{}: numbered data files are not read; join them with 'unu'", path.string()));
    if (io.dataFNArr && io.dataFNArr->len > 0)
        for (unsigned n = 0; n < io.dataFNArr->len; ++n) add(path.parent_path() / io.dataFN[n]);
    else
        add(path);
    return sum;
}

// The least number of file bytes per sample that an encoding can need; deflate cannot pack better than 1032 to 1.
double least_bytes(const Nrrd& nrrd, const NrrdIoState& io) {
    const double size = static_cast<double>(nrrdTypeSize[nrrd.type]);
    if (io.encoding == nrrdEncodingGzip) return size / 1032.0;
    if (io.encoding == nrrdEncodingRaw) return size;
    if (io.encoding == nrrdEncodingAscii) return 1.5;
    if (io.encoding == nrrdEncodingHex) return 2.0 * size;
    return size / 10000.0;
}

struct Geometry {
    Mat3 step;    // columns: one sample along each file axis, m, LPS
    Vec3 origin;  // m, LPS
};

Geometry geometry_of(const Nrrd& nrrd, const std::string& file) {
    if (nrrd.dim != 3)
        throw Error(fmt::format("{}: has {} axes, a CT volume has 3 (take one frame with 'unu slice')", file, nrrd.dim));
    Vec3 to_lps(1.0);
    if (nrrd.space == nrrdSpaceRightAnteriorSuperior) to_lps = {-1.0, -1.0, 1.0};
    else if (nrrd.space == nrrdSpaceLeftAnteriorSuperior) to_lps = {1.0, -1.0, 1.0};
    else if (nrrd.space != nrrdSpaceLeftPosteriorSuperior)
        throw Error(fmt::format("{}: no usable 'space' (spacing and directions of the patient are unknown); write "
                                "'space: left-posterior-superior', 'space directions' and 'space origin' into the header",
                                file));
    for (unsigned n = 0; n < 3; ++n)
        if (nrrd.spaceUnits[n] && *nrrd.spaceUnits[n] && std::string_view(nrrd.spaceUnits[n]) != "mm")
            throw Error(fmt::format("{}: space units '{}' are not mm; rewrite the header in mm", file, nrrd.spaceUnits[n]));
    Geometry geometry{};
    for (int axis = 0; axis < 3; ++axis)
        for (int n = 0; n < 3; ++n) {
            geometry.step[axis][n] = nrrd.axis[axis].spaceDirection[n] * 1e-3 * to_lps[n];
            geometry.origin[n] = nrrd.spaceOrigin[n] * 1e-3 * to_lps[n];
        }
    if (!is_finite(geometry.origin)) geometry.origin = Vec3(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(geometry.step[axis]);
        if (!(length > 1e-6 && length < 0.1))
            throw Error(fmt::format("{}: the voxel spacing along axis {} is missing or not between 0.001 and 100 mm; "
                                    "give 'space directions' in mm",
                                    file, axis));
    }
    for (int a = 0; a < 3; ++a)
        for (int b = a + 1; b < 3; ++b) {
            const double cosine = glm::dot(glm::normalize(geometry.step[a]), glm::normalize(geometry.step[b]));
            if (std::abs(cosine) > 1e-3)
                throw Error(fmt::format("{}: axes {} and {} are {:.2f} degrees off square (gantry tilt); resample the "
                                        "series to a box first",
                                        file, a, b, std::abs(90.0 - std::acos(cosine) * 57.29577951308232)));
        }
    return geometry;
}

// Sorts the axes of a volume that is aligned with LPS up to order and direction.
Grid sorted(const Grid& in, const Geometry& geometry, const std::array<int, 3>& file_axis) {
    Grid out;
    std::array<std::array<int, 3>, 3> along{};  // file index per step of an output axis
    std::array<int, 3> start{0, 0, 0};
    out.origin = geometry.origin;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const int from = file_axis[a];
        const double step = geometry.step[from][axis];
        out.size[a] = in.size[static_cast<std::size_t>(from)];
        out.spacing[axis] = glm::length(geometry.step[from]);
        along[a][static_cast<std::size_t>(from)] = step > 0.0 ? 1 : -1;
        if (step < 0.0) {
            start[static_cast<std::size_t>(from)] = out.size[a] - 1;
            out.origin[axis] += step * (out.size[a] - 1);
        }
    }
    out.values.reserve(in.count());
    for (int k = 0; k < out.size[2]; ++k)
        for (int j = 0; j < out.size[1]; ++j)
            for (int i = 0; i < out.size[0]; ++i) {
                std::array<int, 3> at = start;
                for (std::size_t n = 0; n < 3; ++n) at[n] += i * along[0][n] + j * along[1][n] + k * along[2][n];
                out.values.push_back(in.at(at[0], at[1], at[2]));
            }
    return out;
}

// Interpolates a turned volume onto a box of LPS axes around it. Outside the volume stands its lowest value.
Grid turned(const Grid& in, const Geometry& geometry) {
    const Mat3 back = glm::inverse(geometry.step);
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    double spacing = low.x;
    for (int c = 0; c < 8; ++c) {
        const Vec3 corner = geometry.origin + geometry.step * Vec3(c & 1 ? in.size[0] - 1 : 0, c & 2 ? in.size[1] - 1 : 0,
                                                                   c & 4 ? in.size[2] - 1 : 0);
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    for (int axis = 0; axis < 3; ++axis) spacing = std::min(spacing, glm::length(geometry.step[axis]));
    Grid out{{}, low, Vec3(spacing), {}};
    for (int axis = 0; axis < 3; ++axis)
        out.size[static_cast<std::size_t>(axis)] = static_cast<int>((high[axis] - low[axis]) / spacing) + 1;
    if (static_cast<double>(out.size[0]) * out.size[1] * out.size[2] > 3e8)
        throw Error("the turned volume would need more than 300 million voxels on LPS axes; crop the file first");
    const float lowest = *std::min_element(in.values.begin(), in.values.end());
    out.values.reserve(out.count());
    const auto cubic = [](double x) {
        x = std::abs(x);
        return x < 1.0 ? (1.5 * x - 2.5) * x * x + 1.0 : x < 2.0 ? ((-0.5 * x + 2.5) * x - 4.0) * x + 2.0 : 0.0;
    };
    for (int k = 0; k < out.size[2]; ++k)
        for (int j = 0; j < out.size[1]; ++j)
            for (int i = 0; i < out.size[0]; ++i) {
                const Vec3 u = back * (out.position(i, j, k) - geometry.origin);
                const std::array<int, 3> base{int(std::floor(u.x)), int(std::floor(u.y)), int(std::floor(u.z))};
                bool outside = false;
                for (std::size_t n = 0; n < 3; ++n) outside = outside || base[n] < -1 || base[n] >= in.size[n];
                double sum = outside ? double(lowest) : 0.0;
                for (int n = 0; n < 64 && !outside; ++n) {
                    const std::array<int, 3> at{base[0] - 1 + n % 4, base[1] - 1 + n / 4 % 4, base[2] - 1 + n / 16};
                    const double weight = cubic(u.x - at[0]) * cubic(u.y - at[1]) * cubic(u.z - at[2]);
                    sum += weight * double(in.at(std::clamp(at[0], 0, in.size[0] - 1), std::clamp(at[1], 0, in.size[1] - 1),
                                                 std::clamp(at[2], 0, in.size[2] - 1)));
                }
                out.values.push_back(static_cast<float>(sum));
            }
    return out;
}

}  // namespace

CtVolume load_nrrd(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) throw Error(fmt::format("{}: no such file", file));
    const auto refuse = [&] { throw Error(fmt::format("{}: cannot be read as NRRD: {}", file, teem_message())); };

    const NrrdPointer header(nrrdNew(), nrrdNuke);
    const IoPointer io(nrrdIoStateNew(), nrrdIoStateNix);
    nrrdIoStateSet(io.get(), nrrdIoStateSkipData, 1);
    if (nrrdLoad(header.get(), file.c_str(), io.get())) refuse();
    if (nrrdTypeBlock == header->type) throw Error(fmt::format("{}: holds blocks, not numbers", file));
    const Geometry geometry = geometry_of(*header, file);
    double count = 1.0;
    for (unsigned axis = 0; axis < 3; ++axis) count *= static_cast<double>(header->axis[axis].size);
    if (count * least_bytes(*header, *io) > bytes_on_disk(path, *io) + 64.0)
        throw Error(fmt::format("{}: cut short: its header asks for {:.0f} voxels, more than the file can hold", file, count));
    if (count > 1e9) throw Error(fmt::format("{}: {:.0f} voxels are too many (at most 1e9); crop it first", file, count));

    const NrrdPointer nrrd(nrrdNew(), nrrdNuke);
    if (nrrdLoad(nrrd.get(), file.c_str(), nullptr)) refuse();
    CtVolume ct{{}, false, !nrrdTypeIsUnsigned[nrrd->type], io->encoding->name};
    Grid raw;
    for (unsigned axis = 0; axis < 3; ++axis) raw.size[axis] = static_cast<int>(nrrd->axis[axis].size);
    raw.values.resize(raw.count());
    const auto lookup = nrrdFLookup[nrrd->type];
    for (std::size_t n = 0; n < raw.values.size(); ++n) {
        raw.values[n] = lookup(nrrd->data, n);
        if (!std::isfinite(raw.values[n])) throw Error(fmt::format("{}: a voxel's value is not a number", file));
    }

    std::array<int, 3> file_axis{-1, -1, -1};
    bool aligned = true;
    for (int from = 0; from < 3; ++from) {
        const Vec3 direction = glm::abs(glm::normalize(geometry.step[from]));
        const int axis = direction.x > 0.9999 ? 0 : direction.y > 0.9999 ? 1 : direction.z > 0.9999 ? 2 : -1;
        if (axis < 0) aligned = false;
        else file_axis[static_cast<std::size_t>(axis)] = from;
    }
    ct.resampled = !aligned;
    ct.grid = aligned ? sorted(raw, geometry, file_axis) : turned(raw, geometry);
    return ct;
}

}  // namespace tactus
