// SPDX-License-Identifier: Apache-2.0
#include "tools/report/figures/inspection_picture.hpp"

#include "assets/bone/labels.hpp"
#include "devices/display/legend.hpp"
#include "devices/display/offscreen.hpp"
#include "devices/display/png.hpp"
#include "tools/render/painted_points.hpp"
#include "tools/render/scene_colours.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace tactus::report {

namespace {

constexpr int panel = 560, gap = 4, margin = 26;

// A 5 x 7 bitmap font for the sides of the patient; bits of a row from left to right.
std::array<int, 7> dots_of(char letter) {
    switch (letter) {
        case 'A': return {4, 10, 17, 17, 31, 17, 17};
        case 'P': return {30, 17, 17, 30, 16, 16, 16};
        case 'R': return {30, 17, 17, 30, 20, 18, 17};
        case 'L': return {16, 16, 16, 16, 16, 16, 31};
        case 'S': return {15, 16, 16, 14, 1, 1, 30};
        default: return {14, 4, 4, 4, 4, 4, 14};  // I
    }
}

struct Canvas {
    display::Image image;

    void set(int x, int y, const Vec3& colour) {
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
        for (int n = 0; n < 3; ++n)
            image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x)) +
                      static_cast<std::size_t>(n)] =
                static_cast<std::uint8_t>(std::clamp(colour[n], 0.0, 1.0) * 255.0 + 0.5);
    }
    void letter(int x, int y, char what) {
        constexpr int size = 2;
        const auto rows = dots_of(what);
        for (int v = 0; v < 7 * size; ++v)
            for (int u = 0; u < 5 * size; ++u)
                if (rows[static_cast<std::size_t>(v / size)] >> (4 - u / size) & 1)
                    set(x + u, y + v, Vec3(1.0, 0.85, 0.3));
    }
    void paste(const display::Image& from, int x, int y) {
        for (int v = 0; v < from.height; ++v)
            for (int u = 0; u < from.width; ++u) {
                const std::uint8_t* p = from.pixel(u, v);
                set(x + u, y + v, Vec3(p[0], p[1], p[2]) / 255.0);
            }
    }
};

// A slice orthogonal to `axis`; `across` and `down` are the axes of the panel; the letters label left, right, top and
// bottom.
struct Slice {
    int axis, across, down;
    bool upwards;
    std::string_view letters, name;
};
constexpr std::array<Slice, 3> slices{
    {{2, 0, 1, false, "RLAP", "axial"}, {1, 0, 2, true, "RLSI", "coronal"}, {0, 1, 2, true, "APSI", "sagittal"}}};

Vec3 colour_at(const analysis::Inspection& found, const std::array<double, 3>& u) {
    const volume::Grid& grid = found.grey;
    std::array<int, 3> low{}, nearest{};
    Vec3 share;
    for (std::size_t a = 0; a < 3; ++a) {
        low[a] = std::clamp(static_cast<int>(u[a]), 0, std::max(grid.size[a] - 2, 0));
        share[static_cast<int>(a)] = std::clamp(u[a] - low[a], 0.0, 1.0);
        nearest[a] = std::clamp(static_cast<int>(u[a] + 0.5), 0, grid.size[a] - 1);
    }
    if (found.is_labels) {
        const int label = static_cast<int>(grid.at(nearest[0], nearest[1], nearest[2]));
        return label == 0 ? Vec3(0.05) : bone::label_colour(label);
    }
    double sum = 0.0;
    for (int c = 0; c < 8; ++c) {
        double weight = 1.0;
        std::array<int, 3> at = low;
        for (int a = 0; a < 3; ++a) {
            const bool up = c >> a & 1;
            weight *= up ? share[a] : 1.0 - share[a];
            if (up)
                at[static_cast<std::size_t>(a)] =
                    std::min(low[static_cast<std::size_t>(a)] + 1, grid.size[static_cast<std::size_t>(a)] - 1);
        }
        sum += weight * double(grid.at(at[0], at[1], at[2]));
    }
    return Vec3((sum - found.window[0]) / std::max(found.window[1] - found.window[0], 1e-9));
}

void draw_slice(Canvas& canvas, const analysis::Inspection& found, const Slice& slice, const Vec3& centre_mm, int left,
                int top) {
    const volume::Grid& grid = found.grey;
    const auto extent = [&](int a) { return grid.size[static_cast<std::size_t>(a)] * grid.spacing[a]; };
    const double pixel = std::max(extent(slice.across), extent(slice.down)) / (panel - 2 * margin);  // m
    const int width = std::max(1, static_cast<int>(extent(slice.across) / pixel));
    const int height = std::max(1, static_cast<int>(extent(slice.down) / pixel));
    const int x0 = left + (panel - width) / 2, y0 = top + (panel - height) / 2;
    std::array<double, 3> u{};
    const auto fixed = static_cast<std::size_t>(slice.axis);
    u[fixed] = (centre_mm[slice.axis] * 1e-3 - grid.origin[slice.axis]) / grid.spacing[slice.axis];
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            u[static_cast<std::size_t>(slice.across)] = (x + 0.5) * pixel / grid.spacing[slice.across] - 0.5;
            const int row = slice.upwards ? height - 1 - y : y;
            u[static_cast<std::size_t>(slice.down)] = (row + 0.5) * pixel / grid.spacing[slice.down] - 0.5;
            canvas.set(x0 + x, y0 + y, colour_at(found, u));
        }
    canvas.letter(left + 6, top + panel / 2 - 7, slice.letters[0]);
    canvas.letter(left + panel - 16, top + panel / 2 - 7, slice.letters[1]);
    canvas.letter(left + panel / 2 - 5, top + 6, slice.letters[2]);
    canvas.letter(left + panel / 2 - 5, top + panel - 20, slice.letters[3]);
}

// The name of a panel, in its lower left corner.
void label(Canvas& canvas, const std::string& name, int left, int top) {
    display::Legend legend;
    legend.title = name;
    const display::Image text = display::legend_image(legend, 1.0);
    canvas.paste(text, left + 6, top + panel - text.height - 6);
}

display::PictureMesh picture_mesh(const mesh::ColouredSurface& from, const render::PaintedPoints& paint,
                                  const Vec3& origin) {
    std::vector<Vec3> normals(from.surface.vertices.size(), Vec3(0.0));
    display::PictureMesh mesh;
    for (const auto& t : from.surface.triangles) {
        const auto at = [&](std::size_t n) { return from.surface.vertices[static_cast<std::size_t>(t[n])]; };
        const Vec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
        for (const int corner : t) {
            normals[static_cast<std::size_t>(corner)] += normal;
            mesh.triangles.push_back(static_cast<std::uint32_t>(corner));
        }
    }
    for (std::size_t n = 0; n < normals.size(); ++n) {
        const Vec3& colour =
            paint.covers(from.surface.vertices[n], normals[n]) ? render::scene_colours::paint_colour : from.colour;
        for (int a = 0; a < 3; ++a) {
            mesh.positions.push_back(static_cast<float>(from.surface.vertices[n][a] - origin[a]));
            mesh.normals.push_back(static_cast<float>(normals[n][a] * 1e6));
            mesh.colours.push_back(static_cast<float>(colour[a]));
        }
    }
    return mesh;
}

/// The view from as near as shows all of the meshes in a square picture: a bounding sphere is larger than its content.
display::View closest(display::View view, const std::vector<display::PictureMesh>& meshes) {
    constexpr double rim = 1.08;
    const Vec3 into = glm::normalize(view.target - view.eye), right = glm::normalize(glm::cross(into, view.up)),
               up = glm::cross(right, into);
    const double slope = std::tan(0.5 * view.vertical_field_of_view_rad) / rim;
    double away = 1e-6;
    for (const display::PictureMesh& mesh : meshes)
        for (std::size_t n = 0; n + 2 < mesh.positions.size(); n += 3) {
            const Vec3 p = Vec3(mesh.positions[n], mesh.positions[n + 1], mesh.positions[n + 2]) - view.target;
            const double aside = std::max(std::abs(glm::dot(p, right)), std::abs(glm::dot(p, up)));
            away = std::max(away, aside / slope - glm::dot(p, into));
        }
    view.eye = view.target - away * into;
    return view;
}

}  // namespace

void write_picture(const analysis::Inspection& found, const std::filesystem::path& path) {
    // Of each surface its own: a neighbour that touches it is not painted.
    std::vector<render::PaintedPoints> paint(found.surfaces.size());
    for (std::size_t n = 0; n < std::min(paint.size(), found.painted.size()); ++n)
        for (const auto& [at, normal] : found.painted[n]) paint[n].add(at, normal);
    const bool is_painted = !std::ranges::all_of(paint, &render::PaintedPoints::empty);
    Canvas canvas;
    canvas.image.height = 2 * panel + gap;
    canvas.image.width = canvas.image.height + (is_painted ? panel + gap : 0);
    canvas.image.rgb.assign(
        static_cast<std::size_t>(canvas.image.width) * static_cast<std::size_t>(canvas.image.height) * 3, 12);
    Vec3 low(1e30), high(-1e30);
    for (const auto& each : found.surfaces)
        for (const Vec3& v : each.surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
    const Vec3 middle = low.x <= high.x ? 0.5 * (low + high) : found.grey.origin;
    std::vector<display::PictureMesh> meshes;
    for (std::size_t n = 0; n < found.surfaces.size(); ++n)
        if (!found.surfaces[n].surface.triangles.empty())
            meshes.push_back(picture_mesh(found.surfaces[n], paint[n], middle));
    const auto view = [&](const std::string& name, const Vec3& direction, const Vec3& up, int left, int top) {
        if (meshes.empty()) return;
        const display::View from = closest(display::fit_view(low - middle, high - middle, direction, up), meshes);
        canvas.paste(display::render_picture(meshes, from, panel, panel), left, top);
        label(canvas, name, left, top);
    };
    const std::array<std::array<int, 2>, 3> places{{{0, 0}, {panel + gap, 0}, {0, panel + gap}}};
    if (found.grey.values.empty()) {
        // From the front, from above and from the patient's left.
        view("front", Vec3(0, 1, 0), Vec3(0, 0, 1), places[0][0], places[0][1]);
        view("top", Vec3(0, 0, -1), Vec3(0, -1, 0), places[1][0], places[1][1]);
        view("left", Vec3(-1, 0, 0), Vec3(0, 0, 1), places[2][0], places[2][1]);
    } else {
        Vec3 centre =
            (found.grey.origin +
             0.5 * Vec3(found.grey.size[0] - 1, found.grey.size[1] - 1, found.grey.size[2] - 1) * found.grey.spacing) *
            1e3;
        if (!found.parts.empty())
            for (int a = 0; a < 3; ++a) {
                const auto& bounds = found.parts.front().bounds_mm[static_cast<std::size_t>(a)];
                centre[a] = 0.5 * (bounds[0] + bounds[1]);
            }
        for (std::size_t n = 0; n < 3; ++n) {
            draw_slice(canvas, found, slices[n], centre, places[n][0], places[n][1]);
            label(canvas,
                  fmt::format("{}, {} = {:.1f} mm", slices[n].name, "xyz"[slices[n].axis], centre[slices[n].axis]),
                  places[n][0], places[n][1]);
        }
    }
    view("front left", Vec3(-0.55, 0.8, -0.25), Vec3(0, 0, 1), panel + gap, panel + gap);
    if (is_painted) {
        // Paint may lie on any side.
        view("back right, from below", Vec3(0.55, -0.8, 0.25), Vec3(0, 0, 1), 2 * (panel + gap), panel + gap);
        view("front right, from below", Vec3(0.8, 0.55, 0.5), Vec3(0, 0, 1), 2 * (panel + gap), 0);
    }
    display::write_png(canvas.image, path.string());
}

}  // namespace tactus::report
