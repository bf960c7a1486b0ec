// SPDX-License-Identifier: Apache-2.0
#include "tools/window/scene/scene_screens.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tactus::window {

namespace {

/// The content of a legend as text, to detect changes.
std::string words_of(const display::Legend& legend) {
    std::string all = legend.title;
    for (const auto& s : legend.scales) all += s.title + s.low_text + s.high_text;
    for (const auto& e : legend.entries) all += e.text + "\n";
    for (const auto& w : legend.warnings) all += w + "\n";
    return all;
}

}  // namespace

void SceneScreens::lay_out(const Sight& sight, int width, int height) {
    const auto count = static_cast<int>(sight.screens());
    tiles_.resize(sight.screens());
    while (targets_.size() < tiles_.size()) targets_.push_back(std::make_unique<Target>());
    targets_.resize(tiles_.size());
    if (!sight.aspect_of(0)) {
        tiles_[0] = {0, 0, width, height, tiles_[0].texture, tiles_[0].version, tiles_[0].views, width, height};
        return;
    }
    const auto aspect_of = [&](std::size_t screen) {
        return *sight.aspect_of(screen) * (sight.mode_of(screen) == display::StereoMode::side_by_side ? 2.0 : 1.0);
    };
    // The number of columns that maximises the smallest tile.
    int columns = 1;
    double best = 0.0;
    for (int tried = 1; tried <= count; ++tried) {
        const int rows = (count + tried - 1) / tried;
        double least = 1e30;
        for (std::size_t i = 0; i < tiles_.size(); ++i)
            least = std::min(least, std::min(width / tried / aspect_of(i), static_cast<double>(height) / rows));
        if (least > best) {
            best = least;
            columns = tried;
        }
    }
    const int rows = (count + columns - 1) / columns, wide = width / columns, high = height / rows;
    constexpr int gap = 4;
    for (int i = 0; i < count; ++i) {
        Tile& tile = tiles_[static_cast<std::size_t>(i)];
        const double aspect = aspect_of(static_cast<std::size_t>(i));
        tile.width = std::max(8, static_cast<int>(std::min<double>(wide - gap, (high - gap) * aspect)));
        tile.height = std::max(8, static_cast<int>(tile.width / aspect));
        tile.x = (i % columns) * wide + (wide - tile.width) / 2;
        tile.y = (i / columns) * high + (high - tile.height) / 2;
        tile.picture_width = tile.width;
        tile.picture_height = tile.height;
    }
}

void SceneScreens::open(const Sight& sight, bool all) {
    windows_.clear();
    try {
        for (std::size_t i = 0; i < sight.screens(); ++i) {
            const bool two = sight.mode_of(i) == display::StereoMode::quad_buffer;
            ScreenWindow::Place place{0, {}, two};
            std::string title = "Tactus: scene";
            if (sight.display_file()) {
                const display::ScreenSettings& screen = sight.display_file()->screens[i];
                place = {screen.monitor, screen.window, two};
                title = fmt::format("screen '{}'", screen.name);
            }
            if (!all && !two && place.monitor == 0 && place.window[2] == 0) continue;
            windows_.push_back({i, std::make_unique<ScreenWindow>(title, place)});
        }
    } catch (const Error&) {
        windows_.clear();
        throw;
    }
}

void SceneScreens::tend() {
    std::erase_if(windows_, [](const Opened& opened) { return opened.window->wants_to_close(); });
}

ScreenWindow* SceneScreens::window_of(std::size_t screen) const {
    for (const Opened& opened : windows_)
        if (opened.screen == screen) return opened.window.get();
    return nullptr;
}

/// At the same position for both eyes, and readable in a mirror.
void SceneScreens::draw_legend(std::size_t screen, TextureTarget& target, const Sight& sight,
                               const display::Legend& legend, std::span<const display::DrawnView> views) {
    const double scale = std::clamp(std::min(views[0].width, views[0].height) / 600.0, 0.55, 4.0);
    const std::string words = words_of(legend);
    if (words.empty()) return;
    if (words != legend_text_ || scale != legend_scale_) {
        legend_image_ = display::legend_image(legend, scale);
        legend_text_ = words;
        legend_scale_ = scale;
    }
    const int gap = static_cast<int>(10.0 * scale);
    int last = -1;
    for (const display::DrawnView& view : views) {
        if (view.x == last) continue;
        last = view.x;
        const display::Flip flip = sight.text_of(screen);
        target.lay(legend_image_,
                   flip == display::Flip::left_right ? view.x + view.width - gap - legend_image_.width : view.x + gap,
                   flip == display::Flip::upside_down ? view.height - gap - legend_image_.height : gap, flip);
    }
}

std::vector<display::DrawnView> SceneScreens::aim(Sight& sight, const display::OrbitCamera& camera,
                                                  const display::Bounds& scene) {
    std::vector<display::DrawnView> all;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        Tile& tile = tiles_[i];
        const ScreenWindow* const window = window_of(i);
        const bool has_size = window && window->width() > 0 && window->height() > 0;
        tile.picture_width = has_size ? window->width() : tile.width;
        tile.picture_height = has_size ? window->height() : tile.height;
        tile.views = sight.views(i, camera, scene, tile.picture_width, tile.picture_height);
        all.insert(all.end(), tile.views.begin(), tile.views.end());
    }
    return all;
}

void SceneScreens::draw(display::SceneRenderer& renderer, const display::Picture& picture, const Sight& sight,
                        const display::Legend& legend) {
    has_steps_left_ = false;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        Tile& tile = tiles_[i];
        Target& target = *targets_[i];
        const int width = tile.picture_width, height = tile.picture_height;
        target.has_two = tile.views.front().channel == display::Channel::back_left;
        if (target.has_two) {
            for (display::DrawnView& view : tile.views) view.channel = display::Channel::all;
            target.right.begin(width, height, samples);
            renderer.draw(picture, std::span(tile.views).subspan(1));
            target.right.end();
            tile.views.resize(1);
        }
        target.left->begin(width, height, samples);
        renderer.draw(picture, tile.views);
        target.left->end();
        tile.texture = target.left->texture();
        tile.version = target.left->version();
        if (!window_of(i)) continue;
        draw_legend(i, *target.left, sight, legend, tile.views);
        if (target.has_two) draw_legend(i, target.right, sight, legend, tile.views);
    }
}

void SceneScreens::begin_steps() {
    has_steps_left_ = !tiles_.empty();
    step_tile_ = 0;
    step_ = {};
}

void SceneScreens::draw_step(display::SceneRenderer& renderer, const display::Picture& picture) {
    Tile& tile = tiles_[step_tile_];
    Target& target = *targets_[step_tile_];
    if (!target.next) target.next = std::make_unique<TextureTarget>();
    const bool is_first = step_ == display::DrawnSoFar{};
    if (is_first) target.next->begin(tile.picture_width, tile.picture_height, samples);
    else target.next->resume();
    if (!renderer.draw_some(picture, tile.views, step_, step_triangles_)) return target.next->pause();
    target.next->end();
    std::swap(target.left, target.next);
    tile.texture = target.left->texture();
    tile.version = target.left->version();
    step_ = {};
    has_steps_left_ = ++step_tile_ < tiles_.size();
}

void SceneScreens::took(double step_s) {
    constexpr double wanted_s = 0.01, least = 2e3, most = 2e6;
    const double times = std::clamp(wanted_s / std::max(step_s, 1e-4), 0.5, 1.5);
    step_triangles_ = static_cast<std::size_t>(std::clamp(times * static_cast<double>(step_triangles_), least, most));
}

void SceneScreens::show() {
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
        ScreenWindow* const window = window_of(i);
        if (!window) continue;
        const Target& target = *targets_[i];
        window->show(target.left->texture(), target.has_two ? target.right.texture() : 0, target.left->width(),
                     target.left->height(), i == 0);
    }
}

}  // namespace tactus::window
