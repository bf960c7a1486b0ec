// SPDX-License-Identifier: Apache-2.0
#include "assets/library/saw_recordings.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/signal/filter/biquad.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::library {

namespace {

constexpr int sample_rate = 48000;                  // Hz
constexpr std::size_t count = 2 * sample_rate;      // a whole number of cycles for every rate used
constexpr double full_scale = 1000.0;               // m/s², more than five times the rms of the loudest sound
constexpr double greatest_rate = 233.0;             // Hz
constexpr double stroke = 3.0e-3;                   // m
constexpr double tooth_pitch = 25.4e-3 / 18.0;      // m
constexpr double free_air_level = 90.5;  // m/s² rms at the greatest rate: the published minimum of air-driven saws
constexpr double cutting_level = 182.0;  // the published maximum, used at the greatest load
constexpr double greatest_load = 12.0;  // N
constexpr std::array<double, 3> rates{150.0, 190.0, greatest_rate};
constexpr std::array<double, 3> loads{3.0, 7.0, greatest_load};

// Orders of the drive: the stroke (first), the obliquity of a connecting rod ten strokes long (second), and the play of
// the guides, which decreases towards higher orders.
constexpr std::array<double, 10> order_levels{1.0, 0.32, 0.22, 0.16, 0.10, 0.08, 0.05, 0.04, 0.025, 0.02};

// Shares of the power added by cutting.
constexpr double chip_share = 0.6, tooth_share = 0.3, friction_share = 0.1;

using Signal = std::vector<double>;

double angle(std::size_t i, double rate) {
    return 2.0 * std::numbers::pi * std::fmod(rate * static_cast<double>(i) / sample_rate, 1.0);
}

/// Adds `part` without its mean, scaled to the given rms.
void add(Signal& sum, const Signal& part, double rms) {
    double mean = 0.0, power = 0.0;
    for (double x : part) mean += x / static_cast<double>(count);
    for (double x : part) power += (x - mean) * (x - mean) / static_cast<double>(count);
    const double gain = rms / std::sqrt(power);
    for (std::size_t i = 0; i < count; ++i) sum[i] += gain * (part[i] - mean);
}

Signal drive(double rate, const Random& random) {
    Signal out(count);
    for (std::size_t k = 0; k < order_levels.size(); ++k) {
        // The first order is the stroke itself; the blade is at its end position at angle 0.
        const double phase = k == 0 ? 0.0 : 2.0 * std::numbers::pi * random.uniform(k);
        for (std::size_t i = 0; i < count; ++i)
            out[i] += order_levels[k] * std::cos(static_cast<double>(k + 1) * angle(i, rate) + phase);
    }
    return out;
}

/// Chips break at random, at a rate proportional to the blade's speed: noise from 300 to 1500 Hz, modulated twice per
/// cycle.
Signal chips(double rate, const Random& random) {
    Signal noise(count), out(count);
    for (std::size_t i = 0; i < count; ++i) noise[i] = random.normal(i + 100);
    signal::Biquad above{signal::highpass(300.0, sample_rate)}, below{signal::lowpass(1500.0, sample_rate)};
    // The first period lets the filter settle, the second is kept, so that the loop is seamless.
    for (int round = 0; round < 2; ++round)
        for (std::size_t i = 0; i < count; ++i) out[i] = below(above(noise[i] * std::abs(std::sin(angle(i, rate)))));
    return out;
}

/// Tooth passing: a tone whose frequency follows the blade's speed, up to 1.56 kHz.
Signal teeth(double rate) {
    Signal out(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double a = angle(i, rate), place = 0.5 * stroke * std::cos(a);
        out[i] = std::abs(std::sin(a)) * std::sin(2.0 * std::numbers::pi * place / tooth_pitch + 0.7);
    }
    return out;
}

/// Coulomb friction against the motion, with a smooth reversal below a tenth of the greatest speed.
Signal friction(double rate) {
    Signal out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = std::tanh(10.0 * std::sin(angle(i, rate)));
    return out;
}

/// Acceleration of the handle along the blade, in shares of full scale.
std::vector<float> synthesise(double rate, double load, std::uint64_t seed) {
    const Random random{seed};
    const double speed = rate / greatest_rate;
    // The stroke is constant, so the acceleration is proportional to the square of the rate.
    const double blade = free_air_level * speed * speed;
    const double cut =
        std::sqrt(cutting_level * cutting_level - free_air_level * free_air_level) * (load / greatest_load) * speed;
    Signal parts(count), sum(count);
    add(parts, drive(rate, random), blade);
    if (load > 0.0) {
        add(parts, chips(rate, random), cut * std::sqrt(chip_share));
        add(parts, teeth(rate), cut * std::sqrt(tooth_share));
        add(parts, friction(rate), cut * std::sqrt(friction_share));
    }
    // The parts are correlated, so the level is measured on their sum.
    add(sum, parts, std::hypot(blade, cut));
    std::vector<float> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<float>(sum[i] / full_scale);
    return out;
}

constexpr std::string_view heading =
    "# A reciprocating bone saw: no recordings, but sounds computed from published facts.\n"
    "title = \"Reciprocating saw, synthesised\"\n"
    "note = \"computed from: 233 Hz greatest rate, stroke 3.0 mm, 18 teeth per inch, 90.5 to 182 m/s2 at the handle; "
    "levels between and spectra are assumed\"\n"
    "licence = \"Apache-2.0\"\n"
    "synthesised = true\n"
    "sensor = \"none: acceleration of the handle along the blade\"\n";

}  // namespace

void make_saw_recordings(const std::filesystem::path& folder) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot be made: {}", folder.string(), failure.message()));
    std::string set = fmt::format("{}full_scale = \"{:g} m/s^2\"\n", heading, full_scale);
    std::uint64_t seed = 0;
    const auto record = [&](double rate, double load) {
        const std::string state = load > 0.0 ? "cutting" : "free_air";
        const std::string file = load > 0.0 ? fmt::format("{}_{:g}_{:g}N.flac", state, rate, load)
                                            : fmt::format("{}_{:g}.flac", state, rate);
        sound::SoundWriter writer(folder / file, 1, sample_rate, sound::SoundFormat::flac);
        writer.write(synthesise(rate, load, seed++).data(), count);
        writer.finish();
        set += fmt::format("\n[[recording]]\nfile = \"{}\"\nstate = \"{}\"\nrate = \"{:g} Hz\"\n", file, state, rate);
        if (load > 0.0) set += fmt::format("load = \"{:g} N\"\n", load);
    };
    for (const double rate : rates) {
        record(rate, 0.0);
        for (const double load : loads) record(rate, load);
    }
    // Written last: a set that exists is complete.
    file::write_whole_file(folder / "reciprocating.toml", set);
}

}  // namespace tactus::library
