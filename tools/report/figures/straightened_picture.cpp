// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/straightened_picture.hpp"
#include "devices/display/png.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::report {

namespace {

constexpr int max_columns = 1600, margin = 6;
using Pixel = std::array<std::uint8_t, 3>;
constexpr Pixel edge{70, 170, 255}, lost{255, 150, 40};

class Page {
public:
    Page(int width, int height, int zoom) : zoom_(zoom) {
        image_.width = width * zoom, image_.height = height * zoom;
        image_.rgb.assign(3 * static_cast<std::size_t>(image_.width) * static_cast<std::size_t>(image_.height), 40);
    }
    void set(int x, int y, const Pixel& pixel) {
        if (x < 0 || y < 0 || x >= image_.width / zoom_ || y >= image_.height / zoom_) return;
        for (int n = 0; n < zoom_ * zoom_; ++n)
            std::copy(pixel.begin(), pixel.end(),
                      image_.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y * zoom_ + n / zoom_) * image_.width +
                                                x * zoom_ + n % zoom_));
    }
    const display::Image& image() const { return image_; }

private:
    display::Image image_;
    int zoom_;
};

}  // namespace

void write_picture(const vessel::Straightened& cuts, double background, double contrast,
                   const std::filesystem::path& path) {
    const int zoom = std::clamp(900 / cuts.columns, 1, 6);
    const int width = std::min(cuts.columns, max_columns);
    const int strips = (cuts.columns + width - 1) / width;
    const int strip_height = 2 * (cuts.rows + margin);
    Page page(width, strips * strip_height, zoom);
    const double low = background - 0.5 * contrast, range = 2.0 * contrast;
    for (int column = 0; column < cuts.columns; ++column) {
        const int x = column % width, top = column / width * strip_height;
        for (int cut = 0; cut < 2; ++cut) {
            const std::vector<float>& values = cut == 0 ? cuts.first : cuts.second;
            const int y = top + cut * (cuts.rows + margin);
            for (int row = 0; row < cuts.rows; ++row) {
                const double value =
                    double(values[static_cast<std::size_t>(row) * static_cast<std::size_t>(cuts.columns) +
                                  static_cast<std::size_t>(column)]);
                const auto grey = static_cast<std::uint8_t>(std::clamp((value - low) / range, 0.0, 1.0) * 255.0);
                page.set(x, y + row, {grey, grey, grey});
            }
            const std::size_t n = static_cast<std::size_t>(column);
            const int middle = y + cuts.rows / 2;
            const int off = std::min(cuts.rows / 2, static_cast<int>(std::lround(cuts.radius[n] / cuts.spacing)));
            const Pixel& colour = cuts.is_lost[n] ? lost : edge;
            page.set(x, middle - off, colour);
            page.set(x, middle + off, colour);
        }
    }
    display::write_png(page.image(), path.string());
}

}  // namespace tactus::report
