// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/write_volume.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace tactus::volume {

namespace {

static_assert(std::endian::native == std::endian::little, "samples are written as they lie in memory");

std::string gzipped(const std::string& bytes) {
    z_stream stream{};
    constexpr int with_gzip_header = 15 + 16, memory = 8;
    if (deflateInit2(&stream, 4, Z_DEFLATED, with_gzip_header, memory, Z_DEFAULT_STRATEGY) != Z_OK)
        throw Error("zlib cannot start to compress");
    std::string out;
    std::size_t at = 0;
    int state = Z_OK;
    // In pieces, because zlib's sizes have 32 bits.
    while (state != Z_STREAM_END) {
        if (stream.avail_in == 0 && at < bytes.size()) {
            const std::size_t piece = std::min<std::size_t>(bytes.size() - at, 1 << 28);
            stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + at));
            stream.avail_in = static_cast<uInt>(piece);
            at += piece;
        }
        char block[1 << 16];
        stream.next_out = reinterpret_cast<Bytef*>(block);
        stream.avail_out = sizeof block;
        state = deflate(&stream, at == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
        out.append(block, sizeof block - stream.avail_out);
        if (state == Z_STREAM_ERROR) break;
    }
    deflateEnd(&stream);
    if (state != Z_STREAM_END) throw Error("zlib cannot compress");
    return out;
}

std::string samples_of(const Grid& grid, WrittenType type) {
    std::string bytes;
    if (type == WrittenType::float32) {
        bytes.assign(reinterpret_cast<const char*>(grid.values.data()), grid.values.size() * sizeof(float));
        return bytes;
    }
    bytes.reserve(grid.values.size() * 2);
    for (const float value : grid.values) {
        const auto rounded = static_cast<std::int16_t>(std::lround(std::clamp(value, -32768.0f, 32767.0f)));
        bytes.append(reinterpret_cast<const char*>(&rounded), 2);
    }
    return bytes;
}

std::string nrrd_of(const Grid& grid, WrittenType type) {
    const Vec3 h = grid.spacing * 1e3, o = grid.origin * 1e3;
    return fmt::format(
               "NRRD0005\ntype: {}\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
               "space units: \"mm\" \"mm\" \"mm\"\nspace directions: ({},0,0) (0,{},0) (0,0,{})\nkinds: domain domain "
               "domain\nendian: little\n"
               "encoding: gzip\nspace origin: ({},{},{})\n\n",
               type == WrittenType::int16 ? "short" : "float", grid.size[0], grid.size[1], grid.size[2], h.x, h.y, h.z,
               o.x, o.y, o.z) +
           gzipped(samples_of(grid, type));
}

// The NIfTI-1 header: 348 bytes with fixed offsets, then 4 bytes for "no extension".
std::string nifti_of(const Grid& grid, WrittenType type) {
    std::string header(352, '\0');
    const auto put = [&header](std::size_t at, auto value) { std::memcpy(header.data() + at, &value, sizeof value); };
    const Vec3 h = grid.spacing * 1e3, o = grid.origin * 1e3;
    put(0, std::int32_t{348});
    put(40, std::int16_t{3});
    for (std::size_t n = 0; n < 3; ++n) {
        if (grid.size[n] > 32767)
            throw Error(fmt::format("{} samples along an axis are too many for NIfTI; write .nrrd", grid.size[n]));
        put(42 + 2 * n, static_cast<std::int16_t>(grid.size[n]));
        put(80 + 4 * n, static_cast<float>(h[static_cast<int>(n)]));
    }
    for (std::size_t n = 3; n < 7; ++n) put(42 + 2 * n, std::int16_t{1});
    put(70, static_cast<std::int16_t>(type == WrittenType::int16 ? 4 : 16));
    put(72, static_cast<std::int16_t>(type == WrittenType::int16 ? 16 : 32));
    put(76, 1.0f);     // qfac: right-handed
    put(108, 352.0f);  // offset of the samples
    put(112, 1.0f);    // slope
    header[123] = 2;   // mm
    std::memcpy(header.data() + 148, "Tactus", 6);
    put(252, std::int16_t{1});  // scanner coordinates, for qform and sform
    put(254, std::int16_t{1});
    // LPS axes in RAS: a rotation by 180° about z, quaternion (0, 0, 0, 1).
    put(264, 1.0f);
    put(268, static_cast<float>(-o.x)), put(272, static_cast<float>(-o.y)), put(276, static_cast<float>(o.z));
    put(280, static_cast<float>(-h.x)), put(292, static_cast<float>(-o.x));
    put(300, static_cast<float>(-h.y)), put(308, static_cast<float>(-o.y));
    put(320, static_cast<float>(h.z)), put(324, static_cast<float>(o.z));
    std::memcpy(header.data() + 344, "n+1", 4);
    return header + samples_of(grid, type);
}

}  // namespace

void write_volume(const Grid& grid, WrittenType type, const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    if (name.ends_with(".nrrd")) file::write_whole_file(path, nrrd_of(grid, type));
    else if (name.ends_with(".nii.gz")) file::write_whole_file(path, gzipped(nifti_of(grid, type)));
    else if (name.ends_with(".nii")) file::write_whole_file(path, nifti_of(grid, type));
    else throw Error(fmt::format("{}: a volume is written as .nrrd, .nii or .nii.gz", path.string()));
}

}  // namespace tactus::volume
