// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/touched.hpp"

#include "dsp/core/error.hpp"
#include "dsp/geometry/symmetric_eigen.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tactus::display {

namespace {

// Spread that counts as zero, relative to the largest: touches are accurate to about a millimetre in some centimetres.
constexpr double thin = 0.02;

/// Principal component analysis: root mean square spread along the three axes, largest first, and the axes.
struct Spread {
    Vec3 mean{0.0};
    std::array<double, 3> along{};
    std::array<Vec3, 3> axis{};

    template <class Points, class Of>
    Spread(const Points& points, const Of& of) {
        for (const auto& point : points) mean += of(point);
        mean /= static_cast<double>(points.size());
        std::array<double, 9> m{};
        for (const auto& point : points) {
            const Vec3 d = of(point) - mean;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) m[static_cast<std::size_t>(3 * i + j)] += d[i] * d[j];
        }
        const geometry::SymmetricEigen<3> eigen = geometry::symmetric_eigen<3>(m);
        for (std::size_t n = 0; n < 3; ++n) {
            const auto& v = eigen.vector[2 - n];
            along[n] = std::sqrt(std::max(eigen.value[2 - n], 0.0) / static_cast<double>(points.size()));
            axis[n] = Vec3(v[0], v[1], v[2]);
        }
    }
};

template <class Points, class Of>
void check(const Points& touches, std::size_t least, std::string_view what, const Of& of) {
    if (touches.size() < least)
        throw Error(fmt::format("{} needs at least {} touches, not {}", what, least, touches.size()));
    for (std::size_t i = 0; i < touches.size(); ++i)
        if (!is_finite(of(touches[i]))) throw Error(fmt::format("{}: touch {} is not a number", what, i + 1));
}

void check_line(const Spread& spread, std::string_view what) {
    if (!(spread.along[0] > 1e-3))
        throw Error(fmt::format("{}: the touches all lie at one place; spread them out", what));
    if (!(spread.along[1] > thin * spread.along[0]))
        throw Error(fmt::format("{}: the touches lie on a line; touch places to its sides as well", what));
}

template <class Points, class Off>
TouchResidual residual_of(const Points& touches, const Off& off) {
    TouchResidual residual;
    double sum = 0.0;
    for (std::size_t i = 0; i < touches.size(); ++i) {
        const double apart = off(touches[i]);
        sum += apart * apart;
        if (apart > residual.worst) residual = {0.0, apart, i};
    }
    residual.rms = std::sqrt(sum / static_cast<double>(touches.size()));
    return residual;
}

/// Solves for the 4 × 3 map of (u, 1) by its normal equations, about the mean.
Mat3 linear_fit(std::span<const TouchPair> touches, const Vec3& from_mean, const Vec3& to_mean) {
    Mat3 uu(0.0), wu(0.0);
    for (const TouchPair& touch : touches) {
        const Vec3 u = touch.from - from_mean, w = touch.to - to_mean;
        uu += glm::outerProduct(u, u);
        wu += glm::outerProduct(w, u);
    }
    return wu * glm::inverse(uu);
}

}  // namespace

RigidFit fit_rigid(std::span<const TouchPair> touches) {
    constexpr std::string_view what = "the placement of a workspace";
    const auto from = [](const TouchPair& t) { return t.from; };
    const auto to = [](const TouchPair& t) { return t.to; };
    check(touches, 3, what, from);
    check(touches, 3, what, to);
    const Spread a(touches, from), b(touches, to);
    check_line(a, what);
    check_line(b, what);
    Mat3 s(0.0);  // s[column][row]: sum of from[column] · to[row]
    for (const TouchPair& touch : touches) s += glm::outerProduct(touch.to - b.mean, touch.from - a.mean);
    const auto c = [&s](int x, int y) { return s[x][y]; };
    std::array<double, 16> n{};
    const double symmetric[4][4] = {
        {c(0, 0) + c(1, 1) + c(2, 2), c(1, 2) - c(2, 1), c(2, 0) - c(0, 2), c(0, 1) - c(1, 0)},
        {c(1, 2) - c(2, 1), c(0, 0) - c(1, 1) - c(2, 2), c(0, 1) + c(1, 0), c(2, 0) + c(0, 2)},
        {c(2, 0) - c(0, 2), c(0, 1) + c(1, 0), c(1, 1) - c(0, 0) - c(2, 2), c(1, 2) + c(2, 1)},
        {c(0, 1) - c(1, 0), c(2, 0) + c(0, 2), c(1, 2) + c(2, 1), c(2, 2) - c(0, 0) - c(1, 1)}};
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) n[4 * i + j] = symmetric[i][j];
    const auto best = geometry::symmetric_eigen<4>(n).vector[3];
    RigidFit fit;
    fit.pose.orientation = glm::normalize(Quat(best[0], best[1], best[2], best[3]));
    fit.pose.position = b.mean - fit.pose.rotate(a.mean);
    fit.residual = residual_of(touches, [&](const TouchPair& t) { return glm::length(fit.pose.apply(t.from) - t.to); });
    return fit;
}

AffineFit fit_affine(std::span<const TouchPair> touches) {
    constexpr std::string_view what = "the affine placement of a workspace";
    const auto from = [](const TouchPair& t) { return t.from; };
    check(touches, 4, what, from);
    check(touches, 4, what, [](const TouchPair& t) { return t.to; });
    const Spread a(touches, from), b(touches, [](const TouchPair& t) { return t.to; });
    check_line(a, what);
    if (!(a.along[2] > thin * a.along[0]))
        throw Error(fmt::format("{}: the touches lie in a plane; touch places above and below it as well", what));
    AffineFit fit;
    fit.linear = linear_fit(touches, a.mean, b.mean);
    fit.shift = b.mean - fit.linear * a.mean;
    fit.residual = residual_of(touches, [&](const TouchPair& t) { return glm::length(fit.apply(t.from) - t.to); });
    return fit;
}

PlaneFit fit_plane(std::span<const Vec3> touches, const Vec3& towards) {
    constexpr std::string_view what = "a plane";
    const auto same = [](const Vec3& p) { return p; };
    check(touches, 3, what, same);
    const Spread spread(touches, same);
    check_line(spread, what);
    if (!(spread.along[2] < 0.5 * spread.along[1]))
        throw Error(fmt::format("{}: the touches do not lie in a plane", what));
    PlaneFit fit{{spread.mean, glm::normalize(spread.axis[2])}, {}};
    if (fit.plane.height(towards) < 0.0) fit.plane.normal = -fit.plane.normal;
    fit.residual = residual_of(touches, [&](const Vec3& p) { return std::abs(fit.plane.height(p)); });
    return fit;
}

ScreenFit fit_screen(std::span<const ScreenTouch> touches) {
    constexpr std::string_view what = "a screen";
    const auto shown = [](const ScreenTouch& t) { return Vec3(t.shown, 0.0); };
    const auto touched = [](const ScreenTouch& t) { return t.touched; };
    check(touches, 3, what, shown);
    check(touches, 3, what, touched);
    const Spread a(touches, shown), b(touches, touched);
    check_line(a, what);
    check_line(b, what);
    std::vector<TouchPair> pairs;
    for (const ScreenTouch& touch : touches) pairs.push_back({shown(touch), touch.touched});
    // The third axis is undetermined: two auxiliary touches, whose result is not used, make the system solvable.
    for (const double side : {-1.0, 1.0}) pairs.push_back({a.mean + Vec3(0.0, 0.0, side), b.mean});
    const Mat3 axes = linear_fit(pairs, a.mean, b.mean);
    const double width = glm::length(axes[0]), height = glm::length(axes[1]);
    ScreenFit fit;
    fit.skew_rad = std::asin(std::clamp(glm::dot(axes[0], axes[1]) / (width * height), -1.0, 1.0));
    if (!(std::abs(fit.skew_rad) < 0.0524))
        throw Error(fmt::format("{}: the touches are skewed by {:.1f} deg; was a mark mistaken for another?", what,
                                fit.skew_rad * 57.29578));
    // Orthogonalises both axes symmetrically.
    const Vec3 sum = glm::normalize(axes[0] / width + axes[1] / height),
               difference = glm::normalize(axes[0] / width - axes[1] / height);
    const double half = std::sqrt(0.5);
    const Vec3 right = width * half * (sum + difference), up = height * half * (sum - difference);
    const Vec3 low_left = b.mean - right * a.mean.x - up * a.mean.y;
    fit.screen = {low_left, low_left + right, low_left + up};
    fit.residual = residual_of(touches, [&](const ScreenTouch& t) {
        return glm::length(low_left + right * t.shown.x + up * t.shown.y - t.touched);
    });
    return fit;
}

}  // namespace tactus::display
