// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/command_list.hpp"

#include "tools/window/widgets/spots.hpp"

#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <utility>

namespace tactus::window {

namespace {

constexpr const char *list_title = "commands", *help_title = "Keys";

std::vector<std::string> menus_of(const std::vector<Command>& commands) {
    std::vector<std::string> menus;
    for (const Command& command : commands)
        if (!command.menu.empty() && std::ranges::find(menus, command.menu) == menus.end())
            menus.push_back(command.menu);
    return menus;
}

void draw_menu(const std::vector<Command>& commands, const std::string& menu) {
    for (const Command& command : commands) {
        if (command.menu != menu) continue;
        if (command.is_separated) ImGui::Separator();
        const bool is_pressed = ImGui::MenuItem(command.name.c_str(), command.keys.c_str(),
                                                command.is_on && command.is_on(), command.is_possible());
        mark_spot("menu " + command.name);
        if (is_pressed) command.run();
    }
}

/// Flat buttons, as menus have.
bool menu_button(const char* label) {
    ImGui::PushStyleColor(ImGuiCol_Button, 0u);
    const bool pressed = ImGui::Button(label);
    ImGui::PopStyleColor();
    mark_spot(label);
    return pressed;
}

/// The number of a key in the order of GLFW, which ImGui 1.86 passes on.
int key_of(const std::string& key) {
    struct Named {
        std::string_view name;
        int code;
    };
    static constexpr std::array<Named, 16> names{{{"Space", 32},
                                                  {"Esc", 256},
                                                  {"Enter", 257},
                                                  {"Tab", 258},
                                                  {"Backspace", 259},
                                                  {"Del", 261},
                                                  {"Right", 262},
                                                  {"Left", 263},
                                                  {"Down", 264},
                                                  {"Up", 265},
                                                  {"Home", 268},
                                                  {"End", 269},
                                                  {"F1", 290},
                                                  {"F2", 291},
                                                  {"F5", 294},
                                                  {"F10", 299}}};
    for (const Named& named : names)
        if (named.name == key) return named.code;
    return key.size() == 1 ? static_cast<int>(static_cast<unsigned char>(key[0])) : -1;
}

}  // namespace

void draw_menus(const std::vector<Command>& commands, double room, bool wants_all) {
    const std::vector<std::string> menus = menus_of(commands);
    const ImGuiStyle& style = ImGui::GetStyle();
    float wide = 0.0f;
    for (const std::string& menu : menus)
        wide += ImGui::CalcTextSize(menu.c_str()).x + 2.0f * style.FramePadding.x + style.ItemSpacing.x;
    const auto open = [&](const char* label) {
        const bool pressed = menu_button(label);
        const ImVec2 below(ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y);
        if (pressed) ImGui::OpenPopup(label);
        ImGui::SetNextWindowPos(below, ImGuiCond_Appearing);
        return ImGui::BeginPopup(label);
    };
    const auto draw_all = [&] {
        for (const std::string& menu : menus)
            if (ImGui::BeginMenu(menu.c_str())) {
                draw_menu(commands, menu);
                ImGui::EndMenu();
            }
        ImGui::EndPopup();
    };
    if (static_cast<double>(wide) <= room) {
        for (const std::string& menu : menus) {
            if (open(menu.c_str())) {
                draw_menu(commands, menu);
                ImGui::EndPopup();
            }
            ImGui::SameLine(0.0f, 0.0f);
        }
        ImGui::SameLine();
        // All menus in one, for the keyboard.
        if (wants_all) ImGui::OpenPopup("Menu");
        if (ImGui::BeginPopup("Menu")) draw_all();
        return;
    }
    if (wants_all) ImGui::OpenPopup("Menu");
    if (open("Menu")) draw_all();
    ImGui::SameLine();
}

void run_pressed(const std::vector<Command>& commands, bool is_typing) {
    const ImGuiIO& io = ImGui::GetIO();
    for (const Command& command : commands) {
        if (command.keys.empty()) continue;
        const Chord chord = chord_of(command.keys);
        if (is_typing && !passes_text_field(chord)) continue;
        const int key = key_of(chord.key);
        if (key < 0 || chord.ctrl != io.KeyCtrl || chord.shift != io.KeyShift || chord.alt != io.KeyAlt) continue;
        if (!ImGui::IsKeyPressed(key, false) || !command.is_possible()) continue;
        return command.run();
    }
}

void CommandList::open(std::vector<Command> all) {
    all_ = std::move(all);
    words_.clear();
    found_ = find_commands(all_, words_);
    chosen_ = 0;
    wants_open_ = true;
}

void CommandList::draw_list(const Fonts& fonts) {
    if (std::exchange(wants_open_, false)) {
        ImGui::OpenPopup(list_title);
        const Point all = point(ImGui::GetMainViewport()->Size);
        const double wide = std::min(620.0 * fonts.scale, 0.95 * all.x);
        ImGui::SetNextWindowPos(vec({0.5 * (all.x - wide), 0.08 * all.y}));
        ImGui::SetNextWindowSize(vec({wide, std::min(420.0 * fonts.scale, 0.85 * all.y)}));
    }
    is_open_ = ImGui::BeginPopup(list_title, ImGuiWindowFlags_NoMove);
    if (!is_open_) return;
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::InputTextWithHint("##words", "what to do: some words of it", &words_)) {
        found_ = find_commands(all_, words_);
        chosen_ = 0;
    }
    mark_spot("command");
    const auto pressed = [](ImGuiKey_ key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
    const bool down = pressed(ImGuiKey_DownArrow), up = pressed(ImGuiKey_UpArrow);
    if (down && chosen_ + 1 < found_.size()) ++chosen_;
    if (up && chosen_ > 0) --chosen_;
    const Command* wanted = nullptr;
    ImGui::BeginChild("found");
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(found_.size()));
    if (down || up) clipper.ForceDisplayRangeByIndices(static_cast<int>(chosen_), static_cast<int>(chosen_) + 1);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const Command& command = *found_[static_cast<std::size_t>(i)];
            const bool is_chosen = static_cast<std::size_t>(i) == chosen_;
            ImGui::BeginDisabled(!command.is_possible());
            ImGui::PushID(i);
            if (ImGui::Selectable(command.name.c_str(), is_chosen)) wanted = &command;
            mark_spot("command " + command.name);
            ImGui::PopID();
            if (is_chosen && (down || up)) ImGui::SetScrollHereY();
            const std::string note = command.keys.empty() ? command.menu : command.keys;
            const float wide = ImGui::CalcTextSize(note.c_str()).x;
            ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - wide);
            ImGui::TextDisabled("%s", note.c_str());
            ImGui::EndDisabled();
        }
    if (found_.empty()) ImGui::TextDisabled("nothing suits; try another word");
    ImGui::EndChild();
    if (!wanted && chosen_ < found_.size() && (pressed(ImGuiKey_Enter) || pressed(ImGuiKey_KeyPadEnter)))
        wanted = found_[chosen_];
    if (wanted || pressed(ImGuiKey_Escape)) ImGui::CloseCurrentPopup();
    const std::function<void()> run = wanted && wanted->is_possible() ? wanted->run : nullptr;
    ImGui::EndPopup();
    if (run) run();
}

void CommandList::draw(const std::vector<Command>& commands, const Fonts& fonts) {
    draw_list(fonts);
    if (std::exchange(wants_help_, false)) {
        ImGui::OpenPopup(help_title);
        const Point all = point(ImGui::GetMainViewport()->Size);
        const Point size{std::min(640.0 * fonts.scale, 0.95 * all.x), std::min(560.0 * fonts.scale, 0.9 * all.y)};
        ImGui::SetNextWindowPos(vec((all - size) * 0.5));
        help_size_ = size;
    }
    if (!ImGui::BeginPopup(help_title)) return;
    // A popup takes the size of its content, and columns that stretch would have none.
    ImGui::BeginChild("page", vec(help_size_));
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_RowBg)) {
        ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthStretch, 0.38f);
        ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch, 0.62f);
        const auto row = [](const char* keys, const char* what) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextWrapped("%s", keys);
            ImGui::TableNextColumn();
            ImGui::TextWrapped("%s", what);
        };
        for (const Command& command : commands)
            if (!command.keys.empty()) row(command.keys.c_str(), command.name.c_str());
        row("in the patch", "");
        row("double-click", "empty: add a node; output: a scope; sub-patch: open it");
        row("drag", "output to input: a wire; a wire near its end: to another port; a node; over empty ground: choose");
        row("drag a comment", "with what lies in it; with Alt: alone");
        row("Shift-click", "choose more nodes and comments");
        row("right button", "drag: move the view; click: menu");
        row("wheel", "nearer and farther");
        row("in the scene", "");
        row("1 to 7", "seven sides");
        row("Alt+arrows, Alt+Page Up, Page Down", "turn the view; nearer and farther");
        row("H; T, Y, U, I", "mouse for the hand or the view; buttons of the hand");
        row("arrows, Page Up, Page Down", "move the hand in small steps; with Shift: turn it");
        row("in a list of files", "");
        row("Up, Down; Alt+Up; Alt+1 to Alt+5", "choose a file; the folder above; the places on the left");
        row("in a menu or a question", "");
        row("arrows, Enter, Esc", "go to an item, press it, leave");
        row("in a field", "");
        row("Ctrl-click, Enter", "type a number, with its unit shown; Tab goes to the next field");
        ImGui::EndTable();
    }
    ImGui::EndChild();
    mark_spot("keys");
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace tactus::window
