// SPDX-License-Identifier: Apache-2.0
#include "dsp/cutting_guide/plate_template.hpp"

#include "dsp/core/error.hpp"
#include "dsp/cutting_guide/guide_solid.hpp"
#include "dsp/geometry/dual_contour.hpp"
#include "dsp/geometry/spline.hpp"
#include "dsp/geometry/triangle_tree.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace tactus::cutting_guide {

namespace {

constexpr double bed_cell = 0.5 * mm;  // of the heights of the bed
constexpr double smoothing = 8.0 * mm;  // of the curve
constexpr double station_step = 2.0 * mm;
constexpr double sought_above = 12.0 * mm, sought_below = 12.0 * mm;  // of the curve: where bone is sought
constexpr double min_part = 8e-9;  // m³

/// A smooth curve along the points of a plate, with the directions out of the bone.
class PlateCurve {
public:
    struct Frame {
        Vec3 at, along, out, aside;  // out and aside are across along
    };

    explicit PlateCurve(const reconstruction::Plate& plate) {
        std::vector<double> knots;
        std::array<std::vector<double>, 6> values;
        const Vec3* before = nullptr;
        for (std::size_t n = 0; n < plate.points.size(); ++n) {
            const double gone = before ? glm::length(plate.points[n] - *before) : 0.0;
            if (before && gone < 0.5 * mm) continue;
            before = &plate.points[n];
            knots.push_back(knots.empty() ? 0.0 : knots.back() + gone);
            for (int axis = 0; axis < 3; ++axis) {
                values[static_cast<std::size_t>(axis)].push_back(plate.points[n][axis]);
                values[static_cast<std::size_t>(axis) + 3].push_back(plate.outward[n][axis]);
            }
        }
        if (knots.size() < 2) throw Error(fmt::format("plate '{}' has no course: it needs two points", plate.name));
        for (auto& list : values) list = smoothed(knots, list);
        // Lengths are those of the smoothed course, which cuts off steps of the bone.
        for (std::size_t n = 1; n < knots.size(); ++n) {
            Vec3 step(0.0);
            for (std::size_t axis = 0; axis < 3; ++axis)
                step[static_cast<int>(axis)] = values[axis][n] - values[axis][n - 1];
            knots[n] = knots[n - 1] + std::max(glm::length(step), 0.01 * mm);
        }
        length_ = knots.back();
        for (auto& list : values) splines_.emplace_back(knots, list);
        for (double s = 0.0; s < length_ + station_step; s += station_step)
            stations_.push_back(frame(std::min(s, length_)).at);
    }

    double length() const { return length_; }
    /// Beyond its ends straight on.
    Frame frame(double s) const {
        Frame f;
        Vec3 out(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            const auto point = splines_[static_cast<std::size_t>(axis)](s);
            f.at[axis] = point.value, f.along[axis] = point.slope;
            out[axis] = splines_[static_cast<std::size_t>(axis) + 3](std::clamp(s, 0.0, length_)).value;
        }
        f.along = glm::normalize(f.along);
        f.out = glm::normalize(out - glm::dot(out, f.along) * f.along);
        f.aside = glm::cross(f.along, f.out);
        return f;
    }
    /// Of a point: along the curve, aside and out of the bone, m.
    Vec3 local(const Vec3& p) const {
        std::size_t nearest = 0;
        double least = infinity;
        for (std::size_t n = 0; n < stations_.size(); ++n)
            if (const Vec3 r = p - stations_[n]; glm::dot(r, r) < least) least = glm::dot(r, r), nearest = n;
        double s = std::min(static_cast<double>(nearest) * station_step, length_);
        Frame f = frame(s);
        for (int round = 0; round < 6; ++round) {
            const double more = glm::dot(p - f.at, f.along);
            s += more;
            f = frame(s);
            if (std::abs(more) < 1e-7) break;
        }
        return {s, glm::dot(p - f.at, f.aside), glm::dot(p - f.at, f.out)};
    }
    Vec3 place(const Vec3& l) const {
        const Frame f = frame(l.x);
        return f.at + l.y * f.aside + l.z * f.out;
    }
    /// 1/m, of the bend towards the bone.
    double bend(double s) const {
        constexpr double h = 1.0 * mm;
        const Frame a = frame(s - h), b = frame(s + h);
        return glm::dot(b.out - a.out, frame(s).along) / glm::length(b.at - a.at);
    }

private:
    /// By lines through the neighbours of each knot, weighted by their distance: steps and kinks of the bone between
    /// segments shape the bed, not the curve.
    static std::vector<double> smoothed(const std::vector<double>& knots, const std::vector<double>& values) {
        std::vector<double> all;
        for (const double at : knots) {
            double w = 0.0, x = 0.0, xx = 0.0, y = 0.0, xy = 0.0;
            for (std::size_t n = 0; n < knots.size(); ++n) {
                const double away = (knots[n] - at) / smoothing, weight = std::exp(-0.5 * away * away);
                w += weight, x += weight * away, xx += weight * away * away;
                y += weight * values[n], xy += weight * away * values[n];
            }
            const double spread = w * xx - x * x;
            all.push_back(spread > 1e-9 * w * w ? (xx * y - x * xy) / spread : y / w);
        }
        return all;
    }

    std::vector<geometry::Spline> splines_;
    std::vector<Vec3> stations_;
    double length_ = 0.0;
};

/// Heights of the bed over the curve's along and aside.
class Bed {
public:
    Bed(const PlateCurve& curve, const geometry::TriangleTree& bone, double beyond, double half_width, double lowest,
        double max_slope, const RunJobs& run)
        : low_x_(-beyond),
          low_y_(-half_width),
          columns_(static_cast<int>(std::ceil((curve.length() + 2.0 * beyond) / bed_cell)) + 1),
          rows_(static_cast<int>(std::ceil(2.0 * half_width / bed_cell)) + 1) {
        bone_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), -infinity);
        run(columns_, [&](int i) {
            for (int j = 0; j < rows_; ++j) {
                const PlateCurve::Frame f = curve.frame(x(i));
                const double part = bone.sweep(f.at + y(j) * f.aside + sought_above * f.out,
                                               -(sought_above + sought_below) * f.out, 1e-9);
                if (part < 1.0) bone_[index(i, j)] = sought_above - part * (sought_above + sought_below);
            }
        });
        // The lowest surface of that slope above all bone: two passes as of a chamfer distance.
        height_ = bone_;
        for (double& h : height_) h = std::max(h, lowest);
        const double step = max_slope * bed_cell, aslant = step * std::sqrt(2.0);
        const auto raise = [&](int i, int j, int di, int dj) {
            const int a = i + di, b = j + dj;
            if (a < 0 || b < 0 || a >= columns_ || b >= rows_) return;
            double& here = height_[index(i, j)];
            here = std::max(here, height_[index(a, b)] - (di != 0 && dj != 0 ? aslant : step));
        };
        for (int i = 0; i < columns_; ++i)
            for (int j = 0; j < rows_; ++j)
                raise(i, j, -1, 0), raise(i, j, 0, -1), raise(i, j, -1, -1), raise(i, j, -1, 1);
        for (int i = columns_; i-- > 0;)
            for (int j = rows_; j-- > 0;) raise(i, j, 1, 0), raise(i, j, 0, 1), raise(i, j, 1, 1), raise(i, j, 1, -1);
    }

    double height(double along, double aside) const {
        const double u = std::clamp((along - low_x_) / bed_cell, 0.0, columns_ - 1.0),
                     v = std::clamp((aside - low_y_) / bed_cell, 0.0, rows_ - 1.0);
        const int i = std::min(static_cast<int>(u), columns_ - 2), j = std::min(static_cast<int>(v), rows_ - 2);
        const double s = u - i, t = v - j;
        return (1.0 - s) * ((1.0 - t) * height_[index(i, j)] + t * height_[index(i, j + 1)]) +
               s * ((1.0 - t) * height_[index(i + 1, j)] + t * height_[index(i + 1, j + 1)]);
    }
    double highest() const { return *std::ranges::max_element(height_); }

    /// Of what lies below the plate.
    void measure(MadeTemplate& made, double length, double half_width) const {
        std::size_t all = 0, with_bone = 0, on = 0;
        for (int i = 0; i < columns_; ++i)
            for (int j = 0; j < rows_; ++j) {
                if (x(i) < 0.0 || x(i) > length || std::abs(y(j)) > half_width) continue;
                ++all;
                if (!std::isfinite(bone_[index(i, j)])) continue;
                const double span = height_[index(i, j)] - bone_[index(i, j)];
                ++with_bone, on += span < 0.1 * mm;
                made.max_span = std::max(made.max_span, span);
            }
        if (all == 0) return;
        made.bone_share = static_cast<double>(with_bone) / static_cast<double>(all);
        made.on_bone_share = static_cast<double>(on) / static_cast<double>(all);
    }

private:
    double x(int i) const { return low_x_ + bed_cell * i; }
    double y(int j) const { return low_y_ + bed_cell * j; }
    std::size_t index(int i, int j) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(j);
    }

    double low_x_, low_y_;
    int columns_, rows_;
    std::vector<double> bone_, height_;
};

/// In the coordinates of the curve: below the bed, above the lower side, between the sides and the ends; with marks and
/// text.
class TemplateSolid final : public geometry::ImplicitSolid {
public:
    TemplateSolid(const PlateCurve& curve, const Bed& bed, const MadeTemplate& made, const TemplateDesign& design)
        : curve_(curve),
          bed_(bed),
          made_(made),
          set_(design.settings),
          text_(design.text),
          has_text_(!design.text.outlines.empty()),
          text_end_(0.5 * (curve.length() + design.text.width)) {}

    double value(const Vec3& p) const noexcept override {
        // Slopes of the bed and the bend of the curve let it change faster than the distance.
        return 0.4 * evaluate(p);
    }
    Vec3 normal(const Vec3& p) const noexcept override {
        // Of the face that is active at p, on either side of it.
        int face = 0;
        evaluate(p, &face);
        constexpr double h = 0.01 * mm;
        Vec3 g(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 step(0.0);
            step[axis] = h;
            g[axis] = of_face(face, p + step) - of_face(face, p - step);
        }
        const double length = glm::length(g);
        return length > 0.0 ? g / length : Vec3(0.0, 0.0, 1.0);
    }

private:
    enum Face { bed, under, one_side, other_side, start, finish, round, end, text, text_ground };

    double of(Face face, const Vec3& p, const Vec3& l, std::size_t mark) const {
        switch (face) {
            case bed: return l.z - bed_.height(l.x, l.y);
            case under: return -set_.thickness - l.z;
            case one_side: return l.y - 0.5 * made_.width;
            case other_side: return -l.y - 0.5 * made_.width;
            case start: return -set_.margin - l.x;
            case finish: return l.x - curve_.length() - set_.margin;
            case round: {
                const HoleMark& m = made_.marks[mark];
                const Vec3 r = p - m.at;
                return glm::length(r - glm::dot(r, m.axis) * m.axis) - 0.5 * m.diameter;
            }
            case end: {
                const HoleMark& m = made_.marks[mark];
                const double up = glm::dot(p - m.at, m.axis);
                return set_.marks == HoleMarks::pins ? std::max(up - set_.mark, -up - 2.0 * mm)
                                                     : std::max(-set_.mark - up, up - 5.0 * mm);
            }
            case text: return text_.value(text_end_ - l.x, text_height(l));
            case text_ground: return l.y + 0.5 * made_.width - set_.text_depth;
        }
        return 0.0;
    }
    // Who looks at this side with the bed up sees the curve run to the left.
    double text_height(const Vec3& l) const { return l.z + set_.thickness - 1.0 * mm; }
    double of_face(int code, const Vec3& p) const {
        const int kind = code % 16;
        const bool is_cut = (code & 1 << 12) != 0;
        const double value = of(static_cast<Face>(kind), p, curve_.local(p), static_cast<std::size_t>(code / 16 % 256));
        return is_cut ? -value : value;
    }
    double evaluate(const Vec3& p, int* active = nullptr) const {
        const Vec3 l = curve_.local(p);
        double found = -infinity;
        int by = 0;
        for (const Face face : {bed, under, one_side, other_side, start, finish})
            if (const double here = of(face, p, l, 0); here > found) found = here, by = face;
        for (std::size_t n = 0; n < made_.marks.size(); ++n) {
            const double wall = of(round, p, l, n), top = of(end, p, l, n), here = std::max(wall, top);
            const int face = (wall > top ? round : end) + 16 * static_cast<int>(n);
            if (set_.marks == HoleMarks::pins && here < found) found = here, by = face;
            if (set_.marks == HoleMarks::dimples && -here > found) found = -here, by = face + (1 << 12);
        }
        if (has_text_) {
            const double letters = of(text, p, l, 0), ground = of(text_ground, p, l, 0);
            if (const double here = std::max(letters, ground); -here > found)
                found = -here, by = (letters > ground ? text : text_ground) + (1 << 12);
        }
        if (active) *active = by;
        return found;
    }

    const PlateCurve& curve_;
    const Bed& bed_;
    const MadeTemplate& made_;
    const TemplateSettings& set_;
    TextField text_;
    bool has_text_;
    double text_end_;
};

void check(const TemplateDesign& design) {
    const TemplateSettings& s = design.settings;
    const auto positive = [](double value, const char* what) {
        if (!(value > 0.0 && value < 0.1)) throw Error(fmt::format("a template needs a {} above 0", what));
    };
    positive(s.thickness, "thickness"), positive(s.voxel, "voxel"), positive(s.mark, "height of its marks");
    positive(s.max_slope * mm, "slope of its bed"), positive(design.plate.width, "width of the plate");
    if (!(s.margin >= 0.0)) throw Error("the margin of a template is negative");
    if (design.plate.points.size() < 2 || design.plate.outward.size() != design.plate.points.size())
        throw Error(fmt::format("plate '{}' has no course: it needs two points", design.plate.name));
    if (design.plate.screws.size() > 255) throw Error("a template has marks for up to 255 holes");
    for (const reconstruction::Screw& screw : design.plate.screws)
        if (const double pin = screw.diameter - 2.0 * s.clearance; s.marks == HoleMarks::pins && pin < s.min_pin)
            throw Error(
                fmt::format("a pin of {:.2f} mm for a hole of {:.2f} mm is thinner than {:.2f} mm: dimples mark "
                            "such holes",
                            pin / mm, screw.diameter / mm, s.min_pin / mm));
}

}  // namespace

MadeTemplate make_template(const TemplateDesign& design, const RunJobs& run) {
    check(design);
    const TemplateSettings& set = design.settings;
    const PlateCurve curve(design.plate);
    MadeTemplate made;
    made.length = curve.length() + 2.0 * set.margin, made.width = design.plate.width + 2.0 * set.margin;
    double bend = 1.0;
    for (double s = 0.0; s <= curve.length(); s += 1.0 * mm) bend = std::max(bend, curve.bend(s));
    made.min_radius = 1.0 / bend;
    if (made.min_radius < set.thickness + 1.0 * mm)
        throw Error(
            fmt::format("plate '{}' bends with a radius of {:.1f} mm, more tightly than a template of {:.1f} mm "
                        "can follow: a thinner one (--thickness), or a plate with fewer bends",
                        design.plate.name, made.min_radius / mm, set.thickness / mm));
    const geometry::TriangleTree bone(design.bone);
    const Bed bed(curve, bone, set.margin, 0.5 * made.width, -0.5 * set.thickness, set.max_slope, run);
    bed.measure(made, curve.length(), 0.5 * design.plate.width);
    for (const reconstruction::Screw& screw : design.plate.screws) {
        const Vec3 l = curve.local(screw.head);
        made.marks.push_back({curve.place({l.x, l.y, bed.height(l.x, l.y)}), -glm::normalize(screw.axis),
                              screw.diameter - (set.marks == HoleMarks::pins ? 2.0 * set.clearance : 0.0)});
    }
    const TemplateSolid solid(curve, bed, made, design);
    volume::Grid grid;
    Vec3 low(infinity), high(-infinity);
    const double top = bed.highest() + set.mark + 2.0 * mm;
    for (double s = -set.margin; s <= curve.length() + set.margin + 1.0 * mm; s += 1.0 * mm)
        for (const double y : {-0.5 * made.width, 0.5 * made.width})
            for (const double z : {-set.thickness, top}) {
                const Vec3 p = curve.place({s, y, z});
                low = glm::min(low, p), high = glm::max(high, p);
            }
    grid.origin = low - 3.0 * set.voxel, grid.spacing = Vec3(set.voxel);
    double count = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        grid.size[static_cast<std::size_t>(axis)] =
            static_cast<int>(std::ceil((high[axis] - low[axis]) / set.voxel)) + 7;
        count *= grid.size[static_cast<std::size_t>(axis)];
    }
    if (!(count < 150e6)) throw Error("the template needs too many voxels: a coarser voxel (--voxel)");
    made.surface = geometry::dual_contour(grid, solid, min_part, run).surface;
    if (made.surface.triangles.empty()) throw Error("nothing is left of the template");
    return made;
}

}  // namespace tactus::cutting_guide
