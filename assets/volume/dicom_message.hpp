// SPDX-License-Identifier: Apache-2.0
// Messages between DicomReader and its process.
#pragma once

#include "assets/volume/dicom_images.hpp"
#include "dsp/core/error.hpp"

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tactus::volume {

/// Descriptors of the process: the socket of messages, and the memory of files in a zip and of samples.
inline constexpr int decoder_socket = 3, decoder_memory = 4;

enum class DecoderRequest : char { headers = 'h', samples = 's' };
enum class DecoderReply : char { images = 'i', samples = 'v', refused = 'e', no_room = 'm' };

class MessageWriter {
public:
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void put_text(std::string_view text) {
        put(static_cast<std::uint32_t>(text.size()));
        bytes += text;
    }
    std::string bytes;
};

/// Throws Error when a message ends early: the process reads untrusted files, and is not trusted either.
class MessageReader {
public:
    explicit MessageReader(std::string_view bytes) : rest_(bytes) {}
    template <class T>
    T get() {
        static_assert(std::is_trivially_copyable_v<T>);
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    bool get_flag() { return take(1).front() != '\0'; }
    std::string get_text() {
        const auto size = get<std::uint32_t>();
        return std::string(take(size));
    }

private:
    std::string_view take(std::size_t size) {
        if (size > rest_.size()) throw Error("a message of the process that reads scans is incomplete");
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    std::string_view rest_;
};

/// Everything but file, archive and entry.
inline void put_image(MessageWriter& out, const DicomImage& image) {
    out.put(image.frame);
    out.put(image.is_one_of_several);
    for (const std::string* text : {&image.instance, &image.series, &image.description, &image.modality,
                                    &image.rescale_type, &image.syntax, &image.segment_name})
        out.put_text(*text);
    out.put(image.rows), out.put(image.columns);
    out.put(image.position.has_value());
    out.put(image.position.value_or(Vec3(0.0)));
    out.put(image.has_own_position);
    out.put(image.along_row), out.put(image.along_column);
    for (const double number : {image.row_spacing, image.column_spacing, image.slice_spacing, image.slice_thickness,
                                image.slope, image.intercept})
        out.put(number);
    for (const bool flag : {image.has_rescale, image.is_localizer, image.is_colour, image.is_inverted,
                            image.has_decimal_commas, image.has_zero_slope})
        out.put(flag);
    out.put(image.segment);
}

inline DicomImage get_image(MessageReader& in) {
    DicomImage image;
    image.frame = in.get<int>();
    image.is_one_of_several = in.get_flag();
    for (std::string* text : {&image.instance, &image.series, &image.description, &image.modality, &image.rescale_type,
                              &image.syntax, &image.segment_name})
        *text = in.get_text();
    image.rows = in.get<int>(), image.columns = in.get<int>();
    const bool has_position = in.get_flag();
    const Vec3 position = in.get<Vec3>();
    if (has_position) image.position = position;
    image.has_own_position = in.get_flag();
    image.along_row = in.get<Vec3>(), image.along_column = in.get<Vec3>();
    for (double* number : {&image.row_spacing, &image.column_spacing, &image.slice_spacing, &image.slice_thickness,
                           &image.slope, &image.intercept})
        *number = in.get<double>();
    for (bool* flag : {&image.has_rescale, &image.is_localizer, &image.is_colour, &image.is_inverted,
                       &image.has_decimal_commas, &image.has_zero_slope})
        *flag = in.get_flag();
    image.segment = in.get<int>();
    return image;
}

}  // namespace tactus::volume
