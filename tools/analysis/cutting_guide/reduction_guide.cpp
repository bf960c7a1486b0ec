// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/cutting_guide/reduction_guide.hpp"

#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/gap.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "tools/analysis/bone/surface_file.hpp"
#include "tools/analysis/cutting_guide/guide_text.hpp"
#include "tools/analysis/plan/plan_case.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

namespace {

constexpr double min_facing_area = 10e-6;  // m²: fragments with smaller facing areas do not meet
constexpr double beside = 25.0 * mm;  // of a fracture: the bone there shows the direction of the line
constexpr double step = 1.0 * mm, height = 80.0 * mm;  // of the rays that find the fragments below the base
constexpr int half_length = 70, half_width = 12;  // of their field, in steps
constexpr double max_slope = 50.0 * degree;  // of the bone under a screw, against the approach
constexpr double max_aside = 9.0 * mm, aside_of_bridge = 2.0 * mm;  // of a screw from the middle; of its rim

struct PlacedFragment {
    std::string name;
    Pose pose;
    CaseFragment loaded;
    geometry::TriangleSurface surface;  // in its planned place
    Vec3 middle{0.0};

    Vec3 at(const contact::SurfacePoint& p) const { return pose.apply(p.position); }
};

/// Where two fragments meet.
struct Fracture {
    std::size_t first, second;
    FractureGap gap;
    double area = 0.0;
    Vec3 middle{0.0};
};

/// The fragments that the guide holds, and then the others that are shown.
struct Reduction {
    std::vector<PlacedFragment> fragments;
    std::size_t held = 0;
    std::vector<Fracture> fractures;
};

std::vector<int> held_fragments(const plan::CasePlan& plan, const plan::PlanState& state, const GuideChoice& choice) {
    std::vector<int> held;
    for (const std::string& name : choice.fragments) {
        const int n = plan::find_fragment(plan, name);
        if (state.arrangement.is_hidden(n)) throw Error(fmt::format("fragment '{}' is hidden", name));
        if (std::ranges::find(held, n) != held.end()) throw Error(fmt::format("fragment '{}' is named twice", name));
        held.push_back(n);
    }
    for (int n = 0; n < static_cast<int>(plan.fragments.size()) && choice.fragments.empty(); ++n)
        if (!state.arrangement.is_hidden(n)) held.push_back(n);
    if (held.size() < 2)
        throw Error("a guide for a reduction holds two fragments or more together: --fragments NAME NAME");
    if (held.size() > 9)
        throw Error(
            fmt::format("a guide holds up to 9 fragments, not {}: name some of them "
                        "(--fragments)",
                        held.size()));
    return held;
}

Reduction load_reduction(const plan::CasePlan& plan, const std::filesystem::path& folder, const GuideChoice& choice) {
    plan::check_files(plan, folder);
    const plan::PlanState state = plan::state_of(plan);
    const std::vector<plan::PlanFragment> files = plan::fragments_of(plan, state);
    std::vector<int> order = held_fragments(plan, state, choice);
    Reduction all;
    all.held = order.size();
    for (int n = 0; n < static_cast<int>(files.size()); ++n)
        if (!state.arrangement.is_hidden(n) && std::ranges::find(order, n) == order.end()) order.push_back(n);
    all.fragments.resize(order.size());
    on_threads()(static_cast<int>(order.size()), [&](int k) {
        const auto n = static_cast<std::size_t>(order[static_cast<std::size_t>(k)]);
        PlacedFragment& made = all.fragments[static_cast<std::size_t>(k)];
        made.name = files[n].name;
        made.pose = state.arrangement.pose(static_cast<int>(n));
        made.loaded = load_fragment(files[n], folder);
        made.surface = surface_of_file(plan::file_of(files[n].file, folder), made.loaded.map.grid);
        for (Vec3& v : made.surface.vertices) v = made.pose.apply(v);
        for (const auto& p : made.loaded.bone.points)
            made.middle += made.at(p) / static_cast<double>(made.loaded.bone.points.size());
    });
    return all;
}

std::optional<Fracture> fracture_between(const Reduction& all, std::size_t a, std::size_t b) {
    const PlacedFragment &first = all.fragments[a], &second = all.fragments[b];
    const auto& points = first.loaded.bone.points;
    const fit::SurfaceGap gap = fit::gap_between(points, first.pose, second.loaded.map, second.pose);
    if (gap.facing_area < min_facing_area) return {};
    Fracture found{a, b, {first.name, second.name, gap.median, 0.0}, 0.0, Vec3(0.0)};
    for (std::size_t n = 0; n < points.size(); ++n)
        if (std::isfinite(gap.distance[n]))
            found.area += points[n].area, found.middle += points[n].area * first.at(points[n]);
    found.middle /= found.area;
    if (gap.deepest > 0.0)
        found.gap.overlap = fit::overlap_volume(first.loaded.map.grid, first.pose, second.loaded.map, second.pose);
    return found;
}

/// Throws Error for fragments that no guide may hold so.
void find_fractures(Reduction& all, const GuideLimits& limits) {
    std::vector<std::size_t> part(all.held);
    std::iota(part.begin(), part.end(), std::size_t{0});
    for (std::size_t a = 0; a < all.held; ++a)
        for (std::size_t b = a + 1; b < all.held; ++b) {
            auto found = fracture_between(all, a, b);
            if (!found) continue;
            if (found->gap.overlap > limits.max_overlap)
                throw Error(fmt::format(
                    "fragments '{}' and '{}' overlap by {:.0f} mm³ where the plan has them, more "
                    "than {:.3g} mm³: settle them first ('tactus plan settle'), or allow more "
                    "(--max-overlap)",
                    found->gap.first, found->gap.second, found->gap.overlap * 1e9, limits.max_overlap * 1e9));
            if (found->gap.gap > limits.max_gap)
                throw Error(
                    fmt::format("fragments '{}' and '{}' are {:.2f} mm apart where the plan has them, more "
                                "than {:.3g} mm: settle them first ('tactus plan settle'), or allow more "
                                "(--max-gap)",
                                found->gap.first, found->gap.second, found->gap.gap / mm, limits.max_gap / mm));
            const std::size_t from = std::max(part[a], part[b]), to = std::min(part[a], part[b]);
            std::ranges::replace(part, from, to);
            all.fractures.push_back(std::move(*found));
        }
    for (std::size_t n = 0; n < all.held; ++n)
        if (part[n] != part[0])
            throw Error(
                fmt::format("fragment '{}' meets none of those that follow from '{}': place it where it "
                            "belongs, name the fragment between them, or leave it out (--fragments)",
                            all.fragments[n].name, all.fragments[0].name));
}

Vec3 turned_about(const Vec3& v, const Vec3& axis, double angle) { return glm::angleAxis(angle, axis) * v; }

/// The frame of the base: its middle, the line along it, the approach, and `aside` across both.
struct BaseFrame {
    Vec3 middle{0.0}, along{1.0, 0.0, 0.0}, up{0.0, 0.0, 1.0}, aside{0.0};
};

BaseFrame frame_of(const Reduction& all, double turn) {
    BaseFrame frame;
    double area = 0.0;
    for (const Fracture& f : all.fractures) frame.middle += f.area * f.middle, area += f.area;
    frame.middle /= area;
    Vec3 along(0.0);
    for (const Fracture& f : all.fractures) {
        const auto near = [&](const PlacedFragment& fragment) {
            Vec3 sum(0.0);
            double weight = 0.0;
            for (const auto& p : fragment.loaded.bone.points)
                if (const Vec3 at = fragment.at(p); glm::length(at - f.middle) < beside)
                    sum += p.area * at, weight += p.area;
            return weight > 0.0 ? sum / weight : fragment.middle;
        };
        const Vec3 here = near(all.fragments[f.second]) - near(all.fragments[f.first]);
        along += glm::dot(here, along) < 0.0 ? -here : here;
    }
    if (!(glm::length(along) > 1.0 * mm))
        throw Error(
            "the fragments do not follow each other along a line: hold fewer "
            "of them by a guide (--fragments)");
    frame.along = glm::normalize(along);
    Vec3 whole(0.0);
    for (const PlacedFragment& f : all.fragments) whole += f.middle / static_cast<double>(all.fragments.size());
    const auto across = [&](const Vec3& v) { return v - glm::dot(v, frame.along) * frame.along; };
    Vec3 out = across(frame.middle - whole);
    // Along a straight bone the middle shows no outside: then from in front, or from the left.
    for (const Vec3& other : {Vec3(0.0, -1.0, 0.0), Vec3(1.0, 0.0, 0.0)})
        if (glm::length(out) < 5.0 * mm) out = across(other);
    frame.up = turned_about(glm::normalize(out), frame.along, turn);
    // The text looks up.
    if (glm::cross(frame.up, frame.along).z > 0.0) frame.along = -frame.along;
    frame.aside = glm::cross(frame.up, frame.along);
    return frame;
}

/// The fragments as they are seen along the approach.
class Field {
public:
    Field(const Reduction& all, const BaseFrame& frame) : frame_(frame) {
        std::vector<geometry::TriangleTree> trees;
        for (const PlacedFragment& f : all.fragments) trees.emplace_back(f.surface);
        of_.assign(rows() * columns(), -1), top_.assign(of_.size(), 0.0);
        on_threads()(static_cast<int>(columns()), [&](int column) {
            for (int j = -half_width; j <= half_width; ++j) {
                const int i = column - half_length;
                const Vec3 from = at(i, j, height);
                double first = 1.0;
                for (std::size_t n = 0; n < trees.size(); ++n) {
                    const double part = trees[n].sweep(from, -2.0 * height * frame_.up, 1e-9);
                    if (part >= first) continue;
                    first = part;
                    of_[index(i, j)] = static_cast<int>(n), top_[index(i, j)] = height - 2.0 * height * part;
                }
            }
        });
    }
    int of(int i, int j) const { return of_[index(i, j)]; }
    Vec3 place(int i, int j) const { return at(i, j, top_[index(i, j)]); }
    /// Whether all within so many steps belong to the fragment.
    bool is_all(int i, int j, int reach, int fragment) const {
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x)
                if (x * x + y * y <= reach * reach &&
                    (std::abs(i + x) > half_length || std::abs(j + y) > half_width || of(i + x, j + y) != fragment))
                    return false;
        return true;
    }
    /// Unit, out of the bone, over three steps to either side.
    Vec3 normal(int i, int j) const {
        constexpr int reach = 3;
        const Vec3 x = place(i + reach, j) - place(i - reach, j), y = place(i, j + reach) - place(i, j - reach);
        return glm::normalize(glm::cross(x, y));
    }

private:
    static std::size_t rows() { return 2 * half_width + 1; }
    static std::size_t columns() { return 2 * half_length + 1; }
    static std::size_t index(int i, int j) {
        return static_cast<std::size_t>(i + half_length) * rows() + static_cast<std::size_t>(j + half_width);
    }
    Vec3 at(int i, int j, double z) const {
        return frame_.middle + step * i * frame_.along + step * j * frame_.aside + z * frame_.up;
    }

    const BaseFrame& frame_;
    std::vector<int> of_;
    std::vector<double> top_;
};

/// The range of the base in steps: from the outermost changes between fragments that it holds, and on.
std::pair<int, int> range_of_base(const Field& field, std::size_t held, double beyond) {
    int low = half_length, high = -half_length;
    const auto is_held = [&](int n) { return n >= 0 && n < static_cast<int>(held); };
    for (int j = -4; j <= 4; ++j)
        for (int i = -half_length; i < half_length; ++i)
            if (const int a = field.of(i, j), b = field.of(i + 1, j); a != b && is_held(a) && is_held(b))
                low = std::min(low, i), high = std::max(high, i + 1);
    if (low > high)
        throw Error(
            "the approach does not see a fracture between the fragments that the guide holds: turn it (--turn)");
    const int more = static_cast<int>(std::ceil(beyond / step));
    return {std::max(low - more, -half_length), std::min(high + more, half_length)};
}

/// The place of a fragment in the range that is farthest from its edges there, in steps; none: it is not seen.
std::optional<std::array<int, 2>> deepest_place(const Field& field, std::pair<int, int> range, int fragment) {
    std::optional<std::array<int, 2>> best;
    for (int reach = 0;; ++reach) {
        std::optional<std::array<int, 2>> found;
        for (int j = 0; j <= half_width && !found; j = j > 0 ? -j : 1 - j)
            for (int i = range.first; i <= range.second && !found; ++i)
                if (field.is_all(i, j, reach, fragment)) found = std::array{i, j};
        if (!found) return best;
        best = found;
    }
}

/// Two places for screws on a fragment, as far from each other as possible.
std::vector<std::array<int, 2>> screw_places(const Field& field, const BaseFrame& frame, std::pair<int, int> range,
                                             int fragment, const cutting_guide::GuideSettings& set) {
    const double room = set.screw_radius + set.min_wall + 0.5 * mm;
    const int reach = static_cast<int>(std::ceil(room / step)),
              least = static_cast<int>(std::ceil((0.5 * set.rail + set.screw_radius + aside_of_bridge) / step)),
              most = static_cast<int>(max_aside / step);
    std::vector<std::array<int, 2>> all;
    for (int i = range.first + reach; i <= range.second - reach; ++i)
        for (int j = -most; j <= most; ++j)
            if (std::abs(j) >= least && field.is_all(i, j, reach, fragment) &&
                glm::dot(field.normal(i, j), frame.up) > std::cos(max_slope))
                all.push_back({i, j});
    if (all.empty()) return {};
    const auto away = [](const std::array<int, 2>& a, const std::array<int, 2>& b) {
        return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
    };
    std::array<std::array<int, 2>, 2> best{all.front(), all.front()};
    for (const auto& a : all)
        for (const auto& b : all)
            if (away(a, b) > away(best[0], best[1])) best = {a, b};
    const double apart = step * std::sqrt(static_cast<double>(away(best[0], best[1])));
    if (apart < 2.0 * set.screw_radius + set.min_wall + 0.5 * mm) return {best[0]};
    return {best[0], best[1]};
}

cutting_guide::GuideDesign design_of(const Reduction& all, const plan::CasePlan& plan, const GuideChoice& choice,
                                     std::vector<HeldFragment>& held) {
    cutting_guide::GuideDesign design;
    design.settings = choice.settings;
    design.settings.offset = choice.offset.value_or(0.3 * mm);
    const BaseFrame frame = frame_of(all, choice.turn);
    design.removal = frame.up, design.along = frame.along;
    for (const PlacedFragment& f : all.fragments) {
        const int first = static_cast<int>(design.bone.vertices.size());
        design.bone.vertices.insert(design.bone.vertices.end(), f.surface.vertices.begin(), f.surface.vertices.end());
        for (const auto& t : f.surface.triangles)
            design.bone.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
        design.fragments.push_back(f.surface);
    }
    const Field field(all, frame);
    const std::pair<int, int> range = range_of_base(field, all.held, design.settings.end);
    std::vector<std::pair<std::array<int, 2>, std::size_t>> places;
    for (std::size_t n = 0; n < all.held; ++n) {
        const auto place = deepest_place(field, range, static_cast<int>(n));
        if (!place)
            throw Error(
                fmt::format("the base does not reach fragment '{}': another approach (--turn) or a longer base "
                            "(--end) may reach it; else leave it out (--fragments)",
                            all.fragments[n].name));
        places.emplace_back(*place, n);
    }
    std::ranges::sort(places);
    std::string letters;
    for (const auto& [place, n] : places) {
        const auto letter = static_cast<char>('1' + letters.size());
        letters += letter;
        held.push_back({all.fragments[n].name, letter});
        cutting_guide::BaseSpan span{frame.middle, frame.along, step * range.first, step * range.second};
        span.on = cutting_guide::BaseSpan::OnFragment{n, field.place(place[0], place[1])};
        design.base.push_back(span);
        int screw = 0;
        for (const auto& [i, j] : screw_places(field, frame, range, static_cast<int>(n), design.settings)) {
            // Near the edge of the base it moves in, towards the middle of the fragment and the bridge.
            const double inmost =
                0.5 * design.settings.rail + design.settings.screw_radius + aside_of_bridge - step * std::abs(j);
            const Vec3 slide = 0.6 * step * (place[0] - i) * frame.along + (j > 0 ? inmost : -inmost) * frame.aside;
            design.holes.push_back({field.place(i, j), -field.normal(i, j), design.settings.screw_radius,
                                    fmt::format("screw {} in fragment '{}'", ++screw, all.fragments[n].name), false,
                                    slide});
        }
    }
    Vec3 whole(0.0);
    for (const PlacedFragment& f : all.fragments) whole += f.middle / static_cast<double>(all.fragments.size());
    add_texts(design, plan.title, choice, frame.middle.x > whole.x ? "L" : "R", frame.along.y < 0.0, letters);
    return design;
}

}  // namespace

PlannedGuide plan_reduction_guide(const plan::CasePlan& plan, const std::filesystem::path& folder,
                                  const GuideChoice& choice) {
    Reduction all = load_reduction(plan, folder, choice);
    find_fractures(all, choice.limits);
    std::vector<HeldFragment> held;
    PlannedGuide guide = measured_guide(design_of(all, plan, choice, held), choice);
    guide.held = std::move(held);
    for (Fracture& f : all.fractures) guide.gaps.push_back(std::move(f.gap));
    for (std::size_t n = 0; n < guide.held.size(); ++n) {
        HeldFragment& one = guide.held[n];
        const geometry::TriangleTree tree(guide.design.fragments[guide.design.base[n].on->fragment]);
        const cutting_guide::Seat seat =
            cutting_guide::seat_of(guide.made.surface, tree, glm::normalize(guide.design.removal),
                                   guide.design.settings.offset, choice.limits.seat_gap, 1.0 * mm, on_threads());
        one.contact_area = seat.contact_area, one.play = seat.play, one.play_angle = seat.play_angle;
        one.holes =
            static_cast<std::size_t>(std::ranges::count_if(guide.made.holes, [&](const cutting_guide::MadeHole& hole) {
                return tree.nearest(hole.at, 0.5 * mm).distance < 0.5 * mm;
            }));
    }
    refuse_guide(guide);
    warn_of(guide);
    return guide;
}

}  // namespace tactus::analysis
