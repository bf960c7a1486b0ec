// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/recording_set.hpp"

#include "assets/file/toml_file.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/sound/saw_model_file.hpp"
#include "assets/sound/sound.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "dsp/signal/spectrum/fundamental.hpp"
#include "dsp/vibration/order_share.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::sound {

namespace {

constexpr double lowest_rate = 5.0, highest_rate = 1000.0;  // Hz
constexpr double usual_load = 7.0;                          // N: typical thrust on a bone saw

const std::array<std::string, 8> set_keys{"title",  "note",       "licence",   "synthesised",
                                          "sensor", "full_scale", "recording", "model"};
const std::array<std::string, 9> recording_keys{"file", "state", "rate",   "load",      "density",
                                                "loop", "note",  "sensor", "full_scale"};
const std::array<std::string, 2> states{"cutting", "free_air"};

/// [begin, end) of the selected part, in samples.
struct Part {
    std::size_t begin, end;
};

Part part_of(const Recording& r) {
    const auto sample = [&](double seconds) { return static_cast<std::size_t>(std::lround(seconds * r.sample_rate)); };
    return {sample(r.loop_begin), r.loop_end > 0.0 ? std::min(sample(r.loop_end), r.samples.size()) : r.samples.size()};
}

/// About the mean, of the selected part.
double rms_of(const Recording& r) {
    const Part part = part_of(r);
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = part.begin; i < part.end; ++i) {
        const auto x = static_cast<double>(r.samples[i]);
        sum += x, squares += x * x;
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, part.end - part.begin));
    return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

void load_samples(Recording& r) {
    const Sound sound = load_sound(r.file);
    r.sample_rate = sound.rate;
    r.samples = mix_to_mono(sound);
    if (!sound.note.empty()) r.file_note = fmt::format("{}: {}", r.file.filename().string(), sound.note);
}

/// Estimates an unstated rate. Throws Error when the sound has no clear rate or is too short.
void settle_rate(Recording& r, const char* how_to_state = "as in rate = \"233 Hz\"") {
    const Part part = part_of(r);
    if (r.rate == 0.0) {
        const auto part_used = std::span(r.samples).subspan(part.begin, part.end - part.begin);
        const signal::FundamentalEstimate heard = signal::find_fundamental(part_used, r.sample_rate);
        if (!heard.is_certain())
            throw Error(fmt::format("no rate of reciprocation was found in '{}'; state it, {}",
                                    r.file.filename().string(), how_to_state));
        r.rate = heard.frequency;
        r.rate_estimated = true;
    }
    const double cycles = static_cast<double>(part.end - part.begin) / r.sample_rate * r.rate;
    if (cycles < static_cast<double>(vibration::CycleLoop::fewest_cycles))
        throw Error(fmt::format("'{}' has only {:.1f} cycles at {:.4g} Hz; {} are needed", r.file.filename().string(),
                                cycles, r.rate, vibration::CycleLoop::fewest_cycles));
}

class SetReader {
public:
    explicit SetReader(const std::filesystem::path& path) : path_(path) {}

    RecordingSet read() {
        const file::TomlTable parsed = file::parse_toml(file::read_whole_file(path_), path_.string());
        const toml::table& root = *parsed;
        check_keys(root, set_keys, "a recording set");
        RecordingSet set;
        set.path = path_;
        set.title = text_of(root, "title");
        set.note = text_of(root, "note");
        set.licence = text_of(root, "licence");
        if (const toml::node* flag = root.get("synthesised")) {
            if (!flag->is_boolean()) throw Error(location(flag->source()), "'synthesised' must be true or false");
            set.synthesised = flag->as_boolean()->get();
        }
        sensor_ = text_of(root, "sensor");
        if (const toml::node* value = root.get("full_scale")) full_scale_ = full_scale(*value);
        const toml::node* list = root.get("recording");
        if (const toml::node* model = root.get("model")) {
            if (list) throw Error(location(list->source()), "a file holds recordings or a model, not both");
            if (!model->is_table()) throw Error(location(model->source()), "'model' must be a table: [model]");
            SawModelTable table = read_saw_model(*model->as_table(), path_.string());
            set.model = std::move(table.model);
            set.model_calibrated = table.calibrated;
            return set;
        }
        if (!list) throw Error({path_.string(), 1, 1}, "the set has no recording; start each with [[recording]]");
        const toml::array* items = list->as_array();
        if (!items) throw Error(location(list->source()), "a recording begins with [[recording]], in two brackets");
        if (items->empty()) throw Error(location(list->source()), "the set has no recording");
        if (items->size() > vibration::SawVoice::max_recordings)
            throw Error(location(list->source()), fmt::format("a set has at most {} recordings, not {}",
                                                              vibration::SawVoice::max_recordings, items->size()));
        for (const toml::node& item : *items) {
            set.recordings.push_back(recording(item));
            if (set.recordings.back().full_scale.has_value() != set.calibrated())
                throw Error(
                    location(item.source()),
                    "some recordings are calibrated (full_scale) and some are not: their levels cannot be compared");
        }
        return set;
    }

private:
    SourceLocation location(const toml::source_region& region) const {
        return {path_.string(), static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
    }

    template <std::size_t N>
    void check_keys(const toml::table& table, const std::array<std::string, N>& known, std::string_view what) const {
        for (const auto& [key, value] : table)
            if (std::find(known.begin(), known.end(), key.str()) == known.end())
                throw Error(location(key.source()),
                            fmt::format("unknown key '{}' in {}{}", key.str(), what, did_you_mean(key.str(), known)));
    }

    std::string text(const toml::node& value, std::string_view key) const {
        if (const auto* found = value.as_string()) return found->get();
        throw Error(location(value.source()), fmt::format("'{}' must be a text in quotes", key));
    }
    std::string text_of(const toml::table& table, std::string_view key) const {
        const toml::node* value = table.get(key);
        return value ? text(*value, key) : std::string{};
    }

    double quantity(const toml::node& value, std::string_view key, std::string_view unit) const {
        try {
            return parse_as(text(value, key), unit);
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
            throw Error(location(value.source()), fmt::format("'{}': {}", key, error.message()));
        }
    }

    std::optional<double> full_scale(const toml::node& value) const {
        if (const auto* word = value.as_string(); word && word->get() == "uncalibrated") return std::nullopt;
        const double found = quantity(value, "full_scale", "m/s^2");
        if (std::isfinite(found) && found > 0.0) return found;
        throw Error(location(value.source()), "'full_scale' must be above 0 m/s^2, or \"uncalibrated\"");
    }

    Recording recording(const toml::node& item) const {
        const toml::table* table = item.as_table();
        if (!table) throw Error(location(item.source()), "a recording begins with [[recording]], in two brackets");
        check_keys(*table, recording_keys, "a recording");
        Recording r;
        const toml::node *file = table->get("file"), *state = table->get("state");
        if (!file) throw Error(location(item.source()), "the recording has no file = \"…\"");
        if (!state)
            throw Error(location(item.source()), "the recording has no state; write \"cutting\" or \"free_air\"");
        r.file = path_.parent_path() / text(*file, "file");
        const std::string word = text(*state, "state");
        if (std::find(states.begin(), states.end(), word) == states.end())
            throw Error(location(state->source()),
                        fmt::format("unknown state '{}'; use cutting or free_air{}", word, did_you_mean(word, states)));
        r.cutting = word == "cutting";
        r.note = text_of(*table, "note");
        r.sensor = table->contains("sensor") ? text_of(*table, "sensor") : sensor_;
        const toml::node* own_scale = table->get("full_scale");
        r.full_scale = own_scale ? full_scale(*own_scale) : full_scale_;
        const toml::node* rate = table->get("rate");
        if (rate) r.rate = quantity(*rate, "rate", "Hz");
        if (rate && !(r.rate >= lowest_rate && r.rate <= highest_rate))
            throw Error(location(rate->source()), "'rate' must be 5 Hz to 1 kHz");
        load(*table, item, r);
        if (const toml::node* density = table->get("density")) {
            if (!r.cutting) throw Error(location(density->source()), "in free air there is no bone; remove 'density'");
            r.density = quantity(*density, "density", "kg/m^3");
            if (!(r.density >= 1.0 && r.density <= 1e4))
                throw Error(location(density->source()), "'density' must be 1 to 10000 kg/m^3");
        }
        try {
            load_samples(r);
        } catch (const Error& error) {
            throw Error(location(file->source()), error.message());
        }
        if (const toml::node* bounds = table->get("loop")) loop(*bounds, r);
        try {
            settle_rate(r);
        } catch (const Error& error) {
            throw Error(location((rate ? *rate : item).source()), error.message());
        }
        return r;
    }

    void load(const toml::table& table, const toml::node& item, Recording& r) const {
        const toml::node* value = table.get("load");
        if (!value && !r.cutting) return;
        if (!value) throw Error(location(item.source()), "a cutting recording needs its load, such as load = \"7 N\"");
        if (!r.cutting) throw Error(location(value->source()), "in free air there is no load; remove it");
        r.load = quantity(*value, "load", "N");
        if (!(std::isfinite(r.load) && r.load > 0.0))
            throw Error(location(value->source()), "'load' must be above 0 N");
    }

    void loop(const toml::node& value, Recording& r) const {
        const toml::array* bounds = value.as_array();
        if (!bounds || bounds->size() != 2)
            throw Error(location(value.source()), "'loop' must be begin and end: loop = [\"0.1 s\", \"2.4 s\"]");
        r.loop_begin = quantity(*bounds->get(0), "loop", "s");
        r.loop_end = quantity(*bounds->get(1), "loop", "s");
        const double length = static_cast<double>(r.samples.size()) / r.sample_rate;
        if (!(r.loop_begin >= 0.0 && r.loop_end > r.loop_begin && r.loop_end <= length))
            throw Error(location(value.source()),
                        fmt::format("'loop' must begin at 0 s or later and end after that, within the {:.4g} s of '{}'",
                                    length, r.file.filename().string()));
    }

    std::filesystem::path path_;
    std::string sensor_;
    std::optional<double> full_scale_;
};

}  // namespace

void cut(Recording& r, const Stretch& stretch) {
    if (stretch.is_whole()) return;
    const double length = static_cast<double>(r.samples.size()) / r.sample_rate;
    const ReadStretch wanted = stretch_within(stretch, length, r.sample_rate, r.file);
    const double end = r.loop_end > 0.0 ? r.loop_end : length;
    if (wanted.to <= r.loop_begin || wanted.from >= end)
        throw Error(fmt::format("{}: {} lies outside of its loop, {:.4g} to {:.4g} s", r.file.string(), wanted.text(),
                                r.loop_begin, end));
    r.loop_begin = std::max(r.loop_begin, wanted.from);
    r.loop_end = std::min(end, wanted.to);
    settle_rate(r);
}

namespace {

struct RatedName {
    std::filesystem::path file;
    std::optional<double> rate;  // Hz
};

/// "my-saw.wav#233 Hz"
RatedName split(const std::filesystem::path& path) {
    const std::string text = path.string();
    const std::size_t mark = text.rfind('#');
    std::error_code ignored;
    if (mark == std::string::npos || std::filesystem::exists(path, ignored)) return {path, {}};
    try {
        return {text.substr(0, mark), parse_as(text.substr(mark + 1), "Hz")};
    } catch (const Error& error) {
        throw Error(
            fmt::format("{}: what follows '#' is the rate of the saw, as in #233 Hz: {}", text, error.message()));
    }
}

}  // namespace

bool is_plain_sound(const RecordingSet& set) {
    return !set.model && set.path.extension() != ".toml" && !set.recordings.empty();
}

std::string saw_question(const RecordingSet& set) {
    if (!is_plain_sound(set)) return {};
    const Recording& r = set.recordings.front();
    if (r.order_share >= min_order_share) return {};
    return fmt::format(
        "is {} the sound of a saw? Only {:.0f} % of its power lies in multiples of {:.4g} Hz{}; of saws it is 18 % or "
        "more. It is played all the same",
        r.file.filename().string(), 100.0 * r.order_share, r.rate,
        r.rate_estimated ? ", the rate that was estimated" : "");
}

RecordingSet load_recording_set(const std::filesystem::path& name, std::optional<double> given_rate) {
    const RatedName parts = given_rate ? RatedName{name, given_rate} : split(name);
    const std::filesystem::path& path = parts.file;
    const std::optional<double> rate = parts.rate;
    if (rate && !(*rate >= lowest_rate && *rate <= highest_rate))
        throw Error(fmt::format("{}: the rate of a saw must be 5 Hz to 1 kHz", path.string()));
    if (path.extension() == ".toml") {
        if (rate)
            throw Error(fmt::format("{}: a recording set states its own rates; leave out the rate", path.string()));
        return SetReader(path).read();
    }
    Recording r;
    r.file = path;
    r.cutting = true;
    r.load = usual_load;
    r.rate = rate.value_or(0.0);
    load_samples(r);
    try {
        settle_rate(r, "by --rate \"233 Hz\", or as in my-saw.wav#233 Hz");
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", path.string(), error.message()));
    }
    r.order_share = vibration::order_share(r.samples, r.sample_rate, r.rate);
    RecordingSet set;
    set.path = path;
    set.title = path.stem().string();
    set.recordings.push_back(std::move(r));
    return set;
}

vibration::SawRecording saw_recording(const Recording& r) {
    const Part part = part_of(r);
    return {r.samples, static_cast<double>(r.sample_rate), r.rate,     r.load,
            r.cutting, r.full_scale.value_or(1.0),         part.begin, part.end,
            r.density};
}

std::vector<vibration::SawRecording> saw_recordings(const RecordingSet& set) {
    std::vector<vibration::SawRecording> out;
    double strongest = 0.0;
    for (const Recording& r : set.recordings) strongest = std::max(strongest, rms_of(r));
    const double normalised = strongest > 0.0 ? assumed_vibration / strongest : 1.0;
    for (const Recording& r : set.recordings) {
        out.push_back(saw_recording(r));
        if (!r.full_scale) out.back().gain = normalised;
    }
    return out;
}

}  // namespace tactus::sound
