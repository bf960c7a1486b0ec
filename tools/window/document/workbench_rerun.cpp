// SPDX-License-Identifier: Apache-2.0
// The next run of a patch in place of the present one.
#include "tools/window/document/workbench.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::window {

namespace fs = std::filesystem;

void Workbench::use_asset(const std::string& asset, const fs::path& file) {
    std::erase_if(choice_.overrides.assets, [&](const std::string& given) { return given.starts_with(asset + "="); });
    choice_.overrides.assets.push_back(asset + "=" + file.string());
}

void Workbench::run_with(const std::string& asset, const fs::path& file, const fs::path& otherwise) {
    const std::vector<std::string> before = choice_.overrides.assets;
    use_asset(asset, file);
    if (const auto problem = check(editor_->text())) {
        choice_.overrides.assets = before;
        return tell(*problem, true);
    }
    if (is_recording())
        tell(fmt::format("the recording into {} ends here: the run begins again", last_take_.string()), true);
    run_.reset();
    adopt();
    next_goes_on_ = true;
    run();
    if (!otherwise.empty()) otherwise_ = {asset, otherwise};
}

/// What compiles may still not begin: a node asks for what the file no longer has.
void Workbench::go_back() {
    if (!otherwise_) return;
    const std::shared_ptr<const RunStatus> now = status();
    if (now->folder.empty() && !run_->is_over()) return;  // it loads
    const auto [asset, file] = *std::exchange(otherwise_, std::nullopt);
    if (!now->folder.empty() || now->failure.empty()) return;
    tell(fmt::format("the run could not begin with the change, and goes on without it: {}", now->failure), true);
    use_asset(asset, file);
    if (const auto problem = check(editor_->text())) return tell(*problem, true);
    run_.reset();
    adopt();
    next_goes_on_ = true;
    run();
}

}  // namespace tactus::window
