// SPDX-License-Identifier: Apache-2.0
#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/nrrd_header.hpp"
#include "assets/volume/readers.hpp"
#include "assets/volume/sample_stream.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <teem/nrrd.h>

#include <fmt/format.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace tactus::volume {

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

// Total size of the data files of a header, bytes.
double bytes_on_disk(const std::filesystem::path& path, const NrrdIoState& io) {
    std::error_code failure;
    double sum = 0.0;
    const auto add = [&](const std::filesystem::path& file) {
        const auto size = std::filesystem::file_size(file, failure);
        if (failure) throw Error(fmt::format("{}: its data file {} is missing", path.string(), file.string()));
        sum += static_cast<double>(size);
    };
    if (io.dataFNFormat)
        throw Error(fmt::format("{}: numbered data files are not supported; join them with 'unu'", path.string()));
    if (io.dataFNArr && io.dataFNArr->len > 0)
        for (unsigned n = 0; n < io.dataFNArr->len; ++n) add(path.parent_path() / io.dataFN[n]);
    else add(path);
    return sum;
}

// Lower bound of file bytes per sample for an encoding; deflate compresses at most 1032 to 1.
double least_bytes(const Nrrd& nrrd, const NrrdIoState& io) {
    const double size = static_cast<double>(nrrdTypeSize[nrrd.type]);
    if (io.encoding == nrrdEncodingGzip) return size / 1032.0;
    if (io.encoding == nrrdEncodingRaw) return size;
    if (io.encoding == nrrdEncodingAscii) return 1.5;
    if (io.encoding == nrrdEncodingHex) return 2.0 * size;
    return size / 10000.0;
}

// `first`: the first spatial axis; before it is the axis of the segmentation layers, if any.
void read_geometry(const Nrrd& nrrd, unsigned first, ScanVolume& volume, const std::string& file) {
    const bool is_ras = nrrd.space == nrrdSpaceRightAnteriorSuperior;
    if (!is_ras && nrrd.space != nrrdSpaceLeftPosteriorSuperior && nrrd.space != nrrdSpaceLeftAnteriorSuperior)
        throw Error(
            fmt::format("{}: no usable 'space' (the patient's directions are unknown); write "
                        "'space: left-posterior-superior', 'space directions' and 'space origin' into the header",
                        file));
    for (unsigned n = 0; n < 3; ++n)
        if (nrrd.spaceUnits[n] && *nrrd.spaceUnits[n] && std::string_view(nrrd.spaceUnits[n]) != "mm")
            throw Error(
                fmt::format("{}: space units '{}' are not mm; convert the header to mm", file, nrrd.spaceUnits[n]));
    SampleMap<Frame::lps> map;
    for (unsigned n = 0; n < 3; ++n) {
        const double flip = nrrd.space == nrrdSpaceLeftAnteriorSuperior && n == 1 ? -1e-3 : 1e-3;
        const auto row = static_cast<int>(n);
        for (unsigned axis = 0; axis < 3; ++axis)
            map.step[static_cast<int>(axis)][row] = nrrd.axis[first + axis].spaceDirection[n] * flip;
        map.origin[row] = nrrd.spaceOrigin[n] * flip;
    }
    if (!is_finite(map.origin)) {
        map.origin = Vec3(0.0);
        volume.notes.push_back("the file states no space origin: its first voxel was placed at 0");
    }
    volume.map = is_ras ? to_lps(SampleMap<Frame::ras>{map.step, map.origin}) : map;
    volume.file_frame = is_ras ? Frame::ras : Frame::lps;
    volume.unit_stated = nrrd.spaceUnits[0] && *nrrd.spaceUnits[0];
    check_map(volume.map, file);
}

std::string value_of(const Nrrd& nrrd, const std::string& key) {
    char* text = nrrdKeyValueGet(&nrrd, key.c_str());
    std::string value = text ? text : "";
    std::free(text);
    return value;
}

struct Layered {
    Segment segment;
    int layer = 0;
    int label = 0;  // in its layer
};

// Segments as 3D Slicer describes them in a .seg.nrrd: Segment0_Name, Segment0_LabelValue, Segment0_Color, ...
std::vector<Layered> segments_of(const Nrrd& nrrd) {
    std::vector<Layered> found;
    for (int n = 0; n < 100000; ++n) {
        const std::string prefix = fmt::format("Segment{}_", n), label = value_of(nrrd, prefix + "LabelValue");
        if (label.empty() && value_of(nrrd, prefix + "ID").empty()) break;
        Layered& entry = found.emplace_back();
        entry.segment.label = label.empty() ? n + 1 : std::atoi(label.c_str());
        entry.layer = std::atoi(value_of(nrrd, prefix + "Layer").c_str());
        entry.segment.name = value_of(nrrd, prefix + "Name");
        Vec3 c;
        if (std::sscanf(value_of(nrrd, prefix + "Color").c_str(), "%lf %lf %lf", &c.x, &c.y, &c.z) == 3 && is_finite(c))
            entry.segment.colour = glm::clamp(c, 0.0, 1.0);
    }
    return found;
}

void check_header(const Nrrd& header, const NrrdIoState& io, const std::filesystem::path& path, unsigned first) {
    const std::string file = path.string();
    if (nrrdTypeBlock == header.type) throw Error(fmt::format("{}: the samples are blocks, not numbers", file));
    std::array<std::int64_t, 3> size{};
    for (unsigned axis = 0; axis < 3; ++axis)
        size[axis] = static_cast<std::int64_t>(std::min<std::size_t>(header.axis[first + axis].size, 1u << 30));
    double count = 1.0;
    for (unsigned axis = 0; axis < header.dim; ++axis) count *= static_cast<double>(header.axis[axis].size);
    if (count * least_bytes(header, io) > bytes_on_disk(path, io) + 64.0)
        throw Error(
            fmt::format("{}: cut short: its header states {:.0f} voxels, more than the file can hold", file, count));
    checked_count(size, file);
    if (count > 2e9) throw Error(fmt::format("{}: too many samples in its layers: {:.0f}", file, count));
}

// Start of the samples in a file with attached header: after the first empty line.
std::uint64_t end_of_header(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string line;
    std::uint64_t at = 0;
    while (std::getline(file, line)) {
        at += line.size() + 1;
        if (line.empty() || line == "\r") return at;
    }
    throw Error(fmt::format("{}: cut short: the header has no end", path.string()));
}

std::optional<SampleType> type_of(int type) {
    switch (type) {
        case nrrdTypeChar: return SampleType{SampleType::int8};
        case nrrdTypeUChar: return SampleType{SampleType::uint8};
        case nrrdTypeShort: return SampleType{SampleType::int16};
        case nrrdTypeUShort: return SampleType{SampleType::uint16};
        case nrrdTypeInt: return SampleType{SampleType::int32};
        case nrrdTypeUInt: return SampleType{SampleType::uint32};
        case nrrdTypeLLong: return SampleType{SampleType::int64};
        case nrrdTypeULLong: return SampleType{SampleType::uint64};
        case nrrdTypeFloat: return SampleType{SampleType::float32};
        case nrrdTypeDouble: return SampleType{SampleType::float64};
        default: return {};
    }
}

// Start of the samples in a data file, after the skipped lines and bytes; `bytes`: length of unpacked samples.
std::uint64_t start_of_samples(const std::filesystem::path& path, std::uint64_t start, const NrrdIoState& io,
                               double bytes) {
    const auto cut_short = [&] { return Error(fmt::format("{}: cut short; copy the file again", path.string())); };
    if (io.lineSkip > 0) {
        std::ifstream file(path, std::ios::binary);
        file.seekg(static_cast<std::streamoff>(start));
        for (unsigned n = 0; n < io.lineSkip; ++n)
            if (!file.ignore(std::numeric_limits<std::streamsize>::max(), '\n') || file.eof()) throw cut_short();
        start = static_cast<std::uint64_t>(file.tellg());
    }
    if (io.encoding != nrrdEncodingRaw) return start;
    if (io.byteSkip >= 0) return start + static_cast<std::uint64_t>(io.byteSkip);
    // A negative skip counts from the end: -1 means that the samples end the file.
    const double from_end = static_cast<double>(std::filesystem::file_size(path)) - bytes + (double(io.byteSkip) + 1.0);
    if (from_end < static_cast<double>(start)) throw cut_short();
    return static_cast<std::uint64_t>(from_end);
}

// Streams the samples of raw or gzipped files: teem would load the whole file, and leaks zlib's buffers on damaged
// data. None for encodings that only teem reads.
std::optional<SampleStream> stream_of(const Nrrd& header, const NrrdIoState& io, const std::filesystem::path& path,
                                      std::size_t samples) {
    const bool is_gzip = io.encoding == nrrdEncodingGzip;
    const std::optional<SampleType> type = type_of(header.type);
    if (!type || (!is_gzip && io.encoding != nrrdEncodingRaw)) return {};
    const bool is_apart = io.dataFNArr && io.dataFNArr->len > 0;
    const std::size_t files = is_apart ? io.dataFNArr->len : 1;
    if (samples % files != 0)
        throw Error(fmt::format("{}: its samples cannot be divided evenly among {} data files", path.string(), files));
    if (is_gzip && io.byteSkip < 0)
        throw Error(
            fmt::format("{}: a negative byte skip needs an unpacked file; unpack it with 'unu save "
                        "-f nrrd -e raw'",
                        path.string()));
    const bool swapped = io.endian != airEndianUnknown && io.endian != airMyEndian() && type->bytes() > 1;
    std::vector<SampleStream::Piece> pieces;
    for (std::size_t n = 0; n < files; ++n) {
        SampleStream::Piece piece{is_apart ? path.parent_path() / io.dataFN[n] : path, 0, 0, samples / files};
        const double bytes = static_cast<double>(piece.samples) * static_cast<double>(type->bytes());
        piece.start = start_of_samples(piece.file, is_apart ? 0 : end_of_header(path), io, bytes);
        if (is_gzip) piece.skip = static_cast<std::uint64_t>(io.byteSkip);
        pieces.push_back(std::move(piece));
    }
    return SampleStream(std::move(pieces), *type, swapped, is_gzip);
}

// teem reads text numbers into a buffer of fixed size without checking their length.
void check_text(const std::filesystem::path& path, std::uint64_t start) {
    constexpr std::size_t longest = 500;
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(start));
    std::array<char, 1 << 16> block;
    std::size_t length = 0;
    do {
        leave_if_stopped();
        file.read(block.data(), block.size());
        for (const char c : std::span(block).first(static_cast<std::size_t>(file.gcount()))) {
            length = std::isspace(static_cast<unsigned char>(c)) ? 0 : length + 1;
            if (length > longest)
                throw Error(fmt::format("{}: a text number has more than {} characters", path.string(), longest));
        }
    } while (file);
}

class NrrdSlices final : public SliceReader {
public:
    explicit NrrdSlices(const std::filesystem::path& path) {
        const std::string file = path.string();
        check_nrrd_header(path);
        const NrrdPointer header(nrrdNew(), nrrdNuke);
        const IoPointer io(nrrdIoStateNew(), nrrdIoStateNix);
        nrrdIoStateSet(io.get(), nrrdIoStateSkipData, 1);
        if (nrrdLoad(header.get(), file.c_str(), io.get())) refuse(file);
        segments_ = segments_of(*header);
        unsigned first = header->dim == 4 && !segments_.empty() ? 1 : 0;
        bool has_single = false;
        if (header->dim == 4 && segments_.empty()) {
            has_single = header->axis[0].size == 1 || header->axis[3].size == 1;
            if (header->axis[0].size == 1 && header->axis[3].size > 1) first = 1;
        }
        if (header->dim != 3 + first && !has_single)
            throw Error(fmt::format("{}: has {} axes; a CT volume must have 3 (extract one frame with 'unu slice')",
                                    file, header->dim));
        about.format = "NRRD";
        about.source = path.filename().string();
        about.encoding = io->encoding->name;
        read_geometry(*header, first, about, file);
        check_header(*header, *io, path, first);
        for (unsigned axis = 0; axis < 3; ++axis) about.size[axis] = static_cast<int>(header->axis[first + axis].size);
        layers_ = first == 1 ? header->axis[0].size : 1;
        if (has_single) about.notes.push_back("a fourth axis of one sample was left out");
        integers_ = nrrdTypeIsIntegral[header->type] != 0;
        flatten_segments();
        stream_ = stream_of(*header, *io, path, about.count() * layers_);
        if (stream_) return;
        if (io->encoding == nrrdEncodingAscii) {
            const unsigned files = io->dataFNArr ? io->dataFNArr->len : 0;
            for (unsigned n = 0; n < files; ++n) check_text(path.parent_path() / io->dataFN[n], 0);
            if (files == 0) check_text(path, end_of_header(path));
        }
        read_by_teem(file);
    }

    void read(int k, std::span<float> values) override {
        const std::size_t first = static_cast<std::size_t>(k) * values.size() * layers_;
        if (layers_ == 1) return take(first, values);
        std::vector<float> layered(values.size() * layers_);
        take(first, layered);
        std::fill(values.begin(), values.end(), 0.0f);
        const bool counts = shown_ < 0 && k == counted_;
        for (std::size_t s = 0; s < segments_.size(); ++s) {
            const Layered& segment = segments_[s];
            if (shown_ >= 0 && segment.layer != shown_) continue;
            const auto label = static_cast<float>(segment.label), in_one = static_cast<float>(segment.segment.label);
            for (std::size_t n = 0; n < values.size(); ++n)
                if (layered[n * layers_ + static_cast<std::size_t>(segment.layer)] == label) {
                    if (counts) covered_ += values[n] != 0.0f;
                    values[n] = in_one;
                }
        }
        counted_ += counts;
    }

    int layer_count() const override { return static_cast<int>(layers_); }
    void show_layer(int layer) override { shown_ = layers_ > 1 ? layer : -1; }
    bool in_any_order() const override { return !stream_ || stream_->in_any_order(); }

    void settle(const Tally& tally) override {
        if (layers_ > 1 && shown_ < 0)
            about.notes.push_back(
                fmt::format("{} segment layers were merged into one label map, numbered from 1", layers_));
        if (covered_ > 0)
            about.notes.push_back(
                fmt::format("{} voxels lie in several segments; the last segment takes them", covered_));
        covered_ = 0;
        settle_meaning(about, tally, integers_);
    }

private:
    [[noreturn]] static void refuse(const std::string& file) {
        throw Error(fmt::format("{}: cannot be read as NRRD: {}", file, teem_message()));
    }

    // Overlapping segments are stored in layers; in one label map each gets its own number, and later segments
    // overwrite earlier ones.
    void flatten_segments() {
        for (std::size_t s = 0; s < segments_.size(); ++s) {
            Layered& segment = segments_[s];
            segment.label = segment.segment.label;
            if (layers_ > 1) {
                if (segment.layer < 0 || static_cast<std::size_t>(segment.layer) >= layers_)
                    throw Error(fmt::format("{}: segment {} is in layer {}, but there are {} layers", about.source, s,
                                            segment.layer, layers_));
                segment.segment.label = static_cast<int>(s) + 1;
            }
            about.segments.push_back(segment.segment);
        }
    }

    // Text and bzip2 are read at once.
    void read_by_teem(const std::string& file) {
        // The numbers in the type of the file, and as float.
        file::require_room(12.0 * double(about.count()) * double(layers_), file, "its samples");
        const NrrdPointer nrrd(nrrdNew(), nrrdNuke);
        if (nrrdLoad(nrrd.get(), file.c_str(), nullptr)) refuse(file);
        const auto lookup = nrrdFLookup[nrrd->type];
        whole_.resize(about.count() * layers_);
        for (std::size_t n = 0; n < whole_.size(); ++n) {
            if (n % (1 << 20) == 0) leave_if_stopped();
            whole_[n] = lookup(nrrd->data, n);
        }
    }

    void take(std::size_t first, std::span<float> values) {
        if (stream_) stream_->read(first, values);
        else std::copy_n(whole_.begin() + static_cast<std::ptrdiff_t>(first), values.size(), values.begin());
    }

    std::vector<Layered> segments_;
    std::optional<SampleStream> stream_;
    std::vector<float> whole_;
    std::size_t layers_ = 1, covered_ = 0;
    int shown_ = -1;   // layer; -1: all
    int counted_ = 0;  // slices whose overlapping voxels are counted
    bool integers_ = false;
};

}  // namespace

std::unique_ptr<SliceReader> open_nrrd(const std::filesystem::path& path) { return std::make_unique<NrrdSlices>(path); }

}  // namespace tactus::volume
