// SPDX-License-Identifier: Apache-2.0
#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/nrrd_header.hpp"
#include "assets/volume/readers.hpp"
#include "assets/volume/sample_stream.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace tactus::volume {

namespace {

// Total size of the data files of a header, bytes.
double bytes_on_disk(const std::filesystem::path& path, const NrrdHeader& header) {
    double sum = 0.0;
    for (const std::filesystem::path& file : header.data) {
        if (!std::filesystem::exists(file))
            throw Error(fmt::format("{}: its data file {} is missing", path.string(), file.string()));
        sum += static_cast<double>(file::require_file(file));
    }
    return sum;
}

// Lower bound of file bytes per sample for an encoding; deflate compresses at most 1032 to 1.
double min_bytes(const NrrdHeader& header) {
    const double size = static_cast<double>(header.type.bytes());
    switch (header.encoding) {
        case NrrdEncoding::raw: return size;
        case NrrdEncoding::gzip: return size / 1032.0;
        case NrrdEncoding::bzip2: return size / 1e6;
        case NrrdEncoding::text: return 1.5;
        case NrrdEncoding::hex: return 2.0 * size;
    }
    return size;
}

// The three axes of space: those with a direction. Without a direction only axes of one sample are left out, and the
// axis of the segmentation layers.
struct Axes {
    std::array<std::size_t, 3> space{};
    std::size_t layers = 1;  // samples of the first axis, before those of space
    bool has_single = false;  // an axis of one sample was left out
};

Axes axes_of(const NrrdHeader& header, bool has_segments, const std::string& file) {
    const std::size_t dimension = header.sizes.size();
    Axes axes;
    std::vector<std::size_t> kept;
    for (std::size_t n = 0; n < dimension; ++n) {
        const bool is_direction = n < header.directions.size() && header.directions[n];
        if (dimension > 3 && !is_direction && n == 0 && has_segments)
            axes.layers = static_cast<std::size_t>(header.sizes[0]);
        else kept.push_back(n);
    }
    for (const bool may_have_direction : {false, true})
        for (std::size_t n = kept.size(); n-- > 0 && kept.size() > 3;) {
            const bool is_direction = kept[n] < header.directions.size() && header.directions[kept[n]];
            if (header.sizes[kept[n]] != 1 || (is_direction && !may_have_direction)) continue;
            kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(n));
            axes.has_single = true;
        }
    if (kept.size() != 3)
        throw Error(fmt::format("{}: has {} axes; a CT volume must have 3 (extract one frame with 'unu slice')", file,
                                dimension));
    std::ranges::copy(kept, axes.space.begin());
    return axes;
}

void read_geometry(const NrrdHeader& header, const Axes& axes, ScanVolume& volume, const std::string& file) {
    const bool is_ras = header.space == "right-anterior-superior" || header.space == "ras";
    const bool is_las = header.space == "left-anterior-superior" || header.space == "las";
    if (!is_ras && !is_las && header.space != "left-posterior-superior" && header.space != "lps")
        throw Error(
            fmt::format("{}: no usable 'space' (the patient's directions are unknown); write "
                        "'space: left-posterior-superior', 'space directions' and 'space origin' into the header",
                        file));
    for (const std::string& unit : header.space_units)
        if (!unit.empty() && unit != "mm")
            throw Error(fmt::format("{}: space units '{}' are not mm; convert the header to mm", file, unit));
    const Vec3 to_m(1e-3, is_las ? -1e-3 : 1e-3, 1e-3);
    SampleMap<Frame::lps> map;
    for (int n = 0; n < 3; ++n) {
        const std::size_t axis = axes.space[static_cast<std::size_t>(n)];
        map.step[n] = axis < header.directions.size() ? header.directions[axis].value_or(Vec3(0.0)) * to_m : Vec3(0.0);
    }
    map.origin = header.origin.value_or(Vec3(0.0)) * to_m;
    if (!header.origin) volume.notes.push_back("the file states no space origin: its first voxel was placed at 0");
    volume.map = is_ras ? to_lps(SampleMap<Frame::ras>{map.step, map.origin}) : map;
    volume.file_frame = is_ras ? Frame::ras : Frame::lps;
    volume.unit_stated = !header.space_units.empty() && !header.space_units.front().empty();
    check_map(volume.map, file);
}

struct Layered {
    Segment segment;
    int layer = 0;
    int label = 0;  // in its layer
};

// Segments as 3D Slicer describes them in a .seg.nrrd: Segment0_Name, Segment0_LabelValue, Segment0_Color, ...
std::vector<Layered> segments_of(const NrrdHeader& header) {
    std::vector<Layered> found;
    for (int n = 0; n < 100000; ++n) {
        const std::string prefix = fmt::format("Segment{}_", n), label = header.value(prefix + "LabelValue");
        if (label.empty() && header.value(prefix + "ID").empty()) break;
        Layered& entry = found.emplace_back();
        entry.segment.label = label.empty() ? n + 1 : std::atoi(label.c_str());
        entry.layer = std::atoi(header.value(prefix + "Layer").c_str());
        entry.segment.name = header.value(prefix + "Name");
        Vec3 c;
        if (std::sscanf(header.value(prefix + "Color").c_str(), "%lf %lf %lf", &c.x, &c.y, &c.z) == 3 && is_finite(c))
            entry.segment.colour = glm::clamp(c, 0.0, 1.0);
    }
    return found;
}

void check_size(const NrrdHeader& header, const Axes& axes, const std::filesystem::path& path) {
    const std::string file = path.string();
    std::array<std::int64_t, 3> size{};
    for (std::size_t n = 0; n < 3; ++n) size[n] = header.sizes[axes.space[n]];
    const double count = header.count();
    if (count * min_bytes(header) > bytes_on_disk(path, header) + 64.0)
        throw Error(
            fmt::format("{}: cut short: its header states {:.0f} voxels, more than the file can hold", file, count));
    checked_count(size, file);
    if (count > 2e9) throw Error(fmt::format("{}: too many samples in its layers: {:.0f}", file, count));
}

// Start of the samples in a data file, after the skipped lines and bytes; `bytes`: length of unpacked samples.
std::uint64_t start_of_samples(const std::filesystem::path& path, const NrrdHeader& header, double bytes) {
    std::uint64_t start = header.start;
    const auto cut_short = [&] { return Error(fmt::format("{}: cut short; copy the file again", path.string())); };
    if (header.line_skip > 0) {
        std::ifstream file(path, std::ios::binary);
        file.seekg(static_cast<std::streamoff>(start));
        for (std::uint64_t n = 0; n < header.line_skip; ++n)
            if (!file.ignore(std::numeric_limits<std::streamsize>::max(), '\n') || file.eof())
                throw Error(fmt::format("{}: cut short: it ends in line {} of {} to skip", path.string(), n + 1,
                                        header.line_skip));
        start = static_cast<std::uint64_t>(file.tellg());
    }
    if (header.encoding != NrrdEncoding::raw && header.encoding != NrrdEncoding::hex) return start;
    if (header.byte_skip >= 0) return start + static_cast<std::uint64_t>(header.byte_skip);
    // A negative skip counts from the end: -1 means that the samples end the file.
    const double from_end =
        static_cast<double>(std::filesystem::file_size(path)) - bytes + (double(header.byte_skip) + 1.0);
    if (from_end < static_cast<double>(start)) throw cut_short();
    return static_cast<std::uint64_t>(from_end);
}

std::size_t samples_per_file(const NrrdHeader& header, std::size_t samples, const std::filesystem::path& path) {
    if (samples % header.data.size() != 0)
        throw Error(fmt::format("{}: its samples cannot be divided evenly among {} data files", path.string(),
                                header.data.size()));
    return samples / header.data.size();
}

SampleStream stream_of(const NrrdHeader& header, const std::filesystem::path& path, std::size_t samples) {
    const bool is_packed = header.encoding != NrrdEncoding::raw;
    if (is_packed && header.byte_skip < 0)
        throw Error(
            fmt::format("{}: a negative byte skip needs an unpacked file; unpack it with 'unu save "
                        "-f nrrd -e raw'",
                        path.string()));
    std::vector<SampleStream::Piece> pieces;
    for (const std::filesystem::path& file : header.data) {
        SampleStream::Piece piece{file, 0, 0, samples_per_file(header, samples, path)};
        const double bytes = static_cast<double>(piece.samples) * static_cast<double>(header.type.bytes());
        piece.start = start_of_samples(file, header, bytes);
        if (is_packed) piece.skip = static_cast<std::uint64_t>(header.byte_skip);
        pieces.push_back(std::move(piece));
    }
    const Packing packing = header.encoding == NrrdEncoding::raw    ? Packing::none
                            : header.encoding == NrrdEncoding::gzip ? Packing::gzip
                                                                    : Packing::bzip2;
    return SampleStream(std::move(pieces), header.type, header.is_swapped && header.type.bytes() > 1, packing);
}

// Characters of a data file, in blocks.
class Characters {
public:
    Characters(const std::filesystem::path& path, std::uint64_t start) : file_(path, std::ios::binary) {
        file_.seekg(static_cast<std::streamoff>(start));
    }
    /// -1 at the end.
    int next() {
        if (at_ == size_) {
            leave_if_stopped();
            file_.read(block_.data(), static_cast<std::streamsize>(block_.size()));
            at_ = 0, size_ = static_cast<std::size_t>(file_.gcount());
            if (size_ == 0) return -1;
        }
        return static_cast<unsigned char>(block_[at_++]);
    }

private:
    std::ifstream file_;
    std::vector<char> block_ = std::vector<char>(1 << 16);
    std::size_t at_ = 0, size_ = 0;
};

// Numbers as text, separated by blanks or commas.
void read_text(const std::filesystem::path& path, std::uint64_t start, std::span<float> values) {
    constexpr std::size_t longest = 500;
    Characters characters(path, start);
    std::string word;
    for (std::size_t count = 0; count < values.size();) {
        const int c = characters.next();
        const bool is_between = c < 0 || std::isspace(c) || c == ',';
        if (!is_between) {
            word += static_cast<char>(c);
            if (word.size() > longest)
                throw Error(fmt::format("{}: a text number has more than {} characters", path.string(), longest));
            continue;
        }
        if (!word.empty()) {
            double number = 0.0;
            const char* const first = word.data() + (word.front() == '+');
            const auto [end, failure] = std::from_chars(first, word.data() + word.size(), number);
            if (failure == std::errc::result_out_of_range)
                number = word.find_first_of("eE") + 1 < word.size() && word[word.find_first_of("eE") + 1] == '-'
                             ? 0.0
                             : std::numeric_limits<double>::infinity();
            if (failure == std::errc::invalid_argument || end != word.data() + word.size())
                throw Error(
                    fmt::format("{}: '{}' at sample {} is not a number", path.string(), word.substr(0, 40), count + 1));
            values[count++] = static_cast<float>(number);
            word.clear();
        } else if (c < 0) {
            throw Error(fmt::format("{}: cut short; copy the file again", path.string()));
        }
    }
}

// Two digits per byte; blanks between them are skipped.
std::string read_hex(const std::filesystem::path& path, std::uint64_t start, std::size_t bytes) {
    Characters characters(path, start);
    std::string out(bytes, '\0');
    for (std::size_t digit = 0; digit < 2 * bytes;) {
        const int c = characters.next();
        if (c < 0) throw Error(fmt::format("{}: cut short; copy the file again", path.string()));
        if (std::isspace(c)) continue;
        const int value = c >= '0' && c <= '9'                     ? c - '0'
                          : (c | 0x20) >= 'a' && (c | 0x20) <= 'f' ? (c | 0x20) - 'a' + 10
                                                                   : -1;
        if (value < 0)
            throw Error(
                fmt::format("{}: a character that is no hexadecimal digit, in byte {}", path.string(), digit / 2 + 1));
        char& byte = out[digit / 2];
        byte = static_cast<char>(static_cast<unsigned char>(byte) << 4 | value);
        ++digit;
    }
    return out;
}

class NrrdSlices final : public SliceReader {
public:
    explicit NrrdSlices(const std::filesystem::path& path) {
        const std::string file = path.string();
        const NrrdHeader header = read_nrrd_header(path);
        segments_ = segments_of(header);
        const Axes axes = axes_of(header, !segments_.empty(), file);
        about.format = "NRRD";
        about.source = path.filename().string();
        about.encoding = name_of(header.encoding);
        about.surface_hu = parse_surface_hu(header.value(std::string(surface_hu_key)));
        read_geometry(header, axes, about, file);
        check_size(header, axes, path);
        for (std::size_t n = 0; n < 3; ++n) about.size[n] = static_cast<int>(header.sizes[axes.space[n]]);
        layers_ = axes.layers;
        if (axes.has_single) about.notes.push_back("a fourth axis of one sample was left out");
        integers_ = header.type.is_integer();
        flatten_segments();
        const std::size_t samples = about.count() * layers_;
        if (header.encoding == NrrdEncoding::text || header.encoding == NrrdEncoding::hex)
            read_whole(header, samples, path);
        else stream_ = stream_of(header, path, samples);
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
        if (counts)
            for (std::size_t n = 0; n < layered.size(); ++n)
                unnamed_ += layered[n] != 0.0f && !names(n % layers_, layered[n]);
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
        if (unnamed_ > 0)
            about.notes.push_back(
                fmt::format("{} voxels have values that no segment names; they were left out", unnamed_));
        covered_ = unnamed_ = 0;
        settle_meaning(about, tally, integers_);
    }

private:
    bool names(std::size_t layer, float value) const {
        return std::ranges::any_of(segments_, [&](const Layered& each) {
            return static_cast<std::size_t>(each.layer) == layer && static_cast<float>(each.label) == value;
        });
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

    // Samples as text and as hexadecimal digits are read at once.
    void read_whole(const NrrdHeader& header, std::size_t samples, const std::filesystem::path& path) {
        const bool is_hex = header.encoding == NrrdEncoding::hex;
        const double bytes = sizeof(float) + (is_hex ? double(header.type.bytes()) : 0.0);
        file::require_room(bytes * static_cast<double>(samples), path, "its samples");
        whole_.resize(samples);
        const std::size_t each = samples_per_file(header, samples, path);
        for (std::size_t n = 0; n < header.data.size(); ++n) {
            const std::span<float> values = std::span(whole_).subspan(n * each, each);
            const std::size_t size = each * header.type.bytes();
            const std::uint64_t start = start_of_samples(header.data[n], header, 2.0 * double(size));
            if (is_hex) unpack_samples(read_hex(header.data[n], start, size), header.type, header.is_swapped, values);
            else read_text(header.data[n], start, values);
        }
    }

    void take(std::size_t first, std::span<float> values) {
        if (stream_) stream_->read(first, values);
        else std::copy_n(whole_.begin() + static_cast<std::ptrdiff_t>(first), values.size(), values.begin());
    }

    std::vector<Layered> segments_;
    std::optional<SampleStream> stream_;
    std::vector<float> whole_;
    std::size_t layers_ = 1, covered_ = 0, unnamed_ = 0;
    int shown_ = -1;   // layer; -1: all
    int counted_ = 0;  // slices whose overlapping voxels are counted
    bool integers_ = false;
};

}  // namespace

std::unique_ptr<SliceReader> open_nrrd(const std::filesystem::path& path) { return std::make_unique<NrrdSlices>(path); }

}  // namespace tactus::volume
