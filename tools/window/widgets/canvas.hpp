// SPDX-License-Identifier: Apache-2.0
// A plane with pan and zoom.
#pragma once

#include <algorithm>

namespace tactus::window {

struct Point {
    double x = 0.0, y = 0.0;

    Point operator+(Point b) const { return {x + b.x, y + b.y}; }
    Point operator-(Point b) const { return {x - b.x, y - b.y}; }
    Point operator*(double s) const { return {x * s, y * s}; }
};

struct Box {
    double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;

    double width() const { return right - left; }
    double height() const { return bottom - top; }
    Point middle() const { return {0.5 * (left + right), 0.5 * (top + bottom)}; }
    bool contains(Point p) const { return p.x >= left && p.x < right && p.y >= top && p.y < bottom; }
    bool meets(const Box& b) const { return left <= b.right && b.left <= right && top <= b.bottom && b.top <= bottom; }
};

/// Pixel = (world − origin) · zoom, from the upper left corner of the window.
struct Canvas {
    Point origin;
    double zoom = 1.0;  ///< pixels per unit
    static constexpr double min_zoom = 0.01, max_zoom = 4.0;

    Point to_pixel(Point world) const { return (world - origin) * zoom; }
    Point to_world(Point pixel) const { return pixel * (1.0 / zoom) + origin; }
    /// The visible part of the plane.
    Box visible(double width, double height) const {
        return {origin.x, origin.y, origin.x + width / zoom, origin.y + height / zoom};
    }
    void pan(Point pixels) { origin = origin - pixels * (1.0 / zoom); }
    /// Zooms about `pixel`, which keeps its position.
    void zoom_at(Point pixel, double factor) {
        const Point fixed = to_world(pixel);
        zoom = std::clamp(zoom * factor, min_zoom, max_zoom);
        origin = fixed - pixel * (1.0 / zoom);
    }
    /// Centres and fits `what` with a margin, at most at `largest` pixels per unit.
    void fit(const Box& what, double width, double height, double largest = 1.25) {
        constexpr double margin = 12.0;
        const double across = (width - 2 * margin) / std::max(1.0, what.width());
        const double down = (height - 2 * margin) / std::max(1.0, what.height());
        zoom = std::clamp(std::min({across, down, largest}), min_zoom, max_zoom);
        origin = what.middle() - Point{width, height} * (0.5 / zoom);
    }
};

}  // namespace tactus::window
