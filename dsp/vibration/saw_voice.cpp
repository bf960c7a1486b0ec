// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/saw_voice.hpp"

#include "dsp/core/error.hpp"
#include "dsp/vibration/refine_rate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::vibration {

namespace {

constexpr double free_air_level = 0.25;  // −12 dB: cutting recordings used as free air
constexpr double one_rate = 1.03;  // recorded rates within this ratio count as one rate

double ratio(double a, double b) noexcept { return a > b ? a / b : b / a; }

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

void SawVoice::prepare(double rate, std::span<const SawRecording> recordings, const SawBehaviour& behaviour) {
    if (!positive(rate)) throw Error("the sample rate of a saw must be above 0 Hz");
    if (recordings.empty()) throw Error("a saw needs at least one recording");
    if (recordings.size() > max_recordings)
        throw Error(fmt::format("a saw takes at most {} recordings, not {}", max_recordings, recordings.size()));
    *this = SawVoice{};
    behaviour_ = behaviour;
    blade_ = BladeMotion(rate, behaviour);
    fade_step_ = behaviour.fade_time * rate > 1.0 ? 1.0 / (behaviour.fade_time * rate) : 1.0;
    bool any[2] = {false, false};
    for (const SawRecording& recording : recordings) {
        const auto part = recording.part();
        const double exact = refine_rate(part, recording.sample_rate, recording.reciprocation_rate, 0.02);
        loops_.emplace_back(part, recording.sample_rate, exact, rate, BladeMotion::greatest_rate / exact);
        loops_.back().align(loops_.front());
        layers_.push_back({loops_.size() - 1, exact, recording.load, recording.gain, recording.cutting});
        any[recording.cutting] = true;
    }
    for (const bool cutting : {false, true}) {
        if (any[cutting]) continue;
        for (std::size_t i = 0, count = layers_.size(); i < count && count <= max_recordings; ++i) {
            if (layers_[i].cutting == cutting) break;
            Layer stand_in = layers_[i];
            stand_in.cutting = cutting;
            if (!cutting) stand_in.amplitude *= free_air_level;
            layers_.push_back(stand_in);
        }
    }
    for (const CycleLoop& a : loops_)
        for (const CycleLoop& b : loops_) likeness_.push_back(&a == &b ? 1.0 : likeness(a, b));
    lowest_recorded_ = layers_.front().rate;
    for (Layer& layer : layers_) {
        lowest_recorded_ = std::min(lowest_recorded_, layer.rate);
        layer.level = std::abs(layer.amplitude) * std::sqrt(loops_[layer.loop].power());
    }
    make_groups();
}

void SawVoice::make_groups() {
    for (const bool cutting : {false, true}) {
        auto& groups = groups_[cutting];
        for (const Layer& layer : layers_)
            if (layer.cutting == cutting) groups.push_back({layer.rate, 0.0, {}});
        std::sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.rate < b.rate; });
        groups.erase(
            std::unique(groups.begin(), groups.end(), [](const Group& a, const Group& b) { return a.rate == b.rate; }),
            groups.end());
        for (std::size_t i = 0; i < groups.size(); ++i) {
            if (i + 1 < groups.size()) groups[i].border = groups[i].rate * groups[i + 1].rate;
            for (std::size_t k = 0; k < layers_.size(); ++k)
                if (layers_[k].cutting == cutting && ratio(layers_[k].rate, groups[i].rate) <= one_rate)
                    groups[i].layers.push_back(k);
        }
    }
}

const SawVoice::Group& SawVoice::choose_group() noexcept {
    const auto& groups = groups_[blade_.loaded()];
    std::ptrdiff_t& playing = playing_[blade_.loaded()];
    std::size_t nearest = 0;
    while (nearest + 1 < groups.size() && blade_.rate() * blade_.rate() > groups[nearest].border) ++nearest;
    if (playing < 0) playing = static_cast<std::ptrdiff_t>(nearest);
    const Group &kept = groups[static_cast<std::size_t>(playing)], &near = groups[nearest];
    if (&kept == &near) return kept;
    const auto too_far = [&](const Group& group) {
        return std::abs(blade_.rate() / group.rate - 1.0) > greatest_pitch_change;
    };
    const bool nearer = ratio(blade_.rate(), kept.rate) > 1.02 * ratio(blade_.rate(), near.rate);
    if (!nearer && !(too_far(kept) && !too_far(near))) return kept;
    playing = static_cast<std::ptrdiff_t>(nearest);
    return near;
}

void SawVoice::aim(Layer& layer, double share) noexcept {
    layer.target += share;
    const auto index = static_cast<std::size_t>(&layer - layers_.data());
    std::size_t* const end = active_.data() + active_count_;
    std::size_t* const place = std::lower_bound(active_.data(), end, index);
    if (place != end && *place == index) return;
    std::move_backward(place, end, end + 1);
    *place = index;
    ++active_count_;
}

void SawVoice::choose_layers(double load) noexcept {
    for (const std::size_t i : active()) layers_[i].target = 0.0;
    // `below` and `above` are the recorded loads on both sides of this one; equal outside the recorded range.
    Layer *below = nullptr, *above = nullptr;
    for (const std::size_t i : choose_group().layers) {
        Layer& layer = layers_[i];
        if (layer.load <= load && (!below || layer.load > below->load)) below = &layer;
        if (layer.load >= load && (!above || layer.load < above->load)) above = &layer;
    }
    if (!below) below = above;
    if (!above) above = below;
    const double span = above->load - below->load;
    const double x = span > 0.0 ? (load - below->load) / span : 0.0;
    aim(*below, 1.0 - x);
    if (x > 0.0) aim(*above, x);
}

double SawVoice::sample(const Layer& layer) const noexcept {
    return loops_[layer.loop](blade_.cycles(), blade_.rate() / layer.rate);
}

double SawVoice::mix() noexcept {
    for (const std::size_t i : active()) {
        Layer& layer = layers_[i];
        layer.weight += std::clamp(layer.target - layer.weight, -fade_step_, fade_step_);
    }
    const auto silent = [&](std::size_t i) { return layers_[i].weight <= 0.0 && layers_[i].target <= 0.0; };
    std::size_t* const end = active_.data() + active_count_;
    active_count_ = static_cast<std::size_t>(std::remove_if(active_.data(), end, silent) - active_.data());
    if (active_count_ == 1) {
        // A single layer plays at its own level, whatever its weight.
        const Layer& alone = layers_[active_.front()];
        return alone.weight > 0.0 ? alone.amplitude * sample(alone) : 0.0;
    }
    double sum = 0.0, weights = 0.0, wanted = 0.0, got = 0.0;
    const std::size_t count = loops_.size();
    for (std::size_t i = 0; i < active_count_; ++i) {
        const Layer& a = layers_[active_[i]];
        if (a.weight <= 0.0) continue;
        sum += a.weight * a.amplitude * sample(a);
        weights += a.weight;
        const double share = a.weight * a.level;
        wanted += share * a.level;
        got += share * share;
        for (std::size_t j = 0; j < i; ++j) {
            const Layer& b = layers_[active_[j]];
            got += 2.0 * share * b.weight * b.level * likeness_[a.loop * count + b.loop];
        }
    }
    if (!(weights > 0.0) || !(got > 0.0)) return 0.0;
    return sum * std::sqrt(wanted / (weights * got));
}

float SawVoice::tick(double load, bool trigger, double commanded_rate, std::optional<bool> contact) noexcept {
    const double thrust = std::isfinite(load) ? load : 0.0;
    blade_.command(thrust, trigger, commanded_rate, contact);
    if (!running()) return 0.0f;
    choose_layers(thrust);
    const double slow = std::min(1.0, blade_.rate() / lowest_recorded_);
    const double y = behaviour_.gain * slow * slow * mix();
    blade_.advance();
    return static_cast<float>(y);
}

int SawVoice::loudest_recording() const {
    if (!running()) return -1;
    const auto loudest = std::max_element(layers_.begin(), layers_.end(),
                                          [](const Layer& a, const Layer& b) { return a.weight < b.weight; });
    return loudest == layers_.end() ? -1 : static_cast<int>(loudest->loop);
}

}  // namespace tactus::vibration
