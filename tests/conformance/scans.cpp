// SPDX-License-Identifier: Apache-2.0
// Scans: DICOM, NRRD, NIfTI, InVesalius, bone files, and formats that are not read.
#include "assets/file/whole_file.hpp"
#include "tests/assets/volume/dicom_changes.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/campaign/packed_dicom.hpp"
#include "tests/conformance/cases.hpp"
#include "tests/support/bone_files.hpp"
#include "tests/support/written_zip.hpp"

#include <bzlib.h>
#include <zlib.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

namespace tactus::conformance {

namespace {

using Bytes = std::string;
using Change = std::function<Bytes(Bytes)>;

constexpr std::array<int, 3> low{14, 9, 3}, high{30, 21, 8};  // voxels of the block of bone

/// A block of 1500 HU in air, not in the middle: a wrong place, order or direction shows. GDCM writes beyond its memory
/// when it compresses images of a few samples.
WrittenVolume block() {
    WrittenVolume v;
    v.size = {48, 40, 12};
    v.step = Mat3(Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.75, 0.0), Vec3(0.0, 0.0, 2.0));
    v.origin = {-10.5, 20.25, -100.0};
    const auto index = [&](double at, int axis) { return (at - v.origin[axis]) / v.step[axis][axis]; };
    v.fill([&](const Vec3& p) {
        for (int axis = 0; axis < 3; ++axis) {
            const double at = index(p[axis], axis);
            if (at < low[std::size_t(axis)] - 0.5 || at > high[std::size_t(axis)] + 0.5) return -1000.0;
        }
        return 1500.0;
    });
    return v;
}

/// The bounds of the block are those of the file that was written: its places, directions, order and values are right.
std::string is_block(const Json& found, double tolerance) {
    const WrittenVolume v = block();
    if (found["size"] != Json(v.size)) return "the size is " + found["size"].dump();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int n = int(axis);
        if (auto fault = differs("a spacing", found["spacing_mm"][axis], v.step[n][n]); !fault.empty()) return fault;
        const std::array<double, 2> wanted{v.origin[n] + (low[axis] - 0.5) * v.step[n][n],
                                           v.origin[n] + (high[axis] + 0.5) * v.step[n][n]};
        for (std::size_t end = 0; end < 2; ++end)
            if (std::abs(found["components"][0]["bounds_mm"][axis][end].get<double>() - wanted[end]) > 1e-3)
                return "the bounds are " + found["components"].dump();
    }
    if (std::abs(found["range"][0].get<double>() + 1000.0) > tolerance ||
        std::abs(found["range"][1].get<double>() - 1500.0) > tolerance)
        return "the values are " + found["range"].dump();
    return "";
}

std::string same_block(const Json& found) { return is_block(found, 0.6); }
std::string nearly_same_block(const Json& found) { return is_block(found, 60.0); }

Check of_kind(const std::string& kind) {
    return [kind](const Json& found) {
        const std::string seen = found["kind"].get<std::string>();
        return seen == kind ? "" : fmt::format("kind is {}", seen);
    };
}

// DICOM

/// A folder of slices, each changed by its number.
std::function<void(const fs::path&)> slices(const std::function<Bytes(int, Bytes)>& change,
                                            const SliceStyle& style = {}) {
    return [=](const fs::path& path) {
        const WrittenVolume v = block();
        fs::create_directories(path);
        for (int k = 0; k < v.size[2]; ++k)
            file::write_whole_file(path / fmt::format("{:02}.dcm", k), change(k, dicom_bytes(v, k, style)));
    };
}
std::function<void(const fs::path&)> all_slices(const Change& change) {
    return slices([=](int, Bytes bytes) { return change(std::move(bytes)); });
}
std::function<void(const fs::path&)> one_slice(const Change& change) {
    return slices([=](int k, Bytes bytes) { return k == 4 ? change(std::move(bytes)) : bytes; });
}
std::function<void(const fs::path&)> plain_slices() {
    return all_slices([](Bytes bytes) { return bytes; });
}
/// The same, and more files beside them.
std::function<void(const fs::path&)> slices_and(const std::function<void(const fs::path&)>& more) {
    return [=](const fs::path& path) {
        plain_slices()(path);
        more(path);
    };
}

Change value(unsigned group, unsigned number, const std::string& text) {
    return [=](Bytes bytes) { return with_value(std::move(bytes), group, number, [&](auto&&) { return text; }); };
}
Change short_value(unsigned group, unsigned number, unsigned number_in_it) {
    return value(group, number, {char(number_in_it & 0xff), char(number_in_it >> 8)});
}

std::uint32_t number_at(const Bytes& bytes, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    std::memcpy(&value, &bytes[at], size);
    return value;
}

Bytes number_bytes(std::uint32_t value, std::size_t size, bool big) {
    Bytes out(reinterpret_cast<const char*>(&value), size);
    if (big) std::ranges::reverse(out);
    return out;
}

/// The elements of an explicit data set, written implicit or big-endian. No sequence has an undefined length.
Bytes encoded(const Bytes& set, bool is_implicit, bool big) {
    Bytes out;
    for (std::size_t at = 0; at + 8 <= set.size();) {
        out += number_bytes(number_at(set, at, 2), 2, big) + number_bytes(number_at(set, at + 2, 2), 2, big);
        const bool is_item = number_at(set, at, 2) == 0xfffe;
        const Bytes kind = is_item ? Bytes() : set.substr(at + 4, 2);
        const bool is_long = kind == "OB" || kind == "OW" || kind == "SQ" || kind == "UN" || kind == "UT";
        const std::size_t size =
            is_item || is_long ? number_at(set, at + (is_item ? 4 : 8), 4) : number_at(set, at + 6, 2);
        const std::size_t start = at + (is_long ? 12 : 8);
        Bytes content = set.substr(start, size);
        if (is_item || kind == "SQ") content = encoded(content, is_implicit, big);
        else if (big && (kind == "OW" || kind == "US"))
            for (std::size_t n = 0; n + 1 < content.size(); n += 2) std::swap(content[n], content[n + 1]);
        const auto length = std::uint32_t(content.size());
        if (is_item || is_implicit) out += number_bytes(length, 4, big);
        else if (is_long) out += kind + Bytes(2, '\0') + number_bytes(length, 4, big);
        else out += kind + number_bytes(length, 2, big);
        out += content;
        at = start + size;
    }
    return out;
}

/// A file with another transfer syntax, whose UID has the length of the old one: 1.2.840.10008.1.2 and two zeros, or
/// 1.2.840.10008.1.2.2.
Bytes with_syntax(Bytes file, const Bytes& uid, const Change& change) {
    const Bytes plain("1.2.840.10008.1.2.1\0", 20);
    const std::size_t at = file.find(plain);
    if (at == Bytes::npos) throw std::logic_error("there is no transfer syntax");
    const std::size_t body = at + plain.size();
    Bytes padded = uid;
    padded.resize(plain.size(), '\0');
    file.replace(at, plain.size(), padded);
    return file.substr(0, body) + change(file.substr(body));
}
Bytes as_implicit(Bytes bytes) {
    // Two zeros more than the UID needs: written with its own length.
    Bytes file =
        with_syntax(std::move(bytes), "1.2.840.10008.1.2", [](const Bytes& set) { return encoded(set, true, false); });
    const std::size_t at = file.find("1.2.840.10008.1.2\0\0\0");
    file.erase(at + 18, 2);
    file[at - 2] = 18;
    file[140] = char(file[140] - 2);
    return file;
}
Bytes as_big(Bytes bytes) {
    return with_syntax(std::move(bytes), "1.2.840.10008.1.2.2",
                       [](const Bytes& set) { return encoded(set, false, true); });
}

std::function<void(const fs::path&)> packed_slices(const std::string& kind) {
    return [=](const fs::path& path) {
        plain_slices()(path / "../plain");
        fs::create_directories(path);
        for (const auto& entry : fs::directory_iterator(path / "../plain"))
            campaign::pack_dicom(entry.path(), path / entry.path().filename(), kind);
        fs::remove_all(path / "../plain");
    };
}

Bytes without_samples(const Bytes& bytes) { return bytes.substr(0, bytes.find(tag_bytes(0x7fe0, 0x10), 132)); }

Bytes without_rescale(Bytes bytes) {
    const std::size_t from = bytes.find(tag_bytes(0x28, 0x1052), 132), to = bytes.find(tag_bytes(0x7fe0, 0x10), 132);
    return bytes.erase(from, to - from);
}

/// Unsigned, with 63536 in the first row, which lies outside of the field of view.
Bytes padded(Bytes bytes) {
    bytes = short_value(0x28, 0x103, 0)(std::move(bytes));
    const std::size_t samples = bytes.size() - std::size_t{48 * 40 * 2};
    for (std::size_t n = 0; n < 48; ++n) bytes.replace(samples + 2 * n, 2, "\x30\xf8");
    return bytes;
}
Bytes padded_and_stated(const Bytes& file) {
    Bytes bytes = padded(file);
    return bytes.insert(bytes.find(tag_bytes(0x28, 0x1052), 132), tag_bytes(0x28, 0x120) + Bytes("US\2\0\x30\xf8", 6));
}

/// All slices as frames that have the position of the first, as cone-beam scanners write.
Bytes stacked_frames(bool has_spacing) {
    const WrittenVolume v = block();
    Bytes bytes = dicom_bytes(v, 0);
    const auto insert = [&](unsigned group, unsigned number, const Bytes& element) {
        bytes.insert(bytes.find(tag_bytes(group, number), 132), element);
    };
    if (has_spacing)
        insert(0x20, 0xe,
               tag_bytes(0x18, 0x88) + Bytes("DS\4\0"
                                             "2.0 ",
                                             8));
    insert(0x28, 0x10,
           tag_bytes(0x28, 8) + Bytes("IS\2\0"
                                      "12",
                                      6));
    const std::size_t samples = bytes.find(tag_bytes(0x7fe0, 0x10), 132);
    Bytes all;
    for (int k = 0; k < v.size[2]; ++k) {
        const Bytes slice = dicom_bytes(v, k);
        all += slice.substr(slice.size() - std::size_t{48 * 40 * 2});
    }
    return bytes.substr(0, samples) + tag_bytes(0x7fe0, 0x10) + Bytes("OW\0\0", 4) +
           number_bytes(std::uint32_t(all.size()), 4, false) + all;
}

/// The position of each slice moved along the normal by its number.
std::function<void(const fs::path&)> moved_slices(const std::function<double(int)>& shift, int missing = -1) {
    return [=](const fs::path& path) {
        const WrittenVolume v = block();
        fs::create_directories(path);
        for (int k = 0; k < v.size[2]; ++k) {
            SliceStyle style;
            style.shift.z = shift(k);
            if (k != missing) file::write_whole_file(path / fmt::format("{:02}.dcm", k), dicom_bytes(v, k, style));
        }
    };
}

void write_tilted(const fs::path& path, double degrees) {
    WrittenVolume v = block();
    const double angle = degrees * 3.14159265358979 / 180.0;
    v.step[1] = 0.75 * Vec3(0.0, std::cos(angle), std::sin(angle));
    write_dicom_folder(v, path);
}

void write_split(const fs::path& path) {
    const WrittenVolume v = block();
    fs::create_directories(path);
    for (int k = 0; k < v.size[2]; ++k) {
        SliceStyle style;
        style.series = k < 6 ? "1.2.3.4" : "1.2.3.77";
        file::write_whole_file(path / fmt::format("{:02}.dcm", k), dicom_bytes(v, k, style));
    }
}

WrittenVolume labelled() {
    WrittenVolume v = block();
    for (std::int16_t& value : v.hu) value = std::int16_t(value > 0 ? 1 : 0);
    return v;
}

Bytes segmentation() {
    WrittenVolume v = block();
    return one_bit_segmentation(v);
}

std::string is_segmentation(const Json& found) {
    if (found["kind"] != "labels") return "kind is " + found["kind"].dump();
    const double voxels = 17.0 * 13.0 * 6.0;
    return differs("the volume", found["components"][0]["volume_mm3"], voxels * 0.5 * 0.75 * 2.0);
}

Format dicom() {
    SliceStyle inverted, scanner, other_series, scout;
    inverted.photometric = "MONOCHROME1";
    scanner.rescale_type = "US";
    other_series.series = "1.2.3.99";
    scout.image_type = "ORIGINAL\\PRIMARY\\LOCALIZER";
    scout.shift = Vec3(50.0, 0.0, 3.3);
    const auto commas = [](Bytes bytes) {
        const auto change = [](Bytes text) {
            std::ranges::replace(text, '.', ',');
            return text;
        };
        return with_value(with_value(std::move(bytes), 0x28, 0x30, change), 0x20, 0x32, change);
    };
    const Bytes colour = short_value(0x28, 2, 3)(dicom_bytes(block(), 0));
    const Bytes compressed_segmentation =
        with_syntax(segmentation(), "1.2.840.10008.1.2.5", [](const Bytes& set) { return set; });
    std::vector<Case> cases{
        {"a folder of slices", "ct", plain_slices()},
        {"one slice, whose folder has the others", "ct/00.dcm",
         [](const fs::path& path) { plain_slices()(path.parent_path()); }},
        {"a zip of slices", "ct.zip",
         [](const fs::path& path) {
             std::vector<std::pair<std::string, std::string>> files{{"readme.txt", "not DICOM"}};
             for (int k = 0; k < 12; ++k) files.emplace_back(fmt::format("study/{}.dcm", k), dicom_bytes(block(), k));
             test::write_zip(path, files);
         }},
        {"an enhanced file", "ct.dcm", bytes(enhanced_dicom_bytes(block()))},
        {"implicit", "ct", all_slices(as_implicit)},
        {"an enhanced file, implicit", "ct.dcm", bytes(as_implicit(enhanced_dicom_bytes(block())))},
        {"big endian", "ct", all_slices(as_big)},
        {"deflated", "ct", all_slices(deflated)},
        {"RLE", "ct", packed_slices("rle")},
        {"JPEG, lossless", "ct", packed_slices("jpeg")},
        {"JPEG-LS, lossless", "ct", packed_slices("jpeg_ls")},
        {"JPEG 2000, lossless", "ct", packed_slices("j2k")},
        {"JPEG 2000, lossy", "ct", packed_slices("j2k_lossy"), Result::read, "", {}, nearly_same_block},
        {"no preamble", "ct", all_slices([](Bytes bytes) { return bytes.substr(132); })},
        {"private elements of unknown kind and undefined length (CP-246)", "ct", all_slices(with_unknown_sequence)},
        {"zeros behind the last element", "ct", all_slices([](Bytes bytes) { return bytes + Bytes(64, '\0'); })},
        {"pixel spacing as unlimited text (UT)", "ct", all_slices(with_spacing_as_text)},
        {"inverted display (MONOCHROME1)", "ct", slices([](int, Bytes b) { return b; }, inverted), Result::note,
         "only the display is inverted"},
        {"numbers with decimal commas", "ct", all_slices(commas), Result::note, "decimal commas"},
        {"text where a number belongs", "ct", all_slices(value(0x28, 0x30, "2.5x\\2.5")), Result::refused,
         "(0028,0030)"},
        {"a segmentation (SEG) of one bit per sample",
         "seg.dcm",
         bytes(segmentation()),
         Result::read,
         "",
         {},
         is_segmentation},
        {"the same, compressed", "seg.dcm", bytes(compressed_segmentation), Result::refused, "compress"},
        {"a colour image beside the slices", "ct",
         slices_and([=](const fs::path& path) { file::write_whole_file(path / "screen.dcm", colour); }), Result::note,
         "1 colour image"},
        {"a scout view beside the slices", "ct", slices_and([=](const fs::path& path) {
             file::write_whole_file(path / "scout.dcm", dicom_bytes(block(), 1, scout));
         }),
         Result::note, "1 scout view"},
        {"colour images only", "ct",
         [=](const fs::path& path) {
             fs::create_directories(path);
             file::write_whole_file(path / "screen.dcm", colour);
         },
         Result::refused, "colour"},
        {"several series", "ct", slices_and([=](const fs::path& path) {
             for (int k = 0; k < 12; ++k)
                 file::write_whole_file(path / fmt::format("b{}.dcm", k), dicom_bytes(block(), k, other_series));
         }),
         Result::refused, "--series"},
        {"a scan that was split over two series", "ct", write_split, Result::refused, "--series 1.2.3.4,1.2.3.77"},
        {"the same", "ct", write_split, Result::note, "joined", {"--series", "1.2.3.4,1.2.3.77"}},
        {"a slice of another orientation", "ct", one_slice(value(0x20, 0x37, "0\\1\\0\\0\\0\\-1")), Result::refused,
         "different orientations"},
        {"a slice of another modality", "ct", one_slice(value(8, 0x60, "MR")), Result::refused, "is MR"},
        {"a slice of another pixel spacing", "ct", one_slice(value(0x28, 0x30, "0.75\\0.6")), Result::refused,
         "differ in pixel spacing"},
        {"a tilted gantry",
         "ct",
         [](const fs::path& path) { write_tilted(path, 12.0); },
         Result::read,
         "",
         {},
         [](const Json& found) { return differs("the tilt", found["tilt_deg"], 12.0, 1e-3); }},
        {"a gantry tilted by more than 70 degrees", "ct", [](const fs::path& path) { write_tilted(path, 80.0); },
         Result::refused, "70 degrees"},
        {"a rescale that differs from slice to slice", "ct",
         [](const fs::path& path) {
             fs::create_directories(path);
             for (int k = 0; k < 12; ++k) {
                 SliceStyle style;
                 style.slope = k % 2 == 0 ? 2.0 : 1.0, style.intercept = -1024.0 - 4.0 * k;
                 file::write_whole_file(path / fmt::format("{:02}.dcm", k), dicom_bytes(block(), k, style));
             }
         }},
        {"a rescale that a slice lacks", "ct", one_slice(without_rescale), Result::refused, "and 04.dcm none"},
        {"a rescale to other units in a slice", "ct", one_slice(value(0x28, 0x1054, "OD")), Result::refused, "in OD"},
        {"a rescale of several numbers", "ct", one_slice(value(0x28, 0x1052, "-1024\\-1000")), Result::refused,
         "several numbers"},
        {"a rescale slope of 0 in a slice", "ct", one_slice(value(0x28, 0x1053, "0")), Result::refused,
         "RescaleSlope of 0"},
        {"a rescale slope of 0 in all slices", "ct", all_slices(value(0x28, 0x1053, "0")), Result::note,
         "RescaleSlope is 0"},
        {"no samples", "ct", one_slice(without_samples), Result::refused, "04.dcm"},
        {"frames of one position, with a spacing between slices (cone-beam CT)", "ct.dcm", bytes(stacked_frames(true)),
         Result::note, "stacked"},
        {"the same without a spacing", "ct.dcm", bytes(stacked_frames(false)), Result::refused, "SpacingBetweenSlices"},
        {"padding that the header states (PixelPaddingValue)", "ct", all_slices(padded_and_stated), Result::note,
         "are padding"},
        {"padding that it does not state: one value above 32767", "ct", all_slices(padded), Result::note,
         "are padding"},
        {"samples that need more bits than are stored", "ct", all_slices([](Bytes file) {
             return short_value(0x28, 0x102, 11)(short_value(0x28, 0x101, 12)(padded(std::move(file))));
         }),
         Result::refused, "does not fit the 12 bits"},
        {"a missing slice", "ct", moved_slices([](int) { return 0.0; }, 5), Result::refused, "--fill-gaps"},
        {"the same", "ct", moved_slices([](int) { return 0.0; }, 5), Result::note, "interpolated", {"--fill-gaps"}},
        {"a spacing that changes once",
         "ct",
         moved_slices([](int k) { return k < 6 ? 0.0 : 2.0 * (k - 6); }),
         Result::note,
         "interpolated",
         {},
         [](const Json& found) {
             if (found["uniform"] == true) return std::string("the slices count as even");
             return differs("the highest value", found["range"][1], 1500.0);
         }},
        {"a slice beside the line of the others", "ct", slices_and([](const fs::path& path) {
             SliceStyle beside;
             beside.shift.x = 0.7;
             file::write_whole_file(path / "05.dcm", dicom_bytes(block(), 5, beside));
         }),
         Result::refused, "off the line"},
        {"two equal images at one position", "ct",
         slices_and([](const fs::path& path) { fs::copy_file(path / "03.dcm", path / "copy.dcm"); }), Result::note,
         "duplicate"},
        {"two different images at one position", "ct", slices_and([](const fs::path& path) {
             WrittenVolume other = block();
             for (std::int16_t& value : other.hu) value = std::int16_t(value + 10);
             file::write_whole_file(path / "copy.dcm", dicom_bytes(other, 3));
         }),
         Result::refused, "at the same position"},
        {"cut short", "ct", one_slice([](const Bytes& file) { return file.substr(0, file.size() - 500); }),
         Result::refused, "04.dcm"},
        {"numbers of a scanner without HU (RescaleType US)",
         "ct",
         slices([](int, Bytes b) { return b; }, scanner),
         Result::note,
         "the values are not HU",
         {},
         [](const Json& found) { return found["hu"] == "scanner" ? "" : "hu is " + found["hu"].dump(); }},
    };
    return {"DICOM", {"info", "FILE", "--json"}, {}, same_block, std::move(cases)};
}

// NRRD

/// The header with a line replaced or, if there is none of its field, added.
Bytes nrrd_with(const Bytes& line, Bytes file = nrrd_bytes(block())) {
    const Bytes field = line.substr(0, line.find(':') + 1);
    const std::size_t at = file.find("\n" + field), end = file.find("\n\n");
    if (at < end) return file.replace(at + 1, file.find('\n', at + 1) - at - 1, line);
    return file.insert(end, "\n" + line);
}
Bytes nrrd_without(const Bytes& field, Bytes file = nrrd_bytes(block())) {
    const std::size_t at = file.find("\n" + field + ":");
    return file.erase(at, file.find('\n', at + 1) - at);
}
std::pair<Bytes, Bytes> header_and_samples(const Bytes& file) {
    const std::size_t end = file.find("\n\n") + 2;
    return {file.substr(0, end), file.substr(end)};
}
/// The header with an encoding, and its samples packed by it.
Bytes encoded_nrrd(const std::string& encoding, const std::function<Bytes(const Bytes&)>& pack) {
    const auto [header, samples] = header_and_samples(nrrd_with("encoding: " + encoding));
    return header + pack(samples);
}

Bytes gzipped(const Bytes& bytes) {
    Bytes out(compressBound(uLong(bytes.size())) + 64, '\0');
    z_stream stream{};
    if (deflateInit2(&stream, 6, Z_DEFLATED, 31, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::runtime_error("zlib");
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = uInt(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = uInt(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

Bytes bzipped(const Bytes& bytes) {
    Bytes out(bytes.size() + 1000, '\0'), copy = bytes;
    auto size = unsigned(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &size, copy.data(), unsigned(copy.size()), 9, 0, 0);
    return out.substr(0, size);
}

Bytes as_text(const Bytes&) {
    Bytes out;
    for (const std::int16_t value : block().hu) out += fmt::format("{}\n", value);
    return out;
}
Bytes as_hex(const Bytes& bytes) {
    Bytes out;
    for (const char c : bytes) out += fmt::format("{:02x}", static_cast<unsigned char>(c));
    return out;
}
Bytes swapped(Bytes bytes) {
    for (std::size_t n = 0; n + 1 < bytes.size(); n += 2) std::swap(bytes[n], bytes[n + 1]);
    return bytes;
}
Bytes with_carriage_returns(const Bytes& file) {
    const auto [header, samples] = header_and_samples(file);
    Bytes out;
    for (const char c : header) out += c == '\n' ? Bytes("\r\n") : Bytes(1, c);
    return out + samples;
}
/// Floating-point samples by a function of their number.
Bytes float_nrrd(const std::function<float(std::size_t, std::int16_t)>& value_of) {
    const WrittenVolume v = block();
    Bytes out = header_and_samples(nrrd_with("type: float")).first;
    for (std::size_t n = 0; n < v.hu.size(); ++n) {
        const float value = value_of(n, v.hu[n]);
        out.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return out;
}
Bytes layered_segments() {
    Bytes out =
        "NRRD0004\ntype: unsigned char\ndimension: 4\nsizes: 2 16 16 16\nspace: left-posterior-superior\n"
        "kinds: list domain domain domain\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
        "encoding: raw\nSegment0_ID:=a\nSegment0_Name:=Jaw\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
        "Segment1_ID:=b\nSegment1_Name:=Tooth\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n\n";
    for (int n = 0; n < 16 * 16 * 16; ++n) {
        const auto within = [n](int from, int to) {
            const std::array at{n % 16, n / 16 % 16, n / 256};
            return std::ranges::all_of(at, [&](int i) { return i >= from && i < to; });
        };
        out += char(within(2, 14)), out += char(within(5, 11));
    }
    return out;
}

Format nrrd() {
    const Bytes plain = nrrd_bytes(block());
    const auto detached = [=](const Bytes& line, const std::vector<std::pair<Bytes, Bytes>>& files) {
        return [=](const fs::path& path) {
            file::write_whole_file(path, header_and_samples(nrrd_with(line)).first);
            for (const auto& [name, content] : files) file::write_whole_file(path.parent_path() / name, content);
        };
    };
    const Bytes samples = header_and_samples(plain).second;
    std::vector<std::pair<Bytes, Bytes>> per_slice;
    Bytes list = "data file: LIST";
    for (std::size_t k = 0; k < 12; ++k) {
        per_slice.emplace_back(fmt::format("s{:02}.raw", k), samples.substr(k * 48 * 40 * 2, 48 * 40 * 2));
        list += "\n" + per_slice.back().first;
    }
    const auto single_axis = [&] {
        Bytes file = nrrd_with("sizes: 48 40 1 12", nrrd_with("dimension: 4"));
        file = nrrd_with("space directions: (0.5,0,0) (0,0.75,0) none (0,0,2)", std::move(file));
        return nrrd_with("space units: \"mm\" \"mm\" \"mm\"", std::move(file));
    }();
    const Bytes ras = [&] {
        Bytes file = nrrd_with("space: right-anterior-superior");
        file = nrrd_with("space directions: (-0.5,0,0) (0,-0.75,0) (0,0,2)", std::move(file));
        return nrrd_with("space origin: (10.5,-20.25,-100)", std::move(file));
    }();
    const Bytes las = [&] {
        Bytes file = nrrd_with("space: left-anterior-superior");
        file = nrrd_with("space directions: (0.5,0,0) (0,-0.75,0) (0,0,2)", std::move(file));
        return nrrd_with("space origin: (-10.5,-20.25,-100)", std::move(file));
    }();
    Bytes skipped = nrrd_with("byte skip: 3", nrrd_with("line skip: 2"));
    skipped.insert(skipped.find("\n\n") + 2, "one line\nanother\nabc");
    const auto labels = [](std::size_t, std::int16_t hu) { return hu > 0 ? 1.0f : 0.0f; };
    return {
        "NRRD",
        {"info", "FILE", "--json"},
        {},
        same_block,
        {
            {"raw samples", "ct.nrrd", bytes(plain)},
            {"a name in capitals (`CT.NRRD`)", "CT.NRRD", bytes(plain)},
            {"big endian", "ct.nrrd", bytes([&] {
                 const auto [header, rest] = header_and_samples(nrrd_with("endian: big"));
                 return header + swapped(rest);
             }())},
            {"text", "ct.nrrd", bytes(encoded_nrrd("ascii", as_text))},
            {"hexadecimal digits", "ct.nrrd", bytes(encoded_nrrd("hex", as_hex))},
            {"gzip", "ct.nrrd", bytes(encoded_nrrd("gzip", gzipped))},
            {"bzip2", "ct.nrrd", bytes(encoded_nrrd("bzip2", bzipped))},
            {"lines that end with CR LF", "ct.nrrd", bytes(with_carriage_returns(plain))},
            {"samples in another file", "ct.nhdr", detached("data file: ct.raw", {{"ct.raw", samples}})},
            {"in a list of files", "ct.nhdr", detached(list, per_slice)},
            {"in numbered files", "ct.nhdr", detached("data file: s%02d.raw 0 11 1", per_slice)},
            {"in another file that is missing", "ct.nhdr", detached("data file: ct.raw", {}), Result::refused,
             "ct.raw"},
            {"behind lines and bytes to skip", "ct.nrrd", bytes(skipped)},
            {"space RAS", "ct.nrrd", bytes(ras)},
            {"space LAS", "ct.nrrd", bytes(las)},
            {"no space", "ct.nrrd", bytes(nrrd_without("space")), Result::refused, "space"},
            {"a fourth axis of one sample", "ct.nrrd", bytes(single_axis), Result::note, "fourth axis"},
            {"more samples along a fourth axis", "ct.nrrd",
             bytes(nrrd_with(
                 "sizes: 48 40 2 6",
                 nrrd_with("dimension: 4", nrrd_with("space directions: (0.5,0,0) (0,0.75,0) none (0,0,2)")))),
             Result::refused, "axes"},
            {"no space origin",
             "ct.nrrd",
             bytes(nrrd_without("space origin")),
             Result::note,
             "no space origin",
             {},
             of_kind("ct")},
            {"an infinite space origin", "ct.nrrd", bytes(nrrd_with("space origin: (0,inf,0)")), Result::refused,
             "origin is not a place"},
            {"a spacing of 0", "ct.nrrd", bytes(nrrd_with("space directions: (0,0,0) (0,0.75,0) (0,0,2)")),
             Result::refused, "ct.nrrd"},
            {"space units other than mm", "ct.nrrd", bytes(nrrd_with("space units: \"cm\" \"cm\" \"cm\"")),
             Result::refused, "not mm"},
            {"a field that comes twice", "ct.nrrd", bytes(Bytes(plain).insert(9, "type: short\n")), Result::refused,
             "comes twice"},
            {"an unknown type", "ct.nrrd", bytes(nrrd_with("type: shrt")), Result::refused, "'shrt' is unknown"},
            {"an unknown encoding", "ct.nrrd", bytes(nrrd_with("encoding: rar")), Result::refused, "'rar' is unknown"},
            {"cut short", "ct.nrrd", bytes(plain.substr(0, plain.size() - 100)), Result::refused, "cut short"},
            {"segments in layers (`.seg.nrrd`)",
             "s.seg.nrrd",
             bytes(layered_segments()),
             Result::note,
             "layer",
             {},
             [](const Json& found) -> std::string {
                 if (found["components"].size() != 2) return "the segments are " + found["components"].dump();
                 return differs("the inner one", found["components"][1]["volume_mm3"], 216.0);
             }},
            {"a voxel that is not a number", "ct.nrrd",
             bytes(float_nrrd([](std::size_t n, std::int16_t hu) { return n == 7 ? std::nanf("") : float(hu); })),
             Result::note, "not numbers"},
            {"no voxel that is a number", "ct.nrrd",
             bytes(float_nrrd([](std::size_t, std::int16_t) { return std::nanf(""); })), Result::refused, "no voxel"},
            {"whole numbers, most of them 0: integers",
             "labels.nrrd",
             bytes(nrrd_bytes(labelled())),
             Result::read,
             "",
             {},
             of_kind("labels")},
            {"the same as floating-point numbers",
             "labels.nrrd",
             bytes(float_nrrd(labels)),
             Result::note,
             "label",
             {},
             of_kind("labels?")},
        }};
}

// NIfTI

template <class T>
Bytes nifti_with(std::size_t at, T number, Bytes file = nifti_bytes(block())) {
    std::memcpy(&file[at], &number, sizeof number);
    return file;
}

Format nifti() {
    const Bytes plain = nifti_bytes(block());
    const auto pair = [=](const fs::path& path) {
        Bytes header = plain.substr(0, 348);
        header.replace(344, 3, "ni1");
        header.replace(108, 4, Bytes(4, '\0'));
        file::write_whole_file(path.parent_path() / "ct.hdr", header);
        file::write_whole_file(path.parent_path() / "ct.img", plain.substr(352));
    };
    const auto of = [](const NiftiStyle& style) { return bytes(nifti_bytes(block(), style)); };
    // qform_code 1, and an offset of the quaternion's frame that is not the sform's.
    const Bytes both = nifti_with(252, std::int16_t{1}, nifti_with(268, 7.0f));
    const Bytes quaternion = nifti_bytes(block(), {.quaternion = true});
    Bytes analyze = plain.substr(0, 348);
    analyze.replace(344, 4, Bytes(4, '\0'));
    analyze.replace(252, 4, Bytes(4, '\0'));
    Bytes unscaled = nifti_with(112, 0.0f);
    return {
        "NIfTI",
        {"info", "FILE", "--json"},
        {},
        same_block,
        {
            {"NIfTI-1", "ct.nii", bytes(plain)},
            {"a name in capitals (`CT.NII`)", "CT.NII", bytes(plain)},
            {"NIfTI-1, big endian", "ct.nii", of({.swapped = true})},
            {"NIfTI-2", "ct.nii", of({.second = true})},
            {"gzip", "ct.nii.gz", bytes(gzipped(plain))},
            {"a pair, by its header", "ct.hdr", pair},
            {"a pair, by its samples", "ct.img", pair},
            {"half of a pair", "ct.hdr",
             [=](const fs::path& path) {
                 pair(path);
                 fs::remove(path.parent_path() / "ct.img");
             },
             Result::refused, "ct.img"},
            {"a qform alone", "ct.nii", of({.quaternion = true})},
            {"sform and qform that differ", "ct.nii", bytes(both), Result::note, "the sform is used"},
            {"neither sform nor qform", "ct.nii", bytes(nifti_with(254, std::int16_t{0})), Result::refused, "ct.nii"},
            {"Analyze 7.5", "ct.hdr",
             [=](const fs::path& path) {
                 pair(path);
                 file::write_whole_file(path, analyze);
             },
             Result::refused, "Analyze"},
            {"a quaternion longer than 1", "ct.nii", bytes(nifti_with(256, 1.2f, quaternion)), Result::refused,
             "has a length of"},
            {"a negative spacing beside a qform", "ct.nii", bytes(nifti_with(84, -0.75f, quaternion)), Result::refused,
             "spacing along axis 1"},
            {"an offset that is not a number", "ct.nii", bytes(nifti_with(268, INFINITY, quaternion)), Result::refused,
             "not a number"},
            {"a scale of 0: none",
             "ct.nii",
             bytes(unscaled),
             Result::read,
             "",
             {},
             [](const Json& found) { return differs("the highest value", found["range"][1], 1250.0); }},
            {"several volumes", "ct.nii", bytes(nifti_with(40, std::int16_t{4}, nifti_with(48, std::int16_t{2}))),
             Result::refused, "2 volumes"},
            {"colours", "ct.nii", bytes(nifti_with(70, std::int16_t{128})), Result::refused, "type 128"},
            {"complex numbers", "ct.nii", bytes(nifti_with(70, std::int16_t{32})), Result::refused, "type 32"},
            {"cut short", "ct.nii", bytes(plain.substr(0, plain.size() - 100)), Result::refused, "ct.nii"},
        }};
}

// Others

void write_bone(const fs::path& path) {
    file::write_whole_file(path.parent_path() / "ct.nrrd", nrrd_bytes(block()));
    by_command(path, {"import", "ct.nrrd", "-o", path.filename().string()});
}
std::function<void(const fs::path&)> changed_bone(const Change& change) {
    return [=](const fs::path& path) {
        write_bone(path);
        file::write_whole_file(path, change(file::read_whole_file(path)));
    };
}

Format invesalius() {
    return {"InVesalius",
            {"info", "FILE", "--json"},
            {},
            of_kind("ct"),
            {{"a project (`.inv3`)",
              "ct.inv3",
              bytes(gzipped(inv3_tar(block()))),
              Result::note,
              "no patient position",
              {},
              [](const Json& found) { return differs("the highest value", found["range"][1], 1500.0); }},
             {"cut short", "ct.inv3", bytes([] {
                  const Bytes whole = gzipped(inv3_tar(block()));
                  return whole.substr(0, whole.size() / 2);
              }()),
              Result::refused, "ct.inv3"}}};
}

Format bone_file() {
    return {"bone file",
            {"info", "FILE", "--json"},
            {},
            [](const Json& found) {
                return found["kind"] == "bone"
                           ? differs("the volume", found["components"][0]["volume_mm3"], 8.5 * 9.75 * 12.0, 0.05)
                           : "kind is " + found["kind"].dump();
            },
            {{"`.vdb` of `import`", "bone.vdb", write_bone},
             {"the same in capitals (`BONE.VDB`)", "BONE.VDB",
              [](const fs::path& path) {
                  write_bone(path.parent_path() / "bone.vdb");
                  fs::rename(path.parent_path() / "bone.vdb", path);
              }},
             {"a byte changed", "bone.vdb", changed_bone([](Bytes file) {
                  file[file.size() / 2] = char(~file[file.size() / 2]);
                  return file;
              }),
              Result::refused, "bone.vdb"},
             {"cut short", "bone.vdb", changed_bone([](const Bytes& file) { return file.substr(0, file.size() / 2); }),
              Result::refused, "bone.vdb"},
             {"OpenVDB of another program", "bone.vdb",
              changed_bone([](const Bytes& file) { return file.substr(0, file.size() - 24); }), Result::refused,
              "bone.vdb"}}};
}

Format unread_scans() {
    const auto unread = [](const std::string& feature, const std::string& name, const Bytes& content) {
        return Case{feature, name, bytes(content), Result::refused, name};
    };
    return {
        "others",
        {"info", "FILE", "--json"},
        {},
        of_kind("ct"),
        {unread("MetaImage", "ct.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementDataFile = ct.raw\n"),
         unread("MetaImage in one file", "ct.mha", "ObjectType = Image\nNDims = 3\nElementDataFile = LOCAL\n"),
         unread("MINC 2, HDF5", "ct.mnc", "\x89HDF\r\n\x1a\n"), unread("an empty file", "ct.nrrd", ""),
         unread("text", "ct.txt", "some text\n")}};
}

}  // namespace

Table scan_table() {
    Table table{"scans", {dicom(), nrrd(), nifti(), invesalius(), bone_file(), unread_scans()}};
    for (Format& format : table.formats) format.notes = [](const Json& found) { return strings_of(found["notes"]); };
    // Those of a bone file are how it was made, not how it was read.
    for (Format& format : table.formats)
        if (format.name == "bone file") format.notes = [](const Json&) { return std::vector<std::string>{}; };
    return table;
}

}  // namespace tactus::conformance
