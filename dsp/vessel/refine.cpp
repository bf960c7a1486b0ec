// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/refine.hpp"

#include "dsp/core/median.hpp"
#include "dsp/geometry/spline.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <span>

namespace tactus::vessel {

namespace {

/// Tubes at even distances along a spline through `tubes`. A spline may swing beyond its points: no radius is above
/// `max_radius`.
std::vector<Tube> resampled(const std::vector<Tube>& tubes, double spacing, double max_radius) {
    std::vector<double> along{0.0};
    for (std::size_t n = 1; n < tubes.size(); ++n)
        along.push_back(along.back() + std::max(1e-9, glm::length(tubes[n].centre - tubes[n - 1].centre)));
    std::vector<geometry::Spline> splines;
    for (int axis = 0; axis < 4; ++axis) {
        std::vector<double> values;
        for (const Tube& tube : tubes) values.push_back(axis < 3 ? tube.centre[axis] : tube.radius);
        splines.emplace_back(along, std::move(values));
    }
    const int parts = std::max(1, static_cast<int>(std::lround(along.back() / spacing)));
    std::vector<Tube> out;
    for (int n = 0; n <= parts; ++n) {
        const double s = along.back() * n / parts;
        Tube tube = tubes.front();
        for (int axis = 0; axis < 3; ++axis) {
            const auto point = splines[static_cast<std::size_t>(axis)](s);
            tube.centre[axis] = point.value;
            tube.direction[axis] = point.slope;
        }
        tube.direction = glm::normalize(tube.direction);
        tube.radius = std::clamp(splines[3](s).value, 1e-9, std::max(1e-9, max_radius));
        out.push_back(tube);
    }
    return out;
}

class Refinement {
public:
    explicit Refinement(const Search& search) : search_(search), voxel_(search.scan.voxel()) {}

    double blur(const Vec3& direction) const {
        const Across frame = across(direction);
        const double psf = search_.settings.psf_voxels;
        return std::sqrt(
            0.5 * (search_.scan.blur_variance(frame.first, psf) + search_.scan.blur_variance(frame.second, psf)));
    }

    /// `kept` above 0: contrast held at this value.
    Tube at(const Tube& tube, double kept) const {
        const double q = blur(tube.direction);
        // Short where the radius is large: a long window cuts corners by about the square of its length.
        const double axial = std::max(0.6, 2.0 * voxel_ / tube.radius);
        const double beyond = std::clamp(3.2 * q / tube.radius, 0.9, 4.5);
        const Window window = refining_window(axial, beyond);
        const double least = 0.25 * voxel_;
        FitLimits limits{least, std::max(least, std::min(1.6 * tube.radius + voxel_, search_.settings.max_radius))};
        limits.shift = std::max(0.6, voxel_ / tube.radius);
        limits.rounds = 2;
        limits.blur = q;
        limits.turns = false;
        limits.contrast = kept;
        return fitted(search_.scan, window, search_.sampling, tube, limits);
    }

private:
    const Search& search_;
    double voxel_;
};

void smooth_directions(std::vector<Tube>& tubes, double reach) {
    std::vector<Vec3> directions;
    for (std::size_t n = 0; n < tubes.size(); ++n) {
        std::size_t low = n, high = n;
        while (low > 0 && glm::length(tubes[low].centre - tubes[n].centre) < reach) --low;
        while (high + 1 < tubes.size() && glm::length(tubes[high].centre - tubes[n].centre) < reach) ++high;
        const Vec3 way = tubes[high].centre - tubes[low].centre;
        directions.push_back(glm::length(way) > 0.0 ? glm::normalize(way) : tubes[n].direction);
    }
    for (std::size_t n = 0; n < tubes.size(); ++n) tubes[n].direction = directions[n];
}

/// Mean of neighbours with the weights 1, 2, 1, of the part across the track.
void smooth_centres(std::vector<Tube>& tubes) {
    std::vector<Vec3> centres;
    for (std::size_t n = 0; n < tubes.size(); ++n) {
        Vec3 centre = tubes[n].centre;
        if (n > 0 && n + 1 < tubes.size()) {
            const Vec3 to = 0.25 * (tubes[n - 1].centre + tubes[n + 1].centre) - 0.5 * centre;
            centre += to - glm::dot(to, tubes[n].direction) * tubes[n].direction;
        }
        centres.push_back(centre);
    }
    for (std::size_t n = 0; n < tubes.size(); ++n) tubes[n].centre = centres[n];
}

/// What an end is judged by.
struct Seen {
    double contrast, radius;
};

/// How many of these nodes, from the inside of a branch to its end, belong to the vessel: up to where contrast times
/// cross-section, beside those before, exceeds 0.65 by the most in sum. A run into noise has less than that on average,
/// however long it is; beyond a gap or a stenosis the vessel makes up for it.
std::size_t kept_of(const std::vector<Seen>& nodes, double known_contrast, double known_radius) {
    constexpr std::ptrdiff_t window = 60;
    std::vector<double> contrasts, radii;
    double sum = 0.0, most = 0.0;
    std::size_t kept = 1;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        double contrast = known_contrast, radius = known_radius;
        if (n >= window / 2) {
            const std::ptrdiff_t count = std::min<std::ptrdiff_t>(window, std::ssize(contrasts));
            contrast = std::max(0.6 * known_contrast, median({contrasts.end() - count, contrasts.end()}));
            radius = median({radii.end() - count, radii.end()});
        }
        const double slimmer = std::min(1.0, nodes[n].radius / radius);
        sum += nodes[n].contrast / contrast * slimmer * slimmer - 0.65;
        contrasts.push_back(nodes[n].contrast);
        radii.push_back(nodes[n].radius);
        if (sum > most) most = sum, kept = n + 1;
    }
    return kept;
}

/// How many nodes, from the inside of a branch to its end, come before the track leaves its vessel: two in a row are wider
/// than twice the median of those from two to twelve radii before them, as in the search. Cut back to where they widen.
std::size_t before_leaving(std::span<const Tube> nodes) {
    std::size_t wide = 0;
    for (std::size_t n = 1; n < nodes.size(); ++n) {
        double back = 0.0;
        std::vector<double> earlier;
        for (std::size_t k = n; k-- > 0;) {
            back += glm::length(nodes[k + 1].centre - nodes[k].centre);
            if (back > 12.0 * nodes[k].radius) break;
            if (back > 2.0 * nodes[k].radius) earlier.push_back(nodes[k].radius);
        }
        const double usual = earlier.size() >= 3 ? median(earlier) : nodes.front().radius;
        wide = nodes[n].radius > 2.0 * usual ? wide + 1 : 0;
        if (wide < 2) continue;
        std::size_t kept = n;
        while (kept > 1 && nodes[kept - 1].radius > 1.4 * usual) --kept;
        return kept;
    }
    return nodes.size();
}

}  // namespace

Refined refined_nodes(const Search& search, const std::vector<Tube>& tubes, double reference_contrast,
                      const Vec3& inside, bool cut_start, bool cut_end) {
    if (tubes.size() < 2) return {};
    const double voxel = search.scan.voxel();
    std::vector<double> radii;
    for (const Tube& tube : tubes) radii.push_back(tube.radius);
    const double typical = median(radii);
    std::vector<Tube> fine = resampled(tubes, std::max(0.8 * voxel, 0.35 * typical), search.settings.max_radius);
    std::size_t middle = 0;
    for (std::size_t n = 0; n < fine.size(); ++n)
        if (glm::length(fine[n].centre - inside) < glm::length(fine[middle].centre - inside)) middle = n;
    const Refinement refinement(search);

    std::vector<Tube> free;
    for (const Tube& tube : fine) free.push_back(refinement.at(tube, 0.0));
    std::vector<double> thick;
    for (const Tube& tube : free)
        if (tube.radius >= 1.2 * voxel && tube.contrast > 0.5 * reference_contrast) thick.push_back(tube.contrast);
    const double known = thick.size() >= 3 ? median(thick) : reference_contrast;

    std::vector<char> lost(fine.size(), 0), uncertain(fine.size(), 0);
    for (std::size_t n = 0; n < fine.size(); ++n) {
        Tube& tube = free[n];
        const bool thin = tube.radius < 1.2 * voxel || tube.contrast > 1.6 * known;
        if (thin) {
            // Contrast and radius are not separable: the contrast of the thick part is kept.
            const Tube held = refinement.at(fine[n], known);
            tube = held;
            uncertain[n] = 1;
            lost[n] = tube.radius < 0.3 * voxel || tube.score < 2.0;
            tube.contrast = lost[n] ? 0.0 : known;
        } else {
            lost[n] = tube.contrast < 0.5 * known || tube.score < 2.0;
        }
        uncertain[n] |= tube.radius < 1.5 * voxel;
        if (lost[n]) {  // no centre to be found here
            tube.centre = fine[n].centre;
            tube.radius = fine[n].radius;
        }
    }
    smooth_directions(free, std::max(typical, 1.5 * voxel));
    smooth_centres(free);

    std::vector<Seen> seen;
    for (std::size_t n = 0; n < free.size(); ++n)
        seen.push_back({lost[n] ? std::min(free[n].contrast, 0.4 * known) : free[n].contrast, free[n].radius});
    const auto middle_of = static_cast<std::ptrdiff_t>(middle);
    std::size_t first = 0, last = free.size();
    if (cut_end) last = middle + kept_of({seen.begin() + middle_of, seen.end()}, known, free[middle].radius);
    if (cut_start) first = middle + 1 - kept_of({seen.rend() - middle_of - 1, seen.rend()}, known, free[middle].radius);
    Refined refined;
    if (cut_end)
        if (const std::size_t most = before_leaving(std::span(free).subspan(middle, last - middle));
            most < last - middle) {
            last = middle + most;
            refined.end = End::larger_vessel;
        }
    if (cut_start) {
        const std::vector<Tube> back(free.rend() - middle_of - 1, free.rend() - static_cast<std::ptrdiff_t>(first));
        if (const std::size_t most = before_leaving(back); most < back.size()) {
            first = middle + 1 - most;
            refined.start = End::larger_vessel;
        }
    }
    double along = 0.0;
    for (std::size_t n = first; n < last; ++n) {
        const Tube& tube = free[n];
        if (n > first) along += glm::length(tube.centre - free[n - 1].centre);
        Node node;
        node.position = tube.centre;
        node.direction = tube.direction;
        node.radius = tube.radius;
        node.contrast = tube.contrast;
        node.score = tube.score;
        node.along = along;
        node.is_lost = lost[n] != 0;
        node.is_radius_uncertain = uncertain[n] != 0;
        node.confidence = node.is_lost ? 0.0
                                       : std::min(1.0, std::max(0.0, tube.score) / (2.0 * search.min_mean)) *
                                             std::min(1.0, std::max(0.0, tube.contrast) / (0.8 * known));
        refined.nodes.push_back(node);
    }
    return refined;
}

}  // namespace tactus::vessel
