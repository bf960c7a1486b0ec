// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/dicom_images.hpp"

#include "assets/file/room.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/dicom_elements.hpp"
#include "dsp/core/error.hpp"

#include <gdcmImageReader.h>
#include <gdcmMediaStorage.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>
#include <gdcmUIDs.h>

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
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

// Numbers as text, separated by backslashes (DICOM DS).
std::vector<double> decimals_of(const gdcm::DataSet& set, gdcm::Tag tag) {
    const std::string text = text_of(set, tag);
    std::vector<double> numbers;
    for (std::size_t at = 0; at <= text.size() && numbers.size() < 16;) {
        const std::size_t end = std::min(text.find('\\', at), text.size());
        const std::string word = text.substr(at, end - at);
        char* rest = nullptr;
        const double number = std::strtod(word.c_str(), &rest);
        if (rest == word.c_str() || !std::isfinite(number)) return {};
        numbers.push_back(number);
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

// Item `n` (from 0) of a sequence.
const gdcm::DataSet* item_of(const gdcm::DataSet& set, gdcm::Tag tag, std::size_t n) {
    if (!set.FindDataElement(tag)) return nullptr;
    const auto sequence = set.GetDataElement(tag).GetValueAsSQ();
    if (!sequence || n >= sequence->GetNumberOfItems()) return nullptr;
    return &sequence->GetItem(n + 1).GetNestedDataSet();
}

void take_geometry(const gdcm::DataSet& position, const gdcm::DataSet& orientation, const gdcm::DataSet& measures,
                   DicomImage& image) {
    if (const auto p = decimals_of(position, {0x0020, 0x0032}); p.size() == 3) image.position = Vec3(p[0], p[1], p[2]);
    if (const auto o = decimals_of(orientation, {0x0020, 0x0037}); o.size() == 6) {
        image.along_row = Vec3(o[0], o[1], o[2]);
        image.along_column = Vec3(o[3], o[4], o[5]);
    }
    if (const auto s = decimals_of(measures, {0x0028, 0x0030}); s.size() == 2) {
        image.row_spacing = s[0];
        image.column_spacing = s[1];
    }
}

void take_rescale(const gdcm::DataSet& set, DicomImage& image) {
    const auto slope = decimals_of(set, {0x0028, 0x1053}), intercept = decimals_of(set, {0x0028, 0x1052});
    if (slope.empty() && intercept.empty()) return;
    image.has_rescale = true;
    image.slope = slope.empty() || slope[0] == 0.0 ? 1.0 : slope[0];
    image.intercept = intercept.empty() ? 0.0 : intercept[0];
    image.rescale_type = text_of(set, {0x0028, 0x1054});
}

// Enhanced files state position and rescale per frame, or once for all frames.
void take_functional_groups(const gdcm::DataSet& set, std::size_t frame, DicomImage& image) {
    const gdcm::DataSet* shared = item_of(set, {0x5200, 0x9229}, 0);
    const gdcm::DataSet* own = item_of(set, {0x5200, 0x9230}, frame);
    const auto group = [&](gdcm::Tag tag) -> const gdcm::DataSet* {
        const gdcm::DataSet* found = own ? item_of(*own, tag, 0) : nullptr;
        return found || !shared ? found : item_of(*shared, tag, 0);
    };
    const gdcm::DataSet none;
    const gdcm::DataSet *position = group({0x0020, 0x9113}), *orientation = group({0x0020, 0x9116});
    const gdcm::DataSet *measures = group({0x0028, 0x9110}), *values = group({0x0028, 0x9145});
    take_geometry(position ? *position : none, orientation ? *orientation : none, measures ? *measures : none, image);
    if (values) take_rescale(*values, image);
}

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
};

template <typename Stored>
void rescale(const char* bytes, const Layout& layout, const DicomImage& image, std::span<float> out) {
    const int shift = std::max(layout.high_bit + 1 - layout.bits_stored, 0), unused = 64 - layout.bits_stored;
    for (std::size_t n = 0; n < out.size(); ++n) {
        Stored stored;
        std::memcpy(&stored, bytes + n * sizeof(Stored), sizeof(Stored));
        const std::uint64_t top = (std::uint64_t{stored} >> shift) << unused;
        const double value =
            layout.is_signed ? double(static_cast<std::int64_t>(top) >> unused) : double(top >> unused);
        out[n] = static_cast<float>(image.slope * value + image.intercept);
    }
}

// The images that `reader`, which has its input, finds in `file` of `size` bytes.
std::vector<DicomImage> images_of(gdcm::Reader& reader, const DicomImage& file, double size) {
    const std::string name = file.file.string();
    std::vector<DicomImage> images;
    try {
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
        image.is_inverted = text_of(set, {0x0028, 0x0004}) == "MONOCHROME1";
        if (binary_of(set, {0x0028, 0x0002}, 1) != 1)
            throw Error(fmt::format("{}: this is a colour image, not a CT", name));
        // GDCM reads the number of frames of these classes without checking that it exists.
        gdcm::MediaStorage kind;
        kind.SetFromFile(reader.GetFile());
        if (kind.GetModalityDimension() > 2 && !set.FindDataElement(gdcm::Tag(0x0028, 0x0008)))
            throw Error(fmt::format("{}: a multi-frame image without a number of frames", name));
        const gdcm::TransferSyntax& syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
        image.syntax = gdcm::TransferSyntax::GetTSString(syntax) ? gdcm::TransferSyntax::GetTSString(syntax) : "";
        take_geometry(set, set, set, image);
        take_rescale(set, image);
        const auto counted = decimals_of(set, {0x0028, 0x0008});
        const double frames = counted.empty() ? 1.0 : counted[0];
        if (!(frames >= 1.0 && frames <= 100000.0))
            throw Error(fmt::format("{}: {:g} frames are not possible", name, frames));
        check_claim(image, size, static_cast<int>(frames), binary_of(set, {0x0028, 0x0100}, 16),
                    syntax.IsEncapsulated());
        const bool enhanced = set.FindDataElement(gdcm::Tag(0x5200, 0x9230));
        for (int frame = 0; frame < static_cast<int>(frames); ++frame) {
            image.frame = frame;
            image.is_one_of_several = frames > 1.0;
            images.push_back(image);
            if (enhanced) take_functional_groups(set, static_cast<std::size_t>(frame), images.back());
        }
    } catch (const Error&) {
        throw;
    } catch (const std::exception& failure) {
        throw Error(fmt::format("{}: cannot be read as DICOM: {}", name, failure.what()));
    }
    return images;
}

}  // namespace

std::vector<DicomImage> dicom_images(const std::filesystem::path& file) {
    silence();
    check_dicom_elements(file);
    gdcm::Reader reader;
    reader.SetFileName(file.c_str());
    DicomImage from;
    from.file = file;
    return images_of(reader, from, static_cast<double>(file::require_file(file)));
}

std::vector<DicomImage> dicom_images(const std::shared_ptr<const file::ZipFile>& archive,
                                     const file::ZipFile::Entry& entry) {
    silence();
    std::string bytes = archive->read(entry);
    check_dicom_elements(bytes, entry.name);
    std::istringstream stream(std::move(bytes));
    gdcm::Reader reader;
    reader.SetStream(stream);
    DicomImage from;
    from.file = entry.name;
    from.archive = archive;
    from.entry = entry;
    return images_of(reader, from, static_cast<double>(entry.size));
}

std::vector<DicomImage> dicom_images_beside(const DicomImage& image) {
    return image.archive ? dicom_images(image.archive, image.entry) : dicom_images(image.file);
}

std::vector<float> dicom_samples(const std::vector<DicomImage>& images) {
    silence();
    const DicomImage& first = images.front();
    const std::string file = first.file.string();
    const auto refuse = [&](std::string_view why) {
        throw Error(fmt::format("{}: the image cannot be decoded ({}): {}", file, first.syntax, why));
    };
    try {
        gdcm::ImageReader reader;
        std::istringstream stream;
        if (first.archive) {
            stream.str(first.archive->read(first.entry));
            reader.SetStream(stream);
        } else {
            reader.SetFileName(file.c_str());
        }
        if (!reader.Read()) refuse("damaged, cut short, or compressed in a way that GDCM does not support");
        const gdcm::Image& picture = reader.GetImage();
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
        const std::size_t each = static_cast<std::size_t>(first.rows) * static_cast<std::size_t>(first.columns);
        if (picture.GetBufferLength() != each * images.size() * bytes)
            refuse("the number of samples differs from the header");
        // The bytes in GDCM, the copy that it returns, and the floats.
        file::require_room(double(picture.GetBufferLength()) * (2.0 + sizeof(float) / double(bytes)), file,
                           "its samples");
        std::vector<char> buffer(picture.GetBufferLength());
        if (!picture.GetBuffer(buffer.data())) refuse("damaged or cut short");
        std::vector<float> values(each * images.size());
        for (std::size_t n = 0; n < images.size(); ++n) {
            const char* from = buffer.data() + n * each * bytes;
            const auto out = std::span(values).subspan(n * each, each);
            if (bytes == 1) rescale<std::uint8_t>(from, layout, images[n], out);
            else if (bytes == 2) rescale<std::uint16_t>(from, layout, images[n], out);
            else rescale<std::uint32_t>(from, layout, images[n], out);
        }
        return values;
    } catch (const Error&) {
        throw;
    } catch (const file::NoRoom&) {
        throw;
    } catch (const std::exception& failure) {
        refuse(failure.what());
    }
    return {};
}

}  // namespace tactus::volume
