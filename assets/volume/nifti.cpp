// SPDX-License-Identifier: Apache-2.0
// NIfTI-1 and NIfTI-2 in a single file. Layout of the headers: nifti1.h and nifti2.h of the NIfTI Data Format Working
// Group.
#include "assets/volume/readers.hpp"
#include "assets/volume/sample_stream.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace tactus::volume {

namespace {

constexpr int label_intent = 1002;

// Reads numbers at fixed offsets of a header in either byte order.
struct Fields {
    std::vector<char> bytes;
    bool swapped = false;

    template <typename T>
    T get(std::size_t at) const {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes.data() + at, sizeof(T));
        if (swapped) std::reverse(raw.begin(), raw.end());
        T value;
        std::memcpy(&value, raw.data(), sizeof(T));
        return value;
    }

    /// Up to the first zero byte.
    std::string text(std::size_t at, std::size_t size) const {
        const std::string all(bytes.data() + at, size);
        return all.substr(0, all.find('\0'));
    }
};

// The fields of both versions.
struct Header {
    std::array<std::int64_t, 8> dim{};
    std::array<double, 8> pixdim{};
    std::array<double, 3> quatern{}, offset{};
    std::array<std::array<double, 4>, 3> rows{};
    double vox_offset = 0.0, slope = 0.0, intercept = 0.0;
    int datatype = 0, qform = 0, sform = 0, intent = 0, units = 0;
    std::string description;
    bool is_pair = false;  // the samples are in a file of their own
};

template <typename Whole, typename Real, typename Code>
Header take(const Fields& f, std::array<std::size_t, 11> at) {
    Header h;
    const std::size_t real = sizeof(Real);
    for (std::size_t n = 0; n < 8; ++n) h.dim[n] = f.get<Whole>(at[0] + n * sizeof(Whole));
    for (std::size_t n = 0; n < 8; ++n) h.pixdim[n] = f.get<Real>(at[1] + n * real);
    for (std::size_t n = 0; n < 3; ++n) {
        h.quatern[n] = f.get<Real>(at[2] + n * real);
        h.offset[n] = f.get<Real>(at[3] + n * real);
        for (std::size_t c = 0; c < 4; ++c) h.rows[n][c] = f.get<Real>(at[4] + (4 * n + c) * real);
    }
    h.slope = f.get<Real>(at[5]);
    h.intercept = f.get<Real>(at[6]);
    h.datatype = f.get<std::int16_t>(at[7]);
    h.qform = f.get<Code>(at[8]);
    h.sform = f.get<Code>(at[9]);
    h.intent = f.get<Code>(at[10]);
    return h;
}

Header header_of(PackedFile& file, Fields& fields, const std::string& name) {
    fields.bytes.resize(348);
    file.read(fields.bytes);
    const auto is_size = [&fields](std::int32_t size) {
        fields.swapped = false;
        if (fields.get<std::int32_t>(0) == size) return true;
        fields.swapped = true;
        return fields.get<std::int32_t>(0) == size;
    };
    if (is_size(348)) {
        const bool is_pair = std::memcmp(&fields.bytes[344], "ni1", 4) == 0;
        if (!is_pair && std::memcmp(&fields.bytes[344], "n+1", 4) != 0)
            throw Error(fmt::format(
                "{}: this is an Analyze file, which does not distinguish left from right; NIfTI is needed", name));
        Header h = take<std::int16_t, float, std::int16_t>(fields, {40, 76, 256, 268, 280, 112, 116, 70, 252, 254, 68});
        h.vox_offset = fields.get<float>(108);
        h.units = fields.bytes[123];
        h.description = fields.text(148, 80);
        h.is_pair = is_pair;
        return h;
    }
    if (!is_size(540)) throw Error(fmt::format("{}: not a NIfTI header", name));
    fields.bytes.resize(540);
    file.read(std::span(fields.bytes).subspan(348));
    const bool is_pair = std::memcmp(&fields.bytes[4], "ni2", 4) == 0;
    if (!is_pair && std::memcmp(&fields.bytes[4], "n+2", 4) != 0)
        throw Error(fmt::format("{}: not a NIfTI-2 header", name));
    Header h = take<std::int64_t, double, std::int32_t>(fields, {16, 104, 352, 376, 400, 176, 184, 12, 344, 348, 504});
    h.vox_offset = static_cast<double>(fields.get<std::int64_t>(168));
    h.units = fields.get<std::int32_t>(500);
    h.description = fields.text(240, 80);
    h.is_pair = is_pair;
    return h;
}

SampleType type_of(int datatype, const std::string& name) {
    switch (datatype) {
        case 2: return {SampleType::uint8};
        case 4: return {SampleType::int16};
        case 8: return {SampleType::int32};
        case 16: return {SampleType::float32};
        case 64: return {SampleType::float64};
        case 256: return {SampleType::int8};
        case 512: return {SampleType::uint16};
        case 768: return {SampleType::uint32};
        case 1024: return {SampleType::int64};
        case 1280: return {SampleType::uint64};
        default: throw Error(fmt::format("{}: samples of NIfTI type {} are not real numbers", name, datatype));
    }
}

SampleMap<Frame::ras> from_rows(const Header& h, double unit) {
    SampleMap<Frame::ras> map;
    for (int n = 0; n < 3; ++n) {
        const auto& row = h.rows[static_cast<std::size_t>(n)];
        for (int axis = 0; axis < 3; ++axis) map.step[axis][n] = row[static_cast<std::size_t>(axis)] * unit;
        map.origin[n] = row[3] * unit;
    }
    return map;
}

SampleMap<Frame::ras> from_quaternion(const Header& h, double unit) {
    const double b = h.quatern[0], c = h.quatern[1], d = h.quatern[2];
    const double a = std::sqrt(std::max(0.0, 1.0 - (b * b + c * c + d * d)));
    const Mat3 rotation = glm::mat3_cast(glm::normalize(Quat(a, b, c, d)));
    SampleMap<Frame::ras> map;
    for (int axis = 0; axis < 3; ++axis) {
        // The sign of pixdim[0] mirrors the third axis.
        const double flip = axis == 2 && h.pixdim[0] < 0.0 ? -unit : unit;
        map.step[axis] = rotation[axis] * (h.pixdim[static_cast<std::size_t>(axis) + 1] * flip);
        map.origin[axis] = h.offset[static_cast<std::size_t>(axis)] * unit;
    }
    return map;
}

// A quaternion longer than 1 is not a rotation, and a negative spacing would mirror. Neither can be corrected.
void check_quaternion(const Header& h, const std::string& name) {
    double square = 0.0;
    for (const double part : h.quatern) square += part * part;
    if (square > 1.001)
        throw Error(
            fmt::format("{}: the quaternion of its qform has a length of {:.4g}, more than 1; correct the header", name,
                        std::sqrt(square)));
    for (std::size_t n = 1; n < 4; ++n)
        if (h.pixdim[n] < 0.0)
            throw Error(fmt::format("{}: the voxel spacing along axis {} is {:g}; a qform needs spacings above 0", name,
                                    n - 1, h.pixdim[n]));
}

void read_geometry(const Header& h, ScanVolume& volume, const std::string& name) {
    const int code = h.units & 7;
    const double unit = code == 1 ? 1.0 : code == 3 ? 1e-6 : 1e-3;
    if (h.sform <= 0 && h.qform <= 0)
        throw Error(
            fmt::format("{}: has neither sform nor qform, so left and right are unknown; set one where the file "
                        "was made",
                        name));
    if (h.sform <= 0) check_quaternion(h, name);
    const SampleMap<Frame::ras> map = h.sform > 0 ? from_rows(h, unit) : from_quaternion(h, unit);
    volume.map = to_lps(map);
    volume.file_frame = Frame::ras;
    volume.unit_stated = code >= 1 && code <= 3;
    check_map(volume.map, name);
    if (h.sform > 0 && h.qform > 0) {
        const SampleMap<Frame::ras> other = from_quaternion(h, unit);
        const Vec3 last(volume.size[0] - 1, volume.size[1] - 1, volume.size[2] - 1);
        const double apart = std::max(glm::length(map(last) - other(last)), glm::length(map.origin - other.origin));
        if (!(apart < 1e-4))
            volume.notes.push_back(fmt::format("sform and qform differ by {:.3g} mm; the sform is used", apart * 1e3));
    }
}

// The other file of a pair: "a.img", or "a.img.gz", of "a.hdr", and the reverse.
std::filesystem::path other_of_pair(const std::filesystem::path& path, const char* ending) {
    std::filesystem::path stem = path;
    if (stem.extension() == ".gz") stem.replace_extension();
    const bool is_capital = stem.extension() == ".HDR" || stem.extension() == ".IMG";
    std::string wanted = ending;
    if (is_capital)
        for (char& c : wanted) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    for (const std::filesystem::path& other : {std::filesystem::path(stem).replace_extension(wanted),
                                               std::filesystem::path(stem).replace_extension(wanted + ".gz")})
        if (std::filesystem::exists(other)) return other;
    throw Error(fmt::format("{}: the other file of the pair, {}, is missing", path.string(),
                            std::filesystem::path(stem).replace_extension(wanted).filename().string()));
}

bool is_image_of_pair(const std::filesystem::path& path) {
    const std::string name = lower(path.filename().string());
    return name.ends_with(".img") || name.ends_with(".img.gz");
}

class NiftiSlices final : public SliceReader {
public:
    explicit NiftiSlices(const std::filesystem::path& given) {
        const std::filesystem::path path = is_image_of_pair(given) ? other_of_pair(given, ".hdr") : given;
        const std::string name = path.string();
        PackedFile file(path);
        Fields fields;
        const Header h = header_of(file, fields, name);
        if (h.dim[0] < 3 || h.dim[0] > 7)
            throw Error(fmt::format("{}: has {} axes; a volume must have 3", name, h.dim[0]));
        for (std::size_t n = 4; n <= static_cast<std::size_t>(h.dim[0]); ++n)
            if (h.dim[n] != 1)
                throw Error(fmt::format("{}: has {} volumes; extract one of them first", name, h.dim[n]));
        const SampleType type = type_of(h.datatype, name);
        const std::size_t count = checked_count({h.dim[1], h.dim[2], h.dim[3]}, name);
        const std::filesystem::path samples = h.is_pair ? other_of_pair(path, ".img") : path;
        const PackedFile in_samples(samples);
        const double header_size = h.is_pair ? 0.0 : static_cast<double>(fields.bytes.size());
        if (!(h.vox_offset >= header_size && h.vox_offset <= 1e8))
            throw Error(fmt::format("{}: an invalid start of the samples, byte {:g}", name, h.vox_offset));
        if (h.vox_offset + static_cast<double>(count * type.bytes()) > in_samples.max_bytes())
            throw Error(
                fmt::format("{}: cut short: its header states {} voxels, more than the file can hold", name, count));
        about.format = "NIfTI";
        about.source = path.filename().string();
        about.encoding = in_samples.is_packed() ? "gzip" : "raw";
        for (std::size_t n = 0; n < 3; ++n) about.size[n] = static_cast<int>(h.dim[n + 1]);
        read_geometry(h, about, name);
        const std::string key = std::string(surface_hu_key) + "=";
        if (const std::size_t at = h.description.find(key); at != std::string::npos)
            about.surface_hu = parse_surface_hu(std::string_view(h.description).substr(at + key.size()));
        const auto start = static_cast<std::uint64_t>(h.vox_offset);
        const bool packed = in_samples.is_packed();
        stream_.emplace(std::vector{SampleStream::Piece{samples, packed ? 0 : start, packed ? start : 0, count}}, type,
                        fields.swapped, packed ? Packing::gzip : Packing::none);
        scaled_ = std::isfinite(h.slope) && h.slope != 0.0 && (h.slope != 1.0 || h.intercept != 0.0);
        slope_ = h.slope, intercept_ = h.intercept;
        integers_ = type.is_integer() && !scaled_;
        if (h.intent == label_intent) about.kind = VolumeKind::labels;
    }

    void read(int k, std::span<float> values) override {
        stream_->read(static_cast<std::size_t>(k) * values.size(), values);
        if (scaled_)
            for (float& value : values) value = static_cast<float>(slope_ * double(value) + intercept_);
    }
    bool in_any_order() const override { return stream_->in_any_order(); }
    void settle(const Tally& tally) override { settle_meaning(about, tally, integers_); }

private:
    std::optional<SampleStream> stream_;
    bool scaled_ = false, integers_ = false;
    double slope_ = 1.0, intercept_ = 0.0;
};

}  // namespace

std::unique_ptr<SliceReader> open_nifti(const std::filesystem::path& path) {
    return std::make_unique<NiftiSlices>(path);
}

}  // namespace tactus::volume
