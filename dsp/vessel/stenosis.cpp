// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/stenosis.hpp"

#include "dsp/core/median.hpp"
#include "dsp/vessel/narrowing.hpp"

#include <algorithm>

namespace tactus::vessel {

namespace {

constexpr double min_gain = 12.0;   ///< chi squared, for the five numbers of a narrowing
constexpr double min_depth = 0.06;  ///< of the radius of the nodes; less is not looked at
constexpr std::size_t max_fits = 5;
constexpr double max_error = 0.06;  ///< of the depth; on phantoms the true error is about half of it
constexpr double max_misfit = 2.0;

/// Radii along a branch, prepared for the search for narrowings.
class Radii {
public:
    explicit Radii(const Branch& branch) : branch_(branch) {
        for (const Node& node : branch.nodes)
            if (is_measured(node)) all_.push_back(node.radius);
        typical_ = all_.size() < 5 ? 0.0 : median(all_);
    }

    bool is_enough() const { return typical_ > 0.0 && branch_.length() - branch_.free_from >= 6.0 * typical_; }
    double typical() const { return typical_; }

    /// The ends are worn by the end of the contrast.
    bool is_inside(double along) const {
        return along >= branch_.free_from + typical_ && along <= branch_.length() - typical_;
    }

    /// Medians of the vessel three to ten radii before and after, or of the one there is.
    std::optional<double> reference(double along) const {
        std::vector<double> before, after;
        for (const Node& other : branch_.nodes) {
            const double away = other.along - along;
            if (!is_measured(other) || std::abs(away) < 3.0 * typical_ || std::abs(away) > 10.0 * typical_) continue;
            (away < 0.0 ? before : after).push_back(other.radius);
        }
        if (before.size() >= 3 && after.size() >= 3) return 0.5 * (median(before) + median(after));
        if (before.size() >= 3) return median(before);
        if (after.size() >= 3) return median(after);
        return std::nullopt;
    }

    /// Length around a node in which the radius is below `limit`, m.
    double below(std::size_t node, double limit) const { return way(node, -1, limit) + way(node, 1, limit); }

private:
    bool is_measured(const Node& node) const { return !node.is_lost && node.along >= branch_.free_from; }

    /// How far from a node, one way, the radius passes `limit`, m; up to the end of the branch.
    double way(std::size_t from, int step, double limit) const {
        const std::vector<Node>& nodes = branch_.nodes;
        auto n = static_cast<std::ptrdiff_t>(from);
        for (; n + step >= 0 && n + step < std::ssize(nodes); n += step) {
            const Node &here = nodes[static_cast<std::size_t>(n)], &next = nodes[static_cast<std::size_t>(n + step)];
            if (next.is_lost || next.radius < limit) continue;
            const double part = here.is_lost ? 1.0 : (limit - here.radius) / std::max(1e-12, next.radius - here.radius);
            return std::abs(here.along + part * (next.along - here.along) - nodes[from].along);
        }
        return std::abs(nodes[static_cast<std::size_t>(n)].along - nodes[from].along);
    }

    const Branch& branch_;
    std::vector<double> all_;
    double typical_ = 0.0;
};

struct Place {
    std::size_t node;
    double depth, reference;
    bool is_lost;
};

/// Deepest first, two radii apart.
std::vector<Place> places_of(const Branch& branch, const Radii& radii) {
    std::vector<Place> all;
    for (std::size_t n = 0; n < branch.nodes.size(); ++n) {
        const Node& node = branch.nodes[n];
        if (node.is_lost || !radii.is_inside(node.along)) continue;
        if (const auto reference = radii.reference(node.along))
            all.push_back({n, std::max(0.0, 1.0 - node.radius / *reference), *reference, false});
    }
    for (const LostStretch& stretch : branch.lost()) {
        const double middle = 0.5 * (stretch.from + stretch.to);
        if (!radii.is_inside(stretch.from) || !radii.is_inside(stretch.to)) continue;
        std::size_t nearest = 0;
        for (std::size_t n = 0; n < branch.nodes.size(); ++n)
            if (std::abs(branch.nodes[n].along - middle) < std::abs(branch.nodes[nearest].along - middle)) nearest = n;
        if (const auto reference = radii.reference(middle)) all.push_back({nearest, 0.9, *reference, true});
    }
    std::ranges::stable_sort(all, std::greater(), &Place::depth);
    std::vector<Place> chosen;
    for (const Place& place : all) {
        const bool is_near = std::ranges::any_of(chosen, [&](const Place& other) {
            return std::abs(branch.nodes[place.node].along - branch.nodes[other.node].along) < 2.0 * radii.typical();
        });
        if (!is_near) chosen.push_back(place);
    }
    return chosen;
}

std::size_t nearest_node(const Branch& branch, double along) {
    std::size_t nearest = 0;
    for (std::size_t n = 0; n < branch.nodes.size(); ++n)
        if (std::abs(branch.nodes[n].along - along) < std::abs(branch.nodes[nearest].along - along)) nearest = n;
    return nearest;
}

}  // namespace

std::optional<Stenosis> measured_stenosis(const Search& search, const Noise& noise, Branch& branch) {
    const Radii radii(branch);
    if (!radii.is_enough()) return std::nullopt;
    const std::vector<Place> places = places_of(branch, radii);
    if (places.empty()) return std::nullopt;
    // As the nodes have it.
    const auto as_seen = [&](const Place& place) {
        const Node& node = branch.nodes[place.node];
        Stenosis seen{place.node, node.radius, place.reference, 100.0 * place.depth, 0.0, node.is_radius_uncertain};
        if (place.is_lost) seen = {place.node, 0.0, place.reference, 100.0, 0.0, true};
        return seen;
    };
    std::optional<Stenosis> worst;
    std::optional<Narrowing> fitted;
    double most = -1.0;
    std::size_t fits = 0;
    for (const Place& place : places) {
        Stenosis found = as_seen(place);
        std::optional<Narrowing> narrowing;
        const double width = radii.below(place.node, (1.0 - 0.5 * place.depth) * place.reference);
        const bool is_short = width < 6.0 * place.reference;
        if (place.depth >= min_depth && is_short && fits < max_fits) {
            ++fits;
            narrowing = fitted_narrowing(search, noise, branch,
                                         {branch.nodes[place.node].along, place.reference, place.depth, width});
            if (!narrowing) found.is_uncertain = true;
            // A reference beyond what a vessel may have is that of something else.
            else if (narrowing->gain < min_gain || narrowing->reference > search.settings.max_radius) narrowing.reset();
        }
        if (narrowing) {
            found.node = nearest_node(branch, narrowing->at);
            found.reference_radius = narrowing->reference;
            found.percent = 100.0 * narrowing->depth;
            found.radius = narrowing->reference * (1.0 - narrowing->depth);
            found.error_percent = 100.0 * narrowing->depth_error;
            // Near 100 % the curvature of chi squared no longer gives the error.
            found.is_uncertain = narrowing->depth_error > max_error || narrowing->misfit > max_misfit ||
                                 narrowing->depth + 2.0 * narrowing->depth_error > 1.0;
        }
        const double least = found.percent - found.error_percent;
        if (least > most) most = least, worst = found, fitted = narrowing;
    }
    if (fitted)
        for (Node& node : branch.nodes) {
            if (node.is_lost || std::abs(node.along - fitted->at) > fitted->width) continue;
            node.radius = std::min(fitted->radius(node.along), search.settings.max_radius);
            node.is_radius_uncertain = worst->is_uncertain;
        }
    return worst;
}

}  // namespace tactus::vessel
