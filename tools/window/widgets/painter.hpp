// SPDX-License-Identifier: Apache-2.0
// Draws on a part of the window with the window's fonts.
#pragma once

#include "tools/window/widgets/canvas.hpp"

#include <imgui.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace tactus::window {

inline ImVec2 vec(Point p) { return ImVec2(static_cast<float>(p.x), static_cast<float>(p.y)); }
inline Point point(ImVec2 v) { return {static_cast<double>(v.x), static_cast<double>(v.y)}; }

struct Fonts {
    ImFont *body, *bold, *large;
    double scale;  ///< of the window's contents
    ImFont* small = nullptr;  ///< null: the body's
};

/// Text of any size, from the font with the nearest size.
class Painter {
public:
    Painter(ImDrawList* list, const Fonts& fonts) : list_(list), fonts_(fonts) {}

    ImDrawList* list() const { return list_; }

    double width_of(std::string_view text, double size, bool heavy = false) const {
        return static_cast<double>(
            font(size, heavy)
                ->CalcTextSizeA(static_cast<float>(size), 1e9f, 0.0f, text.data(), text.data() + text.size())
                .x);
    }
    /// `at` is the upper left corner.
    void text(Point at, double size, ImU32 ink, std::string_view text, bool heavy = false) const {
        // Aligned to pixels, because text between pixels is blurred.
        const ImVec2 whole(static_cast<float>(static_cast<int>(at.x)), static_cast<float>(static_cast<int>(at.y)));
        list_->AddText(font(size, heavy), static_cast<float>(size), whole, ink, text.data(), text.data() + text.size());
    }
    void text_left_of(Point at, double size, ImU32 ink, std::string_view words, bool heavy = false) const {
        text({at.x - width_of(words, size, heavy), at.y}, size, ink, words, heavy);
    }
    /// Truncates a text to a width.
    std::string shortened(std::string text, double size, double width, bool heavy = false) const {
        if (width_of(text, size, heavy) <= width) return text;
        while (text.size() > 1 && width_of(text + "…", size, heavy) > width) {
            do text.pop_back();
            while (text.size() > 1 && (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80);
        }
        return text + "…";
    }
    void box(const Box& b, ImU32 ink, double rounding = 0.0) const {
        list_->AddRectFilled(vec({b.left, b.top}), vec({b.right, b.bottom}), ink, static_cast<float>(rounding));
    }
    void frame(const Box& b, ImU32 ink, double rounding = 0.0, double width = 1.0) const {
        list_->AddRect(vec({b.left, b.top}), vec({b.right, b.bottom}), ink, static_cast<float>(rounding), 0,
                       static_cast<float>(width));
    }
    void line(Point a, Point b, ImU32 ink, double width = 1.0) const {
        list_->AddLine(vec(a), vec(b), ink, static_cast<float>(width));
    }
    void dot(Point at, double radius, ImU32 ink) const {
        list_->AddCircleFilled(vec(at), static_cast<float>(radius), ink);
    }

private:
    ImFont* font(double size, bool heavy) const {
        if (heavy) return fonts_.bold;
        if (fonts_.small && size < 0.9 * static_cast<double>(fonts_.body->FontSize)) return fonts_.small;
        return size > 1.3 * static_cast<double>(fonts_.body->FontSize) ? fonts_.large : fonts_.body;
    }

    ImDrawList* list_;
    const Fonts& fonts_;
};

}  // namespace tactus::window
