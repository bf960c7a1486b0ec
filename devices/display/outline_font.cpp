// SPDX-License-Identifier: Apache-2.0
#include "devices/display/outline_font.hpp"

#include "devices/display/system_font.hpp"

#include <fstream>
#include <iterator>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <stb/stb_easy_font.h>
#include <stb/stb_truetype.h>
#pragma GCC diagnostic pop

namespace tactus::display {

namespace {

/// Data of a system font; empty when none of the usual fonts is installed.
std::string font_bytes(bool bold) {
    std::ifstream file(system_font(bold), std::ios::binary);
    if (!file) return {};
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Next code point of UTF-8 text.
int next_code(const std::string& text, std::size_t& at) {
    const auto byte = static_cast<unsigned char>(text[at++]);
    int more = byte >= 0xF0 ? 3 : byte >= 0xE0 ? 2 : byte >= 0xC0 ? 1 : 0;
    int code = more == 3 ? byte & 7 : more == 2 ? byte & 15 : more == 1 ? byte & 31 : byte;
    for (; more > 0 && at < text.size(); --more) code = code << 6 | (static_cast<unsigned char>(text[at++]) & 63);
    return code;
}

}  // namespace

struct OutlineFont::Data {
    explicit Data(bool bold) : bytes_(font_bytes(bold)) {
        const auto* data = reinterpret_cast<const unsigned char*>(bytes_.data());
        good_ = !bytes_.empty() && stbtt_InitFont(&info_, data, stbtt_GetFontOffsetForIndex(data, 0)) != 0;
    }

    std::vector<std::vector<FigurePoint>> outlines(const std::string& text, double size, double& width) const {
        return good_ ? scalable(text, size, width) : plain(text, size, width);
    }

    std::vector<std::vector<FigurePoint>> scalable(const std::string& text, double size, double& width) const {
        std::vector<std::vector<FigurePoint>> shapes;
        const double scale = static_cast<double>(stbtt_ScaleForMappingEmToPixels(&info_, static_cast<float>(size)));
        width = 0.0;
        for (std::size_t i = 0; i < text.size();) {
            const int code = next_code(text, i);
            stbtt_vertex* vertices = nullptr;
            const int count = stbtt_GetCodepointShape(&info_, code, &vertices);
            const auto at = [&](double x, double y) { return FigurePoint{width + x * scale, -y * scale}; };
            for (int v = 0; v < count; ++v) {
                const stbtt_vertex& to = vertices[v];
                if (to.type == STBTT_vmove) shapes.emplace_back();
                else if (to.type == STBTT_vcurve) {
                    constexpr int pieces = 5;
                    for (int p = 1; p < pieces; ++p) {
                        const double t = static_cast<double>(p) / pieces, s = 1.0 - t;
                        const stbtt_vertex& from = vertices[v - 1];
                        shapes.back().push_back(at(s * s * from.x + 2.0 * s * t * to.cx + t * t * to.x,
                                                   s * s * from.y + 2.0 * s * t * to.cy + t * t * to.y));
                    }
                }
                shapes.back().push_back(at(to.x, to.y));
            }
            stbtt_FreeShape(&info_, vertices);
            int advance = 0, bearing = 0;
            stbtt_GetCodepointHMetrics(&info_, code, &advance, &bearing);
            width += advance * scale;
        }
        return shapes;
    }

    static std::vector<std::vector<FigurePoint>> plain(const std::string& text, double size, double& width) {
        struct Vertex {
            float x, y, z;
            unsigned char colour[4];
        };
        std::string copy;
        for (std::size_t i = 0; i < text.size();) {
            const int code = next_code(text, i);
            copy += code >= 32 && code < 127 ? static_cast<char>(code) : '?';
        }
        std::vector<Vertex> quads(copy.size() * 80 + 4);
        const int count = stb_easy_font_print(0.0f, 0.0f, copy.data(), nullptr, quads.data(),
                                              static_cast<int>(quads.size() * sizeof(Vertex)));
        const double scale = size / 10.0, base = 8.0;  // its letters are 7 units high; the base line is at 8
        width = scale * stb_easy_font_width(copy.data());
        std::vector<std::vector<FigurePoint>> shapes;
        for (int q = 0; q < count; ++q) {
            auto& shape = shapes.emplace_back();
            for (int c = 0; c < 4; ++c) {
                const Vertex& v = quads[static_cast<std::size_t>(4 * q + c)];
                shape.push_back({scale * static_cast<double>(v.x), scale * (static_cast<double>(v.y) - base)});
            }
        }
        return shapes;
    }

    std::string bytes_;
    stbtt_fontinfo info_{};
    bool good_ = false;
};

OutlineFont::OutlineFont(bool bold) : data_(std::make_unique<const Data>(bold)) {}
OutlineFont::~OutlineFont() = default;

std::vector<std::vector<FigurePoint>> OutlineFont::outlines(const std::string& text, double size, double& width) const {
    return data_->outlines(text, size, width);
}

}  // namespace tactus::display
