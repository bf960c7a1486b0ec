// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_writer.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/json.hpp"
#include "assets/file/toml_file.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/file_hash.hpp"
#include "assets/volume/readers.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "graph/patch/sub_patch.hpp"
#include "graph/plugin/plugins.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <bit>
#include <exception>
#include <fstream>
#include <set>
#include <vector>

namespace tactus::take {

using file::Json;
namespace fs = std::filesystem;

namespace {

// A killed run loses the records since the last flush. The limit in bytes is for offline runs, which compute minutes of
// logical time in half a second.
constexpr std::int64_t flush_every_ns = 500'000'000;
constexpr std::uint64_t flush_every_bytes = 1 << 16;

Json assets_json(const patch::Patch& patch) {
    Json assets = Json::array();
    for (const patch::PatchAsset& asset : patch.assets)
        assets.push_back(
            {{"name", asset.name},
             {"path", fs::absolute(asset.path).string()},
             // A patch may name a file that nothing uses.
             {"hash",
              fmt::format("{:016x}", fs::exists(bone::file_of_bone(asset.path)) ? hash_of_asset(asset.path) : 0)}});
    return assets;
}

/// All that are loaded: an edit may use what the first patch did not.
Json plugins_json() {
    Json list = Json::array();
    for (const plugin::Plugin& plugin : plugin::all())
        list.push_back({{"name", plugin.name},
                        {"version", plugin.version},
                        {"path", plugin.file.string()},
                        {"hash", fmt::format("{:016x}", plugin.hash)}});
    return list;
}

Json sample_json(const DeviceSample& s) {
    const auto bits = [](double v) { return fmt::format("{:016x}", std::bit_cast<std::uint64_t>(v)); };
    Json json{{"buttons", s.buttons}, {"counter", s.counter}, {"valid", s.valid}, {"numbers", Json::array()}};
    const Quat& q = s.pose.orientation;
    for (const double v :
         {s.pose.position.x, s.pose.position.y, s.pose.position.z, q.w, q.x, q.y, q.z, s.twist.linear.x,
          s.twist.linear.y, s.twist.linear.z, s.twist.angular.x, s.twist.angular.y, s.twist.angular.z})
        json["numbers"].push_back(bits(v));
    for (const FingerSample& finger : s.fingers)
        json["fingers"].push_back({bits(finger.position), bits(finger.force), finger.state});
    return json;
}

void add_strings(const toml::node& node, std::vector<std::string>& all) {
    if (const auto* text = node.as_string()) all.push_back(text->get());
    if (const auto* table = node.as_table())
        for (const auto& [key, value] : *table) add_strings(value, all);
    if (const auto* list = node.as_array())
        for (const toml::node& value : *list) add_strings(value, all);
}

/// The files of images in a folder, none for one that holds `file` itself.
std::vector<fs::path> images_in(const fs::path& folder, const fs::path& file) {
    try {
        const fs::path way = fs::canonical(file).lexically_relative(fs::canonical(folder));
        if (!way.empty() && *way.begin() != "..") return {};
        return volume::dicom_files_in(folder);
    } catch (const std::exception&) {
        return {};  // reported when it is loaded
    }
}

/// The files that a TOML file names, as recordings, bones and label maps, or as folders of images; ascending. Patches are
/// left out: a take holds its own.
std::vector<fs::path> files_named_in(const fs::path& path) {
    std::vector<std::string> texts;
    try {
        add_strings(*file::parse_toml(file::read_whole_file(path), path.string()), texts);
    } catch (const Error&) {
        return {};  // reported when it is loaded
    }
    std::set<fs::path> found;
    for (const std::string& text : texts) {
        if (text.empty() || text.find('\0') != std::string::npos) continue;
        const fs::path file = (path.parent_path() / bone::file_of_bone(text)).lexically_normal();
        std::error_code ignored;
        if (file.extension() != ".toml" && fs::is_regular_file(file, ignored)) found.insert(file);
        else if (fs::is_directory(file, ignored))
            for (const fs::path& image : images_in(file, path)) found.insert(image);
    }
    return {found.begin(), found.end()};
}

}  // namespace

std::uint64_t hash_of_asset(const fs::path& path) {
    Hash hash;
    volume::add_file_with_samples(hash, bone::file_of_bone(path));
    if (path.extension() == ".toml")
        for (const fs::path& file : files_named_in(path)) {
            Hash own;
            volume::add_file_with_samples(own, file);
            hash.add_word(own.value());
        }
    return hash.value();
}

std::string cpu_family() {
    std::ifstream file("/proc/cpuinfo");
    std::string vendor, family, model;
    for (std::string line; std::getline(file, line) && !line.empty();) {
        const auto value = [&line] { return line.substr(std::min(line.size(), line.find(':') + 2)); };
        if (line.starts_with("vendor_id")) vendor = value();
        else if (line.starts_with("cpu family")) family = value();
        else if (line.starts_with("model\t")) model = value();
    }
    return vendor.empty() ? "unknown" : fmt::format("{} family {} model {}", vendor, family, model);
}

TakeWriter::TakeWriter(fs::path folder, TakeAbout about)
    : folder_(std::move(folder)), about_(std::move(about)), streams_([this](const std::string& json) {
          holds_a_run_ = true;
          if (is_lost_) throw Error(loss());
          line(json);
      }) {
    std::error_code failure;
    fs::create_directories(folder_ / "streams", failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder_.string(), failure.message()));
    if (fs::exists(folder_ / "take.json"))
        throw Error(fmt::format("{}: there is a take already; choose another name", folder_.string()));
    events_ = std::make_unique<file::GrowingFile>(folder_ / "events.jsonl");
}

TakeWriter::~TakeWriter() {
    if (holds_a_run_) return;
    // The folder may hold files of the user: only what was made here is removed.
    events_.reset();
    log_.reset();
    std::error_code ignored;
    for (const char* file : {"take.json", "patch-0.toml", "timing.log", "events.jsonl", "streams"})
        fs::remove(folder_ / file, ignored);
    fs::remove(folder_, ignored);
}

std::string TakeWriter::loss() const {
    const std::lock_guard lock(writing_);
    return loss_;
}

void TakeWriter::lose(const std::string& why) {
    const std::lock_guard lock(writing_);
    holds_a_run_ = true;
    if (is_lost_.exchange(true)) return;
    loss_ = fmt::format("{}; the take repeats the run up to there", why);
}

void TakeWriter::begin(const patch::Patch& patch, std::uint64_t plan_hash) {
    file::write_whole_file(folder_ / "patch-0.toml", patch::bundle_text(patch));
    Json json{{"format", take_format},
              {"patch", fs::absolute(about_.patch_file).string()},
              {"title", patch.title},
              {"settings", about_.overrides.settings},
              {"asset_overrides", about_.overrides.assets},
              {"seconds", about_.seconds},
              {"live", about_.live},
              {"build", build_identity()},
              {"cpu", cpu_family()},
              {"assets", assets_json(patch)}};
    if (Json plugins = plugins_json(); !plugins.empty()) json["plugins"] = std::move(plugins);
    if (about_.seed) json["seed"] = *about_.seed;
    log_ = std::make_unique<TimingLogWriter>(folder_ / "timing.log", plan_hash, about_.seconds,
                                             TimingLogWriter::Name::at_once);
    log_->flush();
    file::write_whole_file(folder_ / "take.json", json.dump(2) + "\n");
}

void TakeWriter::line(const std::string& json) {
    if (is_lost_) return;
    try {
        const std::lock_guard lock(writing_);
        events_->append(json + "\n");
        events_->flush();
        ++lines_;
    } catch (const Error& error) {
        // Later records of the log would refer to events that were not written.
        lose(error.message());
    }
}

void TakeWriter::record(const TimingRecord& record) {
    holds_a_run_ = true;
    if (is_lost_) return;
    try {
        log_->write(record);
    } catch (const Error& error) {
        lose(error.message());
    }
}

void TakeWriter::device(const io::DeviceSlot& slot) {
    const DeviceInfo& info = slot.port.info;
    line(Json{{"device", slot.name},
              {"info",
               {{"name", info.name},
                {"max_force", info.max_force},
                {"max_torque", info.max_torque},
                {"damping", info.damping},
                {"max_stiffness", info.max_stiffness},
                {"actuates_torque", info.actuates_torque},
                {"senses_rotation", info.senses_rotation},
                {"without_motors", info.without_motors},
                {"fingers", info.fingers},
                {"max_speed", info.max_speed},
                {"least_speed", info.least_speed},
                {"resolution", info.resolution},
                {"angular_resolution", info.angular_resolution},
                {"delay", info.delay}}},
              {"first", sample_json(slot.port.sample)}}
             .dump());
}

std::unique_ptr<io::Sink> TakeWriter::sink(const io::FrameLayout& layout, const run::GroupRuntime& group) {
    return streams_.sink(folder_, layout, group);
}

std::string TakeWriter::describe_assets(const patch::Patch& patch) { return assets_json(patch).dump(); }

void TakeWriter::edit(std::int64_t number, Flicks when, const patch::Patch& patch, const std::string& assets) {
    const std::string file = fmt::format("patch-{}.toml", number);
    if (is_lost_) return;
    try {
        file::write_whole_file(folder_ / file, patch::bundle_text(patch));
    } catch (const Error& error) {
        return lose(error.message());
    }
    line(Json{{"plan", number}, {"file", file}, {"when_flicks", when}, {"assets", Json::parse(assets)}}.dump());
}

void TakeWriter::change(std::int64_t id, std::int64_t plan, const std::string& node, const std::string& param,
                        double value) {
    line(Json{{"set", id},
              {"in_plan", plan},
              {"node", node},
              {"param", param},
              {"value", value},
              {"bits", fmt::format("{:016x}", std::bit_cast<std::uint64_t>(value))}}
             .dump());
}

void TakeWriter::checkpoint(const std::vector<Progress>& progress) {
    const std::int64_t now = steady_ns();
    if (is_lost_ || (now < flush_ns_ && log_->size() < flush_bytes_)) return;
    flush_ns_ = now + flush_every_ns;
    for (const Progress& group : progress) {
        TimingRecord record;
        record.kind = TimingKind::progress;
        record.group = static_cast<std::uint16_t>(group.group);
        record.tick = group.done;
        record.value = group.time;
        this->record(record);
    }
    try {
        log_->flush();
        flush_bytes_ = log_->size() + flush_every_bytes;
    } catch (const Error& error) {
        lose(error.message());
    }
}

void TakeWriter::move_to(const fs::path& folder) {
    std::error_code failure;
    // Renaming would replace a folder that is empty.
    if (fs::exists(folder)) throw Error(fmt::format("{}: is there already; choose another name", folder.string()));
    fs::rename(folder_, folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the take: {}", folder.string(), failure.message()));
    folder_ = folder;
}

void TakeWriter::finish(const std::vector<std::pair<std::string, std::uint64_t>>& port_hashes) {
    holds_a_run_ = true;
    // A log without its last record counts as cut off.
    if (is_lost_) return log_.reset();
    try {
        log_->finish();
        // The log repeats the whole run, but not every value can be compared: the take counts as cut off.
        if (streams_.is_cut()) return;
        Json json{{"ports", Json::object()}, {"holds", {{"timing.log", log_->records()}, {"events.jsonl", lines_}}}};
        for (const auto& [name, hash] : port_hashes) json["ports"][name] = fmt::format("{:016x}", hash);
        for (const auto& [file, frames] : streams_.frames()) json["holds"][file] = frames;
        file::write_whole_file(folder_ / "result.json", json.dump(2) + "\n");
    } catch (const Error& error) {
        lose(error.message());
    }
}

}  // namespace tactus::take
