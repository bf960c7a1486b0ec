// SPDX-License-Identifier: Apache-2.0
#include "tests/assets/volume/written_volume.hpp"

#include "assets/file/whole_file.hpp"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus {

namespace {

template <typename T>
std::string raw(T value, bool swapped = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (swapped) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

std::string samples(const WrittenVolume& volume, bool swapped = false) {
    std::string bytes;
    for (const std::int16_t value : volume.hu) bytes += raw(value, swapped);
    return bytes;
}

Vec3 ras(const Vec3& p) { return {-p.x, -p.y, p.z}; }

using Bytes = std::string;

// One element in explicit little endian.
Bytes element(unsigned group, unsigned number, const std::string& kind, Bytes value) {
    if (value.size() % 2) value += kind == "UI" ? '\0' : ' ';
    Bytes out = raw(static_cast<std::uint16_t>(group)) + raw(static_cast<std::uint16_t>(number)) + kind;
    if (kind == "OB" || kind == "OW" || kind == "SQ")
        out += Bytes(2, '\0') + raw(static_cast<std::uint32_t>(value.size()));
    else out += raw(static_cast<std::uint16_t>(value.size()));
    return out + value;
}

Bytes item(const Bytes& content) {
    return raw(std::uint16_t{0xfffe}) + raw(std::uint16_t{0xe000}) + raw(static_cast<std::uint32_t>(content.size())) +
           content;
}

Bytes short_number(unsigned group, unsigned number, int value) {
    return element(group, number, "US", raw(static_cast<std::uint16_t>(value)));
}

std::string text_of(const Vec3& v) { return fmt::format("{:.9g}\\{:.9g}\\{:.9g}", v.x, v.y, v.z); }

std::string orientation_of(const WrittenVolume& volume) {
    return text_of(glm::normalize(volume.step[0])) + "\\" + text_of(glm::normalize(volume.step[1]));
}

std::string spacing_of(const WrittenVolume& volume) {
    return fmt::format("{:.9g}\\{:.9g}", glm::length(volume.step[1]), glm::length(volume.step[0]));
}

Bytes with_preamble(const Bytes& set, const std::string& kind) {
    const Bytes meta = element(2, 1, "OB", Bytes("\0\1", 2)) + element(2, 2, "UI", kind) +
                       element(2, 3, "UI", "1.2.3") + element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
    return Bytes(128, '\0') + "DICM" + element(2, 0, "UL", raw(static_cast<std::uint32_t>(meta.size()))) + meta + set;
}

Bytes pixel_description(const WrittenVolume& volume, const std::string& photometric, int frames) {
    Bytes out = short_number(0x28, 2, 1) + element(0x28, 4, "CS", photometric);
    if (frames > 1) out += element(0x28, 8, "IS", std::to_string(frames));
    return out + short_number(0x28, 0x10, volume.size[1]) + short_number(0x28, 0x11, volume.size[0]);
}

const std::string bits = short_number(0x28, 0x100, 16) + short_number(0x28, 0x101, 16) + short_number(0x28, 0x102, 15);

Bytes tar_entry(const std::string& name, const Bytes& content) {
    Bytes head(512, '\0');
    const auto put = [&head](std::size_t at, const std::string& text) { head.replace(at, text.size(), text); };
    put(0, "folder/" + name);
    put(124, fmt::format("{:011o}", content.size()));
    put(148, Bytes(8, ' '));
    head[156] = '0';
    int sum = 0;
    for (const char c : head) sum += static_cast<unsigned char>(c);
    put(148, fmt::format("{:06o}", sum) + Bytes("\0 ", 2));
    return head + content + Bytes((512 - content.size() % 512) % 512, '\0');
}

}  // namespace

void WrittenVolume::fill(const std::function<double(const Vec3&)>& density) {
    hu.clear();
    for (int k = 0; k < size[2]; ++k)
        for (int j = 0; j < size[1]; ++j)
            for (int i = 0; i < size[0]; ++i)
                hu.push_back(static_cast<std::int16_t>(std::lround(density(position(i, j, k)))));
}

std::string nrrd_bytes(const WrittenVolume& v) {
    const auto vector = [](const Vec3& p) { return fmt::format("({:.9g},{:.9g},{:.9g})", p.x, p.y, p.z); };
    return fmt::format(
               "NRRD0005\ntype: short\ndimension: 3\nsizes: {} {} {}\nspace: left-posterior-superior\n"
               "space units: \"mm\" \"mm\" \"mm\"\nspace directions: {} {} {}\nspace origin: {}\nendian: "
               "little\nencoding: raw\n\n",
               v.size[0], v.size[1], v.size[2], vector(v.step[0]), vector(v.step[1]), vector(v.step[2]),
               vector(v.origin)) +
           samples(v);
}

std::string nifti_bytes(const WrittenVolume& v, const NiftiStyle& style) {
    std::string head(style.second ? 544 : 352, '\0');
    const auto put = [&](std::size_t at, auto value) { head.replace(at, sizeof value, raw(value, style.swapped)); };
    const auto whole = [&](std::size_t at, int value) {
        if (style.second) put(at, std::int64_t{value});
        else put(at, static_cast<std::int16_t>(value));
    };
    const auto real = [&](std::size_t at, double value) {
        if (style.second) put(at, value);
        else put(at, static_cast<float>(value));
    };
    const std::size_t w = style.second ? 8 : 2, r = style.second ? 8 : 4;
    put(0, std::int32_t{style.second ? 540 : 348});
    const std::size_t dim = style.second ? 16 : 40, pixdim = style.second ? 104 : 76;
    whole(dim, 3);
    for (std::size_t n = 0; n < 3; ++n) whole(dim + (n + 1) * w, v.size[n]);
    for (std::size_t n = 3; n < 7; ++n) whole(dim + (n + 1) * w, 1);
    put(style.second ? 12 : 70, std::int16_t{4});
    put(style.second ? 14 : 72, std::int16_t{16});
    real(style.second ? 176 : 112, 2.0);     // slope and intercept: the file holds half of HU
    real(style.second ? 184 : 116, -1000.0);
    const Mat3 step(ras(v.step[0]), ras(v.step[1]), ras(v.step[2]));
    const Vec3 origin = ras(v.origin);
    Mat3 rotation(glm::normalize(step[0]), glm::normalize(step[1]), glm::normalize(step[2]));
    const bool mirrored = glm::dot(glm::cross(rotation[0], rotation[1]), rotation[2]) < 0.0;
    if (mirrored) rotation[2] = -rotation[2];
    real(pixdim, mirrored ? -1.0 : 1.0);
    for (int n = 0; n < 3; ++n) real(pixdim + static_cast<std::size_t>(n + 1) * r, glm::length(step[n]));
    const auto code = [&](std::size_t first, std::size_t second, int value) {
        if (style.second) put(second, std::int32_t{value});
        else put(first, static_cast<std::int16_t>(value));
    };
    if (style.quaternion) {
        Quat q = glm::quat_cast(rotation);
        if (q.w < 0.0) q = -q;
        code(252, 344, 1);
        const double numbers[6] = {q.x, q.y, q.z, origin.x, origin.y, origin.z};
        for (std::size_t n = 0; n < 6; ++n) real((style.second ? 352 : 256) + n * r, numbers[n]);
    } else {
        code(254, 348, 1);
        for (int row = 0; row < 3; ++row)
            for (int n = 0; n < 4; ++n)
                real((style.second ? 400 : 280) + static_cast<std::size_t>(4 * row + n) * r,
                     n < 3 ? step[n][row] : origin[row]);
    }
    if (style.second) {
        put(168, std::int64_t{544});
        put(500, std::int32_t{2});
        head.replace(4, 8, std::string("n+2\0\r\n\032\n", 8));
    } else {
        put(108, 352.0f);
        head[123] = 2;
        head.replace(344, 4, std::string("n+1\0", 4));
    }
    WrittenVolume halved = v;
    for (std::int16_t& value : halved.hu) value = static_cast<std::int16_t>((value + 1000) / 2);
    return head + samples(halved, style.swapped);
}

std::string inv3_tar(const WrittenVolume& v) {
    const std::string list = fmt::format(
        "<plist><dict><key>matrix</key><dict><key>dtype</key><string>int16</string><key>filename</key>"
        "<string>matrix.dat</string><key>shape</key><array><integer>{}</integer><integer>{}</integer><integer>{}</"
        "integer>"
        "</array></dict><key>spacing</key><array><real>{}</real><real>{}</real><real>{}</real></array></dict></plist>",
        v.size[2], v.size[1], v.size[0], glm::length(v.step[0]), glm::length(v.step[1]), glm::length(v.step[2]));
    return tar_entry("mask_0.dat", "not read") + tar_entry("matrix.dat", samples(v)) + tar_entry("main.plist", list) +
           std::string(1024, '\0');
}

std::string dicom_bytes(const WrittenVolume& v, int slice, const SliceStyle& style) {
    const std::size_t each = static_cast<std::size_t>(v.size[0]) * static_cast<std::size_t>(v.size[1]);
    std::string stored;
    for (std::size_t n = 0; n < each; ++n)
        stored += raw(static_cast<std::int16_t>(
            std::lround((v.hu[static_cast<std::size_t>(slice) * each + n] - style.intercept) / style.slope)));
    const std::string instance =
        style.instance.empty() ? fmt::format("{}.{}", style.series, slice + 1) : style.instance;
    const std::string kind = "1.2.840.10008.5.1.4.1.1.2";
    return with_preamble(element(8, 8, "CS", style.image_type) + element(8, 0x16, "UI", kind) +
                             element(8, 0x18, "UI", instance) + element(8, 0x60, "CS", "CT") +
                             element(8, 0x103e, "LO", "phantom") + element(0x20, 0x0e, "UI", style.series) +
                             element(0x20, 0x32, "DS", text_of(v.position(0, 0, slice) + style.shift)) +
                             element(0x20, 0x37, "DS", orientation_of(v)) + pixel_description(v, style.photometric, 1) +
                             element(0x28, 0x30, "DS", spacing_of(v)) + bits + short_number(0x28, 0x103, 1) +
                             element(0x28, 0x1052, "DS", fmt::format("{}", style.intercept)) +
                             element(0x28, 0x1053, "DS", fmt::format("{}", style.slope)) +
                             element(0x28, 0x1054, "LO", style.rescale_type) + element(0x7fe0, 0x10, "OW", stored),
                         kind);
}

std::string enhanced_dicom_bytes(const WrittenVolume& v) {
    const std::string kind = "1.2.840.10008.5.1.4.1.1.2.1";
    const Bytes shared = element(0x20, 0x9116, "SQ", item(element(0x20, 0x37, "DS", orientation_of(v)))) +
                         element(0x28, 0x9110, "SQ", item(element(0x28, 0x30, "DS", spacing_of(v)))) +
                         element(0x28, 0x9145, "SQ",
                                 item(element(0x28, 0x1052, "DS", "-1024") + element(0x28, 0x1053, "DS", "1") +
                                      element(0x28, 0x1054, "LO", "HU")));
    Bytes frames, stored;
    for (int k = v.size[2] - 1; k >= 0; --k)
        frames += item(element(0x20, 0x9113, "SQ", item(element(0x20, 0x32, "DS", text_of(v.position(0, 0, k))))));
    const std::size_t each = static_cast<std::size_t>(v.size[0]) * static_cast<std::size_t>(v.size[1]);
    for (int k = v.size[2] - 1; k >= 0; --k)
        for (std::size_t n = 0; n < each; ++n)
            stored += raw(static_cast<std::int16_t>(v.hu[static_cast<std::size_t>(k) * each + n] + 1024));
    return with_preamble(element(8, 8, "CS", "ORIGINAL\\PRIMARY\\VOLUME\\NONE") + element(8, 0x16, "UI", kind) +
                             element(8, 0x18, "UI", "1.2.9") + element(8, 0x60, "CS", "CT") +
                             element(0x20, 0x0e, "UI", "1.2.8") + pixel_description(v, "MONOCHROME2", v.size[2]) +
                             bits + short_number(0x28, 0x103, 1) + element(0x5200, 0x9229, "SQ", item(shared)) +
                             element(0x5200, 0x9230, "SQ", frames) + element(0x7fe0, 0x10, "OW", stored),
                         kind);
}

void write_dicom_folder(const WrittenVolume& volume, const std::filesystem::path& folder, const SliceStyle& style) {
    std::filesystem::create_directories(folder);
    for (int k = 0; k < volume.size[2]; ++k)
        file::write_whole_file(folder / fmt::format("{:03}.dcm", k * 37 % 101 * 10 + k / 101),
                               dicom_bytes(volume, k, style));
}

}  // namespace tactus
