// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/fidelity.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::control {

namespace {

constexpr double tau = 2.0 * std::numbers::pi;

/// Amplitude and phase at `rate` of the included samples, by least squares with a constant: x ≈ c + Re(p e^jωt).
/// Without gaps and over whole cycles this equals the discrete Fourier sum.
std::complex<double> phasor(std::span<const double> x, double rate, double period,
                            std::span<const std::uint8_t> left_out) {
    double a[3][4] = {};
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (!left_out.empty() && left_out[i]) continue;
        const double angle = tau * rate * period * static_cast<double>(i);
        const double basis[4] = {1.0, std::cos(angle), std::sin(angle), x[i]};
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 4; ++c) a[r][c] += basis[r] * basis[c];
    }
    for (int p = 0; p < 3; ++p) {
        int best = p;
        for (int r = p + 1; r < 3; ++r)
            if (std::abs(a[r][p]) > std::abs(a[best][p])) best = r;
        std::swap(a[p], a[best]);
        if (!(std::abs(a[p][p]) > 0.0)) return 0.0;
        for (int r = 0; r < 3; ++r) {
            if (r == p) continue;
            const double f = a[r][p] / a[p][p];
            for (int c = p; c < 4; ++c) a[r][c] -= f * a[p][c];
        }
    }
    return {a[1][3] / a[1][1], -a[2][3] / a[2][2]};
}

double share_of(std::span<const std::uint8_t> flags) {
    if (flags.empty()) return 0.0;
    return static_cast<double>(std::ranges::count_if(flags, [](std::uint8_t f) { return f != 0; })) /
           static_cast<double>(flags.size());
}

/// rms of the residual without the mean and the first harmonics of the rate.
double beside_harmonics(std::vector<double> x, double rate, double period) {
    double mean = 0.0;
    for (const double v : x) mean += v;
    mean /= static_cast<double>(x.size());
    for (double& v : x) v -= mean;
    for (int order = 1; order <= 15 && order * rate * period < 0.45; ++order) {
        const std::complex<double> p = phasor(x, order * rate, period, {});
        for (std::size_t i = 0; i < x.size(); ++i)
            x[i] -= (p * std::polar(1.0, tau * order * rate * period * static_cast<double>(i))).real();
    }
    double square = 0.0;
    for (const double v : x) square += v * v;
    return std::sqrt(square / static_cast<double>(x.size()));
}

/// Massless, two-sided, under a force that is linear from `f0` to `f1`: exact.
double ramped_step(double x, double f0, double f1, double k, double b, double dt) {
    if (k <= 0.0) return x + 0.5 * (f0 + f1) * dt / b;
    const double lag = b / k, decay = b > 0.0 ? std::exp(-dt / lag) : 0.0, creep = (f1 - f0) / dt * lag;
    return (f1 - creep) / k + decay * (x - (f0 - creep) / k);
}

RigSeries last_cycles(const RigSeries& s, double rate, double settle, double& cycles) {
    const double samples = 1.0 / (rate * s.period);
    const double usable = static_cast<double>(s.force.size()) - std::ceil(settle / s.period);
    cycles = std::floor(usable / samples + 1e-9);
    if (cycles < 2.0)
        throw Error(fmt::format("at {:.4g} Hz two whole cycles after {:.3g} s are needed; {:.3g} s were recorded", rate,
                                settle, static_cast<double>(s.force.size()) * s.period));
    const auto count = static_cast<std::size_t>(std::lround(cycles * samples));
    const auto tail = [count](const auto& all) {
        return std::decay_t<decltype(all)>(all.end() - static_cast<std::ptrdiff_t>(std::min(count, all.size())),
                                           all.end());
    };
    return {s.period, tail(s.force), tail(s.position), tail(s.slips), tail(s.saturated)};
}

}  // namespace

std::complex<double> ideal_admittance(const ObjectSettings& o, double rate) noexcept {
    if (o.kind == ObjectKind::wall) return 0.0;
    const double w = tau * rate;
    return 1.0 / std::complex<double>(o.stiffness - w * w * o.mass, w * o.damping);
}

std::vector<double> ideal_response(const RigSeries& s, const ObjectSettings& o) {
    std::vector<double> x{s.position.front()};
    const bool linear = o.kind == ObjectKind::elastic && !o.one_sided && !(o.mass > 0.0);
    if (linear && !(o.damping > 0.0)) x.front() = o.rest + s.force.front() / o.stiffness;
    VirtualObject object;
    object.set(o, s.period);
    object.place(x.front());
    for (std::size_t i = 1; i < s.force.size(); ++i) {
        const double f0 = s.force[i - 1], f1 = s.force[i];
        x.push_back(linear ? o.rest + ramped_step(x.back() - o.rest, f0, f1, o.stiffness, o.damping, s.period)
                           : object.step(0.5 * (f0 + f1)));
    }
    return x;
}

Fidelity judge_fidelity(const RigSeries& all, const ObjectSettings& object, double rate, double settle) {
    for (std::size_t i = 0; i < all.force.size(); ++i)
        if (!std::isfinite(all.force[i]) || !std::isfinite(all.position[i]))
            throw Error(fmt::format("sample {} is not a finite number", i + 1));
    Fidelity f;
    // The object's initial state has decayed long before the cycles that are evaluated.
    const std::vector<double> response = ideal_response(all, object);
    const RigSeries s = last_cycles(all, rate, settle, f.cycles);
    std::vector<double> ideal(response.end() - static_cast<std::ptrdiff_t>(s.force.size()), response.end());
    f.slip_share = share_of(s.slips);
    f.saturated_share = share_of(s.saturated);
    f.force = phasor(s.force, rate, s.period, s.slips);
    f.position = phasor(s.position, rate, s.period, s.slips);
    f.speed_peak = std::abs(f.position) * tau * rate;
    f.limit_cycle_rms = beside_harmonics(s.position, rate, s.period);
    const std::complex<double> impedance = f.force / f.position;
    f.rendered_stiffness = impedance.real();
    f.rendered_damping = impedance.imag() / (tau * rate);
    const auto kept = [&](std::size_t i) { return s.slips.empty() || !s.slips[i]; };
    // A pure damper has no rest position: its initial position does not matter.
    double drift = 0.0, count = 0.0;
    for (std::size_t i = 0; i < ideal.size(); ++i)
        if (kept(i)) {
            drift += s.position[i] - ideal[i];
            count += 1.0;
        }
    const bool holds_place = object.kind != ObjectKind::elastic || object.stiffness > 0.0;
    drift = holds_place || count == 0.0 ? 0.0 : drift / count;
    double error = 0.0, signal = 0.0;
    for (std::size_t i = 0; i < ideal.size(); ++i) {
        if (object.kind == ObjectKind::wall && (!object.one_sided || s.force[i] > 0.0))
            f.penetration = std::max(
                f.penetration, object.one_sided ? s.position[i] - object.rest : std::abs(s.position[i] - object.rest));
        if (!kept(i)) continue;
        const double off = s.position[i] - ideal[i] - drift;
        error += off * off;
        signal += (ideal[i] - object.rest) * (ideal[i] - object.rest);
    }
    f.position_rms_error = count > 0.0 ? std::sqrt(error / count) : 0.0;
    if (object.kind == ObjectKind::wall || count == 0.0 || !(signal > 0.0)) return f;
    f.nrmse = std::sqrt(error / signal);
    if (object.kind != ObjectKind::elastic || object.one_sided) return f;
    const std::complex<double> ratio = f.position / f.force / ideal_admittance(object, rate);
    f.gain_error_db = 20.0 * std::log10(std::abs(ratio));
    f.phase_error_deg = std::arg(ratio) * 180.0 / std::numbers::pi;
    return f;
}

}  // namespace tactus::control
