// SPDX-License-Identifier: Apache-2.0
// What the window remembers from one time to the next: files opened last, the layout of each, and
// the scan of a plan. No user interface.
#pragma once

#include "tools/window/frame/layout.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class WindowMemory {
public:
    /// Kept in a JSON file; a file that is missing or damaged is as an empty one. Never throws for what it holds.
    explicit WindowMemory(std::filesystem::path file = place());

    /// `$XDG_STATE_HOME/tactus/window.json`, default `~/.local/state`; empty without a home.
    static std::filesystem::path place();

    /// Patches and takes, those opened last first; at most 20. Some may be gone.
    const std::vector<std::string>& recent() const { return known_.recent; }
    void opened(const std::filesystem::path& what);

    std::optional<Layout> layout_of(const std::filesystem::path& patch) const;
    void keep_layout(const std::filesystem::path& patch, Layout layout);

    /// The scan that was shown beside a plan last; empty: none. It may be gone.
    std::filesystem::path scan_of(const std::filesystem::path& plan) const;
    void keep_scan(const std::filesystem::path& plan, const std::filesystem::path& scan);

    /// Where a person has put the borders between the panels of a patch, as `text_of_borders` writes them; empty:
    /// nowhere.
    std::string borders_of(const std::filesystem::path& patch) const;
    void keep_borders(const std::filesystem::path& patch, const std::string& borders);

private:
    void read() noexcept;
    void save() const noexcept;

    struct Known {
        std::vector<std::string> recent;
        std::map<std::string, Layout> layouts;
        std::map<std::string, std::string> scans;  ///< by plan
        std::map<std::string, std::string> borders;
    };
    std::filesystem::path file_;
    Known known_;
};

}  // namespace tactus::window
