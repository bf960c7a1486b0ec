// SPDX-License-Identifier: Apache-2.0
// The page that a window without a patch begins with.
#pragma once

#include "tools/window/document/patch_picture.hpp"
#include "tools/window/document/start_list.hpp"
#include "tools/window/files/window_memory.hpp"
#include "tools/window/widgets/painter.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::window {

class StartPage {
public:
    explicit StartPage(const WindowMemory& memory) : memory_(memory) {}
    ~StartPage();
    StartPage(const StartPage&) = delete;
    StartPage& operator=(const StartPage&) = delete;

    /// Reads the lists anew.
    void open();
    /// Fills the window.
    void draw(const Fonts& fonts);

    bool is_open = false;
    // What was pressed; the owner resets it.
    std::optional<std::filesystem::path> chosen;
    bool wants_new = false, wants_dialog = false;

private:
    void lists(const Fonts& fonts);
    void list(const char* title, const std::vector<StartItem>& items);
    void examples(const Fonts& fonts);
    void card(const StartItem& item, Point corner, Point size, const Fonts& fonts);
    void keys(int columns);
    std::uint32_t texture_of(const StartItem& item);
    const PatchPicture* graph_of(const StartItem& item);

    const WindowMemory& memory_;
    StartList all_;
    std::map<std::string, std::uint32_t> textures_;  ///< 0: there is none
    std::map<std::string, std::unique_ptr<PatchPicture>> graphs_;
    int marked_ = 0;  ///< the example that Enter opens
    bool follows_mark_ = false;
};

}  // namespace tactus::window
