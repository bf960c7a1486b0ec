// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/kerf_check.hpp"

#include "dsp/fit/fit_energy.hpp"
#include "dsp/geometry/dense_cholesky.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace tactus::fit {

namespace {

constexpr double rim = 1.2e-3;  // m: nearer to the face the cortex is rounded
constexpr double reach = 9e-3;  // m: length of a strip on either half
constexpr double half_width = 1.5e-3;  // m, of a strip
constexpr double alike = 0.8;  // least cosine between the normals of a strip
constexpr std::size_t most_strips = 48, least_points = 12, most_paint = 400;
constexpr int independent = 8;  // strips around a bone that tell something of their own
// m: how well the faces hold the halves across the normal. Whole faces of 130 mm² are 0.005 to 0.03 mm off.
constexpr double beside = 0.015e-3;
constexpr double widest = 6e-3;  // m: errors of the opening that are still seen
constexpr double most_error = 0.5e-3;  // m, of the opening
constexpr double most_spread = 1e-3;  // m, of a contour that can contradict what a person has told
// Of the spread: how far the opening of shafts whose kerf was known lay from what their contour said, root mean square.
constexpr double usual_share = 0.5;

struct Spot {
    Vec3 at, normal;
};

/// The cortex around a face but for its rim, in the fixed frame.
std::vector<Spot> cortex_of(const KerfSide& side, const Pose& pose) {
    const FitSurface& face = *side.face;
    const std::size_t stride = 1 + face.position.size() / most_paint;
    double radius = 0.0;
    for (const Vec3& p : face.position) radius = std::max(radius, glm::length(p));
    radius += reach + rim;
    std::vector<Spot> spots;
    for (const contact::SurfacePoint& point : side.points) {
        const Vec3 p = point.position - face.centre;
        if (point.label == contact::surface_label::fracture || point.label == contact::surface_label::as_scanned ||
            !(glm::dot(p, p) < radius * radius) || !(glm::length(point.normal) > 0.5))
            continue;
        bool is_rim = false;
        for (std::size_t n = 0; n < face.position.size() && !is_rim; n += stride) {
            const Vec3 off = p - face.position[n];
            is_rim = glm::dot(off, off) < rim * rim;
        }
        if (!is_rim) spots.push_back({pose.apply(point.position), pose.rotate(glm::normalize(point.normal))});
    }
    return spots;
}

struct Step {
    double step, lever;  ///< m; by how much the step grows with the opening
};

/// The step of one strip across the gap: height over the tangent plane is a parabola, and a step between the halves.
std::optional<Step> step_at(const Vec3& at, const Vec3& out, const Vec3& normal,
                            const std::array<const std::vector<Spot>*, 2>& cortex) {
    constexpr std::size_t unknowns = 6;  // 1, z, z², t, t², step
    const Vec3 across = normal - glm::dot(normal, out) * out;
    if (!(glm::length(across) > 0.5)) return std::nullopt;
    const Vec3 along = glm::normalize(across), aside = glm::cross(out, along);
    std::vector<double> matrix(unknowns * unknowns, 0.0), solved(unknowns, 0.0);
    for (std::size_t half = 0; half < 2; ++half) {
        // An error of the opening lifts the moving half by its share along `out`.
        const double highest = 2e-3 + (half == 0 ? widest * std::abs(glm::dot(normal, out)) : 0.0);
        std::size_t count = 0;
        for (const Spot& spot : *cortex[half]) {
            const Vec3 off = spot.at - at;
            const double t = glm::dot(off, aside) / half_width, z = glm::dot(off, along) / reach;
            const double height = glm::dot(off, out);
            if (!(std::abs(t) < 1.0) || !(std::abs(z) < 1.4) || !(std::abs(height) < highest) ||
                !(glm::dot(spot.normal, out) > alike))
                continue;
            ++count;
            const double row[unknowns] = {1.0, z, z * z, t, t * t, half == 0 ? 0.5 : -0.5};
            for (std::size_t a = 0; a < unknowns; ++a) {
                solved[a] += row[a] * height;
                for (std::size_t b = 0; b < unknowns; ++b) matrix[a * unknowns + b] += row[a] * row[b];
            }
        }
        if (count < least_points) return std::nullopt;
    }
    for (std::size_t a = 0; a < unknowns; ++a) matrix[a * unknowns + a] += 1e-9;
    if (!geometry::solve_positive(matrix, solved)) return std::nullopt;
    return Step{solved[5], glm::dot(normal, out) - solved[1] / reach * glm::dot(normal, along)};
}

struct Opening {
    double excess = 0.0, spread = 1.0;  ///< m
    double misfit = std::numeric_limits<double>::infinity();
};

/// Strips over ridges and holes have steps of their own: their weight falls with the step that is left.
Opening opening_from(double excess, const std::vector<Step>& steps) {
    constexpr double usual = 0.2e-3;  // m, a step that is left
    Opening found{excess, 1.0, 0.0};
    for (int pass = 0; pass < 6; ++pass) {
        double sum = 0.0, squares = 0.0, levers = 0.0, weights = 0.0;
        for (const Step& s : steps) {
            const double off = (s.step - found.excess * s.lever) / usual, weight = 1.0 / (1.0 + off * off);
            sum += weight * s.lever * s.step;
            levers += weight * s.lever * s.lever;
            weights += weight;
            squares += weight * off * off * usual * usual;
        }
        if (!(levers > 0.0)) return {};
        found.excess = sum / levers;
        const double mean_lever2 = levers / weights;
        found.spread =
            std::sqrt((squares / weights / independent + 0.5 * beside * beside) / std::max(mean_lever2, 1e-9));
    }
    for (const Step& s : steps) {
        const double off = (s.step - found.excess * s.lever) / usual;
        found.misfit += std::log1p(off * off);
    }
    return found;
}

/// The median of what single strips say, by how much they can say.
double middle_opening(std::vector<Step> steps) {
    std::erase_if(steps, [](const Step& s) { return !(std::abs(s.lever) > 0.1); });
    std::ranges::sort(steps, {}, [](const Step& s) { return s.step / s.lever; });
    double all = 0.0, below = 0.0;
    for (const Step& s : steps) all += std::abs(s.lever);
    for (const Step& s : steps)
        if ((below += std::abs(s.lever)) >= 0.5 * all) return s.step / s.lever;
    return 0.0;
}

}  // namespace

ContourOpening contour_opening(const KerfSide& moving, const KerfSide& fixed, const Pose& pose) {
    ContourOpening found;
    const Vec3 normal = opening_direction(*moving.face, *fixed.face, pose);
    const std::vector<Spot> mine = cortex_of(moving, pose), other = cortex_of(fixed, {});
    const FitSurface& face = *fixed.face;
    std::vector<Step> steps;
    const std::size_t stride = 1 + face.outline.size() / most_strips;
    for (std::size_t n = 0; n < face.outline.size(); n += stride)
        if (const auto step = step_at(face.centre + face.outline[n], face.outline_normal[n], normal, {&mine, &other}))
            steps.push_back(*step);
    found.strips = static_cast<int>(steps.size());
    if (found.strips < independent) return found;
    // From no error, and from what half of the strips say: an error of millimetres is far from where it is looked for.
    const Opening near = opening_from(0.0, steps), far = opening_from(middle_opening(steps), steps);
    const Opening& best = far.misfit < near.misfit ? far : near;
    found.excess = best.excess;
    found.spread = best.spread;
    return found;
}

KerfEstimate check_kerf(const KerfSide& moving, const KerfSide& fixed, const Pose& pose, double told) {
    const ContourOpening contour = contour_opening(moving, fixed, pose);
    const Vec3 mean = 0.5 * (fixed.face->mean_normal - pose.rotate(moving.face->mean_normal));
    const double cosine = std::clamp(glm::length(mean), 0.5, 1.0);
    KerfEstimate made{told, std::max(0.0, told - contour.excess * cosine), contour.spread * cosine};
    if (told > 0.0) made.is_contradicted = std::abs(contour.excess) > most_error && contour.spread < most_spread;
    else if (contour.strips >= independent) {
        // Faces of which no bone is lost lie on each other however the contour beside them looks: ridges that end there
        // have steps as well, which `spread` knows of.
        const double missing = -contour.excess, off = usual_share * contour.spread;
        made.is_contradicted = missing > std::max(most_error, off);
        made.is_open = !made.is_contradicted && missing + off > most_error;
    }
    made.is_too_wide = told * (1.0 / cosine - 1.0) > most_error;
    return made;
}

}  // namespace tactus::fit
