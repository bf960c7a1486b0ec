// SPDX-License-Identifier: Apache-2.0
#include "devices/display/png.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb/stb_image_write.h>

namespace tactus::display {

std::string png_bytes(const Image& image) {
    std::string bytes;
    const auto append = [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(), 3 * image.width) == 0)
        throw Error("a picture cannot be compressed");
    return bytes;
}

void write_png(const Image& image, const std::string& path) { file::write_whole_file(path, png_bytes(image)); }

}  // namespace tactus::display
