// SPDX-License-Identifier: Apache-2.0
#include "dsp/skin/paddle.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::skin {

namespace {

constexpr double touching_gap = 0.3e-3;   // m above half of the thickness that counts as lying on bone
constexpr double sample_spacing = 0.5e-3;  // m, of the points that measure coverage
constexpr int max_samples_per_side = 400;
constexpr double suture_slack = 1.5e-3, suture_stiffness = 50.0;  // m, N/m; assumed

/// A frame from two axes of unit length that are perpendicular.
Pose frame_of(const Vec3& origin, const Vec3& x, const Vec3& z) {
    return {origin, glm::quat_cast(Mat3(x, glm::cross(z, x), z))};
}

/// A closed curve, its plane and its long axis.
struct Defect {
    std::vector<Vec3> points;  ///< in the frame
    Pose frame;                ///< z: normal, x: long axis
    double area = 0.0;         ///< m²

    bool contains(double x, double y) const {
        bool is_inside = false;
        for (std::size_t n = 0, last = points.size() - 1; n < points.size(); last = n++) {
            const Vec3 &a = points[n], &b = points[last];
            if ((a.y > y) != (b.y > y) && x < (b.x - a.x) * (y - a.y) / (b.y - a.y) + a.x) is_inside = !is_inside;
        }
        return is_inside;
    }
};

/// `jaw`: somewhere on the planned bone, for a curve that lies far from it.
Defect defect_of(std::span<const Vec3> curve, const rope::Obstacle* bone, const Vec3& jaw) {
    if (curve.size() < 3)
        throw Error(fmt::format("the curve of the defect has {} points; it needs three", curve.size()));
    Vec3 centre(0.0);
    for (const Vec3& p : curve) {
        if (!is_finite(p)) throw Error("the curve of the defect has a point that is not finite");
        centre += p / static_cast<double>(curve.size());
    }
    Vec3 twice(0.0);  // Newell's normal
    for (std::size_t n = 0; n < curve.size(); ++n)
        twice += glm::cross(curve[n] - centre, curve[(n + 1) % curve.size()] - centre);
    const double area = 0.5 * glm::length(twice);
    if (area < 1e-5) throw Error(fmt::format("the curve of the defect encloses {:.1f} mm2; it needs 10", area * 1e6));
    Vec3 normal = twice / (2.0 * area);
    // Away from the bone: to the side on which it is farther.
    if (bone) {
        // A distance field is flat beyond its grid, and the far side of the jaw may be near on the inside: only the slope at
        // the curve, weighted by nearness, tells on which side the bone lies.
        double outwards = 0.0;
        bool is_seen = false;
        for (const Vec3& p : curve) {
            Vec3 away(0.0);
            const double gap = bone->distance(p, away);
            is_seen = is_seen || glm::dot(away, away) > 0.25;
            outwards += glm::dot(away, normal) / (5e-3 + std::max(gap, 0.0));
        }
        if (!is_seen) outwards = glm::dot(centre - jaw, normal);
        if (outwards < 0.0) normal = -normal;
    }
    // The long axis, from second moments of the curve in its plane.
    const Vec3 some = std::abs(normal.x) < 0.9 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 u = glm::normalize(some - glm::dot(some, normal) * normal), v = glm::cross(normal, u);
    double uu = 0.0, uv = 0.0, vv = 0.0;
    for (std::size_t n = 0; n < curve.size(); ++n) {
        const Vec3 &a = curve[n], &b = curve[(n + 1) % curve.size()];
        const Vec3 middle = 0.5 * (a + b) - centre;
        const double weight = glm::length(b - a), x = glm::dot(middle, u), y = glm::dot(middle, v);
        uu += weight * x * x;
        uv += weight * x * y;
        vv += weight * y * y;
    }
    const double turn = 0.5 * std::atan2(2.0 * uv, uu - vv);
    Defect defect;
    defect.frame = frame_of(centre, std::cos(turn) * u + std::sin(turn) * v, normal);
    const Pose inward = defect.frame.inverse();
    for (const Vec3& p : curve) defect.points.push_back(inward.apply(p));
    double doubled = 0.0;
    for (std::size_t n = 0; n < defect.points.size(); ++n) {
        const Vec3 &a = defect.points[n], &b = defect.points[(n + 1) % defect.points.size()];
        doubled += a.x * b.y - b.x * a.y;
    }
    defect.area = 0.5 * std::abs(doubled);
    return defect;
}

/// What the paddle lies on: a height above the defect's plane that follows the curve (weights of inverse square distance,
/// Shepard 1968), and the bone where it stands out of it.
class Bed final : public rope::Obstacle {
public:
    Bed(const Defect& defect, const rope::Obstacle* bone) : defect_(defect), bone_(bone) {}

    double distance(const Vec3& place, Vec3& normal) const noexcept override {
        const Vec3 p = defect_.frame.inverse().apply(place);
        double weights = 0.0, heights = 0.0;
        std::array<double, 2> weight_slope{}, height_slope{};
        for (const Vec3& c : defect_.points) {
            const double dx = p.x - c.x, dy = p.y - c.y, square = dx * dx + dy * dy + 1e-6, w = 1.0 / square;
            weights += w;
            heights += w * c.z;
            const double slope = -2.0 * w * w;
            weight_slope[0] += slope * dx;
            weight_slope[1] += slope * dy;
            height_slope[0] += slope * dx * c.z;
            height_slope[1] += slope * dy * c.z;
        }
        const double h = heights / weights;
        const Vec3 up(-(height_slope[0] - h * weight_slope[0]) / weights,
                      -(height_slope[1] - h * weight_slope[1]) / weights, 1.0);
        const double length = glm::length(up), above = (p.z - h) / length;
        normal = defect_.frame.rotate(up / length);
        if (!bone_) return above;
        Vec3 of_bone;
        const double to_bone = bone_->distance(place, of_bone);
        if (to_bone >= above || glm::dot(of_bone, of_bone) < 0.25) return above;
        normal = of_bone;
        return to_bone;
    }

private:
    const Defect& defect_;
    const rope::Obstacle* bone_;
};

/// Largest angle between the directions of a grid line half a thickness before and half a thickness behind a node that lies on
/// bone.
double largest_fold(const Sheet& sheet, const std::vector<char>& touches) {
    const SheetSettings& s = sheet.settings();
    double worst = 0.0;
    const auto at = [&](int c, int r) { return sheet.positions()[static_cast<std::size_t>(sheet.index(c, r))]; };
    const auto turn = [](const Vec3& u, const Vec3& v) {
        return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
    };
    const auto half = [&](double side, int nodes) {
        return std::clamp(static_cast<int>(std::lround(0.5 * s.thickness * (nodes - 1) / side)), 1,
                          std::max(1, (nodes - 3) / 2));
    };
    const int across = half(s.length, s.columns), down = half(s.width, s.rows);
    for (int r = 0; r < s.rows; ++r)
        for (int c = 0; c < s.columns; ++c) {
            if (!touches[static_cast<std::size_t>(sheet.index(c, r))]) continue;
            if (c > across && c + across + 1 < s.columns)
                worst = std::max(worst, turn(at(c - across + 1, r) - at(c - across - 1, r),
                                             at(c + across + 1, r) - at(c + across - 1, r)));
            if (r > down && r + down + 1 < s.rows)
                worst = std::max(
                    worst, turn(at(c, r - down + 1) - at(c, r - down - 1), at(c, r + down + 1) - at(c, r + down - 1)));
        }
    return worst;
}

/// Fraction of the defect that lies below the sheet, seen along the normal.
double coverage_of(const Defect& defect, const Sheet& sheet) {
    const SheetSettings& s = sheet.settings();
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vec3& p : defect.points) low = glm::min(low, p), high = glm::max(high, p);
    const double side = std::max(high.x - low.x, high.y - low.y);
    const double spacing = std::max(sample_spacing, side / max_samples_per_side);
    const int nx = static_cast<int>((high.x - low.x) / spacing) + 1,
              ny = static_cast<int>((high.y - low.y) / spacing) + 1;
    std::vector<char> covered(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny), 0);
    const Pose inward = defect.frame.inverse();
    std::vector<Vec3> flat;
    for (const Vec3& p : sheet.positions()) flat.push_back(inward.apply(p));
    const auto fill = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        const double twice = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
        if (std::abs(twice) < 1e-14) return;
        const auto index = [&](double x, double from, int count) {
            return std::clamp(static_cast<int>(std::floor((x - from) / spacing)), 0, count - 1);
        };
        const int x0 = index(std::min({a.x, b.x, c.x}), low.x, nx), x1 = index(std::max({a.x, b.x, c.x}), low.x, nx);
        const int y0 = index(std::min({a.y, b.y, c.y}), low.y, ny), y1 = index(std::max({a.y, b.y, c.y}), low.y, ny);
        for (int j = y0; j <= y1; ++j)
            for (int i = x0; i <= x1; ++i) {
                const double x = low.x + (i + 0.5) * spacing, y = low.y + (j + 0.5) * spacing;
                const double u = ((b.x - x) * (c.y - y) - (c.x - x) * (b.y - y)) / twice,
                             v = ((c.x - x) * (a.y - y) - (a.x - x) * (c.y - y)) / twice;
                if (u >= 0.0 && v >= 0.0 && u + v <= 1.0)
                    covered[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)] =
                        1;
            }
    };
    for (int r = 0; r + 1 < s.rows; ++r)
        for (int c = 0; c + 1 < s.columns; ++c) {
            const auto p = [&](int column, int row) {
                return flat[static_cast<std::size_t>(sheet.index(column, row))];
            };
            fill(p(c, r), p(c + 1, r), p(c + 1, r + 1));
            fill(p(c, r), p(c + 1, r + 1), p(c, r + 1));
        }
    std::size_t inside = 0, below = 0;
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
            if (!defect.contains(low.x + (i + 0.5) * spacing, low.y + (j + 0.5) * spacing)) continue;
            ++inside;
            below += static_cast<std::size_t>(
                covered[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(i)]);
        }
    return inside ? static_cast<double>(below) / static_cast<double>(inside) : 0.0;
}

}  // namespace

Pose paddle_in_leg(const reconstruction::SkinPaddle& paddle, const reconstruction::FibulaInputs& inputs) {
    const Vec3 x = glm::normalize(inputs.line_direction);
    Vec3 out = paddle.at - inputs.line_point;
    out -= glm::dot(out, x) * x;
    if (glm::length(out) < 1e-3)
        throw Error(
            "the middle of the skin paddle lies on the donor's line; place it on the skin, outside of the bone");
    return frame_of(paddle.at, x, glm::normalize(out));
}

std::optional<std::size_t> segment_at(const reconstruction::FibulaInputs& inputs,
                                      const reconstruction::FibulaPlan& plan, const Vec3& place) {
    const double along = glm::dot(place - inputs.line_point, glm::normalize(inputs.line_direction));
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        const auto [low, high] = std::minmax(plan.segments[n].along_line[0], plan.segments[n].along_line[1]);
        if (along >= low && along <= high) return n;
    }
    return {};
}

DrapedPaddle drape(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                   const reconstruction::Flap& flap, std::span<const Vec3> curve, const rope::Obstacle* bone,
                   const DrapeSettings& settings) {
    if (!flap.paddle) throw Error("the plan has no skin paddle");
    const reconstruction::SkinPaddle& paddle = *flap.paddle;
    const Pose leg = paddle_in_leg(paddle, inputs);
    Vec3 jaw(0.0);
    for (const reconstruction::JawPlane& plane : inputs.planes)
        jaw += plane.origin / static_cast<double>(inputs.planes.size());
    const Defect defect = defect_of(curve, bone, jaw);
    DrapedPaddle draped;
    draped.defect_area = defect.area;
    draped.normal = defect.frame.rotate({0.0, 0.0, 1.0});

    for (const reconstruction::Perforator& p : flap.perforators) {
        const auto segment = segment_at(inputs, plan, p.at);
        const double along = leg.inverse().apply(p.at).x;
        if (!segment || std::abs(along) > 0.5 * paddle.length) {
            draped.unused.push_back(p.name);
            continue;
        }
        PaddleRope rope;
        rope.name = p.name;
        rope.bone = plan.segments[*segment].donor_to_target.apply(p.at);
        rope.along = along;
        draped.ropes.push_back(std::move(rope));
    }

    SheetSettings sheet_settings = settings.sheet;
    sheet_settings.length = paddle.length;
    sheet_settings.width = paddle.width;
    // As many nodes as it takes that bone of half a thickness does not pass between them, and a contact that yields by a
    // twentieth of the thickness under the pressure on a node.
    const double cell = std::max(0.5 * sheet_settings.thickness, 1e-3);
    const auto nodes = [&](double side, int least) {
        return std::clamp(static_cast<int>(std::ceil(side / cell)) + 1, least, 200);
    };
    sheet_settings.columns = nodes(paddle.length, sheet_settings.columns);
    sheet_settings.rows = nodes(paddle.width, sheet_settings.rows);
    const double on_node =
        settings.pressure * paddle.length * paddle.width / ((sheet_settings.columns - 1) * (sheet_settings.rows - 1));
    sheet_settings.contact = std::max(sheet_settings.contact, 20.0 * on_node / sheet_settings.thickness);
    // Either way round: that which stretches the perforators less, or leaves them shorter.
    const auto strain = [&](const Pose& pose) {
        std::array<double, 2> sums{};
        for (const PaddleRope& rope : draped.ropes) {
            const double distance = glm::length(pose.apply({rope.along, 0.0, 0.0}) - rope.bone);
            sums[0] += std::max(0.0, distance - settings.rope_length);
            sums[1] += distance;
        }
        return sums;
    };
    const double root = std::sqrt(0.5);
    const Pose along =
        paddle.width > paddle.length ? defect.frame * Pose{Vec3(0.0), Quat(root, 0.0, 0.0, root)} : defect.frame;
    const Pose turned = along * Pose{Vec3(0.0), Quat(0.0, 0.0, 0.0, 1.0)};
    Pose start = strain(turned) < strain(along) ? turned : along;

    for (PaddleRope& rope : draped.ropes) {
        rope.distance = glm::length(start.apply({rope.along, 0.0, 0.5 * sheet_settings.thickness}) - rope.bone);
        rope.slack = settings.rope_length - rope.distance;
    }

    // Clear of bed and bone before it settles.
    const Bed bed(defect, bone);
    double raise = 0.0;
    const Sheet flat(sheet_settings, start);
    for (const Vec3& p : flat.positions())
        for (int guard = 0; guard < 200; ++guard) {
            Vec3 ignored;
            const double gap = bed.distance(p + raise * draped.normal, ignored);
            if (gap >= 0.5 * sheet_settings.thickness) break;
            raise += std::max(0.2e-3, 0.5 * sheet_settings.thickness - gap);
        }
    start.position += raise * draped.normal;

    Sheet sheet(sheet_settings, start);
    std::vector<Tether> tethers;
    for (const PaddleRope& rope : draped.ropes) {
        const int column =
            static_cast<int>(std::lround((rope.along / paddle.length + 0.5) * (sheet_settings.columns - 1)));
        tethers.push_back({sheet.index(std::clamp(column, 0, sheet_settings.columns - 1), sheet_settings.rows / 2),
                           rope.bone, settings.rope_length, settings.rope_stiffness});
    }
    // Sutures: what lies on the curve is held there.
    const Pose inward = start.inverse();
    for (const Vec3& p : curve) {
        const Vec3 at = inward.apply(p);
        const double u = at.x / paddle.length + 0.5, v = at.y / paddle.width + 0.5;
        if (!(u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0)) continue;
        // A curve that runs through bone must not pull the skin into it.
        const Vec3 target = p + 0.5 * sheet_settings.thickness * draped.normal;
        Vec3 ignored;
        if (bone && bone->distance(target, ignored) < 0.5 * sheet_settings.thickness) continue;
        tethers.push_back({sheet.index(static_cast<int>(std::lround(u * (sheet_settings.columns - 1))),
                                       static_cast<int>(std::lround(v * (sheet_settings.rows - 1)))),
                           target, suture_slack, suture_stiffness});
    }
    SheetLoads loads;
    loads.pressure = -settings.pressure * draped.normal;
    loads.obstacle = &bed;
    loads.tethers = tethers;
    draped.is_settled = sheet.settle(loads, 1e-6);

    std::vector<char> touches(sheet.size(), 0);
    if (bone)
        for (std::size_t n = 0; n < sheet.size(); ++n) {
            Vec3 ignored;
            touches[n] = bone->distance(sheet.positions()[n], ignored) < 0.5 * sheet_settings.thickness + touching_gap;
        }
    draped.touching = static_cast<double>(std::ranges::count(touches, 1)) / static_cast<double>(sheet.size());
    draped.fold = largest_fold(sheet, touches);
    draped.coverage = coverage_of(defect, sheet);
    draped.area_flat = paddle.length * paddle.width;
    draped.area = sheet.area();
    for (std::size_t n = 0; n < draped.ropes.size(); ++n) {
        PaddleRope& rope = draped.ropes[n];
        rope.skin = sheet.positions()[static_cast<std::size_t>(tethers[n].node)];
        rope.tension = sheet.tension(tethers[n]);
        if (rope.tension > 0.0) continue;  // it holds the skin back: how far it is too short was measured before
        rope.distance = glm::length(rope.skin - rope.bone);
        rope.slack = settings.rope_length - rope.distance;
    }
    draped.positions = sheet.positions();
    draped.columns = sheet_settings.columns;
    draped.rows = sheet_settings.rows;
    return draped;
}

geometry::TriangleSurface shell_of(const DrapedPaddle& paddle, double thickness) {
    geometry::TriangleSurface shell;
    const int columns = paddle.columns, rows = paddle.rows;
    const auto index = [&](int c, int r) { return r * columns + c; };
    const auto at = [&](int c, int r) {
        return paddle
            .positions[static_cast<std::size_t>(index(std::clamp(c, 0, columns - 1), std::clamp(r, 0, rows - 1)))];
    };
    const int count = columns * rows;
    std::vector<Vec3> normals;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const Vec3 n = glm::cross(at(c + 1, r) - at(c - 1, r), at(c, r + 1) - at(c, r - 1));
            const double length = glm::length(n);
            normals.push_back(length > 0.0 ? n / length : paddle.normal);
        }
    for (const double side : {0.5, -0.5})
        for (int n = 0; n < count; ++n)
            shell.vertices.push_back(paddle.positions[static_cast<std::size_t>(n)] +
                                     side * thickness * normals[static_cast<std::size_t>(n)]);
    const auto quad = [&](int a, int b, int c, int d) {
        shell.triangles.push_back({a, b, c});
        shell.triangles.push_back({a, c, d});
    };
    for (int r = 0; r + 1 < rows; ++r)
        for (int c = 0; c + 1 < columns; ++c) {
            const int a = index(c, r), b = index(c + 1, r), d = index(c, r + 1), e = index(c + 1, r + 1);
            quad(a, b, e, d);
            quad(count + a, count + d, count + e, count + b);
        }
    const auto wall = [&](int a, int b) { quad(a, count + a, count + b, b); };
    for (int c = 0; c + 1 < columns; ++c) {
        wall(index(c, 0), index(c + 1, 0));
        wall(index(c + 1, rows - 1), index(c, rows - 1));
    }
    for (int r = 0; r + 1 < rows; ++r) {
        wall(index(columns - 1, r), index(columns - 1, r + 1));
        wall(index(0, r + 1), index(0, r));
    }
    return shell;
}

}  // namespace tactus::skin
