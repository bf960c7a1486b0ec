// SPDX-License-Identifier: Apache-2.0
#include "engine/take/take_copy.hpp"

#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <fstream>
#include <utility>

namespace tactus::take {

using file::Json;
namespace fs = std::filesystem;

TakeCopy::TakeCopy(const Take& from, fs::path folder)
    : from_(from), folder_(std::move(folder)), streams_([this](const std::string& json) { line(json); }) {
    if (fs::exists(folder_)) throw Error(fmt::format("{}: is there already; choose another name", folder_.string()));
    std::error_code failure;
    fs::create_directories(folder_ / "streams", failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder_.string(), failure.message()));
    try {
        for (const auto& entry : fs::directory_iterator(from_.folder))
            if (const std::string name = entry.path().filename().string();
                name == "take.json" || name == "timing.log" || name.starts_with("patch-"))
                fs::copy_file(entry.path(), folder_ / name);
        events_ = std::make_unique<file::GrowingFile>(folder_ / "events.jsonl");
        std::ifstream events(from_.folder / "events.jsonl");
        std::string text;
        for (std::int64_t n = 0; n < from_.lines && std::getline(events, text); ++n)
            if (const Json event = Json::parse(text); !event.contains("stream") && !event.contains("values_end_s"))
                line(text);
    } catch (const fs::filesystem_error& error) {
        events_.reset();
        fs::remove_all(folder_, failure);
        throw Error(fmt::format("{}: cannot copy the take: {}", folder_.string(), error.code().message()));
    } catch (const Error&) {
        events_.reset();
        fs::remove_all(folder_, failure);
        throw;
    }
}

TakeCopy::~TakeCopy() {
    if (is_finished_) return;
    events_.reset();
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

void TakeCopy::line(const std::string& json) {
    const std::lock_guard lock(writing_);
    events_->append(json + "\n");
    ++lines_;
}

void TakeCopy::finish() {
    if (streams_.is_cut()) throw Error(fmt::format("{}: not all values could be written", folder_.string()));
    events_->close();
    if (from_.is_complete) {
        Json json{{"ports", Json::object()},
                  {"holds", {{"timing.log", from_.written.at("timing.log")}, {"events.jsonl", lines_}}}};
        for (const auto& [port, hash] : from_.result) json["ports"][port] = fmt::format("{:016x}", hash);
        for (const auto& [file, frames] : streams_.frames()) json["holds"][file] = frames;
        file::write_whole_file(folder_ / "result.json", json.dump(2) + "\n");
    }
    is_finished_ = true;
}

}  // namespace tactus::take
