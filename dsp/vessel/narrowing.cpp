// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/narrowing.hpp"
#include "dsp/geometry/dense_cholesky.hpp"
#include "dsp/vessel/profile.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numbers>

namespace tactus::vessel {

double Narrowing::radius(double along) const {
    const double x = std::abs(2.0 * (along - at) / width);
    return std::max(0.0, reference * (1.0 + slope * (along - at)) *
                             (1.0 - depth * std::exp(-std::numbers::ln2 * std::pow(x, steepness))));
}

namespace {

struct Layer {
    double along;
    Vec3 centre, direction, first, second;
};

struct Reading {
    std::size_t layer;
    double first, second, value, weight;
};

/// Position and slope of the centre line, by local parabolas through the nodes: the centre of a narrow node is noise.
std::vector<Layer> layers_of(const Branch& branch, double from, double to, double step, double reach) {
    std::vector<Layer> layers;
    const int count = std::max(2, static_cast<int>((to - from) / step) + 1);
    for (int n = 0; n < count; ++n) {
        const double s = from + (to - from) * n / (count - 1);
        std::vector<double> matrix(9, 0.0);
        std::array<std::vector<double>, 3> right;
        for (auto& side : right) side.assign(3, 0.0);
        for (const Node& node : branch.nodes) {
            const double x = (node.along - s) / reach;
            if (std::abs(x) > 3.0 || node.is_lost) continue;
            const double weight = std::exp(-0.5 * x * x) * node.contrast * node.radius * node.radius;
            const std::array<double, 3> powers{1.0, x, x * x};
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) matrix[3 * i + j] += weight * powers[i] * powers[j];
                for (std::size_t axis = 0; axis < 3; ++axis)
                    right[axis][i] += weight * powers[i] * node.position[static_cast<int>(axis)];
            }
        }
        Layer layer{s, Vec3(0.0), Vec3(0.0), Vec3(0.0), Vec3(0.0)};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<double> copy = matrix;
            if (!geometry::solve_positive(copy, right[axis])) return {};
            layer.centre[static_cast<int>(axis)] = right[axis][0];
            layer.direction[static_cast<int>(axis)] = right[axis][1];
        }
        if (!(glm::length(layer.direction) > 0.0)) return {};
        layer.direction = glm::normalize(layer.direction);
        // Transported without twist.
        Vec3 first = layers.empty() ? across(layer.direction).first : layers.back().first;
        first -= glm::dot(first, layer.direction) * layer.direction;
        if (!(glm::length(first) > 0.0)) return {};
        layer.first = glm::normalize(first);
        layer.second = glm::cross(layer.direction, layer.first);
        layers.push_back(layer);
    }
    return layers;
}

enum Parameter : std::size_t { size, slope, depth, place, width, aside_1, aside_2, blur, form, parameters };
using Parameters = std::array<double, parameters>;

class Fit {
public:
    Fit(const Search& search, const Noise& noise, const Branch& branch, const NarrowingGuess& guess)
        : guess_(guess), branch_(branch) {
        const Scan& scan = search.scan;
        const double voxel = scan.voxel();
        const double reach = 4.0 * guess.reference + guess.width;
        const double from = std::max(branch.free_from, guess.at - reach);
        const double to = std::min(branch.length(), guess.at + reach);
        half_ = 0.5 * (to - from);
        step_ = std::max(0.6 * voxel, 0.2 * guess.reference);
        if (to - from < guess.width + 2.0 * guess.reference) return;
        layers_ = layers_of(branch, from, to, step_, std::max(guess.reference, 1.5 * voxel));
        if (layers_.size() < 5) {
            layers_.clear();
            return;
        }
        step_ = layers_[1].along - layers_[0].along;
        const Layer& middle = layers_[layers_.size() / 2];
        const double psf = search.settings.psf_voxels;
        blur_along_ = std::sqrt(scan.blur_variance(middle.direction, psf));
        blur_across_ =
            std::sqrt(0.5 * (scan.blur_variance(middle.first, psf) + scan.blur_variance(middle.second, psf)));
        read(scan, search.sampling);
        sigma_ = std::max(noise.sigma, 0.02 * contrast());
    }

    bool is_ready() const { return readings_.size() > 100 && sigma_ > 0.0; }

    /// Fits, with a narrowing or without. Returns chi squared.
    double run(bool narrows) {
        narrows_ = narrows;
        p_ = {};
        p_[form] = std::log(usual_steepness);
        if (narrows) {
            p_[depth] = std::clamp(1.5 * guess_.depth, 0.3, 0.8);
            p_[width] = std::log(std::clamp(guess_.width / guess_.reference, 0.8, 3.0));
        }
        weigh(false);
        for (int round = 0; round < 2; ++round) {  // the second time without neighbours
            improve(round == 0 ? 15 : 10);
            weigh(true);
        }
        std::vector<double> residuals = residuals_of(p_);
        return squared(residuals);
    }

    Narrowing found() const {
        Narrowing narrowing;
        narrowing.at = at(p_);
        narrowing.width = std::exp(p_[width]) * guess_.reference;
        narrowing.slope = p_[slope] / half_;
        narrowing.reference = std::exp(p_[size]) * guess_.reference;
        narrowing.depth = p_[depth];
        narrowing.steepness = std::exp(p_[form]);
        return narrowing;
    }

    /// Standard deviation of the depth, from the curvature of chi squared.
    double depth_error() const {
        std::vector<double> matrix(parameters * parameters, 0.0), right(parameters, 0.0);
        std::vector<double> jacobian;
        const std::vector<double> residuals = residuals_of(p_);
        slopes(residuals, jacobian);
        normal(jacobian, matrix);
        for (std::size_t i = 0; i < parameters; ++i) matrix[i * parameters + i] += 1e-9;
        right[depth] = 1.0;
        return geometry::solve_positive(matrix, right) ? std::sqrt(std::max(0.0, right[depth])) : 1.0;
    }

    double misfit() const {
        double sum = 0.0, count = 0.0;
        const std::vector<double> residuals = residuals_of(p_);
        for (std::size_t n = 0; n < readings_.size(); ++n) {
            sum += residuals[n] * residuals[n];
            count += readings_[n].weight * trust_[n];
        }
        return sum / count;
    }

private:
    void read(const Scan& scan, const Sampling& sampling) {
        const double end = guess_.reference + 3.2 * blur_across_;
        const double thick = std::max(0.6 * scan.voxel(), 0.2 * guess_.reference);
        for (std::size_t l = 0; l < layers_.size(); ++l)
            for (double low = 0.0; low < end; low += thick) {
                const double d = low + 0.5 * thick;
                const int places =
                    std::clamp(static_cast<int>(2.0 * std::numbers::pi * d / thick), low == 0.0 ? 4 : 6, 16);
                const double volume = std::numbers::pi * (2.0 * low * thick + thick * thick) * step_ / places;
                for (int n = 0; n < places; ++n) {
                    const double angle = 2.0 * std::numbers::pi * (n + 0.38 * double(l)) / places;
                    const double first = d * std::cos(angle), second = d * std::sin(angle);
                    float value;
                    if (scan.value(layers_[l].centre + first * layers_[l].first + second * layers_[l].second, value))
                        readings_.push_back(
                            {l, first, second, double(value), std::min(1.0, volume / sampling.independent_volume)});
                }
            }
        trust_.assign(readings_.size(), 1.0);
    }

    double contrast() const {
        std::vector<double> seen;
        for (const Node& node : branch_.nodes)
            if (!node.is_lost) seen.push_back(node.contrast);
        if (seen.empty()) return 0.0;
        std::ranges::sort(seen);
        return seen[seen.size() / 2];
    }

    double at(const Parameters& p) const { return guess_.at + p[place] * guess_.reference; }

    double shape(const Parameters& p, double along) const {
        if (!narrows_) return 0.0;
        const double x = std::abs(2.0 * (along - at(p)) / (std::exp(p[width]) * guess_.reference));
        return std::exp(-std::numbers::ln2 * std::pow(x, std::exp(p[form])));
    }

    /// Brightness of the tube, per layer and distance.
    void fill(const Parameters& p) const {
        const double scale = std::exp(p[blur]), q = scale * blur_across_, qs = scale * blur_along_;
        const int finer = std::max(1, static_cast<int>(std::ceil(step_ / (0.5 * qs))));
        const double h = step_ / finer;
        const int margin = static_cast<int>(std::ceil(3.0 * qs / h));
        const std::size_t count =
            (layers_.size() - 1) * static_cast<std::size_t>(finer) + 1 + 2 * static_cast<std::size_t>(margin);
        bin_ = 0.25 * blur_across_;
        bins_ = static_cast<std::size_t>((2.2 * guess_.reference + 3.2 * blur_across_) / bin_) + 3;
        discs_.assign(count * bins_, 0.0);
        for (std::size_t n = 0; n < count; ++n) {
            const double s = layers_[0].along + (double(n) - margin) * h;
            const double even = std::exp(p[size]) * guess_.reference * (1.0 + p[slope] * (s - at(p)) / half_);
            const double r = std::max(0.0, even * (1.0 - p[depth] * shape(p, s)));
            for (std::size_t b = 0; b < bins_; ++b) discs_[n * bins_ + b] = blurred_disc(double(b) * bin_, r, q);
        }
        std::vector<double> kernel;
        double sum = 0.0;
        for (int k = -margin; k <= margin; ++k) {
            kernel.push_back(std::exp(-0.5 * k * k * h * h / (qs * qs)));
            sum += kernel.back();
        }
        table_.assign(layers_.size() * bins_, 0.0);
        for (std::size_t l = 0; l < layers_.size(); ++l)
            for (std::size_t k = 0; k < kernel.size(); ++k) {
                const double* disc = &discs_[(l * static_cast<std::size_t>(finer) + k) * bins_];
                for (std::size_t b = 0; b < bins_; ++b) table_[l * bins_ + b] += kernel[k] / sum * disc[b];
            }
    }

    /// Weighted, per standard deviation of the noise, at the best contrast and background; behind them those of what is expected.
    std::vector<double> residuals_of(const Parameters& p) const {
        fill(p);
        std::vector<double> profile(readings_.size());
        std::vector<double> matrix(9, 0.0), right(3, 0.0);
        for (std::size_t n = 0; n < readings_.size(); ++n) {
            const Reading& reading = readings_[n];
            const double s = layers_[reading.layer].along, aside = shape(p, s) * guess_.reference;
            const double d = std::hypot(reading.first - p[aside_1] * aside, reading.second - p[aside_2] * aside) / bin_;
            const std::size_t b = std::min(bins_ - 2, static_cast<std::size_t>(d));
            const double* row = &table_[reading.layer * bins_ + b];
            profile[n] = row[0] + (std::min(d, double(bins_ - 1)) - double(b)) * (row[1] - row[0]);
            const std::array<double, 3> terms{profile[n], 1.0, (s - guess_.at) / half_};
            const double w = reading.weight * trust_[n];
            for (std::size_t i = 0; i < 3; ++i) {
                right[i] += w * terms[i] * reading.value;
                for (std::size_t j = 0; j <= i; ++j) matrix[3 * i + j] += w * terms[i] * terms[j];
            }
        }
        std::vector<double> residuals(readings_.size() + priors, 0.0);
        if (!geometry::solve_positive(matrix, right)) return std::vector<double>(residuals.size(), 1e6);
        for (std::size_t n = 0; n < readings_.size(); ++n) {
            const double s = (layers_[readings_[n].layer].along - guess_.at) / half_;
            residuals[n] = std::sqrt(readings_[n].weight * trust_[n]) *
                           (readings_[n].value - right[0] * profile[n] - right[1] - right[2] * s) / sigma_;
        }
        double* prior = &residuals[readings_.size()];
        prior[0] = p[blur] / 0.1;
        if (narrows_) {
            prior[1] = (p[width] - std::log(1.4)) / 0.7;
            prior[2] = p[place] / 1.0;
            prior[3] = p[aside_1] / 0.5;
            prior[4] = p[aside_2] / 0.5;
            prior[5] = (p[form] - std::log(usual_steepness)) / 0.4;
        }
        return residuals;
    }

    /// Huber's weights: a neighbouring vessel counts little.
    void weigh(bool robust) {
        std::ranges::fill(trust_, 1.0);
        if (!robust) return;
        const std::vector<double> residuals = residuals_of(p_);
        for (std::size_t n = 0; n < readings_.size(); ++n) {
            const double off = std::abs(residuals[n]) / std::sqrt(readings_[n].weight);
            if (off > 2.5) trust_[n] = 2.5 / off;
        }
    }

    static double squared(const std::vector<double>& residuals) {
        double sum = 0.0;
        for (const double r : residuals) sum += r * r;
        return sum;
    }

    bool is_free(std::size_t parameter) const {
        return narrows_ || parameter == size || parameter == slope || parameter == blur;
    }

    void slopes(const std::vector<double>& residuals, std::vector<double>& jacobian) const {
        static constexpr Parameters steps{0.01, 0.02, 0.01, 0.05, 0.04, 0.03, 0.03, 0.02, 0.05};
        jacobian.assign(parameters * residuals.size(), 0.0);
        for (std::size_t i = 0; i < parameters; ++i) {
            if (!is_free(i)) continue;
            Parameters other = p_;
            const double step = i == depth && p_[depth] > 0.5 ? -steps[i] : steps[i];
            other[i] += step;
            const std::vector<double> moved = residuals_of(other);
            for (std::size_t n = 0; n < residuals.size(); ++n)
                jacobian[i * residuals.size() + n] = (moved[n] - residuals[n]) / step;
        }
    }

    static void normal(const std::vector<double>& jacobian, std::vector<double>& matrix) {
        const std::size_t count = jacobian.size() / parameters;
        for (std::size_t i = 0; i < parameters; ++i)
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = 0.0;
                for (std::size_t n = 0; n < count; ++n) sum += jacobian[i * count + n] * jacobian[j * count + n];
                matrix[i * parameters + j] = sum;
            }
    }

    void improve(int rounds) {
        std::vector<double> residuals = residuals_of(p_), jacobian;
        double cost = squared(residuals), damping = 1e-2;
        for (int round = 0; round < rounds; ++round) {
            slopes(residuals, jacobian);
            std::vector<double> matrix(parameters * parameters, 0.0), gradient(parameters, 0.0);
            normal(jacobian, matrix);
            for (std::size_t i = 0; i < parameters; ++i)
                for (std::size_t n = 0; n < residuals.size(); ++n)
                    gradient[i] -= jacobian[i * residuals.size() + n] * residuals[n];
            bool better = false, settled = false;
            for (int trial = 0; trial < 5 && !better; ++trial, damping *= 6.0) {
                std::vector<double> damped = matrix, step = gradient;
                for (std::size_t i = 0; i < parameters; ++i)
                    damped[i * parameters + i] += damping * matrix[i * parameters + i] + (is_free(i) ? 1e-9 : 1.0);
                if (!geometry::solve_positive(damped, step)) continue;
                Parameters next = p_;
                static constexpr Parameters most{0.15, 0.3, 0.25, 0.4, 0.4, 0.3, 0.3, 0.1, 0.3};
                for (std::size_t i = 0; i < parameters; ++i) next[i] += std::clamp(step[i], -most[i], most[i]);
                next[depth] = std::clamp(next[depth], 0.0, 1.0);
                next[width] = std::clamp(next[width], std::log(0.3), std::log(6.0));
                next[form] = std::clamp(next[form], std::log(1.2), std::log(8.0));
                next[slope] = std::clamp(next[slope], -0.8, 0.8);
                std::vector<double> tried = residuals_of(next);
                const double other = squared(tried);
                if (!(other < cost)) continue;
                better = true;
                settled = other > cost - 0.02;
                p_ = next, cost = other, residuals = std::move(tried);
                damping = std::max(1e-6, damping * 0.03);
            }
            if (!better || settled) break;
        }
    }

    static constexpr std::size_t priors = 6;
    static constexpr double usual_steepness = 2.5;
    NarrowingGuess guess_;
    const Branch& branch_;
    std::vector<Layer> layers_;
    std::vector<Reading> readings_;
    std::vector<double> trust_;
    double half_ = 0.0, step_ = 0.0, blur_along_ = 0.0, blur_across_ = 0.0, sigma_ = 0.0;
    bool narrows_ = false;
    Parameters p_{};
    mutable std::vector<double> discs_, table_;
    mutable double bin_ = 1.0;
    mutable std::size_t bins_ = 0;
};

}  // namespace

std::optional<Narrowing> fitted_narrowing(const Search& search, const Noise& noise, const Branch& branch,
                                          const NarrowingGuess& guess) {
    Fit fit(search, noise, branch, guess);
    if (!fit.is_ready()) return std::nullopt;
    const double even = fit.run(false), cost = fit.run(true);
    Narrowing found = fit.found();
    found.misfit = fit.misfit();
    found.depth_error = fit.depth_error() * std::sqrt(std::max(1.0, found.misfit));
    found.gain = even - cost;
    return found;
}

}  // namespace tactus::vessel
