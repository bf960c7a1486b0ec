// SPDX-License-Identifier: Apache-2.0
#include "dsp/training/motion.hpp"

#include "dsp/signal/filter/biquad.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::training {

namespace {

constexpr double min_stroke = 2e-3;  // m
constexpr double no_force = 1e-3;      // N
// A blade that grazes bone, or turns between two strokes, has no force for a few ticks; a force that was taken away stays
// away for as long as a device needs to fade and return.
constexpr double shortest_loss = 0.05;  // s
constexpr std::size_t max_track = 100'000'000;

double median_step(std::span<const AttemptSample> samples) {
    std::vector<double> steps;
    for (std::size_t n = 1; n < samples.size(); ++n) steps.push_back(samples[n].time - samples[n - 1].time);
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

/// One pass of a biquad over the values, beginning at rest at the first of them.
void filter(std::vector<Vec3>& values, const signal::BiquadCoefficients& c) {
    Vec3 x1 = values.front(), x2 = x1, y1 = x1, y2 = x1;
    for (Vec3& v : values) {
        const Vec3 y = c.b0 * v + c.b1 * x1 + c.b2 * x2 - c.a1 * y1 - c.a2 * y2;
        x2 = x1;
        x1 = v;
        y2 = y1;
        y1 = v = y;
    }
}

std::size_t index_of(const Track& track, double time) {
    const double n = std::round((time - track.begin) / track.step);
    return static_cast<std::size_t>(std::clamp(n, 0.0, static_cast<double>(track.position.size()) - 1.0));
}

}  // namespace

Track low_pass(std::span<const AttemptSample> samples, double cutoff) {
    Track track;
    if (samples.empty()) return track;
    track.begin = samples.front().time;
    track.step = samples.size() > 1 ? median_step(samples) : 1e-3;
    const double length = samples.back().time - track.begin;
    const std::size_t count = std::min(max_track, static_cast<std::size_t>(std::floor(length / track.step + 1e-6)) + 1);
    // Each pass of the filter needs some periods of its frequency to settle; the ends are repeated that long.
    const auto room = static_cast<std::size_t>(std::ceil(0.3 / track.step));
    std::vector<Vec3> values(count + 2 * room);
    std::size_t at = 0;
    for (std::size_t n = 0; n < count; ++n) {
        const double time = track.begin + static_cast<double>(n) * track.step;
        while (at + 2 < samples.size() && samples[at + 1].time <= time) ++at;
        const AttemptSample &a = samples[at], &b = samples[std::min(at + 1, samples.size() - 1)];
        const double span = b.time - a.time;
        const double share = span > 0.0 ? std::clamp((time - a.time) / span, 0.0, 1.0) : 0.0;
        values[room + n] = a.pose.position + share * (b.pose.position - a.pose.position);
    }
    std::fill_n(values.begin(), room, values[room]);
    std::fill_n(values.end() - static_cast<std::ptrdiff_t>(room), room, values[room + count - 1]);
    if (2.5 * cutoff * track.step < 1.0) {
        const signal::BiquadCoefficients c = signal::lowpass(cutoff, 1.0 / track.step);
        filter(values, c);
        std::ranges::reverse(values);
        filter(values, c);
        std::ranges::reverse(values);
    }
    track.position.assign(values.begin() + static_cast<std::ptrdiff_t>(room),
                          values.end() - static_cast<std::ptrdiff_t>(room));
    return track;
}

std::vector<std::size_t> reversals_of(const Track& track, std::size_t first, std::size_t last, const Vec3& axis,
                                      double least) {
    std::vector<std::size_t> found{first};
    const auto at = [&](std::size_t n) { return glm::dot(track.position[n], axis); };
    std::size_t high = first, low = first;
    int direction = 0;  // of the stroke that is under way
    for (std::size_t n = first; n <= last; ++n) {
        if (at(n) > at(high)) high = n;
        if (at(n) < at(low)) low = n;
        if (direction >= 0 && at(high) - at(n) >= least) {
            if (high != found.back()) found.push_back(high);
            direction = -1;
            low = n;
        } else if (direction <= 0 && at(n) - at(low) >= least) {
            if (low != found.back()) found.push_back(low);
            direction = 1;
            high = n;
        }
    }
    if (direction != 0) {
        // The last stroke ends where it got to.
        const std::size_t end = direction > 0 ? high : low;
        if (end > found.back()) found.push_back(end);
    }
    return found;
}

std::optional<double> log_dimensionless_jerk(const Track& track, std::size_t first, std::size_t last) {
    if (last <= first + 8 || last >= track.position.size()) return std::nullopt;
    const double h = track.step;
    const std::vector<Vec3>& x = track.position;
    double speed = 0.0, sum = 0.0;
    for (std::size_t n = first + 1; n + 1 <= last; ++n)
        speed = std::max(speed, glm::length(x[n + 1] - x[n - 1]) / (2.0 * h));
    for (std::size_t n = first; n <= last; ++n) {
        // Central third difference; the track goes on beyond a stroke's ends, except at its own.
        if (n < 2 || n + 2 >= x.size()) continue;
        const Vec3 jerk = (x[n + 2] - 2.0 * x[n + 1] + 2.0 * x[n - 1] - x[n - 2]) / (2.0 * h * h * h);
        sum += glm::dot(jerk, jerk) * h;
    }
    const double duration = static_cast<double>(last - first) * h;
    if (!(speed > 1e-4) || !(sum > 0.0)) return std::nullopt;
    return std::log(duration * duration * duration / (speed * speed) * sum);
}

MotionMeasures motion_of(std::span<const AttemptSample> samples, const PlannedCut& cut, double force_limit) {
    MotionMeasures m;
    double impulse = 0.0;
    double lost = 0.0;  // s: of the stretch of contact without force that goes on
    const auto end_stretch = [&m, &lost] {
        if (lost >= shortest_loss) m.without_force += lost;
        lost = 0.0;
    };
    bool touched = false;
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const double step = n + 1 < samples.size() ? samples[n + 1].time - samples[n].time
                            : n > 0                ? samples[n].time - samples[n - 1].time
                                                   : 0.0;
        const double force = glm::length(samples[n].force);
        m.max_force = std::max(m.max_force, force);
        m.over_limit += std::max(0.0, force - force_limit) * step;
        if (!samples[n].contact) continue;
        if (!touched) m.begin = samples[n].time;
        touched = true;
        m.end = samples[n].time;
        m.contact += step;
        if (force > no_force) end_stretch();
        else lost += step;
        impulse += force * step;
    }
    end_stretch();
    if (!touched) return m;
    if (m.contact > 0.0) m.mean_force = impulse / m.contact;
    const Track track = low_pass(samples);
    const std::size_t first = index_of(track, m.begin), last = index_of(track, m.end);
    for (std::size_t n = first; n < last; ++n) m.path += glm::length(track.position[n + 1] - track.position[n]);
    m.strokes = static_cast<int>(reversals_of(track, first, last, cut.stroke, min_stroke).size() / 2);
    // Half strokes from reversal to reversal, also where the touch begins or ends within one: a part of one would have
    // less jerk, and the first and the last, which may hold a rest, more.
    const std::vector<std::size_t> turns = reversals_of(track, 0, track.position.size() - 1, cut.stroke, min_stroke);
    double sum = 0.0, count = 0.0;
    for (std::size_t n = 1; n + 2 < turns.size(); ++n) {
        if (turns[n + 1] <= first || turns[n] >= last) continue;
        if (const auto jerk = log_dimensionless_jerk(track, turns[n], turns[n + 1])) {
            sum += *jerk;
            ++count;
        }
    }
    m.jerk = count > 0.0 ? std::optional(sum / count) : log_dimensionless_jerk(track, first, last);
    return m;
}

std::optional<Breakthrough> breakthrough_of(std::span<const AttemptSample> samples, const PlannedCut& cut,
                                            const BladeSize& blade, const Severance& bone) {
    if (samples.size() < 2) return std::nullopt;
    const auto depth = [&](const AttemptSample& s) {
        return edge_depth(cut, blade, s.pose, bone.low, bone.high) - bone.exit;
    };
    std::size_t through = samples.size(), deepest = 0;
    double most = 0.0;
    for (std::size_t n = 0; n < samples.size(); ++n) {
        const double beyond = depth(samples[n]);
        if (beyond > 0.0 && through == samples.size()) through = n;
        if (beyond > most) {
            most = beyond;
            deepest = n;
        }
    }
    if (through == samples.size()) return std::nullopt;
    const Track track = low_pass(samples, 50.0);
    // A tooth that passes slowly and later plunges counts with the plunge, too.
    const std::size_t from = index_of(track, samples[through].time), to = index_of(track, samples[deepest].time);
    Breakthrough found{most, 0.0};
    for (std::size_t n = from; n <= to && n + 1 < track.position.size(); ++n)
        found.speed = std::max(found.speed, glm::dot(track.position[n + 1] - track.position[n], cut.feed) / track.step);
    return found;
}

}  // namespace tactus::training
