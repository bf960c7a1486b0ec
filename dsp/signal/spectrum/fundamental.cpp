// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/fundamental.hpp"

#include "dsp/signal/spectrum/mains.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus::signal {

namespace {

constexpr double silent_score = 0.07;  // of a section in which nothing is heard
constexpr double step_cost = 0.7;      // per unit of ln(f) between sections
constexpr double max_step = 0.2;      // greatest cost
constexpr double min_support = 0.25;
// A rate that moves within a section smears its lines and lowers their scores; that sections in half of the record
// agree on one path is evidence of its own. Paths of 60 noises of 3 to 6 s reach 0.101, those of machete strokes 0.094.
constexpr double heard_as_path = 0.13;
constexpr std::size_t min_path = 4;  // sections
// A rate whose sections agree to 1 % is steady, and only the lines of the whole record are evidence for it: hum beside
// a machine is such a rate.
constexpr double moving = 1.01, wide = 1.1;  // highest by lowest rate of a path
constexpr double jump_in = 0.5;  // of the movement in an eighth of a section: an impact

/// Short enough to keep a varying line together, long enough to resolve the lines of a saw.
WelchSettings section_settings(double rate, std::size_t frames) {
    const double longest = std::min(0.25 * rate, static_cast<double>(frames));
    const std::size_t segment = std::bit_floor(static_cast<std::size_t>(std::max(64.0, longest)));
    return WelchSettings::hann(rate, segment, segment * 3 / 4);
}

WelchSettings whole_settings(double rate, std::size_t frames) {
    const std::size_t segment = suggested_segment(rate, frames);
    return WelchSettings::hann(rate, segment, segment / 2);
}

/// Hz: the least rate that a section resolves: five bins between its orders.
double section_least(double rate) {
    return 5.0 * rate / static_cast<double>(std::bit_floor(static_cast<std::size_t>(std::max(64.0, 0.25 * rate))));
}

bool alike(double a, double b, double ratio) { return a > 0.0 && b > 0.0 && std::abs(a / b - 1.0) < ratio; }

}  // namespace

FundamentalStream::FundamentalStream(double rate, std::size_t frames, double lowest, double highest)
    : lowest_(lowest),
      highest_(highest),
      highest_moving_(std::min(highest, std::max(500.0, 4.0 * lowest))),
      rate_(rate),
      // Rates outside of the range are sought too: their multiples inside it are no fundamentals.
      steady_(rate, frames, std::min(lowest, lowest_fundamental), std::max(highest, highest_fundamental)),
      whole_(whole_settings(rate, frames)),
      section_(section_settings(rate, frames)),
      fresh_section_(section_),
      section_length_(static_cast<std::size_t>(std::ceil(0.5 * rate))) {}

void FundamentalStream::push(std::span<const double> samples) {
    whole_.push(samples);
    steady_.push(samples);
    pushed_ += samples.size();
    while (!samples.empty()) {
        const std::size_t part = std::min(samples.size(), section_length_ - in_section_);
        section_.push(samples.first(part));
        for (std::size_t i = 0; i < part;) {
            const std::size_t eighth = (in_section_ + i) * movement_.size() / section_length_;
            const std::size_t next = ((eighth + 1) * section_length_ + movement_.size() - 1) / movement_.size();
            const std::size_t end = std::min(part, next - in_section_);
            double sum = movement_[eighth];
            for (; i < end; ++i) {
                const double step = samples[i] - last_;
                sum += step * step;
                last_ = samples[i];
            }
            movement_[eighth] = sum;
        }
        samples = samples.subspan(part);
        in_section_ += part;
        if (in_section_ == section_length_) end_section();
    }
}

void FundamentalStream::end_section() {
    Section section;
    double all = 1e-300, most = 0.0;
    for (const double movement : movement_) all += movement, most = std::max(most, movement);
    // An impact excites many frequencies at once: the ripples of its spectrum are no lines.
    if (most < jump_in * all)
        for (const HarmonicSum& one : harmonic_sums(section_.spectrum(), lowest_, highest_moving_, max_candidates))
            section.candidates[section.count++] = one;
    sections_.push_back(section);
    section_ = fresh_section_;
    in_section_ = 0;
    movement_.fill(0.0);
}

void FundamentalStream::gap() {
    whole_.forget_waiting();
    steady_.gap();
    section_ = fresh_section_;
    in_section_ = 0;
    movement_.fill(0.0);
}

/// The path with the greatest sum of scores less costs of changes, by dynamic programming.
FundamentalStream::Path FundamentalStream::best_path() const {
    constexpr std::size_t states = max_candidates + 1;  // the last one: nothing heard
    std::vector<std::array<std::size_t, states>> from(sections_.size());
    std::array<double, states> total{}, next{};
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        const auto frequency_of = [&](std::size_t section, std::size_t state) {
            return state < sections_[section].count ? sections_[section].candidates[state].frequency : 0.0;
        };
        for (std::size_t state = 0; state < states; ++state) {
            next[state] = -1e9;
            if (state >= sections_[i].count && state + 1 < states) continue;
            const double here = frequency_of(i, state);
            const double score = state < sections_[i].count ? sections_[i].candidates[state].score : silent_score;
            for (std::size_t origin = 0; origin < states; ++origin) {
                if (i > 0 && origin >= sections_[i - 1].count && origin + 1 < states) continue;
                const double before = i > 0 ? frequency_of(i - 1, origin) : 0.0;
                const double cost = here > 0.0 && before > 0.0
                                        ? std::min(max_step, step_cost * std::abs(std::log(here / before)))
                                        : 0.5 * max_step * static_cast<double>((here > 0.0) != (before > 0.0) && i > 0);
                if (total[origin] - cost + score > next[state]) {
                    next[state] = total[origin] - cost + score;
                    from[i][state] = origin;
                }
                if (i == 0) break;
            }
        }
        total = next;
    }
    Path path;
    path.points.resize(sections_.size());
    if (sections_.empty()) return path;
    auto state = static_cast<std::size_t>(std::max_element(total.begin(), total.end()) - total.begin());
    path.score = total[state] / static_cast<double>(sections_.size());
    for (std::size_t i = sections_.size(); i-- > 0;) {
        if (state < sections_[i].count) path.points[i] = sections_[i].candidates[state];
        state = from[i][state];
    }
    return path;
}

FundamentalEstimate FundamentalStream::along(const Path& path) const {
    FundamentalEstimate out;
    const std::vector<HarmonicSum> whole = harmonic_sums(whole_.spectrum(), lowest_, highest_moving_);
    const HarmonicSum sharp = whole.empty() ? HarmonicSum{} : whole.front();
    std::vector<HarmonicSum> heard;
    for (const HarmonicSum& point : path.points)
        if (point.frequency > 0.0) heard.push_back(point);
    std::ranges::sort(heard, {}, &HarmonicSum::frequency);
    double all = 0.0, sum = 0.0;
    for (const HarmonicSum& point : heard) all += point.score;
    double median = 0.0, low = 0.0, high = 0.0;
    for (const HarmonicSum& point : heard) {
        if (sum < 0.1 * all) low = point.frequency;
        if (sum < 0.5 * all) median = point.frequency;
        if (sum < 0.9 * all) high = point.frequency;
        sum += point.score;
    }
    const double share =
        sections_.empty() ? 0.0 : static_cast<double>(heard.size()) / static_cast<double>(sections_.size());
    const double mean = heard.empty() ? 0.0 : all / static_cast<double>(heard.size());
    double near = 0.0;
    for (const HarmonicSum& point : heard) near += alike(point.frequency, median, 0.25) ? point.score : 0.0;
    const double together = all > 0.0 ? near / all : 0.0;
    const double varied = mean * std::sqrt(share) * together;
    // A line of the whole record that few sections have is of an event: the ring of a strike.
    std::size_t supporting = 0;
    for (const Section& section : sections_)
        supporting += std::any_of(section.candidates.begin(),
                                  section.candidates.begin() + static_cast<std::ptrdiff_t>(section.count),
                                  [&](const HarmonicSum& one) { return alike(one.frequency, sharp.frequency, 0.03); });
    const bool supported = static_cast<double>(supporting) >= min_support * static_cast<double>(sections_.size());
    const double fixed = (supported ? 1.0 : 0.3) * confidence_in(whole);
    const double weaker = std::min(fixed, varied), stronger = std::max(fixed, varied);
    // One rate of a path is no other answer than the path.
    const bool on_path = sharp.frequency >= 0.95 * low && sharp.frequency <= 1.05 * high;
    if (on_path || alike(sharp.frequency, median, 0.03)) {
        double close = 0.0;
        for (const HarmonicSum& point : heard)
            close += alike(point.frequency, sharp.frequency, 0.012) ? point.score : 0.0;
        out.steady = close >= 0.7 * all && all > 0.0;
        out.frequency = out.steady ? sharp.frequency : median;
        out.confidence = std::min(1.0, stronger + 0.5 * weaker);
    } else if (stronger > 0.0) {
        out.steady = fixed >= varied;
        out.frequency = out.steady ? sharp.frequency : median;
        out.confidence = stronger - 0.5 * weaker;
    }
    out.low = out.steady ? out.frequency : low;
    out.high = out.steady ? out.frequency : high;
    const bool is_path = !out.steady && heard.size() >= min_path && share >= 0.5 && out.high > moving * out.low;
    if (out.confidence < (is_path ? heard_as_path : FundamentalEstimate::heard)) out = {};
    // A steady rate is certain by the lines of the whole record only. Of a moving one, the sections must resolve the
    // half.
    out.certain = is_path && out.confidence >= FundamentalEstimate::path && out.low > 2.0 * section_least(rate_);
    for (const HarmonicSum& one : whole)
        if (!alike(one.frequency, out.frequency, 0.03) && out.rivals.size() < 3 && one.score > 0.05)
            out.rivals.push_back(one);
    return out;
}

/// The lines of the record after its rate was straightened along a path. Sections in which the path is silent, or at a
/// multiple or fraction of its median, take the rate of their neighbours.
SteadyFundamental FundamentalStream::lines_along(const Path& path, double median) const {
    std::vector<double> course(path.points.size(), 0.0);
    std::size_t known = 0;
    for (std::size_t i = 0; i < course.size(); ++i)
        if (alike(path.points[i].frequency, median, 0.25)) course[i] = path.points[i].frequency, ++known;
    if (known < min_path) return {};
    double before = 0.0;
    for (std::size_t i = 0; i < course.size(); ++i) {
        if (course[i] > 0.0) {
            before = course[i];
            continue;
        }
        const auto next = std::find_if(course.begin() + static_cast<std::ptrdiff_t>(i), course.end(),
                                       [](double rate) { return rate > 0.0; });
        const double after = next == course.end() ? before : *next;
        course[i] = before > 0.0 ? 0.5 * (before + after) : after;
    }
    return steady_.estimate_along(course, static_cast<double>(section_length_) / rate_);
}

/// The lines of the whole record; along the course of one of them where the rate varies too much for sharp lines.
SteadyFundamental FundamentalStream::resolved_lines() const {
    SteadyFundamental lines = steady_.estimate();
    if (lines.is_sharp && lines.confidence >= FundamentalEstimate::sure) return lines;
    const SteadyFundamental straight = steady_.estimate_straightened();
    if (straight.confidence >= FundamentalEstimate::sure) return straight;
    // Blurred lines may lack the weak orders that sharp ones show.
    if (straight.frequency > 0.0 && !lines.is_sharp && !alike(straight.frequency, lines.frequency, 0.02))
        lines.confidence = std::min(lines.confidence, 0.9);
    return lines;
}

FundamentalEstimate FundamentalStream::estimate() const {
    const Path path = best_path();
    FundamentalEstimate out = along(path);
    const SteadyFundamental lines = resolved_lines();
    const double seconds = static_cast<double>(pushed_) / rate_;
    const bool in_range = lines.frequency >= lowest_ && lines.frequency <= highest_;
    const bool is_sure = lines.confidence >= FundamentalEstimate::sure;
    const bool agrees = alike(lines.frequency, out.frequency, 0.03) ||
                        (lines.frequency >= 0.95 * out.low && lines.frequency <= 1.05 * out.high);
    if (is_sure && in_range) {
        const bool moves = !lines.is_sharp && !out.steady && out.low > 2.0 * section_least(rate_) &&
                           alike(lines.frequency, out.frequency, 0.05);
        if (!moves) {
            out.frequency = out.low = out.high = lines.frequency;
            out.steady = true;
            out.deviation = lines.deviation;
        }
        out.confidence = lines.confidence;
        out.certain = true;
    } else if (out.frequency > 0.0) {
        // The lines of the whole record overrule the sections.
        if (lines.frequency > 0.0 && !agrees && (lines.explained >= 0.3 || lines.confidence > 0.5)) out.certain = false;
        if (out.steady && agrees && in_range && lines.is_sharp) {
            out.frequency = out.low = out.high = lines.frequency;
            out.deviation = lines.deviation;
        }
        // Sections do not exclude a multiple or a fraction of the rate.
        if (out.steady && !out.certain) out.confidence = std::min(out.confidence, std::max(0.5, lines.confidence));
    } else if (in_range && lines.confidence > 0.5) {
        out.frequency = out.low = out.high = lines.frequency;
        out.steady = true;
        out.confidence = lines.confidence;
    }
    if (!is_sure && out.frequency > 0.0 && out.high > 1.003 * out.low) {
        const SteadyFundamental still = lines_along(path, out.frequency);
        // The mean of a wide path may lie anywhere in its range, and sections in which the rate moves score less.
        const bool is_wide = out.high > wide * out.low;
        const bool same = alike(still.frequency, out.frequency, 0.05) ||
                          (is_wide && still.frequency >= out.low && still.frequency <= out.high);
        if (still.frequency > 0.0 && !same) out.certain = false;
        // A ring after strikes at uneven intervals moves as little, and decays between the strikes.
        const bool rings = (still.frequency > 0.0 && !still.is_persistent) || (agrees && !lines.is_persistent);
        if (!is_wide && rings) out.certain = false;
        if (is_wide && !out.steady && out.confidence >= FundamentalEstimate::wide_path && same &&
            still.explained >= 0.4 && out.low > 2.0 * section_least(rate_))
            out.certain = true;
        // The path may be that of other lines than those of the whole record, or of hum.
        const bool is_contradicted = lines.confidence >= 0.9 && !alike(still.frequency, lines.frequency, 0.05);
        if (still.confidence >= FundamentalEstimate::sure && !is_contradicted && still.frequency >= lowest_ &&
            still.frequency <= highest_) {
            const double scale = same ? 1.0 : still.frequency / out.frequency;
            out.frequency = same && is_wide ? out.frequency : still.frequency;
            out.low *= scale, out.high *= scale;
            out.confidence = still.confidence;
            out.certain = true;
        }
    }
    // Or the lines are one that is no hum, of which the rate is a fraction with the orders that may be.
    const bool is_hum_rate = lines.is_at_mains && lines.confidence_without_hum >= FundamentalEstimate::sure &&
                             alike(lines.frequency, out.frequency, 0.003);
    out.may_be_hum = !out.certain && (is_hum_rate || (lines.may_combine_hum && may_be_hum_rate(out.frequency) &&
                                                      !alike(lines.frequency, out.frequency, 0.003)));
    const auto add_rival = [&](double frequency, double score) {
        if (frequency > 0.0 && !alike(frequency, out.frequency, 0.03) &&
            std::ranges::none_of(out.rivals,
                                 [&](const HarmonicSum& one) { return alike(one.frequency, frequency, 0.03); }))
            out.rivals.insert(out.rivals.begin(), {frequency, score});
    };
    std::erase_if(out.rivals, [&](const HarmonicSum& one) { return alike(one.frequency, out.frequency, 0.03); });
    if (out.frequency > 0.0 && !out.certain) {
        if (out.rivals.empty())
            add_rival(lines.rival, std::clamp(lines.rival_score / std::max(lines.score, 1e-9), 0.0, 1.0));
        add_rival(lines.frequency, lines.confidence);
    }
    if (out.rivals.size() > 3) out.rivals.resize(3);
    out.periods = out.frequency * seconds;
    return out;
}

FundamentalEstimate find_fundamental(std::span<const double> record, double rate, double lowest, double highest) {
    FundamentalStream stream(rate, record.size(), lowest, highest);
    stream.push(record);
    return stream.estimate();
}

FundamentalEstimate find_fundamental(std::span<const float> record, double rate, double lowest, double highest) {
    FundamentalStream stream(rate, record.size(), lowest, highest);
    std::vector<double> piece;
    for (constexpr std::size_t most = 65536; !record.empty(); record = record.subspan(std::min(most, record.size()))) {
        const std::span<const float> part = record.first(std::min(most, record.size()));
        piece.assign(part.begin(), part.end());
        stream.push(piece);
    }
    return stream.estimate();
}

}  // namespace tactus::signal
