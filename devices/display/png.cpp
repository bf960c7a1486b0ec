// SPDX-License-Identifier: Apache-2.0
#include "devices/display/png.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <cmath>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image_write.h>

namespace tactus::display {

namespace {

void append_number(std::string& out, std::uint32_t number) {
    for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(number >> shift);
}

void append_chunk(std::string& out, std::string_view name, std::string_view data) {
    append_number(out, static_cast<std::uint32_t>(data.size()));
    std::string body(name);
    body += data;
    out += body;
    append_number(out, stbiw__crc32(reinterpret_cast<unsigned char*>(body.data()), static_cast<int>(body.size())));
}

}  // namespace

std::string palette_png_bytes(int columns, int rows, std::span<const std::uint8_t> cells,
                              std::span<const Colour> palette) {
    std::string lines;
    for (int row = 0; row < rows; ++row) {
        lines += '\0';  // no filter
        const auto line = cells.subspan(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns),
                                        static_cast<std::size_t>(columns));
        lines.append(line.begin(), line.end());
    }
    int size = 0;
    unsigned char* packed =
        stbi_zlib_compress(reinterpret_cast<unsigned char*>(lines.data()), static_cast<int>(lines.size()), &size, 9);
    if (packed == nullptr) throw Error("a picture cannot be compressed");
    const std::string data(reinterpret_cast<const char*>(packed), static_cast<std::size_t>(size));
    STBIW_FREE(packed);
    std::string head, colours;
    append_number(head, static_cast<std::uint32_t>(columns));
    append_number(head, static_cast<std::uint32_t>(rows));
    head += {8, 3, 0, 0, 0};  // bits, palette, usual compression and filter, not interlaced
    for (const Colour& c : palette)
        for (const std::uint8_t part : {c.red, c.green, c.blue}) colours += static_cast<char>(part);
    std::string out = "\x89PNG\r\n\x1a\n";
    append_chunk(out, "IHDR", head);
    append_chunk(out, "PLTE", colours);
    append_chunk(out, "IDAT", data);
    append_chunk(out, "IEND", {});
    return out;
}

std::string base64(std::string_view bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t n = 0; n < bytes.size(); n += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8 | (n + k < bytes.size() ? static_cast<unsigned char>(bytes[n + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += n + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string png_bytes(const Image& image, double dpi) {
    std::string bytes;
    const auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(), 3 * image.width) == 0)
        throw Error("a picture cannot be compressed");
    if (dpi > 0.0) {
        constexpr std::size_t end_of_header = 33;  // signature and IHDR
        const auto per_metre = static_cast<std::uint32_t>(std::lround(dpi / 0.0254));
        std::string resolution, chunk;
        append_number(resolution, per_metre);
        append_number(resolution, per_metre);
        resolution += '\1';  // per metre
        append_chunk(chunk, "pHYs", resolution);
        bytes.insert(end_of_header, chunk);
    }
    return bytes;
}

void write_png(const Image& image, const std::string& path) { file::write_whole_file(path, png_bytes(image)); }

}  // namespace tactus::display
