// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/filter/regularise.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/geometry/spline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace tactus::signal {

namespace {

constexpr std::size_t block_size = 65536, overlap = 512, max_at_once = 131072;

/// Samples that are off their even places by less than this share of a step are taken as they are: a component at half the
/// rate changes by -110 dB.
constexpr double max_off = 1e-6;

/// Times read in blocks: fast for places that ascend.
class TimeBlocks {
public:
    explicit TimeBlocks(const TimedSamples& samples) : samples_(&samples) {}
    double operator[](std::size_t index) {
        if (index < first_ || index >= first_ + block_.size()) {
            leave_if_stopped();
            first_ = index;
            block_.resize(std::min(block_size, samples_->count - first_));
            samples_->times(first_, block_);
        }
        return block_[index - first_];
    }

private:
    const TimedSamples* samples_;
    std::vector<double> block_;
    std::size_t first_ = 0;
};

/// The values at `ranks` (ascending) of a sequence of numbers >= 0 in ascending order, as selection from the sorted numbers would
/// give them, without keeping the numbers: their bits are in the order of their values, so that four passes that
/// count 16 bits each find them. `pass(use)` calls use(number) for all of them.
template <class Pass>
std::vector<double> select(const std::vector<std::size_t>& ranks, const Pass& pass) {
    struct Search {
        std::uint64_t prefix = 0;
        std::size_t rank = 0;
        std::vector<std::size_t> counts;
    };
    std::vector<Search> searches;
    for (const std::size_t rank : ranks) searches.push_back({0, rank, {}});
    for (int shift = 48; shift >= 0; shift -= 16) {
        for (Search& search : searches) search.counts.assign(65536, 0);
        const auto above = [&](std::uint64_t bits) { return shift == 48 ? 0 : bits >> (shift + 16); };
        pass([&](double number) {
            const auto bits = std::bit_cast<std::uint64_t>(number);
            for (Search& search : searches)
                if (above(bits) == search.prefix) ++search.counts[bits >> shift & 0xffff];
        });
        for (Search& search : searches) {
            std::size_t digit = 0;
            while (digit < 65535 && search.rank >= search.counts[digit]) search.rank -= search.counts[digit++];
            search.prefix = search.prefix << 16 | digit;
        }
    }
    std::vector<double> found;
    for (const Search& search : searches) found.push_back(std::bit_cast<double>(search.prefix));
    return found;
}

/// The step of the clock itself: the largest length of which all steps are whole multiples. 0 if there is none above
/// 1e-5 of the mean step, or if nothing shows it.
double clock_step(const TimedSamples& samples, double first, double last) {
    TimeBlocks times(samples);
    const double least = 1e-5 * (last - first) / static_cast<double>(samples.count - 1);
    // Times are rounded to the digits of a double.
    const double error = std::max(1e-4 * least, 8e-16 * std::max(std::abs(first), std::abs(last)));
    double common = 0.0, before = first;
    for (std::size_t i = 1; i < samples.count; ++i) {
        const double time = times[i];
        double a = common, b = time - before;
        before = time;
        while (b > 2.0 * error) {
            if (a == 0.0) {
                a = b;
                break;
            }
            const double rest = std::abs(a - b * std::round(a / b));
            a = b, b = rest;
            if (a < least) return 0.0;
        }
        common = a;
    }
    return common;
}

/// Even times of the samples [first, end) between two gaps.
struct TimeLine {
    std::size_t first = 0, end = 0;
    double start = 0.0, slope = 0.0, middle = 0.0;  // time = start + slope * (index - first - middle)
};

/// Times of an even sampling that a coarse clock rounded to its own steps: a line explains them within one step. Returns
/// those lines, piece by piece between gaps; none if the steps themselves are uneven, or without such a clock.
std::optional<std::vector<TimeLine>> without_rounding(const TimedSamples& samples, double step, double first_time,
                                                      double last_time) {
    const std::size_t size = samples.count;
    const double mean = (last_time - first_time) / static_cast<double>(size - 1);
    if (!(step > 0.0)) return std::nullopt;
    std::map<long, std::size_t> counts;  // steps by their length in steps of the clock
    std::array<std::size_t, 64> short_counts{};
    std::size_t positive = 0;
    TimeBlocks times(samples);
    double before = first_time;
    for (std::size_t i = 1; i < size; ++i) {
        const double length = times[i] - before;
        before = times[i];
        const long whole = std::lround(std::min(length / step, 1e6));
        if (whole < long(short_counts.size())) ++short_counts[static_cast<std::size_t>(whole)];
        else ++counts[whole];
        positive += length > 0.0;
    }
    for (std::size_t n = 0; n < short_counts.size(); ++n)
        if (short_counts[n] > 0) counts[long(n)] = short_counts[n];
    // Even times in which a few samples are missing: the other steps are multiples of the usual one. Rounding makes steps
    // that differ by one.
    const auto usual = std::ranges::max_element(counts, {}, [](const auto& entry) { return entry.second; });
    std::size_t multiples = 0;
    for (const auto& [length, count] : counts)
        if (usual->first > 0 && length > usual->first && length % usual->first == 0) multiples += count;
    if (20 * usual->second > 19 * (size - 1) && usual->second + multiples == size - 1) return std::nullopt;
    // A clock whose step divides the mean step rounds all samples alike: other steps are jitter of the samples.
    const double drift = std::abs(mean / step - std::round(mean / step)) * static_cast<double>(size - 1);
    if (drift < 2.0 && usual->second + 8 < size - 1) return std::nullopt;
    const double gap = 5.0 * select({positive / 2}, [&](const auto& use) {
                                 TimeBlocks again(samples);
                                 double last = first_time;
                                 for (std::size_t i = 1; i < size; ++i) {
                                     const double time = again[i];
                                     if (time > last) use(time - last);
                                     last = time;
                                 }
                             }).front();
    std::vector<TimeLine> lines;
    double slopes = 0.0, counted = 0.0;  // of pieces that are long enough for a slope of their own
    TimeBlocks ahead(samples);
    for (std::size_t first = 0; first < size;) {
        std::size_t end = first + 1;
        const double start = ahead[first];
        double sum = 0.0, moment = 0.0, last = start;
        // Moments about the first sample, shifted to the middle once the end is known.
        for (; end < size && ahead[end] - last <= gap; ++end) {
            last = ahead[end];
            sum += last - start, moment += static_cast<double>(end - first) * (last - start);
        }
        const auto count = static_cast<double>(end - first);
        const double middle = 0.5 * (count - 1.0), mean_time = sum / count;
        lines.push_back({first, end, start + mean_time, 0.0, middle});
        if (end - first >= 8) {
            const double slope = (moment - middle * sum) / (count * (count * count - 1.0) / 12.0);
            double low = 0.0, high = 0.0;
            for (std::size_t i = first; i < end; ++i) {
                const double line = mean_time + slope * (static_cast<double>(i - first) - middle);
                const double off = times[i] - start - line;
                low = std::min(low, off), high = std::max(high, off);
            }
            // Rounding, up, down or to the nearest, moves a time by less than one step; the fitted line lies within it.
            if (high - low > 1.2 * step) return std::nullopt;
            lines.back().slope = slope;
            slopes += slope * count, counted += count;
        }
        first = end;
    }
    if (counted == 0.0) return std::nullopt;
    // In a short piece the clock may not advance; use the mean slope of the others.
    for (TimeLine& line : lines)
        if (line.end - line.first < 8) line.slope = slopes / counted;
    return lines;
}

/// The times that are used, in ascending order: those on lines, or with equal times spread up to the next.
class UsedTimes {
public:
    UsedTimes(const TimedSamples& samples, const std::vector<TimeLine>* lines)
        : samples_(&samples), lines_(lines), times_(samples) {}

    /// The next time; to be called `count` times.
    double next() {
        const double time = lines_ ? on_line() : spread();
        ++at_;
        return time;
    }

private:
    double on_line() {
        while (at_ >= (*lines_)[line_].end) ++line_;
        const TimeLine& line = (*lines_)[line_];
        return line.start + line.slope * (static_cast<double>(at_ - line.first) - line.middle);
    }

    double spread() {
        if (at_ < end_) return last_ += step_;
        const std::size_t first = end_;
        const double time = times_[first];
        end_ = first + 1;
        while (end_ < samples_->count && times_[end_] == time) ++end_;
        // The last run has no next time: its samples keep the step of the previous run.
        const double before = step_;
        step_ = end_ < samples_->count ? (times_[end_] - time) / static_cast<double>(end_ - first)
                                       : (first > 0 ? time - last_ : before);
        return last_ = time;
    }

    const TimedSamples* samples_;
    const std::vector<TimeLine>* lines_;
    TimeBlocks times_;
    std::size_t at_ = 0, line_ = 0;
    std::size_t end_ = 0;  // of the run of equal times
    double step_ = 0.0, last_ = 0.0;
};

/// Band-limited interpolation between even values: sinc with a Kaiser window of 16 zero crossings to each side.
class Interpolation {
public:
    static constexpr std::size_t reach = 16, width = 2 * reach;
    using Weights = std::array<double, width>;

    Interpolation() {
        const auto bessel = [](double x) {
            double sum = 1.0, term = 1.0;
            for (int k = 1; k < 40; ++k) term *= 0.25 * x * x / (k * k), sum += term;
            return sum;
        };
        const auto value_at = [&](std::size_t i) {
            const double u = static_cast<double>(i) / per_step, share = u / reach, angle = std::numbers::pi * u;
            const double window = share < 1.0 ? bessel(7.0 * std::sqrt(1.0 - share * share)) / bessel(7.0) : 0.0;
            return window * (i == 0 ? 1.0 : std::sin(angle) / angle);
        };
        for (std::size_t phase = 0; phase <= per_step; ++phase)
            for (std::size_t k = 0; k < reach; ++k) table_[phase][k] = value_at(phase + k * per_step);
    }

    /// Weights of the values from the returned index on, for a place at least `reach` from both ends.
    std::size_t weights_at(double place, Weights& weights) const {
        const double before = std::floor(place);
        // The values on one side have the same distances but for whole steps.
        const auto side = [&](double distance, std::array<double, reach>& out) {
            const double u = distance * per_step;
            const auto phase = std::min(static_cast<std::size_t>(u), per_step - 1);
            const double share = u - static_cast<double>(phase);
            const std::array<double, reach>&low = table_[phase], &high = table_[phase + 1];
            for (std::size_t k = 0; k < reach; ++k) out[k] = (1.0 - share) * low[k] + share * high[k];
        };
        std::array<double, reach> left, right;
        side(place - before, left);
        side(before + 1.0 - place, right);
        for (std::size_t k = 0; k < reach; ++k) weights[reach - 1 - k] = left[k], weights[reach + k] = right[k];
        return static_cast<std::size_t>(before) + 1 - reach;
    }

private:
    static constexpr std::size_t per_step = 512;
    std::vector<std::array<double, reach>> table_ = std::vector<std::array<double, reach>>(per_step + 1);
};

/// Makes even values fit the uneven samples better than a spline does near half the rate: three steps of conjugate
/// gradients towards the least squares of the band-limited interpolation. More would follow the noise of the times.
void fit_samples(std::span<const double> places, std::span<const double> values, std::vector<double>& even) {
    static const Interpolation interpolation;
    const std::size_t size = even.size();
    // Near the ends the kernel lacks values on one side.
    const auto is_inside = [&](double place) { return place >= 16.0 && place <= static_cast<double>(size) - 17.0; };
    const auto values_at = [&](const std::vector<double>& x, std::vector<double>& out) {
        Interpolation::Weights weights;
        for (std::size_t i = 0; i < places.size(); ++i) {
            out[i] = 0.0;
            if (!is_inside(places[i])) continue;
            const double* const from = x.data() + interpolation.weights_at(places[i], weights);
            std::array<double, 4> sums{};
            for (std::size_t k = 0; k < weights.size(); k += 4)
                for (std::size_t lane = 0; lane < 4; ++lane) sums[lane] += weights[k + lane] * from[k + lane];
            out[i] = (sums[0] + sums[1]) + (sums[2] + sums[3]);
        }
    };
    const auto back = [&](const std::vector<double>& rest) {
        std::vector<double> out(size);
        Interpolation::Weights weights;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            if (rest[i] == 0.0) continue;
            double* const to = out.data() + interpolation.weights_at(places[i], weights);
            for (std::size_t k = 0; k < weights.size(); ++k) to[k] += weights[k] * rest[i];
        }
        return out;
    };
    const auto square = [](const std::vector<double>& x) {
        double sum = 0.0;
        for (const double v : x) sum += v * v;
        return sum;
    };
    std::vector<double> rest(places.size()), moved(places.size());
    values_at(even, moved);
    for (std::size_t i = 0; i < places.size(); ++i) rest[i] = is_inside(places[i]) ? values[i] - moved[i] : 0.0;
    std::vector<double> slope = back(rest), step = slope;
    double steep = square(slope);
    for (int round = 0; round < 3 && steep > 0.0; ++round) {
        values_at(step, moved);
        const double length = square(moved);
        if (!(length > 0.0)) return;
        const double share = steep / length;
        for (std::size_t n = 0; n < size; ++n) even[n] += share * step[n];
        for (std::size_t i = 0; i < places.size(); ++i) rest[i] -= share * moved[i];
        slope = back(rest);
        const double next = square(slope);
        for (std::size_t n = 0; n < size; ++n) step[n] = slope[n] + next / steep * step[n];
        steep = next;
    }
}

std::size_t samples_in(const std::vector<std::vector<double>>& block) {
    return block.empty() ? 0 : block.front().size();
}

/// Samples between two gaps.
struct Piece {
    std::size_t first = 0, end = 0;
    double start = 0.0, length = 0.0;  // s
    std::size_t frames = 0;
};

}  // namespace

struct Regulariser::State {
    TimedSamples samples;
    std::optional<std::vector<TimeLine>> lines;
    EvenFacts facts;
    std::vector<Piece> pieces;
    // Of the next block.
    std::unique_ptr<UsedTimes> cursor;
    std::vector<double> times;  // those used, of the samples from `first` on
    std::size_t first = 0, read = 0;  // samples; `read`: those that the cursor has passed
    std::size_t piece = 0, part = 0;
    // Small records are computed once.
    struct Kept {
        std::vector<std::vector<double>> block;
        bool after_gap;
    };
    static constexpr std::size_t max_kept = std::size_t{1} << 23;  // numbers
    std::vector<Kept> kept;
    std::size_t next_kept = 0;
    bool keeps = false, is_complete = false;
    bool is_even = false;  // the whole record

    const std::vector<TimeLine>* used_lines() const { return lines ? &*lines : nullptr; }

    void examine();
    void deviation_of_steps(double longest);
    bool compute(std::vector<std::vector<double>>& block, bool& after_gap);
    void load_times(std::size_t from, std::size_t to);
};

void Regulariser::State::examine() {
    const std::size_t size = samples.count;
    if (size < 4) throw Error(fmt::format("there are {} samples; a spectrum needs at least 4", size));
    TimeBlocks all(samples);
    const double begin = all[0];
    double last = begin, squares = 0.0;
    facts.shortest_step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < size; ++i) {
        const double time = all[i], step = time - last;
        if (!(step >= 0.0)) throw Error(fmt::format("time runs backwards at sample {}", i + 1));
        facts.shortest_step = std::min(facts.shortest_step, step);
        facts.longest_step = std::max(facts.longest_step, step);
        squares += step * step;
        last = time;
    }
    if (!(last > begin)) throw Error("time stands still: every sample has the same time");
    const double mean = (last - begin) / static_cast<double>(size - 1);
    if (facts.longest_step - facts.shortest_step < max_off * mean) {
        // Nothing to interpolate, no gaps: what follows would find the same, in many passes.
        is_even = true;
        for (std::size_t i = 0; i < size && is_even; ++i)
            is_even = std::abs((all[i] - begin) / mean - static_cast<double>(i)) < max_off;
    }
    if (is_even) {
        facts.rate = 1.0 / mean;
        facts.usable = 0.5 / std::max(facts.longest_step, mean);
        facts.step_deviation = std::sqrt(std::max(0.0, squares / static_cast<double>(size - 1) - mean * mean));
        facts.frames = size;
        pieces.push_back({0, size, begin, last - begin, size});
        keeps = size * samples.channels <= max_kept;
        return;
    }
    facts.longest_step = 0.0;
    const double clock = clock_step(samples, begin, last);
    lines = without_rounding(samples, clock, begin, last);
    // The rate is off by about 1/n² after n steps of the clock: below 32 steps by more than 0.1 %.
    if (const double steps = (last - begin) / clock; lines && steps < 32.0 && static_cast<double>(size) > 8.0 * steps)
        throw Error(fmt::format(
            "the clock counts in steps of {:.3g} s, and {:.0f} of them are too few for the rate of {} samples; "
            "state the rate (--sample-rate)",
            clock, steps, size));
    if (lines && clock >= 0.01 * mean) facts.clock_step = clock;
    const auto for_each_step = [&](const auto& use) {
        UsedTimes used(samples, used_lines());
        double before = used.next();
        for (std::size_t i = 1; i < size; ++i) {
            const double time = used.next();
            use(time - before);
            before = time;
        }
    };
    const double gap = 5.0 * select({(size - 1) / 2}, [&](const auto& use) {
                                 for_each_step([&](double step) { use(std::max(step, 0.0)); });
                             }).front();
    facts.shortest_step = std::numeric_limits<double>::infinity();
    double present = 0.0;
    UsedTimes used(samples, used_lines());
    Piece open{0, 0, used.next(), 0.0, 0};
    double before = open.start;
    const auto close = [&](std::size_t end) {
        open.end = end, open.length = before - open.start;
        // A sum of all steps would gather their rounding.
        present += open.length;
        if (end - open.first >= 4) pieces.push_back(open);
    };
    for (std::size_t i = 1; i < size; ++i) {
        const double time = used.next(), step = time - before;
        facts.shortest_step = std::min(facts.shortest_step, step);
        if (step > gap) {
            ++facts.gaps;
            facts.lost += step;
            close(i);
            open = {i, 0, time, 0.0, 0};
        } else {
            facts.longest_step = std::max(facts.longest_step, step);
        }
        before = time;
    }
    close(size);
    const std::size_t counted = size - 1 - facts.gaps;
    if (!(present > 0.0)) throw Error("time stands still: no two samples follow each other");
    facts.rate = static_cast<double>(counted) / present;
    // One step of each gap is that between any two samples.
    facts.lost = std::max(0.0, facts.lost - static_cast<double>(facts.gaps) / facts.rate);
    const auto rank = static_cast<std::size_t>(0.99 * static_cast<double>(counted - 1));
    const double long_step =
        facts.longest_step - facts.shortest_step > 1e-9 * facts.longest_step
            ? select({rank}, [&](const auto& use) { for_each_step([&](double step) { use(std::max(step, 0.0)); }); })
                  .front()
            : facts.longest_step;
    facts.usable = 0.5 / std::max(long_step, 1.0 / facts.rate);
    deviation_of_steps(facts.longest_step);
    for (Piece& one : pieces) {
        one.frames = static_cast<std::size_t>(std::floor(one.length * facts.rate * (1.0 + 1e-12))) + 1;
        facts.frames += one.frames;
    }
    if (pieces.empty()) throw Error("no four samples follow each other without a gap");
    keeps = facts.frames * samples.channels <= max_kept;
}

void Regulariser::State::deviation_of_steps(double longest) {
    TimeBlocks all(samples);
    double sum = 0.0, squares = 0.0, count = 0.0, before = all[0];
    for (std::size_t i = 1; i < samples.count; ++i) {
        const double time = all[i], step = time - before;
        before = time;
        if (step > longest) continue;
        sum += step, squares += step * step, ++count;
    }
    const double mean = count > 0.0 ? sum / count : 0.0;
    facts.step_deviation = count > 0.0 ? std::sqrt(std::max(0.0, squares / count - mean * mean)) : 0.0;
}

/// Makes `times` those of the samples [from, to). Both ascend from call to call.
void Regulariser::State::load_times(std::size_t from, std::size_t to) {
    if (!cursor) cursor = std::make_unique<UsedTimes>(samples, used_lines());
    if (from >= first + times.size()) times.clear(), first = from;
    else times.erase(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(from - first)), first = from;
    for (; read < to; ++read) {
        const double time = cursor->next();
        if (read >= from) times.push_back(time);
    }
}

bool Regulariser::State::compute(std::vector<std::vector<double>>& block, bool& after_gap) {
    if (piece == pieces.size()) return false;
    leave_if_stopped();
    const Piece& of = pieces[piece];
    const std::size_t size = of.end - of.first, parts = size <= max_at_once ? 1 : size / block_size;
    const std::size_t begin = of.first + part * block_size, end = part + 1 == parts ? of.end : begin + block_size;
    const std::size_t from = std::max(of.first, begin - std::min(begin, overlap)), to = std::min(of.end, end + overlap);
    if (!is_even) load_times(from, to);
    const auto place_of = [&](std::size_t i) { return (times[i - from] - of.start) * facts.rate; };
    bool is_part_even = true;
    for (std::size_t i = from; i < to && is_part_even && !is_even; ++i)
        is_part_even = std::abs(place_of(i) - static_cast<double>(i - of.first)) < max_off;
    // The first frame of a part, the same for the parts before and behind, also if one of them is even.
    const auto frame_at = [&](std::size_t i) {
        return i == of.first ? 0
               : i == of.end
                   ? of.frames
                   : std::min(of.frames, static_cast<std::size_t>(std::ceil(std::max(0.0, place_of(i) - 1e-5))));
    };
    block.resize(samples.channels);
    if (is_part_even && (end != of.end || of.frames == size)) {
        for (std::size_t c = 0; c < samples.channels; ++c) {
            block[c].resize(end - begin);
            samples.values(c, begin, block[c]);
        }
    } else {
        const std::size_t first_frame = frame_at(begin), end_frame = frame_at(end);
        // The grid of the part: from its first frame on, as far as its samples reach.
        const std::size_t grid =
            std::min(first_frame, from == of.first ? 0 : static_cast<std::size_t>(std::ceil(place_of(from))));
        const std::size_t grid_end =
            to == of.end ? of.frames : static_cast<std::size_t>(std::floor(place_of(to - 1))) + 1;
        std::vector<double> places, values(to - from);
        for (std::size_t i = from; i < to; ++i) places.push_back(place_of(i) - static_cast<double>(grid));
        for (std::size_t c = 0; c < samples.channels; ++c) {
            samples.values(c, from, values);
            std::vector<double> out(grid_end - grid);
            const geometry::Spline curve(times, values);
            for (std::size_t n = 0; n < out.size(); ++n)
                out[n] = curve(of.start + static_cast<double>(grid + n) / facts.rate).value;
            fit_samples(places, values, out);
            block[c].assign(out.begin() + static_cast<std::ptrdiff_t>(first_frame - grid),
                            out.begin() + static_cast<std::ptrdiff_t>(end_frame - grid));
        }
    }
    after_gap = part == 0 && piece > 0;
    if (++part == parts) ++piece, part = 0;
    return true;
}

Regulariser::Regulariser(TimedSamples samples) : state_(std::make_unique<State>()) {
    state_->samples = std::move(samples);
    state_->examine();
}
Regulariser::~Regulariser() = default;
Regulariser::Regulariser(Regulariser&&) noexcept = default;
Regulariser& Regulariser::operator=(Regulariser&&) noexcept = default;

const EvenFacts& Regulariser::facts() const noexcept { return state_->facts; }

bool Regulariser::next(std::vector<std::vector<double>>& block, bool& after_gap) {
    State& state = *state_;
    if (state.is_complete) {
        if (state.next_kept == state.kept.size()) return false;
        const State::Kept& kept = state.kept[state.next_kept++];
        block = kept.block, after_gap = kept.after_gap;
        return true;
    }
    // A gap before a part without frames belongs to the next part.
    bool is_after_gap = false;
    do {
        bool gap = false;
        if (!state.compute(block, gap)) {
            state.is_complete = state.keeps;
            state.next_kept = state.kept.size();
            return false;
        }
        is_after_gap = is_after_gap || gap;
    } while (samples_in(block) == 0);
    after_gap = is_after_gap;
    if (state.keeps) state.kept.push_back({block, after_gap});
    return true;
}

void Regulariser::rewind() {
    State& state = *state_;
    state.cursor.reset();
    state.times.clear();
    state.first = state.read = state.piece = state.part = state.next_kept = 0;
    if (!state.is_complete) state.kept.clear();
}

EvenRecord regularise(std::span<const double> times, std::span<const std::vector<double>> channels) {
    const auto copy = [](std::span<const double> from, std::size_t first, std::span<double> out) {
        std::ranges::copy(from.subspan(first, out.size()), out.begin());
    };
    Regulariser source(
        {times.size(), channels.size(), [&](std::size_t first, std::span<double> out) { copy(times, first, out); },
         [&](std::size_t channel, std::size_t first, std::span<double> out) { copy(channels[channel], first, out); }});
    EvenRecord even{source.facts(), {}};
    std::vector<std::vector<double>> block;
    for (bool after_gap = false; source.next(block, after_gap);) {
        if (even.pieces.empty() || after_gap) even.pieces.emplace_back(block.size());
        for (std::size_t c = 0; c < block.size(); ++c)
            even.pieces.back()[c].insert(even.pieces.back()[c].end(), block[c].begin(), block[c].end());
    }
    return even;
}

}  // namespace tactus::signal
