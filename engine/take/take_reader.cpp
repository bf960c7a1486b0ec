// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_reader.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "graph/plugin/plugins.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <charconv>
#include <fstream>
#include <set>

namespace tactus::take {

using ParsedJson = nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::uint64_t bits_of(const ParsedJson& json) {
    const auto& text = json.get_ref<const std::string&>();
    std::uint64_t bits = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), bits, 16);
    if (failure != std::errc{} || end != text.data() + text.size()) throw Error("a number is damaged");
    return bits;
}

double number_of(const ParsedJson& json) { return std::bit_cast<double>(bits_of(json)); }

void read_assets(const ParsedJson& list, std::vector<TakenAsset>& assets) {
    for (const ParsedJson& asset : list) {
        TakenAsset taken{asset.at("name"), asset.at("path").get<std::string>(), bits_of(asset.at("hash"))};
        const bool known = std::ranges::any_of(
            assets, [&](const TakenAsset& a) { return a.path == taken.path && a.hash == taken.hash; });
        if (!known) assets.push_back(std::move(taken));
    }
}

io::RecordedDevice read_device(const ParsedJson& json) {
    io::RecordedDevice device;
    device.name = json.at("device");
    const ParsedJson& info = json.at("info");
    device.info = {.name = info.at("name"),
                   .max_force = info.at("max_force"),
                   .max_torque = info.at("max_torque"),
                   .damping = info.at("damping"),
                   .max_stiffness = info.at("max_stiffness"),
                   // Takes of earlier versions do not hold these three, nor whether a device has motors.
                   .resolution = info.value("resolution", 0.0),
                   .angular_resolution = info.value("angular_resolution", 0.0),
                   .delay = info.value("delay", 0.0),
                   .actuates_torque = info.at("actuates_torque"),
                   .senses_rotation = info.at("senses_rotation"),
                   .without_motors = info.value("without_motors", false),
                   .fingers = info.at("fingers"),
                   .max_speed = info.at("max_speed"),
                   .least_speed = info.at("least_speed")};
    const ParsedJson& first = json.at("first");
    device.first.buttons = first.at("buttons");
    device.first.counter = first.at("counter");
    device.first.valid = first.at("valid");
    const ParsedJson& n = first.at("numbers");
    const auto v = [&n](std::size_t i) { return number_of(n.at(i)); };
    device.first.pose = {Vec3(v(0), v(1), v(2)), Quat(v(3), v(4), v(5), v(6))};
    device.first.twist = {Vec3(v(7), v(8), v(9)), Vec3(v(10), v(11), v(12))};
    for (std::size_t i = 0; i < max_fingers; ++i) {
        const ParsedJson& finger = first.at("fingers").at(i);
        device.first.fingers[i] = {number_of(finger.at(0)), number_of(finger.at(1)), finger.at(2)};
    }
    return device;
}

/// One output of a file, whose channels begin at `channel`.
TakeStreamInfo read_output(const ParsedJson& file, const ParsedJson& output, int channel) {
    TakeStreamInfo info;
    info.file = file.at("stream");
    info.port = output.at("port");
    info.group = file.at("group");
    info.group_number = file.at("group_number");
    info.type = output.at("type");
    info.period = file.at("period_flicks");
    info.start = file.at("start");
    info.channel = channel;
    info.channels = static_cast<int>(std::min<std::size_t>(output.at("channels").size(), max_channels));
    if (!info.file.starts_with("streams/") || info.file.find("..") != std::string::npos)
        throw Error(fmt::format("'{}' is no stream of the take", info.file));
    if (info.period < 1 || info.start < 0)
        throw Error(fmt::format("the stream of {} has no period, or begins before the run", info.port));
    if (info.channels < 1 || info.channel + info.channels > max_channels)
        throw Error(fmt::format("the stream of {} has no channels, or more than a file holds", info.port));
    return info;
}

void read_streams(const ParsedJson& json, std::vector<TakeStreamInfo>& streams) {
    // Format 2: a file for each output.
    if (!json.contains("outputs")) return streams.push_back(read_output(json, json, 0));
    int channel = 0;
    for (const ParsedJson& output : json.at("outputs")) {
        streams.push_back(read_output(json, output, channel));
        channel += streams.back().channels;
    }
}

void read_event(const ParsedJson& json, Take& take) {
    if (json.contains("device")) take.devices.push_back(read_device(json));
    else if (json.contains("stream")) read_streams(json, take.streams);
    else if (json.contains("values_end_s")) {
        // One line for each output that ends earlier than those before.
        const double end = json.at("values_end_s");
        take.values_end_s = std::min(take.values_end_s.value_or(end), end);
    } else if (json.contains("plan")) {
        TakenEdit edit;
        edit.number = json.at("plan");
        edit.when = json.at("when_flicks");
        edit.text = file::read_whole_file(take.folder / fmt::format("patch-{}.toml", edit.number));
        read_assets(json.at("assets"), take.assets);
        take.events.emplace_back(std::move(edit));
    } else if (json.contains("set")) {
        take.events.emplace_back(
            TakenChange{json.at("set"), json.at("node"), json.at("param"), number_of(json.at("bits"))});
    }
}

}  // namespace

Take Take::load(const fs::path& folder) {
    Take take;
    take.folder = folder;
    if (!fs::exists(folder / "take.json"))
        throw Error(fmt::format("{}: not a take; make one with 'tactus run PATCH --record TAKE'", folder.string()));
    fs::path reading = folder / "take.json";
    int line_number = 0;
    try {
        const ParsedJson json = ParsedJson::parse(file::read_whole_file(reading));
        if (json.at("format") != take_format && json.at("format") != oldest_take_format)
            throw Error(
                fmt::format("it has format {}, and this tactus reads formats {} and {}; replay it with the build that "
                            "made it, or record it again",
                            json.at("format").dump(), oldest_take_format, take_format));
        take.about.patch_file = json.at("patch").get<std::string>();
        take.about.overrides.settings = json.at("settings");
        take.about.overrides.assets = json.at("asset_overrides");
        take.about.seconds = json.at("seconds");
        take.about.live = json.at("live");
        if (json.contains("seed")) take.about.seed = json.at("seed").get<std::uint64_t>();
        take.title = json.at("title");
        take.build = json.at("build");
        take.cpu = json.at("cpu");
        read_assets(json.at("assets"), take.assets);
        if (json.contains("plugins"))
            for (const ParsedJson& plugin : json.at("plugins"))
                take.plugins.push_back(
                    {plugin.at("name"), plugin.at("path").get<std::string>(), bits_of(plugin.at("hash"))});
        take.text = file::read_whole_file(folder / "patch-0.toml");

        reading = folder / "events.jsonl";
        file::require_file(reading);
        std::ifstream events(reading);  // a line at a time: a long run sets parameters millions of times
        for (std::string line; std::getline(events, line);) {
            ++line_number;
            // The last line may have been cut off; result.json has the expected number of lines.
            if (events.eof() && !ParsedJson::accept(line)) break;
            read_event(ParsedJson::parse(line), take);
            ++take.lines;
        }
        line_number = 0;
        reading = folder / "result.json";
        if (fs::exists(reading)) {
            const ParsedJson result = ParsedJson::parse(file::read_whole_file(reading));
            for (const auto& [port, hash] : result.at("ports").items()) take.result[port] = bits_of(hash);
            for (const auto& [file, count] : result.at("holds").items()) take.written[file] = count.get<std::int64_t>();
            take.is_complete = true;
        }
    } catch (const nlohmann::json::exception& error) {
        throw Error({reading.string(), line_number, 0}, fmt::format("the take is damaged: {}", error.what()));
    } catch (const Error& error) {
        if (error.message().find(folder.string()) != std::string::npos) throw;
        throw Error({reading.string(), line_number, 0}, fmt::format("the take cannot be used: {}", error.message()));
    }
    take.log = TimingLog::load(folder / "timing.log", true);
    return take;
}

std::vector<std::string> Take::differences() const {
    std::vector<std::string> found;
    if (build != build_identity())
        found.push_back(fmt::format("the take was made by another build ({}, this is {})", build, build_identity()));
    if (cpu != cpu_family())
        found.push_back(
            fmt::format("the take was made on another kind of processor ({}, this is {})", cpu, cpu_family()));
    for (const TakenPlugin& taken : plugins) {
        const plugin::Plugin* now = nullptr;  // of that name; of several the one with that content
        for (const plugin::Plugin& loaded : plugin::all())
            if (loaded.name == taken.name && (!now || loaded.hash == taken.hash)) now = &loaded;
        if (!now)
            found.push_back(
                fmt::format("the take was made with the plug-in '{}' ({}), which is not loaded; give it by --nodes",
                            taken.name, taken.path.string()));
        else if (now->hash != taken.hash)
            found.push_back(fmt::format("the plug-in '{}' has changed since the take was made: {}", taken.name,
                                        now->file.string()));
    }
    return found;
}

std::vector<std::string> Take::changed_assets() const {
    std::vector<std::string> found;
    for (const TakenAsset& asset : assets) {
        if (asset.hash == 0) continue;
        if (!fs::exists(bone::file_of_bone(asset.path)))
            found.push_back(fmt::format("asset '{}' is gone: {}", asset.name, asset.path.string()));
        else if (hash_of_asset(asset.path) != asset.hash)
            found.push_back(fmt::format("asset '{}' has changed since: {}", asset.name, asset.path.string()));
    }
    return found;
}

namespace {

/// Frames of each file of the streams; those that cannot be read are missing.
std::map<std::string, std::int64_t> frames_of_files(const fs::path& folder,
                                                    const std::vector<TakeStreamInfo>& streams) {
    std::map<std::string, std::int64_t> frames;
    std::set<std::string> unreadable;
    for (const TakeStreamInfo& stream : streams) {
        if (frames.contains(stream.file) || unreadable.contains(stream.file)) continue;
        try {
            frames[stream.file] = TakeStreamReader(folder / stream.file, stream).frames();
        } catch (const Error&) {
            unreadable.insert(stream.file);
        }
    }
    return frames;
}

}  // namespace

std::vector<TakeDamage> Take::damages() const {
    std::vector<TakeDamage> found;
    const auto compare = [&](const std::string& file, std::int64_t holds, const char* unit) {
        const auto known = written.find(file);
        const std::int64_t count = known == written.end() ? 0 : known->second;
        if (holds != count) found.push_back({file, holds, count, unit});
    };
    if (is_complete) {
        compare("timing.log", log.records, "records");
        compare("events.jsonl", lines, "lines");
        auto frames = frames_of_files(folder, streams);
        for (const TakeStreamInfo& stream : streams) frames.try_emplace(stream.file, 0);
        for (const auto& [file, count] : frames) compare(file, count, "values");
    }
    if (found.empty() && log.written && !log.is_whole)
        found.push_back({"timing.log", log.records, *log.written, "records"});
    return found;
}

void Take::require_values() const {
    if (streams.empty())
        throw Error(fmt::format("{0}: the take has no values; write it with values by 'tactus replay {0} --record NEW'",
                                folder.string()));
    if (values_end_s)
        throw Error(
            fmt::format("{0}: the values end at {1:.4g} s, before the run; write all of them by 'tactus replay {0} "
                        "--record NEW'",
                        folder.string(), *values_end_s));
}

void Take::drop_unreadable_streams() {
    const auto frames = frames_of_files(folder, streams);
    std::erase_if(streams, [&](const TakeStreamInfo& stream) { return !frames.contains(stream.file); });
}

}  // namespace tactus::take
