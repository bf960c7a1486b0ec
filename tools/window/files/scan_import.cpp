// SPDX-License-Identifier: Apache-2.0
#include "tools/window/files/scan_import.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"
#include "tools/analysis/beside.hpp"

#include <fmt/format.h>

#include <chrono>
#include <string_view>
#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

std::string words_for(const bone::ImportSummary& made, const fs::path& out) {
    std::string text = fmt::format("{}: {:.0f} mm³ of bone in {} x {} x {} voxels", out.filename().string(),
                                   made.bone_volume_mm3, made.size[0], made.size[1], made.size[2]);
    if (made.threshold.hu) text += fmt::format(", threshold {:g} HU ({})", *made.threshold.hu, made.threshold.from);
    for (const std::string& note : made.notes) text += "; " + note;
    return text;
}

}  // namespace

ScanImport::~ScanImport() {
    stops_ = true;
    if (work_.valid()) work_.wait();
}

void ScanImport::begin(const bone::ImportOptions& options, const fs::path& out) {
    stops_ = false;
    progress_ = {};
    work_ = std::async(std::launch::async, [this, options, out] { return import(options, out); });
}

ScanImport::Result ScanImport::import(const bone::ImportOptions& options, const fs::path& out) {
    analysis::let_others_go_first();
    const StopScope scope([this] { return stops_.load(); });
    try {
        std::error_code ignored;
        if (fs::exists(out, ignored))
            throw Error(fmt::format("{} is there already; choose another name", out.string()));
        const bone::ImportSummary made =
            bone::import_bone_file(options, out, [this](double share, std::string_view doing) {
                const std::lock_guard lock(mutex_);
                progress_ = {share, std::string(doing)};
            });
        return {out, words_for(made, out)};
    } catch (const Stopped&) {
        return {{}, "the import was stopped; no file was written"};
    } catch (const std::exception& error) {
        return {{}, error.what()};
    }
}

ScanImport::Progress ScanImport::progress() const {
    const std::lock_guard lock(mutex_);
    return progress_;
}

std::optional<ScanImport::Result> ScanImport::take_result() {
    if (!work_.valid() || work_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
    return work_.get();
}

fs::path free_bone(const fs::path& scan, const fs::path& folder) {
    // "scan.nii.gz" is scan.vdb; a folder's name may end with a slash.
    const fs::path named = scan.has_filename() ? scan.filename() : scan.parent_path().filename();
    std::string stem = named.stem().string();
    if (stem.ends_with(".nii")) stem.resize(stem.size() - 4);
    std::error_code ignored;
    fs::path free = folder / (stem + ".vdb");
    for (int i = 2; fs::exists(free, ignored); ++i) free = folder / fmt::format("{}-{}.vdb", stem, i);
    return free;
}

}  // namespace tactus::window
