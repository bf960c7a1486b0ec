// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/decoder/dicom_decode.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/dicom_elements.hpp"
#include "dsp/core/error.hpp"

#include <gdcmMediaStorage.h>
#include <gdcmPixmapReader.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>
#include <gdcmUIDs.h>

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <utility>

namespace tactus::volume {

namespace {

const gdcm::Tag pixel_data(0x7fe0, 0x0010);
constexpr std::string_view big_endian = "1.2.840.10008.1.2.2";

// GDCM prints to the terminal; our Error has the relevant text.
void silence() {
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
}

std::string text_of(const gdcm::DataSet& set, gdcm::Tag tag) {
    if (!set.FindDataElement(tag)) return {};
    const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
    if (!value || !value->GetPointer()) return {};
    std::string text(value->GetPointer(), value->GetLength());
    while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
    return text;
}

std::string printable(std::string text) {
    text.resize(std::min<std::size_t>(text.size(), 40));
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    return text;
}

// A number of a text, the whole of which it must be. None for other text. Some programs write "2,5" (the standard has no
// thousands separators, so that it has one meaning).
std::optional<double> number_in(std::string text, bool& has_comma) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\0' || c == '\t' || c == '\n' || c == '\r'; };
    while (!text.empty() && is_blank(text.back())) text.pop_back();
    while (!text.empty() && is_blank(text.front())) text.erase(0, 1);
    if (text.starts_with('+')) text.erase(0, 1);
    if (const std::size_t comma = text.find(','); comma != std::string::npos && text.find('.') == std::string::npos) {
        text[comma] = '.';
        has_comma = true;
    }
    double number = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
    return number;
}

template <class T>
std::vector<double> numbers_of(const std::string& bytes) {
    std::vector<double> numbers;
    for (std::size_t at = 0; at + sizeof(T) <= bytes.size() && numbers.size() < 16; at += sizeof(T)) {
        T number;
        std::memcpy(&number, &bytes[at], sizeof(T));
        numbers.push_back(static_cast<double>(number));
    }
    return numbers;
}

// Numbers as text, separated by backslashes (DICOM DS), or in the binary form that their representation states. Throws
// Error for text that is no number: half of "2.5x" would be a length that nobody wrote.
std::vector<double> decimals_of(const gdcm::DataSet& set, gdcm::Tag tag, DicomImage& image) {
    if (!set.FindDataElement(tag)) return {};
    const gdcm::DataElement& element = set.GetDataElement(tag);
    const gdcm::ByteValue* value = element.GetByteValue();
    if (!value || !value->GetPointer()) return {};
    const gdcm::VR kind = element.GetVR();
    const std::string bytes(value->GetPointer(), value->GetLength());
    if (kind == gdcm::VR::FD) return numbers_of<double>(bytes);
    if (kind == gdcm::VR::FL) return numbers_of<float>(bytes);
    if (kind == gdcm::VR::US) return numbers_of<std::uint16_t>(bytes);
    if (kind == gdcm::VR::SS) return numbers_of<std::int16_t>(bytes);
    if (kind == gdcm::VR::UL) return numbers_of<std::uint32_t>(bytes);
    if (kind == gdcm::VR::SL) return numbers_of<std::int32_t>(bytes);
    const std::string text = text_of(set, tag);
    if (text.find_first_not_of(' ') == std::string::npos) return {};
    std::vector<double> numbers;
    for (std::size_t at = 0; at <= text.size() && numbers.size() < 16;) {
        const std::size_t end = std::min(text.find('\\', at), text.size());
        const std::optional<double> number = number_in(text.substr(at, end - at), image.has_decimal_commas);
        if (!number)
            throw Error(fmt::format("{}: element ({:04x},{:04x}) is '{}', not numbers; correct it in the file",
                                    image.file.string(), tag.GetGroup(), tag.GetElement(), printable(text)));
        numbers.push_back(*number);
        at = end + 1;
    }
    return numbers;
}

int binary_of(const gdcm::DataSet& set, gdcm::Tag tag, int otherwise) {
    if (!set.FindDataElement(tag)) return otherwise;
    const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
    if (!value || !value->GetPointer() || value->GetLength() < 2) return otherwise;
    std::uint16_t number = 0;
    std::memcpy(&number, value->GetPointer(), 2);
    return number;
}

// Item `n` (from 0) of a sequence. In an implicit file the sequence is parsed on request: it must outlive its items.
class Item {
public:
    Item() = default;
    Item(const gdcm::DataSet& set, gdcm::Tag tag, std::size_t n) {
        if (!set.FindDataElement(tag)) return;
        sequence_ = set.GetDataElement(tag).GetValueAsSQ();
        if (sequence_ && n < sequence_->GetNumberOfItems()) set_ = &sequence_->GetItem(n + 1).GetNestedDataSet();
    }
    explicit operator bool() const { return set_ != nullptr; }
    const gdcm::DataSet& operator*() const { return *set_; }

private:
    gdcm::SmartPointer<gdcm::SequenceOfItems> sequence_;
    const gdcm::DataSet* set_ = nullptr;
};

void take_geometry(const gdcm::DataSet& position, const gdcm::DataSet& orientation, const gdcm::DataSet& measures,
                   DicomImage& image) {
    if (const auto p = decimals_of(position, {0x0020, 0x0032}, image); p.size() == 3)
        image.position = Vec3(p[0], p[1], p[2]);
    if (const auto o = decimals_of(orientation, {0x0020, 0x0037}, image); o.size() == 6) {
        image.along_row = Vec3(o[0], o[1], o[2]);
        image.along_column = Vec3(o[3], o[4], o[5]);
    }
    if (const auto s = decimals_of(measures, {0x0028, 0x0030}, image); s.size() == 2) {
        image.row_spacing = s[0];
        image.column_spacing = s[1];
    }
    if (const auto s = decimals_of(measures, {0x0018, 0x0088}, image); !s.empty()) image.slice_spacing = s[0];
    if (const auto s = decimals_of(measures, {0x0018, 0x0050}, image); !s.empty()) image.slice_thickness = s[0];
}

void take_rescale(const gdcm::DataSet& set, DicomImage& image) {
    const auto slope = decimals_of(set, {0x0028, 0x1053}, image), intercept = decimals_of(set, {0x0028, 0x1052}, image);
    if (slope.empty() && intercept.empty()) return;
    if (slope.size() > 1 || intercept.size() > 1)
        throw Error(
            fmt::format("{}: the rescale to HU (RescaleSlope, RescaleIntercept) has several numbers; correct it "
                        "in the file",
                        image.file.string()));
    image.has_rescale = true;
    image.has_zero_slope = !slope.empty() && slope[0] == 0.0;
    image.slope = slope.empty() || slope[0] == 0.0 ? 1.0 : slope[0];
    image.intercept = intercept.empty() ? 0.0 : intercept[0];
    image.rescale_type = text_of(set, {0x0028, 0x1054});
}

// Enhanced files state position and rescale per frame, or once for all frames.
class FunctionalGroups {
public:
    explicit FunctionalGroups(const gdcm::DataSet& set) : shared_(set, {0x5200, 0x9229}, 0) {
        if (set.FindDataElement(gdcm::Tag(0x5200, 0x9230)))
            frames_ = set.GetDataElement(gdcm::Tag(0x5200, 0x9230)).GetValueAsSQ();
        for (std::size_t n = 0;; ++n) {
            const Item segment(set, {0x0062, 0x0002}, n);
            if (!segment) break;
            segments_.emplace_back(binary_of(*segment, {0x0062, 0x0004}, 0), text_of(*segment, {0x0062, 0x0005}));
        }
    }

    bool are_there() const { return frames_ != nullptr; }

    void take(std::size_t frame, DicomImage& image) const {
        const gdcm::DataSet* own =
            frames_ && frame < frames_->GetNumberOfItems() ? &frames_->GetItem(frame + 1).GetNestedDataSet() : nullptr;
        const auto group = [&](gdcm::Tag tag) {
            Item found = own ? Item(*own, tag, 0) : Item();
            return found || !shared_ ? found : Item(*shared_, tag, 0);
        };
        const gdcm::DataSet none;
        const Item position = group({0x0020, 0x9113}), orientation = group({0x0020, 0x9116}),
                   measures = group({0x0028, 0x9110}), values = group({0x0028, 0x9145}),
                   segment = group({0x0062, 0x000a});
        take_geometry(position ? *position : none, orientation ? *orientation : none, measures ? *measures : none,
                      image);
        image.has_own_position = image.has_own_position || static_cast<bool>(position);
        if (values) take_rescale(*values, image);
        if (!segment) return;
        image.segment = binary_of(*segment, {0x0062, 0x000b}, 0);
        for (const auto& [number, name] : segments_)
            if (number == image.segment) image.segment_name = name;
    }

private:
    Item shared_;
    gdcm::SmartPointer<gdcm::SequenceOfItems> frames_;
    std::vector<std::pair<int, std::string>> segments_;
};

void check_claim(const DicomImage& image, double size, int frames, int bits, bool compressed) {
    const std::string file = image.file.string();
    if (image.rows < 1 || image.columns < 1)
        throw Error(fmt::format("{}: the image has {} rows and {} columns", file, image.rows, image.columns));
    const double asked = double(image.rows) * image.columns * frames * bits / 8.0;
    // No transfer syntax compresses noisy images by a factor of thousands; empty images come close.
    if (asked > size * (compressed ? 2000.0 : 1.0))
        throw Error(fmt::format(
            "{}: cut short: its header asks for {:.0f} bytes of samples, more than the file can hold", file, asked));
}

struct Layout {
    int bits_allocated, bits_stored, high_bit;
    bool is_signed;

    double value_of(std::uint64_t stored) const {
        const int shift = std::max(high_bit + 1 - bits_stored, 0), unused = 64 - bits_stored;
        const std::uint64_t top = (stored >> shift) << unused;
        return is_signed ? double(static_cast<std::int64_t>(top) >> unused) : double(top >> unused);
    }
    // Whether the bits beyond the stored ones are empty, or repeat the sign.
    bool fits(std::uint64_t stored) const {
        const int above = high_bit + 1;
        if (above >= bits_allocated) return true;
        const std::uint64_t mask = (std::uint64_t{1} << bits_allocated) - 1, rest = (stored & mask) >> above,
                            ones = mask >> above;
        return rest == 0 || (is_signed && rest == ones && (stored >> high_bit & 1) != 0);
    }
};

// Samples that lie outside the field of view: a stated value or range (PixelPaddingValue), as its bits are stored.
struct Padding {
    std::optional<double> from, to;
    std::uint64_t bits = 0;
    bool is_stated = true;
};

template <typename Stored>
std::uint64_t stored_at(const char* bytes, std::size_t n) {
    Stored stored;
    std::memcpy(&stored, bytes + n * sizeof(Stored), sizeof(Stored));
    return std::uint64_t{stored};
}

constexpr double air = -1000.0;  // HU

// Without a stated padding: unsigned samples of which all above half of the range have one value, as when a signed
// padding of -2000 is stored as 63536. No tissue and no metal has one value only.
template <typename Stored>
Padding recognised_padding(const char* bytes, std::size_t count, const Layout& layout, const DicomImage& image) {
    Padding padding;
    if (layout.is_signed || layout.bits_stored != 16 || image.modality != "CT" || !image.has_rescale) return padding;
    std::optional<std::uint64_t> high;
    for (std::size_t n = 0; n < count; ++n) {
        const std::uint64_t stored = stored_at<Stored>(bytes, n);
        if (stored < 0x8000) continue;
        if (high && *high != stored) return padding;
        high = stored;
    }
    if (!high) return padding;
    padding.from = padding.to = double(*high);
    padding.bits = *high;
    padding.is_stated = false;
    return padding;
}

// Returns the number of padded samples.
template <typename Stored>
std::size_t rescale(const char* bytes, const Layout& layout, const DicomImage& image, Padding padding, bool has_overlay,
                    std::span<float> out, DicomSamples& about) {
    if (!padding.from) padding = recognised_padding<Stored>(bytes, out.size(), layout, image);
    float low = std::numeric_limits<float>::infinity(), high = -low;
    std::size_t padded = 0;
    const auto is_padding = [&](std::uint64_t stored, double value) {
        if (!padding.from) return false;
        return stored == padding.bits || (value >= *padding.from && value <= *padding.to);
    };
    for (std::size_t n = 0; n < out.size(); ++n) {
        const std::uint64_t stored = stored_at<Stored>(bytes, n);
        const double value = layout.value_of(stored);
        if (is_padding(stored, value)) {
            out[n] = std::numeric_limits<float>::quiet_NaN();
            ++padded;
            continue;
        }
        if (!has_overlay && !layout.fits(stored))
            throw Error(
                fmt::format("{}: a sample of {} does not fit the {} bits that its header states; the file is "
                            "damaged, or its header wrong",
                            image.file.string(), stored, layout.bits_stored));
        out[n] = static_cast<float>(image.slope * value + image.intercept);
        low = std::min(low, out[n]), high = std::max(high, out[n]);
    }
    if (padded == 0) return 0;
    // Padding is no measured value. In HU it becomes air, elsewhere it stays unless it would be the brightest.
    const auto stated = static_cast<float>(image.slope * *padding.from + image.intercept);
    const bool is_hu = image.modality == "CT" && image.has_rescale;
    const float fill = is_hu ? static_cast<float>(air) : low > high || stated <= high ? stated : low;
    for (float& value : out)
        if (std::isnan(value)) value = fill;
    about.padded += padded;
    about.padding = *padding.from;
    about.is_padding_stated = padding.is_stated;
    return padded;
}

Padding stated_padding(const gdcm::DataSet& set, const Layout& layout) {
    const auto bits_of = [&](gdcm::Tag tag) -> std::optional<std::uint64_t> {
        if (!set.FindDataElement(tag)) return std::nullopt;
        const gdcm::ByteValue* value = set.GetDataElement(tag).GetByteValue();
        if (!value || !value->GetPointer()) return std::nullopt;
        const std::size_t size =
            std::min<std::size_t>(value->GetLength(), static_cast<std::size_t>(layout.bits_allocated) / 8);
        if (size == 0) return std::nullopt;
        std::uint64_t bits = 0;
        std::memcpy(&bits, value->GetPointer(), size);
        return bits;
    };
    Padding padding;
    const std::optional<std::uint64_t> bits = bits_of({0x0028, 0x0120});
    if (!bits) return padding;
    padding.bits = *bits;
    padding.from = padding.to = layout.value_of(*bits);
    if (const std::optional<std::uint64_t> limit = bits_of({0x0028, 0x0121})) {
        const double other = layout.value_of(*limit);
        padding.from = std::min(*padding.from, other), padding.to = std::max(*padding.to, other);
    }
    return padding;
}

// Overlays of old files lie in the bits that samples do not use.
bool has_embedded_overlay(const gdcm::DataSet& set) {
    for (std::uint16_t group = 0x6000; group < 0x6020; group = static_cast<std::uint16_t>(group + 2))
        if (binary_of(set, {group, 0x0102}, 0) != 0) return true;
    return false;
}

// The images that `reader`, which has its input, finds in `file` of `size` bytes.
std::vector<DicomImage> images_of(gdcm::Reader& reader, const DicomImage& file, double size) {
    const std::string name = file.file.string();
    std::vector<DicomImage> images;
    if (!reader.ReadUpToTag(pixel_data)) return {};
    const gdcm::DataSet& set = reader.GetFile().GetDataSet();
    const int rows = binary_of(set, {0x0028, 0x0010}, 0), columns = binary_of(set, {0x0028, 0x0011}, 0);
    if (rows == 0 && columns == 0) return {};
    DicomImage image = file;
    image.rows = rows;
    image.columns = columns;
    image.instance = text_of(set, {0x0008, 0x0018});
    image.series = text_of(set, {0x0020, 0x000e});
    image.description = text_of(set, {0x0008, 0x103e});
    image.modality = text_of(set, {0x0008, 0x0060});
    image.is_localizer = text_of(set, {0x0008, 0x0008}).find("LOCALIZER") != std::string::npos;
    const std::string photometric = text_of(set, {0x0028, 0x0004});
    image.is_inverted = photometric == "MONOCHROME1";
    image.is_colour = binary_of(set, {0x0028, 0x0002}, 1) != 1 || photometric == "PALETTE COLOR";
    const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
    image.syntax = gdcm::TransferSyntax::GetTSString(syntax) ? gdcm::TransferSyntax::GetTSString(syntax) : "";
    if (image.is_colour) return {image};
    // GDCM reads the number of frames of these classes without checking that it exists.
    gdcm::MediaStorage kind;
    kind.SetFromFile(reader.GetFile());
    if (kind.GetModalityDimension() > 2 && !set.FindDataElement(gdcm::Tag(0x0028, 0x0008)))
        throw Error(fmt::format("{}: a multi-frame image without a number of frames", name));
    take_geometry(set, set, set, image);
    take_rescale(set, image);
    const auto counted = decimals_of(set, {0x0028, 0x0008}, image);
    const double frames = counted.empty() ? 1.0 : counted[0];
    if (!(frames >= 1.0 && frames <= 100000.0))
        throw Error(fmt::format("{}: {:g} frames are not possible", name, frames));
    const bool is_deflated = image.syntax == "1.2.840.10008.1.2.1.99";
    check_claim(image, size, static_cast<int>(frames), binary_of(set, {0x0028, 0x0100}, 16),
                syntax.IsEncapsulated() || is_deflated);
    const FunctionalGroups groups(set);
    image.has_own_position = frames == 1.0;
    for (int frame = 0; frame < static_cast<int>(frames); ++frame) {
        image.frame = frame;
        image.is_one_of_several = frames > 1.0;
        images.push_back(image);
        if (groups.are_there()) groups.take(static_cast<std::size_t>(frame), images.back());
    }
    return images;
}

// One bit per sample, the lowest first, without gaps between frames.
void unpack_bits(const gdcm::DataSet& set, const std::string& file, std::span<float> values) {
    const gdcm::ByteValue* packed =
        set.FindDataElement(pixel_data) ? set.GetDataElement(pixel_data).GetByteValue() : nullptr;
    if (!packed || !packed->GetPointer() || double(packed->GetLength()) * 8.0 < double(values.size()))
        throw Error(fmt::format("{}: cut short: samples of one bit are missing", file));
    for (std::size_t n = 0; n < values.size(); ++n)
        values[n] = static_cast<float>(static_cast<unsigned char>(packed->GetPointer()[n / 8]) >> (n % 8) & 1);
}

}  // namespace

std::vector<DicomImage> decode_dicom_images(const DicomSource& source) {
    silence();
    DicomImage from;
    from.file = source.name;
    const std::string own = source.bytes ? std::string() : file::read_whole_file(source.name);
    const std::string& bytes = source.bytes ? *source.bytes : own;
    const std::string doubt = doubt_about_dicom(bytes, source.name);
    try {
        gdcm::Reader reader;
        std::istringstream stream(bytes);
        reader.SetStream(stream);
        std::vector<DicomImage> images = images_of(reader, from, static_cast<double>(bytes.size()));
        if (images.empty() && !doubt.empty()) throw Error(doubt);
        return images;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        if (!doubt.empty()) throw Error(doubt);
        throw Error(fmt::format("{}: cannot be read as DICOM: {}", source.name, failure.what()));
    }
}

DicomSamples decode_dicom_samples(const DicomSource& source, const std::vector<DicomImage>& images,
                                  const std::function<float*(std::size_t)>& memory) {
    silence();
    const DicomImage& first = images.front();
    const std::string& file = source.name;
    const auto refuse = [&](std::string_view why) {
        // The walk names the place of a damage.
        const std::string doubt = doubt_about_dicom(source.bytes ? *source.bytes : file::read_whole_file(file), file);
        if (!doubt.empty()) throw Error(doubt);
        throw Error(fmt::format("{}: the image cannot be decoded ({}): {}", file, first.syntax, why));
    };
    try {
        std::istringstream stream, plain_stream;
        const auto give = [&](gdcm::Reader& reader, std::istringstream& from) {
            if (source.bytes) {
                from.str(*source.bytes);
                reader.SetStream(from);
            } else {
                reader.SetFileName(file.c_str());
            }
        };
        const auto require_samples = [&](const gdcm::DataSet& set) {
            if (!set.FindDataElement(pixel_data)) refuse("it has no samples (PixelData)");
        };
        const std::size_t each = static_cast<std::size_t>(first.rows) * static_cast<std::size_t>(first.columns);
        const std::size_t count = each * images.size();
        // Without the geometry, which GDCM's reader of images derives by assertions. One bit is not for it at all.
        if (first.modality == "SEG") {
            gdcm::Reader plain;
            give(plain, plain_stream);
            if (!plain.Read()) refuse("damaged or cut short");
            const gdcm::DataSet& set = plain.GetFile().GetDataSet();
            require_samples(set);
            if (binary_of(set, {0x0028, 0x0100}, 8) == 1) {
                if (plain.GetFile().GetHeader().GetDataSetTransferSyntax().IsEncapsulated())
                    refuse("samples of one bit are compressed; save the segmentation without compression");
                file::require_room(double(count) * sizeof(float), file, "its samples");
                unpack_bits(set, file, {memory(count), count});
                return {};
            }
        }
        gdcm::PixmapReader reader;
        give(reader, stream);
        const bool is_read = reader.Read();
        require_samples(reader.GetFile().GetDataSet());
        if (!is_read) refuse("damaged, cut short, or compressed in a way that GDCM does not support");
        const gdcm::Pixmap& picture = reader.GetPixmap();
        const gdcm::PixelFormat& format = picture.GetPixelFormat();
        const Layout layout{format.GetBitsAllocated(), format.GetBitsStored(), format.GetHighBit(),
                            format.GetPixelRepresentation() == 1};
        if (layout.bits_allocated != 8 && layout.bits_allocated != 16 && layout.bits_allocated != 32)
            refuse(fmt::format("{} bits per sample", layout.bits_allocated));
        if (layout.bits_stored < 1 || layout.bits_stored > layout.bits_allocated ||
            layout.high_bit >= layout.bits_allocated)
            refuse("its header has contradictory bit depths");
        const auto bytes = static_cast<std::size_t>(layout.bits_allocated / 8);
        if (bytes == 4 && first.syntax == big_endian) refuse("GDCM does not swap 32-bit samples correctly");
        if (picture.GetBufferLength() != count * bytes) refuse("the number of samples differs from the header");
        // The bytes in GDCM, the copy that it returns, and the floats.
        file::require_room(double(picture.GetBufferLength()) * (2.0 + sizeof(float) / double(bytes)), file,
                           "its samples");
        const gdcm::DataSet& set = reader.GetFile().GetDataSet();
        std::vector<char> buffer(picture.GetBufferLength());
        // GDCM clears the bits above the stored ones, where padding and damage show: plain samples are taken as they are.
        const gdcm::ByteValue* plain =
            first.syntax == "1.2.840.10008.1.2" || first.syntax.starts_with("1.2.840.10008.1.2.1")
                ? set.GetDataElement(pixel_data).GetByteValue()
                : nullptr;
        if (plain && plain->GetPointer() && plain->GetLength() >= buffer.size())
            std::memcpy(buffer.data(), plain->GetPointer(), buffer.size());
        else if (!picture.GetBuffer(buffer.data())) refuse("damaged or cut short");
        const Padding padding = stated_padding(set, layout);
        const bool has_overlay = has_embedded_overlay(set);
        const std::span<float> values(memory(count), count);
        DicomSamples about;
        for (std::size_t n = 0; n < images.size(); ++n) {
            const char* from = buffer.data() + n * each * bytes;
            const auto out = values.subspan(n * each, each);
            if (bytes == 1) rescale<std::uint8_t>(from, layout, images[n], padding, has_overlay, out, about);
            else if (bytes == 2) rescale<std::uint16_t>(from, layout, images[n], padding, has_overlay, out, about);
            else rescale<std::uint32_t>(from, layout, images[n], padding, has_overlay, out, about);
        }
        return about;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& failure) {
        throw Error(fmt::format("{}: the image cannot be decoded: {}", file, failure.what()));
    }
}

}  // namespace tactus::volume
