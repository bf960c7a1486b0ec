// SPDX-License-Identifier: Apache-2.0
#include "dsp/vibration/saw_sounds.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace tactus::vibration {

namespace {

constexpr double stand_in_level = 0.25;  // −12 dB: cutting conditions used as free air
constexpr double same_rate = 1.03, same_density = 1.03;  // ratios that count as equal

/// The last element whose value is at most `value`, and the share of the next one; the ends outside of the range.
struct Place {
    std::size_t below, above;
    double share;
};

template <class Range, class Value>
Place place_in(const Range& sorted, Value value_of, double value) noexcept {
    std::size_t above = 0;
    while (above < sorted.size() && std::invoke(value_of, sorted[above]) < value) ++above;
    if (above == 0) return {0, 0, 0.0};
    if (above == sorted.size()) return {above - 1, above - 1, 0.0};
    const double low = std::invoke(value_of, sorted[above - 1]), high = std::invoke(value_of, sorted[above]);
    return {above - 1, above, (value - low) / (high - low)};
}

template <class List, class Value>
auto& entry(List& list, Value value_of, double value, double same) {
    for (auto& item : list)
        if (std::max(std::invoke(value_of, item), value) <= same * std::min(std::invoke(value_of, item), value))
            return item;
    const auto place = std::ranges::lower_bound(list, value, {}, value_of);
    return *list.insert(place, {value, {}});
}

}  // namespace

SawSounds::SawSounds(const SawModel& model) {
    if (model.conditions.empty()) throw Error("the model of a saw needs at least one condition");
    if (model.conditions.size() > SawModel::max_conditions)
        throw Error(fmt::format("the model of a saw has at most {} conditions, not {}", SawModel::max_conditions,
                                model.conditions.size()));
    for (const SawCondition& condition : model.conditions) {
        add(condition.cutting, condition, 1.0);
        recorded_[condition.cutting] = true;
    }
    for (const bool missing : {false, true}) {
        if (recorded_[missing]) continue;
        for (const SawCondition& condition : model.conditions) add(missing, condition, missing ? 1.0 : stand_in_level);
    }
    if (!recorded_[false] || !recorded_[true]) return;
    for (Speed& speed : speeds_[true])
        for (Bone& bone : speed.bones)
            if (bone.points.front().load > 0.0)
                bone.points.insert(bone.points.begin(), {0.0, at(false, speed.rate, 0.0, 0.0)});
}

void SawSounds::add(bool cutting, const SawCondition& condition, double gain) {
    SawSound sound = condition.sound;
    for (double& level : sound.orders) level *= gain;
    sound.residual *= gain;
    Speed& speed = entry(speeds_[cutting], &Speed::rate, condition.rate, same_rate);
    Bone& bone = entry(speed.bones, &Bone::density, condition.density, same_density);
    const auto place = std::ranges::lower_bound(bone.points, condition.load, {}, &Point::load);
    // Of two recordings of one condition, the mean.
    if (place != bone.points.end() && place->load == condition.load) place->sound = blend(place->sound, sound, 0.5);
    else bone.points.insert(place, {condition.load, sound});
}

bool SawSounds::covers(const Speed& speed, double load, double density) noexcept {
    const auto within = [load](const Bone& bone) {
        return bone.points.front().load <= load && load <= bone.points.back().load;
    };
    const auto& bones = speed.bones;
    if (density > 0.0 && !(bones.front().density <= density && density <= bones.back().density)) return false;
    return std::ranges::all_of(bones, within);
}

bool SawSounds::covers(bool cutting, double rate, double load, double density) const noexcept {
    const auto& speeds = speeds_[cutting];
    if (rate > same_rate * speeds.back().rate || same_rate * rate < speeds.front().rate) return false;
    const Place place = place_in(speeds, &Speed::rate, rate);
    return covers(speeds[place.below], load, density) && covers(speeds[place.above], load, density);
}

SawSound SawSounds::blend(const SawSound& a, const SawSound& b, double x) noexcept {
    SawSound out;
    const auto mix = [](double share, const auto& from, const auto& to, auto& result) {
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = from[i] + share * (to[i] - from[i]);
    };
    mix(x, a.orders, b.orders, out.orders);
    out.residual = a.residual + x * (b.residual - a.residual);
    // Weight the shapes by level, because the shape of a faint residual is unreliable.
    const double shape = out.residual > 0.0 ? x * b.residual / out.residual : x;
    mix(shape, a.lines, b.lines, out.lines);
    mix(shape, a.swell_cos, b.swell_cos, out.swell_cos);
    mix(shape, a.swell_sin, b.swell_sin, out.swell_sin);
    return out;
}

SawSound SawSounds::at_load(const Bone& bone, double load) noexcept {
    const Place place = place_in(bone.points, &Point::load, load);
    if (place.below == place.above) return bone.points[place.below].sound;
    return blend(bone.points[place.below].sound, bone.points[place.above].sound, place.share);
}

SawSound SawSounds::at_speed(const Speed& speed, double rate, double load, double density) noexcept {
    double sought = density;
    if (!(density > 0.0)) sought = 0.5 * (speed.bones.front().density + speed.bones.back().density);
    const Place place = place_in(speed.bones, &Bone::density, sought);
    SawSound sound = at_load(speed.bones[place.below], load);
    if (place.below != place.above) sound = blend(sound, at_load(speed.bones[place.above], load), place.share);
    const double scale = rate / speed.rate;
    for (double& level : sound.orders) level *= scale * scale;
    sound.residual *= scale;
    return sound;
}

SawSound SawSounds::at(bool cutting, double rate, double load, double density) const noexcept {
    const auto& speeds = speeds_[cutting];
    const double played = std::clamp(rate, 0.0, speeds.back().rate);
    const auto log_rate = [](const Speed& speed) { return std::log(speed.rate); };
    const Place place = place_in(speeds, log_rate, std::log(std::max(played, 1e-3)));
    const SawSound below = at_speed(speeds[place.below], played, load, density);
    if (place.below == place.above) return below;
    return blend(below, at_speed(speeds[place.above], played, load, density), place.share);
}

}  // namespace tactus::vibration
