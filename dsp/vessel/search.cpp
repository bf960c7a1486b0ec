// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/search.hpp"

#include "dsp/core/median.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::vessel {

namespace {

/// What the vessel has been like lately.
struct Recent {
    double contrast, lumen, radius;
};

/// A possible continuation: tubes one step apart.
struct Hypothesis {
    std::vector<Tube> tubes;

    double mean() const {
        double sum = 0.0;
        for (const Tube& tube : tubes) sum += tube.score;
        return sum / double(tubes.size());
    }
};

class Walk {
public:
    Walk(const Search& search, const Tube& start, const std::vector<Taken>& taken, double max_length)
        : search_(search), settings_(search.settings), taken_(taken), max_length_(max_length), path_{start} {}

    OneWay run() {
        std::vector<Hypothesis> open;
        double length = 0.0;
        for (;;) {
            const Recent recent = recent_values();
            open = looked_ahead(std::move(open), recent);
            if (open.empty()) return finished(refused_);
            const auto best = std::max_element(open.begin(), open.end(), [](const Hypothesis& a, const Hypothesis& b) {
                return a.tubes.size() != b.tubes.size() ? a.tubes.size() < b.tubes.size() : a.mean() < b.mean();
            });
            if (best->mean() < search_.min_mean) return finished(End::noise);
            const Tube next = best->tubes.front();
            if (search_.scan.inside_by(next.centre) < 0.5 * search_.scan.voxel()) return finished(End::border);
            const double least = min_contrast(next.radius);
            if (next.contrast < least * recent.contrast) return finished(end_of_contrast(next, recent));
            if (!is_same_brightness(next, recent)) return finished(end_of_contrast(next, recent));
            if (const int met = meets(next); met >= 0) {
                meets_ = met;
                return finished(End::meets_track);
            }
            length += glm::length(next.centre - path_.back().centre);
            path_.push_back(next);
            if (is_much_larger()) return finished(End::larger_vessel);
            if (length > max_length_) return finished(End::length);
            std::vector<Hypothesis> kept;
            for (Hypothesis& each : open)
                if (each.tubes.size() > 1 && each.tubes.front().centre == next.centre) {
                    each.tubes.erase(each.tubes.begin());
                    kept.push_back(std::move(each));
                }
            open = std::move(kept);
        }
    }

private:
    OneWay finished(End end) {
        if (end == End::larger_vessel)
            while (path_.size() > 1 && path_.back().radius > 1.4 * earlier_radius_) path_.pop_back();
        OneWay found;
        found.tubes.assign(path_.begin() + 1, path_.end());
        found.end = end;
        found.meets = meets_;
        return found;
    }

    /// Below 1.5 samples blur takes contrast away.
    double min_contrast(double radius) const {
        const double voxels = radius / search_.scan.voxel();
        return settings_.min_contrast * std::clamp(0.5 + 0.5 * (voxels - 0.75) / 0.75, 0.5, 1.0);
    }

    /// Neither tissue nor another contrast than so far.
    bool is_same_brightness(const Tube& tube, const Recent& recent) const {
        const double change = (tube.background + tube.contrast - recent.lumen) / recent.contrast;
        const bool is_thin = tube.radius < 1.5 * search_.scan.voxel();
        return change < 0.6 && (is_thin || change > -0.6);
    }

    End end_of_contrast(const Tube& tube, const Recent& recent) const {
        if (near_excluded(tube)) return End::excluded;
        // Bright, but without an edge: the vessel opens into a larger one.
        const double value = search_.scan.any_value(tube.centre);
        if (std::abs(value - recent.lumen) < 0.4 * recent.contrast &&
            tube.background > recent.lumen - 0.7 * recent.contrast)
            return End::larger_vessel;
        return End::contrast;
    }

    bool near_excluded(const Tube& tube) const {
        for (const double along : {-1.0, 0.0, 1.0, 2.0})
            if (search_.scan.is_excluded(tube.centre + along * tube.radius * tube.direction)) return true;
        return false;
    }

    Recent recent_values() const {
        std::vector<double> contrast, lumen, radius;
        const std::size_t count = std::min<std::size_t>(path_.size(), 15);
        for (std::size_t n = path_.size() - count; n < path_.size(); ++n) {
            contrast.push_back(path_[n].contrast);
            lumen.push_back(path_[n].background + path_[n].contrast);
            radius.push_back(path_[n].radius);
        }
        return {median(contrast), median(lumen), median(radius)};
    }

    /// A vessel that grows to twice its radius within eight radii has run into another one.
    bool is_much_larger() {
        double back = 0.0;
        std::vector<double> earlier;
        for (std::size_t n = path_.size() - 1; n-- > 0;) {
            back += glm::length(path_[n + 1].centre - path_[n].centre);
            if (back > 2.0 * path_[n].radius && back < 12.0 * path_[n].radius) earlier.push_back(path_[n].radius);
        }
        if (earlier.empty()) earlier.push_back(path_.front().radius);
        earlier_radius_ = median(earlier);
        return path_.back().radius > 2.0 * earlier_radius_;
    }

    int meets(const Tube& next) const {
        for (const Taken& place : taken_)
            if (glm::length(next.centre - place.position) < 0.8 * place.radius) return place.branch;
        double back = 0.0;
        for (std::size_t n = path_.size(); n-- > 1;) {
            back += glm::length(path_[n].centre - path_[n - 1].centre);
            if (back > 4.0 * next.radius && glm::length(next.centre - path_[n - 1].centre) < path_[n - 1].radius)
                return 0;
        }
        return -1;
    }

    /// Extends all hypotheses to the depth that is looked ahead.
    std::vector<Hypothesis> looked_ahead(std::vector<Hypothesis> open, const Recent& recent) {
        refused_ = End::noise;
        if (open.empty()) {
            for (const Tube& tube : continued(path_.back(), path_.size() == 1 ? 0.8 : settings_.max_angle, recent))
                open.push_back({{tube}});
        }
        for (;;) {
            std::vector<Hypothesis> next;
            bool grown = false;
            for (Hypothesis& each : open) {
                if (each.tubes.size() >= static_cast<std::size_t>(settings_.depth)) {
                    next.push_back(std::move(each));
                    continue;
                }
                for (const Tube& tube : continued(each.tubes.back(), settings_.max_angle, recent)) {
                    next.push_back(each);
                    next.back().tubes.push_back(tube);
                    grown = true;
                }
            }
            if (next.empty()) return open;  // the end is near: what is left
            open = best_of(std::move(next));
            if (!grown) return open;
        }
    }

    /// The best few, without those that end at the same place.
    std::vector<Hypothesis> best_of(std::vector<Hypothesis> all) const {
        std::ranges::stable_sort(all, [](const Hypothesis& a, const Hypothesis& b) { return a.mean() > b.mean(); });
        std::vector<Hypothesis> kept;
        for (Hypothesis& each : all) {
            const bool is_twin = std::ranges::any_of(kept, [&](const Hypothesis& other) {
                return glm::length(other.tubes.back().centre - each.tubes.back().centre) <
                       std::max(0.6 * each.tubes.back().radius, 0.5 * search_.scan.voxel());
            });
            if (!is_twin) kept.push_back(std::move(each));
            if (kept.size() == 4) break;
        }
        return kept;
    }

    /// Tubes one step on from `from`: local maxima of the score over a fan of directions, fitted.
    std::vector<Tube> continued(const Tube& from, double max_angle, const Recent& recent) {
        const int n = settings_.fan, side = 2 * n + 1;
        const Across frame = across(from.direction);
        const double step = std::max(settings_.step * from.radius, 0.8 * search_.scan.voxel());
        std::vector<Tube> fan(static_cast<std::size_t>(side * side));
        const auto at = [&](int i, int j) -> Tube& { return fan[static_cast<std::size_t>((i + n) * side + j + n)]; };
        for (int i = -n; i <= n; ++i)
            for (int j = -n; j <= n; ++j) {
                const double angle = max_angle * std::hypot(i, j) / n;
                if (angle > max_angle * 1.2) continue;
                const double turn = std::atan2(j, i);
                const Vec3 direction = std::cos(angle) * from.direction +
                                       std::sin(angle) * (std::cos(turn) * frame.first + std::sin(turn) * frame.second);
                Tube tube = from;
                tube.direction = glm::normalize(direction);
                tube.centre = from.centre + step * tube.direction;
                at(i, j) = measured(search_.scan, search_.window, search_.sampling, tube);
            }
        std::vector<std::pair<double, Tube>> peaks;
        for (int i = -n; i <= n; ++i)
            for (int j = -n; j <= n; ++j) {
                const double score = at(i, j).score;
                if (!(score > 1.0)) continue;
                bool is_peak = true;
                for (int a = std::max(-n, i - 1); a <= std::min(n, i + 1); ++a)
                    for (int b = std::max(-n, j - 1); b <= std::min(n, j + 1); ++b)
                        is_peak = is_peak && at(a, b).score <= score;
                if (is_peak) peaks.emplace_back(score, at(i, j));
            }
        std::ranges::stable_sort(peaks, [](const auto& a, const auto& b) { return a.first > b.first; });
        if (peaks.size() > 3) peaks.resize(3);
        std::vector<Tube> found;
        for (const auto& [score, peak] : peaks) {
            const Tube tube = settled(from, peak, step, recent);
            if (tube.score < search_.min_score || tube.contrast < 0.5 * min_contrast(tube.radius) * recent.contrast) {
                if (near_excluded(tube)) refused_ = End::excluded;
                else if (search_.scan.inside_by(tube.centre) < tube.radius) refused_ = End::border;
                else if (tube.contrast < 0.5 * min_contrast(tube.radius) * recent.contrast)
                    refused_ = end_of_contrast(tube, recent);
                continue;
            }
            const bool is_twin = std::ranges::any_of(found, [&](const Tube& other) {
                return glm::length(other.centre - tube.centre) <
                       std::max(0.5 * tube.radius, 0.5 * search_.scan.voxel());
            });
            if (!is_twin) found.push_back(tube);
        }
        return found;
    }

    Tube settled(const Tube& from, const Tube& peak, double step, const Recent& recent) const {
        FitLimits limits{std::max(settings_.min_radius, 0.5 * search_.scan.voxel()), settings_.max_radius};
        limits.min_radius = std::max(limits.min_radius, 0.7 * from.radius);
        limits.max_radius = std::min(limits.max_radius, 1.25 * from.radius);
        limits.max_radius = std::max(limits.max_radius, limits.min_radius);
        limits.shift = 0.7;
        limits.angle = 0.4;
        limits.rounds = 2;
        Tube tube = fitted(search_.scan, search_.window, search_.sampling, peak, limits);
        // A sudden stenosis: what is far narrower is found from far narrower.
        if (tube.contrast < 0.75 * recent.contrast && 0.6 * from.radius > limits.min_radius) {
            Tube narrow = peak;
            narrow.radius = 0.55 * from.radius;
            FitLimits narrowly = limits;
            narrowly.min_radius = std::max(settings_.min_radius, 0.35 * from.radius);
            narrow = fitted(search_.scan, search_.window, search_.sampling, narrow, narrowly);
            if (narrow.score > tube.score) tube = narrow;
        }
        if (tube.radius > 1.05 * from.radius) {
            const double cap = 1.3 * edge_distance(search_.scan, tube);
            if (tube.radius > cap) {
                tube.radius = std::max(cap, limits.min_radius);
                tube = measured(search_.scan, search_.window, search_.sampling, tube);
            }
        }
        const Vec3 way = tube.centre - from.centre;
        const double length = glm::length(way);
        if (length > 0.0) tube.centre = from.centre + way * (step / length);
        if (glm::dot(tube.direction, way) < 0.0) tube.direction = -tube.direction;
        return tube;
    }

    const Search& search_;
    const TrackSettings& settings_;
    const std::vector<Taken>& taken_;
    double max_length_;
    std::vector<Tube> path_;
    End refused_ = End::noise;
    int meets_ = -1;
    double earlier_radius_ = 0.0;
};

}  // namespace

OneWay follow_one_way(const Search& search, const Tube& start, const std::vector<Taken>& taken, double max_length) {
    return Walk(search, start, taken, max_length).run();
}

}  // namespace tactus::vessel
