// SPDX-License-Identifier: Apache-2.0
#include "dsp/simulate/trajectory.hpp"

#include "dsp/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::simulate {
namespace {

Quat orientation_of(const double* value) { return {value[3], value[4], value[5], value[6]}; }
Vec3 position_of(const double* value) { return {value[0], value[1], value[2]}; }

/// Peak speed over mean speed of a minimum-jerk motion.
constexpr double jerk_peak = 1.875;

}  // namespace

TrajectoryPlayer::TrajectoryPlayer(std::span<const TrajectorySample> samples, std::span<const std::size_t> breaks,
                                   const TrajectoryRules& rules) {
    if (samples.empty()) throw Error("a trajectory needs at least one sample");
    start_ = samples.front().pose;
    knots_.resize(samples.size());
    Quat before = samples.front().pose.orientation;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Quat q = glm::normalize(samples[i].pose.orientation);
        if (glm::dot(q, before) < 0.0) q = -q;  // q and -q are one rotation; the spline must not pass through zero
        before = q;
        const Vec3& p = samples[i].pose.position;
        knots_[i] = {{p.x, p.y, p.z, q.w, q.x, q.y, q.z}, {}};
    }
    const auto is_break = [&](std::size_t i) {
        return samples[i].time - samples[i - 1].time > rules.max_gap_s ||
               std::find(breaks.begin(), breaks.end(), i) != breaks.end();
    };
    double clock = 0.0;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= samples.size(); ++i) {
        const bool ends = i == samples.size() || is_break(i);
        if (ends) {
            fit(first, i - 1, samples);
            first = i;
        }
        if (i == samples.size()) break;
        const double step = samples[i].time - samples[i - 1].time;
        if (ends) {
            cross(i - 1, clock, step, rules);
        } else {
            spans_.push_back({clock, clock + step, i - 1, Piece::spline});
            clock += step;
        }
    }
    if (spans_.empty()) spans_.push_back({0.0, 0.0, 0, Piece::hold});
}

/// Second derivatives of the natural spline through knots first..last: tridiagonal system (Thomas algorithm).
void TrajectoryPlayer::fit(std::size_t first, std::size_t last, std::span<const TrajectorySample> samples) {
    if (last < first + 2) return;
    const auto step = [&](std::size_t i) { return samples[i + 1].time - samples[i].time; };
    std::vector<double> factor(last - first + 1, 0.0);
    for (std::size_t i = first + 1; i < last; ++i) {
        const double a = step(i - 1), b = step(i);
        const double pivot = 2.0 * (a + b) - a * factor[i - 1 - first];
        factor[i - first] = b / pivot;
        for (std::size_t c = 0; c < channels; ++c) {
            const double bend =
                (knots_[i + 1].value[c] - knots_[i].value[c]) / b - (knots_[i].value[c] - knots_[i - 1].value[c]) / a;
            knots_[i].second[c] = (6.0 * bend - a * knots_[i - 1].second[c]) / pivot;
        }
    }
    for (std::size_t i = last - 1; i > first; --i)
        for (std::size_t c = 0; c < channels; ++c) knots_[i].second[c] -= factor[i - first] * knots_[i + 1].second[c];
}

/// The pieces between two segments: hold at `knot`, then ease to the next one.
void TrajectoryPlayer::cross(std::size_t knot, double& clock, double recorded, const TrajectoryRules& rules) {
    const double translation = glm::distance(position_of(knots_[knot].value), position_of(knots_[knot + 1].value));
    const double rotation =
        glm::length(rotation_between(orientation_of(knots_[knot].value), orientation_of(knots_[knot + 1].value)));
    const double ease = jerk_peak * std::max(translation / rules.max_speed, rotation / rules.max_angular_speed);
    const double hold = std::max(recorded - ease, 0.0);
    if (hold > 0.0) spans_.push_back({clock, clock + hold, knot, Piece::hold});
    clock += hold;
    if (ease > 0.0) spans_.push_back({clock, clock + ease, knot, Piece::ease});
    clock += ease;
    ++gaps_;
}

Intention TrajectoryPlayer::on(const Piece& piece, double time) const noexcept {
    const Knot& from = knots_[piece.knot];
    if (piece.kind == Piece::hold) return {{position_of(from.value), orientation_of(from.value)}, {}};
    const Knot& to = knots_[piece.knot + 1];
    const double span = piece.end - piece.begin, u = std::clamp((time - piece.begin) / span, 0.0, 1.0);
    if (piece.kind == Piece::ease) {
        const double s = u * u * u * (10.0 + u * (6.0 * u - 15.0));
        const double rate = 30.0 * u * u * (1.0 - u) * (1.0 - u) / span;
        const Vec3 translation = position_of(to.value) - position_of(from.value);
        const Vec3 rotation = rotation_between(orientation_of(from.value), orientation_of(to.value));
        return {{position_of(from.value) + translation * s, rotation_by(rotation * s) * orientation_of(from.value)},
                {translation * rate, rotation * rate}};
    }
    double value[channels], speed[channels];
    const double w = 1.0 - u, h6 = span / 6.0;
    for (std::size_t c = 0; c < channels; ++c) {
        const double bend = (w * w * w - w) * from.second[c] + (u * u * u - u) * to.second[c];
        value[c] = w * from.value[c] + u * to.value[c] + bend * span * h6;
        const double bend_slope = (1.0 - 3.0 * w * w) * from.second[c] + (3.0 * u * u - 1.0) * to.second[c];
        speed[c] = (to.value[c] - from.value[c]) / span + bend_slope * h6;
    }
    // ω = 2 q̇ q⁻¹ for any length of q without the part along q, which only affects the scalar part.
    const Quat q = orientation_of(value), rate = orientation_of(speed) * glm::inverse(q);
    return {{position_of(value), glm::normalize(q)}, {position_of(speed), 2.0 * Vec3(rate.x, rate.y, rate.z)}};
}

TrajectoryState TrajectoryPlayer::at(double time, std::size_t& hint) const noexcept {
    if (spans_.empty()) return {{}, false, true};
    hint = std::min(hint, spans_.size() - 1);
    while (hint > 0 && time < spans_[hint].begin) --hint;
    while (hint + 1 < spans_.size() && time >= spans_[hint].end) ++hint;
    const Piece& piece = spans_[hint];
    TrajectoryState state{on(piece, time), piece.kind != Piece::spline, time >= duration()};
    if (time < 0.0 || state.done) state.intention.twist = {};
    if (state.done) state.gap = false;
    return state;
}

}  // namespace tactus::simulate
