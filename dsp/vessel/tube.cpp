// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/tube.hpp"
#include "dsp/vessel/profile.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <numbers>

namespace tactus::vessel {

namespace {

constexpr double min_weight = 0.1;

void add_layers(Window& window, double axial, double across_sigma, double axial_step, double max_across,
                const std::vector<double>& rings) {
    // Friman's window ends where the weight falls below 0.1: at 1.52 times its width.
    const double end = axial * std::sqrt(-std::log(min_weight));
    const int layers = static_cast<int>(std::ceil(end / axial_step - 0.5));
    const double thick = 2.0 * end / (2 * layers + 1);
    for (int layer = -layers; layer <= layers; ++layer) {
        const double a = layer * thick;
        for (std::size_t ring = 0; ring + 1 < rings.size() && rings[ring] < max_across; ++ring) {
            const double low = rings[ring], high = std::min(rings[ring + 1], max_across), b = 0.5 * (low + high);
            const double weight = std::exp(-(a * a) / (axial * axial) - (b * b) / (across_sigma * across_sigma));
            if (weight < min_weight) continue;
            const int places = low == 0.0 ? 4 : std::clamp(static_cast<int>(9.0 * b + 2.0), 6, 14);
            const double volume = std::numbers::pi * (high * high - low * low) * thick / places;
            for (int n = 0; n < places; ++n) {
                // Rings and layers are turned against each other, so that samples of the grid are met evenly.
                const double angle = 2.0 * std::numbers::pi * (n + 0.38 * layer + 0.5 * double(ring % 2)) / places;
                window.places.push_back(
                    {a, b * std::cos(angle), b * std::sin(angle), weight, volume, smooth_profile(b * b, 1.0).value});
            }
            window.reach = std::max(window.reach, std::hypot(a, high));
        }
    }
}

}  // namespace

Window tracking_window(double axial, double across_sigma) {
    Window window;
    std::vector<double> rings{0.0, 0.45, 0.75, 1.0, 1.3, 1.7, 2.2, 2.8};
    while (rings.back() < 1.52 * across_sigma) rings.push_back(rings.back() * 1.3);
    add_layers(window, axial, across_sigma, 0.8, 1.52 * across_sigma, rings);
    return window;
}

Window refining_window(double axial, double beyond) {
    Window window;
    const double end = 1.0 + beyond;
    std::vector<double> rings{0.0};
    while (rings.back() < end) rings.push_back(rings.back() + 0.25);
    add_layers(window, axial, 3.0 * end, 0.5 * axial, end, rings);
    return window;
}

Across across(const Vec3& direction) {
    const Vec3 a = glm::abs(direction);
    const Vec3 axis = a.x <= a.y && a.x <= a.z ? Vec3(1, 0, 0) : a.y <= a.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    const Vec3 first = glm::normalize(glm::cross(direction, axis));
    return {first, glm::cross(direction, first)};
}

namespace {

/// Sums for contrast and background. A sample that counts as n of an independent one, with weight ω, adds ω²/n to the
/// variance of the sums: a cluster of 1/n copies of one sample has the weight ω/n in all.
struct Sums {
    double w = 0, t = 0, tt = 0, y = 0, ty = 0, yy = 0;
    double v = 0, vt = 0, vtt = 0;
    double all = 0;

    void add(double weight, double share, double profile, double value) {
        w += weight;
        t += weight * profile;
        tt += weight * profile * profile;
        y += weight * value;
        ty += weight * profile * value;
        yy += weight * value * value;
        const double variance = weight * weight / share;
        v += variance;
        vt += variance * profile;
        vtt += variance * profile * profile;
    }

    void settle(Tube& tube, double fixed_contrast = 0.0) const {
        tube.score = tube.contrast = tube.contrast_error = 0.0;
        tube.valid = all > 0.0 ? w / all : 0.0;
        const double det = w * tt - t * t;
        if (!(det > 1e-9 * w * tt)) return;
        const double k = fixed_contrast > 0.0 ? fixed_contrast : (w * ty - t * y) / det;
        const double m = (y - k * t) / w;
        const double rest = yy - 2.0 * k * ty - 2.0 * m * y + k * k * tt + 2.0 * k * m * t + m * m * w;
        // k is a sum of values with the factors ω (w T - t) / det.
        const double variance =
            std::max(rest, 1e-12 * yy) / w * (w * w * vtt - 2.0 * w * t * vt + t * t * v) / (det * det);
        tube.contrast = k;
        tube.background = m;
        tube.contrast_error = std::sqrt(std::max(variance, 0.0));
        tube.score = tube.contrast_error > 0.0 ? k / tube.contrast_error : 0.0;
    }
};

double share_of(const Window::Place& place, double radius, const Sampling& sampling) {
    return std::min(1.0, place.volume * radius * radius * radius / sampling.independent_volume);
}

struct Reading {
    double along, first, second, weight, value, share;
};

/// Solves the n × n system by Cholesky with the diagonal times 1 + damping.
template <std::size_t most>
bool solve(std::array<std::array<double, most>, most> a, std::array<double, most>& b, std::size_t n, double damping) {
    for (std::size_t i = 0; i < n; ++i) a[i][i] *= 1.0 + damping;
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = j; i < n; ++i) {
            double sum = a[i][j];
            for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
            if (i == j) {
                if (!(sum > 1e-300)) return false;
                a[i][i] = std::sqrt(sum);
            } else {
                a[i][j] = sum / a[j][j];
            }
        }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
    return true;
}

/// Shifts across and tilts of the axis, radius; lengths in m.
struct Pose5 {
    double s1 = 0, s2 = 0, t1 = 0, t2 = 0, radius = 0;
};

class Fit {
public:
    Fit(const Scan& scan, const Window& window, const Sampling& sampling, const FitLimits& limits)
        : scan_(scan), window_(window), sampling_(sampling), limits_(limits) {}

    Tube run(const Tube& start) {
        Tube best = start;
        for (int round = 0; round < limits_.rounds; ++round) {
            const Tube before = best;
            if (!read(best)) break;
            best = improved(best, start);
            const double moved = glm::length(best.centre - before.centre);
            const double turned = glm::length(glm::cross(best.direction, before.direction));
            if (moved < 0.02 * best.radius && turned < 0.02 &&
                std::abs(best.radius - before.radius) < 0.01 * best.radius)
                break;
        }
        return best;
    }

private:
    bool read(const Tube& tube) {
        frame_ = across(tube.direction);
        readings_.clear();
        double weight = 0.0, all = 0.0;
        for (const Window::Place& place : window_.places) {
            const double share = share_of(place, tube.radius, sampling_);
            all += place.weight * share;
            const Vec3 at = tube.centre + tube.radius * (place.along * tube.direction + place.across_1 * frame_.first +
                                                         place.across_2 * frame_.second);
            float value;
            if (!scan_.value(at, value)) continue;
            weight += place.weight * share;
            readings_.push_back({tube.radius * place.along, tube.radius * place.across_1, tube.radius * place.across_2,
                                 place.weight * share, double(value), share});
        }
        return weight > 0.35 * all;
    }

    ProfileValue profile(double d2, double radius) const {
        return limits_.blur > 0.0 ? blurred_profile(d2, radius, limits_.blur) : smooth_profile(d2, radius);
    }

    /// Weighted least squares of contrast and background; returns the weighted sum of squared residuals.
    double linear(const Pose5& pose, double& k, double& m) const {
        const double norm = 1.0 / std::sqrt(1.0 + pose.t1 * pose.t1 + pose.t2 * pose.t2);
        double w = 0, t = 0, tt = 0, y = 0, ty = 0, yy = 0;
        for (const Reading& r : readings_) {
            const double y1 = r.first - pose.s1, y2 = r.second - pose.s2;
            const double along = (r.along + y1 * pose.t1 + y2 * pose.t2) * norm;
            const double d2 = std::max(0.0, r.along * r.along + y1 * y1 + y2 * y2 - along * along);
            const double p = profile(d2, pose.radius).value;
            w += r.weight;
            t += r.weight * p;
            tt += r.weight * p * p;
            y += r.weight * r.value;
            ty += r.weight * p * r.value;
            yy += r.weight * r.value * r.value;
        }
        const double det = w * tt - t * t;
        if (!(det > 1e-9 * w * tt)) return std::numeric_limits<double>::infinity();
        k = limits_.contrast > 0.0 ? limits_.contrast : (w * ty - t * y) / det;
        m = (y - k * t) / w;
        return yy - 2.0 * k * ty - 2.0 * m * y + k * k * tt + 2.0 * k * m * t + m * m * w;
    }

    Tube improved(const Tube& tube, const Tube& start) const {
        Pose5 pose;
        pose.radius = tube.radius;
        double k = 0, m = 0, cost = linear(pose, k, m), damping = 1e-3;
        const double scale = tube.radius;
        for (int iteration = 0; iteration < 5 && k > 0.0 && std::isfinite(cost); ++iteration) {
            std::array<std::array<double, 7>, 7> a{};
            std::array<double, 7> b{};
            normal_equations(pose, k, m, scale, a, b);
            bool better = false;
            for (int trial = 0; trial < 4 && !better; ++trial, damping *= 8.0) {
                std::array<double, 7> step = b;
                if (!solve(a, step, std::size_t{7}, damping)) continue;
                Pose5 next = pose;
                next.s1 += std::clamp(step[2], -0.5, 0.5) * scale;
                next.s2 += std::clamp(step[3], -0.5, 0.5) * scale;
                next.t1 += std::clamp(step[4], -0.3, 0.3);
                next.t2 += std::clamp(step[5], -0.3, 0.3);
                next.radius *= std::exp(std::clamp(step[6], -0.2, 0.2));
                confine(next, tube, start);
                double next_k, next_m;
                const double next_cost = linear(next, next_k, next_m);
                if (next_cost < cost) {
                    better = true;
                    const bool settled = next_cost > cost * (1.0 - 1e-4);
                    pose = next, k = next_k, m = next_m, cost = next_cost;
                    damping = std::max(1e-6, damping * 0.02);
                    if (settled) iteration = 99;
                }
            }
            if (!better) break;
        }
        Tube out = tube;
        out.centre = tube.centre + pose.s1 * frame_.first + pose.s2 * frame_.second;
        out.direction = glm::normalize(tube.direction + pose.t1 * frame_.first + pose.t2 * frame_.second);
        out.radius = pose.radius;
        out.contrast = k;
        out.background = m;
        return out;
    }

    void confine(Pose5& pose, const Tube& tube, const Tube& start) const {
        pose.radius = std::clamp(pose.radius, limits_.min_radius, limits_.max_radius);
        const Vec3 centre = tube.centre + pose.s1 * frame_.first + pose.s2 * frame_.second;
        const Vec3 moved = centre - start.centre;
        const double most = limits_.shift * start.radius, length = glm::length(moved);
        if (length > most) {
            const Vec3 back = start.centre + moved * (most / length) - tube.centre;
            pose.s1 = glm::dot(back, frame_.first), pose.s2 = glm::dot(back, frame_.second);
        }
        const double tilt = std::hypot(pose.t1, pose.t2), max_tilt = std::tan(limits_.angle);
        if (tilt > max_tilt) pose.t1 *= max_tilt / tilt, pose.t2 *= max_tilt / tilt;
    }

    void normal_equations(const Pose5& pose, double k, double m, double scale, std::array<std::array<double, 7>, 7>& a,
                          std::array<double, 7>& b) const {
        const double norm = 1.0 / std::sqrt(1.0 + pose.t1 * pose.t1 + pose.t2 * pose.t2);
        for (const Reading& r : readings_) {
            const double y1 = r.first - pose.s1, y2 = r.second - pose.s2;
            const double along = (r.along + y1 * pose.t1 + y2 * pose.t2) * norm;
            const double d2 = std::max(0.0, r.along * r.along + y1 * y1 + y2 * y2 - along * along);
            const ProfileValue p = profile(d2, pose.radius);
            const double by_d2 = k * p.by_squared_distance;
            const double tangent_1 = pose.t1 * norm, tangent_2 = pose.t2 * norm;
            const std::array<double, 7> row{
                limits_.contrast > 0.0 ? 0.0 : p.value,
                1.0,
                -2.0 * by_d2 * (y1 - along * tangent_1) * scale,
                -2.0 * by_d2 * (y2 - along * tangent_2) * scale,
                limits_.turns ? -2.0 * by_d2 * along * (y1 - along * tangent_1) * norm : 0.0,
                limits_.turns ? -2.0 * by_d2 * along * (y2 - along * tangent_2) * norm : 0.0,
                limits_.resizes ? k * p.by_radius * pose.radius : 0.0};
            const double residual = r.value - k * p.value - m;
            for (std::size_t i = 0; i < 7; ++i) {
                const double w = r.weight * row[i];
                b[i] += w * residual;
                for (std::size_t j = 0; j <= i; ++j) a[i][j] += w * row[j];
            }
        }
        for (std::size_t i = 0; i < 7; ++i) a[i][i] += 1e-12 * (a[1][1] + 1e-300) + (a[i][i] == 0.0 ? 1.0 : 0.0);
    }

    const Scan& scan_;
    const Window& window_;
    const Sampling& sampling_;
    const FitLimits& limits_;
    Across frame_{};
    std::vector<Reading> readings_;
};

}  // namespace

Tube measured(const Scan& scan, const Window& window, const Sampling& sampling, Tube tube) {
    const Across frame = across(tube.direction);
    const Vec3 a = tube.radius * tube.direction, b = tube.radius * frame.first, c = tube.radius * frame.second;
    Sums sums;
    for (const Window::Place& place : window.places) {
        const double share = share_of(place, tube.radius, sampling), weight = place.weight * share;
        sums.all += weight;
        float value;
        if (scan.value(tube.centre + place.along * a + place.across_1 * b + place.across_2 * c, value))
            sums.add(weight, share, place.smooth, double(value));
    }
    sums.settle(tube);
    if (tube.valid < 0.35) tube.score = 0.0;
    return tube;
}

Tube fitted(const Scan& scan, const Window& window, const Sampling& sampling, const Tube& start,
            const FitLimits& limits) {
    Tube tube = Fit(scan, window, sampling, limits).run(start);
    if (limits.blur <= 0.0) return measured(scan, window, sampling, tube);
    // With the blurred profile, and around the centre that was found.
    const Across frame = across(tube.direction);
    Sums sums;
    for (const Window::Place& place : window.places) {
        const double share = share_of(place, tube.radius, sampling), weight = place.weight * share;
        sums.all += weight;
        float value;
        if (!scan.value(tube.centre + tube.radius * (place.along * tube.direction + place.across_1 * frame.first +
                                                     place.across_2 * frame.second),
                        value))
            continue;
        const double d2 =
            (place.across_1 * place.across_1 + place.across_2 * place.across_2) * tube.radius * tube.radius;
        sums.add(weight, share, blurred_profile(d2, tube.radius, limits.blur).value, double(value));
    }
    sums.settle(tube, limits.contrast);
    if (tube.valid < 0.35) tube.score = 0.0;
    return tube;
}

}  // namespace tactus::vessel
