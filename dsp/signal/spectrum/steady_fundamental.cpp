// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/steady_fundamental.hpp"

#include "dsp/signal/spectrum/harmonic_fit.hpp"
#include "dsp/signal/spectrum/mains.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <numeric>

namespace tactus::signal {

namespace {

constexpr double needed_rate = 22000.0;  // Hz, at least, after decimation: orders are sought up to 0.36 of it
constexpr std::size_t longest_segment = 1 << 18;  // decimated samples
constexpr std::size_t max_kept = 1 << 19;
constexpr std::size_t max_levels = 6;
constexpr double shortest_segment = 0.04;  // s
constexpr std::size_t max_tested = 40;    // lines
constexpr std::size_t seed_lines = 12;  // lines of which candidate rates are fractions
constexpr int max_divisions = 24;
constexpr double bins_between = 5.0;  // neighbouring orders, at least: a line of a Hann window is four bins wide

constexpr std::size_t floor_block = 32;  // bins
constexpr double explains_all = 0.9;  // fraction of the power
// Power relative to the strongest line of a comb from which another order counts: weaker ones may be chance.
constexpr double min_order_power = 5e-4;
// Lines beside a comb that show a fraction of its rate: log-likelihood ratio to noise and relative power at least, and
// the probability at most that they are near a fraction by chance, which is less for weak ones: there are more of them.
constexpr double min_fraction_weight = 12.0, min_weak_power = 3e-4, min_fraction_power = 0.01;
constexpr double max_fraction_chance = 0.25, max_weak_chance = 0.03;
// Persistence of a line is measured in eighths of the record, over which the strokes of a saw average out. So does a
// ring between strikes, which has the lines of a tone: combs of few strong lines must also be steady over pieces of few
// periods, in which orders stay separate. Rings at 10 strikes per second with a quality of 10 have less than 0.95.
constexpr std::size_t eighths = 8, few_lines = 2;
constexpr double periods_per_piece = 8.0;
constexpr double min_persistence = 0.5, min_persistence_of_few = 0.95;
constexpr int max_fraction = 12;
// Courses of lines: half a band for each, in bins of the spectrum in which it is a narrow line.
constexpr double course_bins = 4.0, min_steadiness = 0.85, min_steadiness_of_one = 0.97;
constexpr std::size_t followed_lines = 2, max_courses = 3;

struct NarrowLine {
    double frequency, deviation;  // Hz
    double power, floor;  // per bin
    double weight;  // log-likelihood ratio, line to noise
    bool is_hum, is_shared_hum;  // an order of the mains; of one that has other lines too
};

struct NarrowLines {
    std::vector<NarrowLine> found;  // heaviest first
    std::vector<MainsComb> mains;
    double df = 0.0, all = 0.0;  // `all`: power above the noise, narrow or not
    double hum = 0.0;  // power of lines at orders of the mains
    double threshold = 0.0;  // power over the noise
    double segments = 1.0;
    std::vector<double> floors;  // noise per block of bins
};

bool is_order_of(std::span<const MainsComb> mains, double frequency, double deviation) {
    return std::ranges::any_of(mains, [&](const MainsComb& one) { return one.order_of(frequency, deviation) > 0; });
}

/// What may be hum among lines, by frequency: of each nominal frequency the comb of most lines and, beside a machine at
/// such a rate, that of the others.
std::vector<MainsComb> mains_among(const std::vector<MainsLine>& lines) {
    std::vector<MainsComb> found;
    for (const int nominal : mains_frequencies) {
        const std::optional<MainsComb> most = fit_mains(lines, nominal);
        if (!most) continue;
        found.push_back(*most);
        std::vector<MainsLine> others = lines;
        std::erase_if(others, [&](const MainsLine& l) { return most->order_of(l.frequency, l.deviation) > 0; });
        if (const std::optional<MainsComb> second = fit_mains(others, nominal)) found.push_back(*second);
    }
    return found;
}

/// Whether a rate may be that of hum. `beside`: what may be hum among the lines that are no orders of the rate.
///
/// The orders of a comb that begins as a family of hum cannot distinguish it from hum. Other lines show that it is a
/// machine's if they are hum of a mains that is nearer to its nominal frequency, and measurably not that of the rate:
/// a record has one mains. A comb at another order of the mains is distinguished from hum by the absence of the first orders, or
/// by their frequency.
bool is_rate_of_hum(double rate, double deviation, std::span<const MainsComb> beside) {
    if (is_order_of(beside, rate, deviation)) return true;
    return std::ranges::any_of(mains_frequencies, [&](int nominal) {
        const int order = mains_order(rate, nominal, 3.0 * deviation);
        return order > 0 && is_hum_family(order) && std::ranges::none_of(beside, [&](const MainsComb& hum) {
                   return hum.nominal == nominal &&
                          std::abs(hum.frequency - nominal) < std::abs(rate / order - nominal);
               });
    });
}

/// Quantile of the mean of K exponential powers (Wilson and Hilferty 1931) at `z` standard deviations.
double power_quantile(double segments, double z) {
    const double part = 1.0 / (9.0 * std::max(1.0, segments));
    return std::pow(std::max(0.05, 1.0 - part + z * std::sqrt(part)), 3.0);
}

/// Greatest power of a Hann window `bins` away from a line, relative to the line.
double side_lobe(double bins) {
    const double d = std::abs(bins);
    const double amplitude = 1.0 / (std::numbers::pi * d * (d * d - 1.0));
    return amplitude * amplitude;
}

NarrowLines lines_of(const Spectrum& spectrum, double top, bool is_sharp) {
    NarrowLines out;
    const std::vector<double>& p = spectrum.power;
    out.df = spectrum.df;
    out.segments = std::max(1.0, spectrum.effective_segments);
    if (p.size() < 16) return out;
    out.threshold = power_quantile(out.segments, 4.9);
    const double low = power_quantile(out.segments, -0.52);
    const auto last = static_cast<std::size_t>(std::min(top / spectrum.df, static_cast<double>(p.size()) - 4.0));
    // Noise level: the 30 % quantile of each block of 32 bins and its two neighbours.
    constexpr std::size_t block = floor_block;
    std::vector<double>& floors = out.floors;
    floors.resize(last / block + 1);
    std::vector<double> near;
    for (std::size_t i = 0; i < floors.size(); ++i) {
        const std::size_t from = std::max<std::size_t>(2, i * block > block ? (i - 1) * block : 2),
                          to = std::min(p.size() - 2, (i + 2) * block);
        near.assign(p.begin() + static_cast<std::ptrdiff_t>(from),
                    p.begin() + static_cast<std::ptrdiff_t>(std::max(to, from + 1)));
        const auto quantile = near.begin() + static_cast<std::ptrdiff_t>(near.size() * 3 / 10);
        std::nth_element(near.begin(), quantile, near.end());
        floors[i] = std::max(*quantile / low, 1e-300);
    }
    double greatest = 0.0;
    for (std::size_t k = 2; k <= last; ++k) {
        const double floor = floors[std::min(k / block, floors.size() - 1)];
        if (p[k] > out.threshold * floor) out.all += p[k] - floor;
        greatest = std::max(greatest, p[k]);
    }
    for (std::size_t k = 2; k <= last; ++k) {
        const double floor = floors[k / block];
        if (!(p[k] > p[k - 1] && p[k] >= p[k + 1]) || p[k] < out.threshold * floor || p[k] < 1e-9 * greatest) continue;
        double beside = 0.0;
        bool is_lobe = false;
        for (std::size_t d = 3; d <= 64; ++d) {
            const double left = k > d + 1 ? p[k - d] : 0.0, right = k + d < p.size() ? p[k + d] : 0.0;
            if (d <= 4) beside = std::max({beside, left, right});
            is_lobe |= p[k] < 6.0 * side_lobe(static_cast<double>(d) - 0.5) * std::max(left, right);
        }
        if (is_lobe || beside > 0.3 * p[k]) continue;
        const bool above = p[k + 1] > p[k - 1];
        const double ratio = std::sqrt((above ? p[k + 1] : p[k - 1]) / p[k]);
        const double shift = std::clamp((2.0 * ratio - 1.0) / (ratio + 1.0), 0.0, 0.5);
        const double snr = p[k] / floor;
        NarrowLine line{};
        line.frequency = (static_cast<double>(k) + (above ? shift : -shift)) * spectrum.df;
        line.deviation = spectrum.df * ((is_sharp ? 0.01 : 0.1) + 0.6 / std::sqrt(snr * out.segments));
        line.power = p[k] - floor;
        line.floor = floor;
        line.weight = out.segments * (snr - 1.0 - std::log(snr));
        out.found.push_back(line);
    }
    std::vector<MainsLine> by_frequency;  // as they were found
    for (const NarrowLine& line : out.found) by_frequency.push_back({line.frequency, line.deviation, line.power});
    out.mains = mains_among(by_frequency);
    for (NarrowLine& line : out.found) {
        for (const MainsComb& mains : out.mains) {
            const bool is_order = mains.order_of(line.frequency, line.deviation) > 0;
            line.is_hum |= is_order;
            line.is_shared_hum |= is_order && mains.lines > 1;
        }
        if (line.is_hum) out.hum += line.power;
    }
    std::ranges::sort(out.found, [](const NarrowLine& a, const NarrowLine& b) { return a.weight > b.weight; });
    return out;
}

/// Fraction of the power of the lines that a comb explains; without the power of hum unless `with_hum`.
double explained_by(double power, const NarrowLines& lines, bool with_hum) {
    // A line of a Hann window has 1.5 times the power of its highest bin.
    return power / std::max(lines.all / 1.5 - (with_hum ? 0.0 : lines.hum), power);
}

struct GrownComb {
    double frequency = 0.0, score = -1e9;
    std::array<int, max_tested> order{};  // of each tested line; 0: none
    std::size_t lines = 0;
    int highest = 0, common = 0;
    double power = 0.0;
};

/// Grows a comb in order of frequency: each line that fits reduces the uncertainty of the rate, and with it the reach
/// for the next line.
GrownComb grow_comb(const NarrowLines& lines, double frequency, double deviation, bool with_hum) {
    const std::size_t tested = std::min(lines.found.size(), max_tested);
    std::array<std::size_t, max_tested> by_frequency{};
    std::iota(by_frequency.begin(), by_frequency.begin() + static_cast<std::ptrdiff_t>(tested), 0u);
    std::sort(by_frequency.begin(), by_frequency.begin() + static_cast<std::ptrdiff_t>(tested),
              [&](std::size_t a, std::size_t b) { return lines.found[a].frequency < lines.found[b].frequency; });
    GrownComb out;
    out.frequency = frequency;
    double information = 1.0 / (deviation * deviation), weighted = frequency * information;
    double score = 0.0;
    for (std::size_t i = 0; i < tested; ++i) {
        const std::size_t at = by_frequency[i];
        const NarrowLine& line = lines.found[at];
        const double order = std::round(line.frequency / out.frequency);
        if (order < 1.0) continue;
        const double reach = 3.0 * std::sqrt(line.deviation * line.deviation + order * order / information);
        if (std::abs(line.frequency - order * out.frequency) > reach) continue;
        const double gain = std::min(line.weight, std::log(out.frequency / (2.0 * reach)));
        if (!(gain > 0.0)) continue;
        out.order[at] = static_cast<int>(order);
        out.common = std::gcd(out.common, out.order[at]);
        out.highest = std::max(out.highest, out.order[at]);
        ++out.lines;
        out.power += line.power;
        if (!line.is_hum || with_hum) score += gain;
        const double more = order * order / (line.deviation * line.deviation);
        weighted += line.frequency / order * more;
        information += more;
        out.frequency = weighted / information;
    }
    // Most machines have most of their orders: each missing one below the highest costs 0.3.
    out.score = score - 0.3 * static_cast<double>(out.highest - static_cast<int>(out.lines));
    return out;
}

/// Whether a line outside of a comb is an order of a fraction of its rate that is no coincidence: the fractions that were
/// tried before it leave so much room between them. `strongest`: line of the comb, of that order.
bool is_order_of_fraction(const NarrowLine& line, const NarrowLine& strongest, int order, double df) {
    if (line.is_shared_hum || line.power < min_weak_power * strongest.power || line.weight < min_fraction_weight)
        return false;
    const double max_chance = line.power < min_fraction_power * strongest.power ? max_weak_chance : max_fraction_chance;
    const double rate = strongest.frequency / order, deviation = strongest.deviation / order;
    double chance = 0.0;
    for (int divisor = 2; divisor <= max_fraction; ++divisor) {
        const double multiple = std::round(line.frequency * divisor / rate);
        const double place = multiple * rate / divisor;
        const double reach = 0.1 * df + 3.0 * std::hypot(line.deviation, multiple * deviation / divisor);
        for (int i = 1; i < divisor; ++i) chance += std::gcd(i, divisor) == 1 ? 2.0 * reach / rate : 0.0;
        if (chance > max_chance) return false;
        if (multiple >= 1.0 && std::abs(line.frequency - place) < reach) return true;
    }
    return false;
}

/// Log-likelihood ratio of the strongest bin at an order of a half to a fifth of `frequency` that is no order of
/// `frequency`: evidence that the rate is that fraction.
double between_orders(const Spectrum& spectrum, const NarrowLines& lines, double frequency, int highest, double top) {
    const double unlikely = power_quantile(lines.segments, 3.7);
    double strongest = 0.0;
    for (int divisor = 2; divisor <= 5; ++divisor)
        for (int order = 1; order < divisor * std::max(highest, 4); ++order) {
            const double place = frequency * order / divisor;
            if (order % divisor == 0 || place < 3.0 * lines.df || place > top) continue;
            if (is_order_of(lines.mains, place, 0.5 * lines.df) || frequency / divisor < bins_between * lines.df)
                continue;
            const auto k = static_cast<std::size_t>(std::lround(place / lines.df));
            if (k + 2 >= spectrum.power.size()) break;
            const double power = std::max({spectrum.power[k - 1], spectrum.power[k], spectrum.power[k + 1]});
            // Side lobes of nearby lines are not evidence.
            double skirt = 0.0;
            for (const NarrowLine& line : lines.found)
                if (const double away = std::abs(line.frequency - place) / lines.df; away > 1.7)
                    skirt = std::max(skirt, 8.0 * line.power * side_lobe(away - 1.0 > 1.5 ? away - 1.0 : 1.5));
            const double snr = (power - skirt) / lines.floors[std::min(k / floor_block, lines.floors.size() - 1)];
            if (snr > unlikely) strongest = std::max(strongest, lines.segments * (snr - 1.0 - std::log(snr)));
        }
    return strongest;
}

/// Expected squared mean of the amplitudes of a steady line in noise over their mean square, where `snr` is the power
/// of the line over that of the noise: π/4 of noise alone, 1 − 1/(2 snr) of a strong line, and a curve between the two
/// that is within 0.03 of Rice's distribution.
double steady_persistence(double snr) {
    constexpr double of_line = 1.0 - 0.25 * std::numbers::pi;
    return 1.0 - of_line / (1.0 + 2.0 * of_line * snr);
}

struct CombChoice {
    GrownComb best, rival;
    double score = -1e9, explained = 0.0;
    const NarrowLines* lines = nullptr;
    std::size_t level = 0;
    bool with_hum = false;
};

CombChoice choose_comb(const NarrowLines& lines, double lowest, double highest, bool with_hum) {
    CombChoice out;
    out.lines = &lines;
    std::vector<GrownComb> combs;
    for (std::size_t i = 0; i < std::min(seed_lines, lines.found.size()); ++i)
        for (int k = 1; k <= max_divisions; ++k) {
            const double f = lines.found[i].frequency / k;
            if (f < lowest || f > highest || f < bins_between * lines.df) continue;
            combs.push_back(grow_comb(lines, f, lines.found[i].deviation / k, with_hum));
        }
    // Weak lines that fit by chance must not outweigh a strong line outside of the comb.
    double all = 0.0;
    for (std::size_t i = 0; i < std::min(lines.found.size(), max_tested); ++i)
        if (with_hum || !lines.found[i].is_hum) all += lines.found[i].power;
    for (GrownComb& one : combs) one.score *= std::min(1.0, one.power / std::max(all, 1e-300));
    for (const GrownComb& one : combs)
        if (one.common == 1 && one.score > out.best.score) out.best = one;
    for (const GrownComb& one : combs)
        if (one.score > out.rival.score && std::abs(one.frequency / out.best.frequency - 1.0) > 0.02) out.rival = one;
    return out;
}

/// The frequency of a line over time.
struct LineCourse {
    std::vector<double> rates;  // Hz, one per interval
    double interval = 0.0;  // s
    /// Squared mean of the amplitude over the mean square: near 1 for one line, less for noise, for several lines in
    /// the band and for a line that leaves it.
    double steadiness = 0.0;
};

/// Frequency of what is within `half_band` of `frequency`, by the phase of its complex envelope.
LineCourse course_of(std::span<const double> samples, double rate, double frequency, double half_band) {
    LineCourse out;
    const auto length = static_cast<std::size_t>(std::lround(2.0 * rate / half_band));
    const std::size_t hop = std::max<std::size_t>(1, length / 8);
    if (samples.size() < 2 * length || frequency < half_band) return out;
    out.interval = static_cast<double>(hop) / rate;
    const double turn = 2.0 * std::numbers::pi * frequency / rate;
    std::vector<std::complex<double>> kernel(length);
    for (std::size_t n = 0; n < length; ++n) {
        const double place = static_cast<double>(n) - 0.5 * static_cast<double>(length - 1);
        kernel[n] =
            std::polar(1.0 + std::cos(2.0 * std::numbers::pi * place / static_cast<double>(length)), -turn * place);
    }
    double roots = 0.0, squares = 0.0;
    std::complex<double> before = 0.0;
    const auto count = samples.size() / hop;
    for (std::size_t i = 0; i <= count; ++i) {
        // At the ends, the kernel is cut off.
        const std::size_t middle = i * hop, half = length / 2;
        const std::size_t skipped = middle < half ? half - middle : 0;
        std::complex<double> sum = 0.0;
        for (std::size_t n = skipped; n < length && middle + n - half < samples.size(); ++n)
            sum += kernel[n] * samples[middle + n - half];
        if (i > 0) {
            const double more = std::arg(sum * std::conj(before)) - turn * static_cast<double>(hop);
            const double beyond = std::remainder(more, 2.0 * std::numbers::pi);
            const double now = frequency + beyond / (2.0 * std::numbers::pi * out.interval);
            // Where the line pauses its phase is that of noise; a rate stays positive, and within the band.
            out.rates.push_back(std::clamp(now, frequency - 0.8 * half_band, frequency + half_band));
        }
        before = sum;
        if (middle >= half && middle + half <= samples.size()) roots += std::abs(sum), squares += std::norm(sum);
    }
    const double whole = static_cast<double>((samples.size() - length) / hop + 1);
    out.steadiness = squares > 0.0 ? roots * roots / (whole * squares) : 0.0;
    return out;
}

/// Probability that the rate is right: logistic regression on the machines of seeds 0 to 999 of `tactus-bench
/// fundamental`, which tests it on others. 0 outside of the range of the regression: hum among the orders, orders of a
/// fraction of the rate, less than half of the power explained, fewer than 6 periods, a line that is not steady.
double probability_of(const SteadyFundamental& one) {
    if (!(one.explained >= 0.5) || one.periods < 6.0 || one.may_combine_hum || one.may_be_multiple) return 0.0;
    if (!one.is_persistent) return 0.0;
    const double gap = std::clamp(one.score - one.rival_score, 0.0, 12.0);
    const double missing = std::min(6.0, static_cast<double>(one.highest_order) - static_cast<double>(one.lines));
    const double sum = -0.937 + 0.645 * gap - 0.871 * std::sqrt(gap) + 0.482 * std::min(std::log(one.periods), 5.0) +
                       0.601 * std::min(static_cast<double>(one.lines), 6.0) + 0.167 * one.explained - 0.469 * 0.5 +
                       1.01 * std::min(one.margin_db, 40.0) / 10.0 - 0.193 * one.persistence - 0.06 * missing -
                       0.982 * std::min(std::log1p(one.between), 2.5) - 0.616 * std::min(std::log1p(one.foreign), 6.0);
    return 1.0 / (1.0 + std::exp(-sum));
}

}  // namespace

SteadyFundamentalStream::SteadyFundamentalStream(double rate, std::size_t frames, double lowest, double highest)
    : lowest_(lowest),
      highest_(highest),
      factor_(static_cast<std::size_t>(std::max(1.0, std::floor(rate / needed_rate)))),
      rate_(rate / static_cast<double>(factor_)) {
    if (factor_ > 1) {
        const auto count = 24 * factor_ + 1;
        const double cut = 0.5 / static_cast<double>(factor_), middle = 0.5 * static_cast<double>(count - 1);
        const std::vector<double> window = make_window(WindowKind::blackman, count, WindowSymmetry::symmetric);
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            const double t = static_cast<double>(i) - middle, angle = 2.0 * std::numbers::pi * 0.94 * cut * t;
            taps_.push_back(window[i] * (std::abs(angle) < 1e-12 ? 1.0 : std::sin(angle) / angle));
            sum += taps_.back();
        }
        for (double& tap : taps_) tap /= sum;
    }
    const std::size_t thinned = std::max<std::size_t>(1, frames / factor_);
    std::size_t segment = std::min(thinned, longest_segment);
    // Lengths with three significant bits have small prime factors.
    const std::size_t unit = std::max<std::size_t>(1, std::bit_floor(segment) / 4);
    segment = segment / unit * unit;
    for (std::size_t level = 0; level < max_levels; ++level, segment /= 4) {
        if (level > 0 && (static_cast<double>(segment) < shortest_segment * rate_ || segment < 64)) break;
        levels_.emplace_back(WelchSettings::hann(rate_, std::max<std::size_t>(segment, 4), segment / 2));
    }
    kept_.reserve(std::min(thinned + 1, max_kept));
}

void SteadyFundamentalStream::push_thinned(std::span<const double> samples) {
    for (WelchStream<double>& level : levels_) level.push(samples);
    kept_.insert(kept_.end(), samples.begin(),
                 samples.begin() + static_cast<std::ptrdiff_t>(std::min(samples.size(), max_kept - kept_.size())));
}

void SteadyFundamentalStream::push(std::span<const double> samples) {
    if (factor_ == 1) return push_thinned(samples);
    history_.insert(history_.end(), samples.begin(), samples.end());
    thinned_.clear();
    std::size_t at = phase_;
    for (; at + taps_.size() <= history_.size(); at += factor_) {
        const double* const x = history_.data() + at;
        std::array<double, 4> sums{};
        std::size_t i = 0;
        for (; i + 4 <= taps_.size(); i += 4)
            for (std::size_t lane = 0; lane < 4; ++lane) sums[lane] += taps_[i + lane] * x[i + lane];
        double sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        for (; i < taps_.size(); ++i) sum += taps_[i] * x[i];
        thinned_.push_back(sum);
    }
    const std::size_t drop = std::min(at, history_.size());
    history_.erase(history_.begin(), history_.begin() + static_cast<std::ptrdiff_t>(drop));
    phase_ = at - drop;
    push_thinned(thinned_);
}

void SteadyFundamentalStream::gap() {
    history_.clear();
    phase_ = 0;
    for (WelchStream<double>& level : levels_) level.forget_waiting();
    if (kept_.size() > pieces_.back()) pieces_.push_back(kept_.size());
}

std::span<const double> SteadyFundamentalStream::piece(std::size_t index) const {
    const std::size_t end = index + 1 < pieces_.size() ? pieces_[index + 1] : kept_.size();
    return std::span(kept_).subspan(pieces_[index], end - pieces_[index]);
}

std::span<const double> SteadyFundamentalStream::longest_piece() const {
    std::span<const double> longest;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        if (piece(i).size() > longest.size()) longest = piece(i);
    return longest;
}

/// How evenly a line is spread over the record: squared mean of its amplitude in parts of `length` samples over the
/// mean square, relative to that of a steady line in the same noise, of which a part has `snr` times the power.
double SteadyFundamentalStream::persistence(double frequency, double snr, std::size_t length) const {
    if (length == 0) return 0.0;
    std::vector<std::complex<double>> kernel(length);
    for (std::size_t n = 0; n < length; ++n) {
        const double w =
            1.0 - std::cos(2.0 * std::numbers::pi * (static_cast<double>(n) + 0.5) / static_cast<double>(length));
        kernel[n] = std::polar(w, 2.0 * std::numbers::pi * frequency / rate_ * static_cast<double>(n));
    }
    double sum = 0.0, roots = 0.0, count = 0.0;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
        for (std::span<const double> rest = piece(i); rest.size() >= length;
             rest = rest.subspan(length), count += 1.0) {
            const std::span<const double> part = rest.first(length);
            const double mean = std::accumulate(part.begin(), part.end(), 0.0) / static_cast<double>(length);
            std::complex<double> amplitude = 0.0;
            for (std::size_t n = 0; n < length; ++n) amplitude += kernel[n] * (part[n] - mean);
            sum += std::norm(amplitude), roots += std::abs(amplitude);
        }
    return sum > 0.0 ? roots * roots / (count * sum) / steady_persistence(snr) : 0.0;
}

SteadyFundamental SteadyFundamentalStream::estimate() const {
    SteadyFundamental out;
    const double top = this->top();
    std::vector<NarrowLines> all(levels_.size());
    CombChoice chosen;
    // Shorter segments are used only for rates that wander: they blur lines that longer ones resolve.
    all[0] = lines_of(levels_[0].spectrum(), top, true);
    double narrow = 0.0;
    for (const NarrowLine& line : all[0].found) narrow += line.power;
    const std::size_t used = narrow >= explains_all * all[0].all / 1.5 && narrow > 0.0 ? 1 : levels_.size();
    for (const bool with_hum : {false, true}) {
        for (std::size_t i = 0; i < used; ++i) {
            if (!with_hum && i > 0) all[i] = lines_of(levels_[i].spectrum(), top, false);
            CombChoice one = choose_comb(all[i], lowest_, highest_, with_hum);
            if (one.best.lines == 0 || !(one.best.score > 0.0)) continue;
            const double explained = explained_by(one.best.power, all[i], with_hum);
            one.score = one.best.score * explained;
            one.explained = explained;
            one.level = i;
            one.with_hum = with_hum;
            if (one.score > chosen.score) chosen = one;
        }
        // If the lines of a machine explain little of the power, the orders of the mains may be the machine's.
        if (chosen.score > 0.0 && chosen.explained >= 0.5) break;
    }
    if (!(chosen.score > 0.0)) return out;
    const NarrowLines& lines = *chosen.lines;
    const GrownComb& comb = chosen.best;
    out.frequency = comb.frequency;
    out.lines = comb.lines;
    out.highest_order = comb.highest;
    out.score = comb.score;
    out.rival = chosen.rival.score > 0.0 ? chosen.rival.frequency : 0.0;
    out.rival_score = std::max(0.0, chosen.rival.score);
    out.is_sharp = chosen.level == 0;
    out.lowest = std::max(lowest_, bins_between * lines.df);
    out.periods = comb.frequency / lines.df;
    out.explained = explained_by(comb.power, lines, chosen.with_hum);
    const NarrowLine* strongest = nullptr;
    int strongest_order = 1;
    std::vector<int> orders;
    int common = 0;  // greatest common divisor of the orders that are no hum
    std::vector<double> others;
    std::vector<MainsLine> beside;  // the comb
    bool is_over_hum = false;  // the rate is a multiple of a line that counts as hum
    for (std::size_t i = 0; i < std::min(lines.found.size(), max_tested); ++i) {
        const NarrowLine& line = lines.found[i];
        if (comb.order[i] == 0) {
            beside.push_back({line.frequency, line.deviation, line.power});
            for (int divisor = 2; divisor <= 12 && line.is_hum; ++divisor)
                is_over_hum |= std::abs(divisor * line.frequency - comb.frequency) < 3.0 * divisor * line.deviation;
            if (!line.is_hum) out.foreign = std::max(out.foreign, line.weight);
            if (others.size() < 8) others.push_back(line.frequency);
            continue;
        }
        if (!strongest || line.power > strongest->power) strongest = &line, strongest_order = comb.order[i];
        orders.push_back(comb.order[i]);
        if (!line.is_hum) common = std::gcd(common, comb.order[i]);
    }
    for (std::size_t i = 0; i < std::min(lines.found.size(), max_tested); ++i) {
        const NarrowLine& line = lines.found[i];
        out.strong_lines += comb.order[i] > 0 && line.power >= min_order_power * strongest->power;
        out.may_be_multiple |= comb.order[i] == 0 && is_order_of_fraction(line, *strongest, strongest_order, lines.df);
    }
    std::ranges::sort(beside, {}, &MainsLine::frequency);
    const double deviation = strongest->deviation / strongest_order, reach = 3.0 * deviation;
    out.is_at_mains = is_rate_of_hum(comb.frequency, deviation, mains_among(beside));
    // If the orders that are no hum have a common divisor, or if there are none, only lines of hum support this rate, and
    // the machine's may be the multiple. This does not apply to a comb at the mains: every order may be hum, or none is
    // if other lines show the hum.
    const bool is_single_family = may_be_hum_rate(comb.frequency, reach);
    out.may_combine_hum = (common != 1 && !out.is_at_mains && !is_single_family) || is_over_hum;
    out.between = between_orders(levels_[chosen.level].spectrum(), lines, comb.frequency, comb.highest, top);
    out.margin_db = 10.0 * std::log10(strongest->power / (lines.threshold * strongest->floor));
    const std::size_t eighth = kept_.size() / eighths;
    const auto few_periods = static_cast<std::size_t>(std::ceil(periods_per_piece * rate_ / comb.frequency));
    const std::size_t length =
        std::min(out.strong_lines > few_lines ? eighth : std::min(eighth, few_periods), longest_piece().size());
    // A bin of the spectrum and a part of the record differ in the noise that they contain.
    out.persistence =
        persistence(strongest->frequency,
                    strongest->power / strongest->floor * lines.df * static_cast<double>(length) / rate_, length);
    out.is_persistent = out.persistence >= (out.strong_lines > few_lines ? min_persistence : min_persistence_of_few);
    out.confidence_without_hum = probability_of(out);
    out.confidence = out.is_at_mains ? 0.0 : out.confidence_without_hum;
    if (out.is_sharp && !kept_.empty()) {
        const HarmonicFit fit = fit_harmonics(longest_piece(), rate_, comb.frequency, orders, others);
        if (std::abs(fit.frequency - comb.frequency) * comb.highest < lines.df) {
            out.frequency = fit.frequency;
            out.deviation = fit.deviation;
        }
    }
    return out;
}

SteadyFundamental SteadyFundamentalStream::estimate_along(std::span<const double> course, double interval) const {
    return estimate_along(piece(0), course, interval);
}

SteadyFundamental SteadyFundamentalStream::estimate_along(std::span<const double> samples,
                                                          std::span<const double> course, double interval) const {
    if (course.empty() || samples.size() < 64) return {};
    const double mean = std::accumulate(course.begin(), course.end(), 0.0) / static_cast<double>(course.size());
    const auto rate_at = [&](double t) {
        const double place = std::clamp(t / interval - 0.5, 0.0, static_cast<double>(course.size() - 1));
        const auto before = static_cast<std::size_t>(place);
        const std::size_t after = std::min(before + 1, course.size() - 1);
        return std::lerp(course[before], course[after], place - static_cast<double>(before)) / mean;
    };
    std::vector<double> warped;
    warped.reserve(samples.size());
    const double last =
        std::min(static_cast<double>(samples.size() - 3), static_cast<double>(course.size()) * interval * rate_);
    // Steps of equal angle, with cubic interpolation (Catmull and Rom 1974).
    for (double at = 1.0; at < last; at += 1.0 / rate_at((at + 0.5) / rate_)) {
        const auto n = static_cast<std::size_t>(at);
        const double u = at - static_cast<double>(n);
        const double a = samples[n - 1], b = samples[n], c = samples[n + 1], d = samples[n + 2];
        warped.push_back(b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a))));
    }
    SteadyFundamentalStream still(rate_, warped.size(), lowest_, highest_);
    still.push(warped);
    return still.estimate();
}

SteadyFundamental SteadyFundamentalStream::estimate_straightened() const {
    const std::span<const double> samples = longest_piece();
    std::vector<LineCourse> courses;
    for (std::size_t level = 1; level < levels_.size(); ++level) {
        NarrowLines lines = lines_of(levels_[level].spectrum(), top(), false);
        std::ranges::sort(lines.found, std::greater<>(), &NarrowLine::power);
        // Hum is steady; along its noise, the lines of a machine and its own would only become wider.
        std::erase_if(lines.found, [](const NarrowLine& line) { return line.is_hum; });
        for (std::size_t i = 0; i < std::min(followed_lines, lines.found.size()); ++i)
            if (LineCourse one = course_of(samples, rate_, lines.found[i].frequency, course_bins * lines.df);
                one.steadiness > min_steadiness)
                courses.push_back(std::move(one));
    }
    std::ranges::sort(courses, std::greater<>(), &LineCourse::steadiness);
    SteadyFundamental best;
    for (std::size_t i = 0; i < std::min(max_courses, courses.size()); ++i) {
        const SteadyFundamental one = estimate_along(samples, courses[i].rates, courses[i].interval);
        if (!one.is_sharp || (one.strong_lines < 2 && courses[i].steadiness < min_steadiness_of_one)) continue;
        if (one.score * one.explained > best.score * best.explained) best = one;
    }
    best.deviation = 0.0;
    best.is_sharp = false;
    return best;
}

}  // namespace tactus::signal
