// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/cutting_guide/guide_text.hpp"

#include "devices/display/figure_painter.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::analysis {

namespace {

using cutting_guide::GuideDesign;
using cutting_guide::GuideText;

constexpr double max_label = 16;        // characters

/// Letters of the given height of capitals.
class Letters {
public:
    explicit Letters(double height) {
        double ignored = 0.0;
        double low = 0.0;
        for (const auto& outline : display::figure_painter().outlines("H", 1.0, true, ignored))
            for (const auto& p : outline) low = std::min(low, p.y);
        size_ = height / -low;
    }
    GuideText text(const std::string& words) const {
        GuideText made;
        for (const auto& outline : display::figure_painter().outlines(words, size_, true, made.width)) {
            auto& to = made.outlines.emplace_back();
            for (const auto& p : outline) to.emplace_back(p.x, -p.y);
        }
        return made;
    }

private:
    double size_ = 1.0;
};

/// An arrow as high as capitals, after the text.
void add_arrow(GuideText& text, double height, bool to_right) {
    const double from = text.width + 0.5 * height, length = 2.5 * height, head = height, half = 0.5 * height;
    cutting_guide::Outline arrow{{0.0, 0.65 * half}, {length - head, 0.65 * half}, {length - head, 0.0},
                                 {length, half},     {length - head, 2.0 * half},  {length - head, 1.35 * half},
                                 {0.0, 1.35 * half}};
    for (auto& p : arrow) p.x = from + (to_right ? p.x : length - p.x);
    text.outlines.push_back(std::move(arrow));
    text.width = from + length;
}

}  // namespace

std::string label_of(const std::string& title, const std::string& chosen) {
    std::string label = chosen.empty() ? title : chosen;
    if (chosen.empty() && label.size() > max_label) label.resize(static_cast<std::size_t>(max_label));
    for (const char c : label)
        if (c < ' ' || c > '~')
            throw Error(fmt::format("'{}' cannot be engraved: --label takes printable ASCII characters", label));
    if (label.size() > max_label) throw Error(fmt::format("--label is longer than {:.0f} characters", max_label));
    return label;
}

void add_texts(GuideDesign& design, const std::string& title, const GuideChoice& choice, const std::string& side,
               bool arrow_to_right, std::string_view marks) {
    const double height = design.settings.text_height;
    const Letters letters(height);
    const std::string label = label_of(title, choice.label);
    design.text[0] = letters.text(label + "  " + side);
    design.text[1] = letters.text("RESEARCH");
    add_arrow(design.text[1], height, arrow_to_right);
    for (const char letter : marks) design.letters.push_back(letters.text(std::string(1, letter)));
}

GuideText engraved(const std::string& words, double height) { return Letters(height).text(words); }

}  // namespace tactus::analysis
