// SPDX-License-Identifier: Apache-2.0
#include "devices/display/read_png.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <cstddef>

namespace tactus::display {

Image read_png(const std::string& path) {
    const std::string bytes = file::read_whole_file(path);
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    constexpr int largest = 4096;
    int width = 0, height = 0, parts = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &parts) || width > largest || height > largest)
        throw Error(fmt::format("{}: this is no PNG picture of at most {} pixels a side", path, largest));
    stbi_uc* pixels = stbi_load_from_memory(data, size, &width, &height, &parts, 3);
    if (!pixels) throw Error(fmt::format("{}: the picture is damaged", path));
    Image image;
    image.width = width;
    image.height = height;
    image.rgb.assign(pixels, pixels + static_cast<std::ptrdiff_t>(3) * width * height);
    stbi_image_free(pixels);
    return image;
}

}  // namespace tactus::display
