// SPDX-License-Identifier: Apache-2.0
#include "tools/render/frames.hpp"

#include "assets/plan/plan_file.hpp"
#include "devices/display/picture_maker.hpp"
#include "devices/display/png.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "tools/render/scene_model.hpp"
#include "tools/render/sight.hpp"
#include "tools/render/surface_map.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace tactus::render {

namespace {

std::pair<int, int> parse_size(const std::string& text) {
    int width = 0, height = 0;
    const char* const end = text.data() + text.size();
    const auto [cross, bad] = std::from_chars(text.data(), end, width);
    const bool has_cross = bad == std::errc{} && cross != end && *cross == 'x';
    const auto [last, worse] = std::from_chars(has_cross ? cross + 1 : end, end, height);
    if (!has_cross || worse != std::errc{} || last != end)
        throw Error(fmt::format("--size must be WIDTHxHEIGHT in pixels, such as 1280x800, not '{}'", text));
    return {width, height};
}

display::NamedView parse_view(const std::string& text) {
    if (text == "tool") return display::NamedView::iso;
    if (const auto named = display::view_of_name(text)) return *named;
    if (text.size() == 1 && text[0] >= '1' && text[0] <= '7') return *display::view_of_number(text[0] - '0');
    std::vector<std::string> names(display::view_names.begin(), display::view_names.end());
    names.emplace_back("tool");
    throw Error(
        fmt::format("--view-from must be front, back, left, right, top, bottom, iso, tool or 1 to 7, not '{}'{}", text,
                    did_you_mean(text, names)));
}

/// Parses "x", "-y" or "z=12 mm": the axis and a position along it; without one: the middle.
struct Clip {
    Vec3 normal{0.0};
    std::optional<double> at;

    explicit Clip(const std::string& text) {
        const std::size_t equals = text.find('=');
        const std::string axis = text.substr(0, equals);
        const bool is_turned = axis.starts_with('-');
        const std::string letter = axis.substr(is_turned ? 1 : 0);
        if (letter == "x" || letter == "y" || letter == "z") normal[letter[0] - 'x'] = is_turned ? -1.0 : 1.0;
        else if (const auto direction = direction_of(axis)) normal = *direction;
        else
            throw Error(
                fmt::format("--clip must be an axis, such as x or -z, or a direction, such as 1,1,0, each also with "
                            "a position along it, such as \"y=12 mm\", not '{}'",
                            text));
        const bool is_backwards = is_turned && letter.size() == 1;
        if (equals != std::string::npos) at = parse_as(text.substr(equals + 1), "m") * (is_backwards ? -1.0 : 1.0);
    }
    /// Of length 1, from three numbers; none: it is no direction.
    static std::optional<Vec3> direction_of(const std::string& text) {
        Vec3 direction(0.0);
        const char* at = text.data();
        const char* const end = at + text.size();
        for (int axis = 0; axis < 3; ++axis) {
            const auto [next, problem] = std::from_chars(at, end, direction[axis]);
            if (problem != std::errc{} || (axis < 2 ? next == end || *next != ',' : next != end)) return std::nullopt;
            at = next + 1;
        }
        const double length = glm::length(direction);
        if (!(length > 1e-9) || !std::isfinite(length)) return std::nullopt;
        return direction / length;
    }
    display::Plane plane(const display::Bounds& bounds) const {
        return {at ? *at * normal : bounds.empty() ? Vec3(0.0) : bounds.middle(), normal};
    }
};

std::string file_part(std::string name) {
    std::ranges::replace(name, ' ', '-');
    return name;
}

}  // namespace

struct FrameWriter::State {
    FrameChoice choice;
    double seconds;
    std::filesystem::path folder;
    display::NamedView view;
    Sight sight;
    std::optional<Clip> clip;
    std::optional<SurfaceMapper> mapper;
    std::vector<std::optional<Pose>> mapped;  ///< poses of the last map
    double map_range = 1e-3;  ///< m
    observe::Observer observer{observe::Observer::Pace::lossless};
    display::PictureMaker maker;
    SceneModel model;
    display::OrbitCamera camera;
    bool is_aimed = false;
    int next = 1;
    std::vector<std::string> files, losses;

    State(const FrameChoice& wanted, SceneOutline outline, double length, std::filesystem::path where)
        : choice(wanted),
          seconds(length),
          folder(std::move(where)),
          view(parse_view(wanted.view_from)),
          sight(wanted.sight),
          maker(parse_size(wanted.size).first, parse_size(wanted.size).second),
          model(std::move(outline), observer, maker.renderer()) {
        if (!wanted.clip.empty()) clip.emplace(wanted.clip);
        model.show_density(clip.has_value(), true);
        if (!wanted.map.empty()) use_map(wanted);
        for (std::size_t i = 0; i < sight.screens(); ++i)
            if (sight.mode_of(i) == display::StereoMode::quad_buffer)
                throw Error("a picture file cannot be quad-buffered; use --stereo side-by-side or anaglyph");
        sight.follow(model.outline());
        for (const std::string& port : sight.ports()) observer.watch(port, observe::Watch::latest);
    }

    void use_map(const FrameChoice& wanted) {
        const SurfaceMap::Kind kind = parse_map_kind(wanted.map);
        map_range = parse_as(wanted.map_range, "m");
        if (!(map_range > 0.0)) throw Error("--map-range must be a length above 0, such as \"1 mm\"");
        const auto& scenes = model.outline().scenes;
        const auto of_plan = std::ranges::find_if(scenes, [](const auto& scene) { return !scene.plan.empty(); });
        if (of_plan == scenes.end()) throw Error("--map needs a patch with a plan: a node of type case_scene");
        mapper.emplace(kind, plan::load_case_plan(of_plan->plan), std::filesystem::path(of_plan->plan).parent_path());
    }

    /// Again when a fragment has moved.
    void map_surfaces() {
        std::vector<std::optional<Pose>> poses = model.plan_poses();
        const auto are_same = [](const std::optional<Pose>& a, const std::optional<Pose>& b) {
            return a.has_value() == b.has_value() &&
                   (!a || (a->position == b->position && a->orientation == b->orientation));
        };
        if (std::ranges::equal(poses, mapped, are_same)) return;
        model.use_map(std::make_shared<const SurfaceMap>(mapper->map(model.plan_bodies(), poses)), map_range);
        mapped = std::move(poses);
        model.update();
    }

    double time_of(int frame) const { return seconds * frame / choice.frames; }

    double aspect() const {
        const int width = sight.mode_of(0) == display::StereoMode::side_by_side ? maker.width() / 2 : maker.width();
        return static_cast<double>(width) / maker.height();
    }

    /// Names the side that the picture shows.
    std::string view_text() const {
        if (choice.view_from == "tool" && model.tool()) return "side of the tool";
        return view == display::NamedView::iso ? "front left"
                                               : std::string(display::view_names[static_cast<std::size_t>(view)]);
    }

    /// The pose of the head must be observed from the first picture on.
    void check_head() const {
        if (sight.head.empty() || observer.latest<Pose>(sight.head)) return;
        std::vector<std::string> poses;
        for (const observe::Observer::Port& port : observer.ports())
            if (port.type == &value::pose) poses.push_back(port.name);
        throw Error(fmt::format("--head: there is no pose output '{}'{}; there are {}", sight.head,
                                did_you_mean(sight.head, poses), fmt::join(poses, ", ")));
    }

    void draw(int frame) {
        observer.advance(static_cast<Flicks>(std::llround(time_of(frame) * static_cast<double>(flicks_per_second))));
        display::Picture& picture = model.update();
        if (mapper) map_surfaces();
        if (!is_aimed) {
            camera.look_from(view);
            if (choice.view_from == "tool" && model.tool()) camera.look_from_side_of(*model.tool(), model.bounds());
            camera.fit(model.bounds(), aspect(), 1.12);
            is_aimed = !model.bounds().empty();
        }
        if (clip) picture.clip = clip->plane(model.bounds());
        check_head();
        sight.update(observer);
        for (std::size_t screen = 0; screen < sight.screens(); ++screen) {
            const auto views = sight.views(screen, camera, picture.bounds, maker.width(), maker.height());
            display::Image image = maker.draw(picture, views);
            display::Legend legend = model.legend();
            legend.title = fmt::format("{}, {:.2f} s, {}", legend.title, time_of(frame), view_text());
            legend.warnings.insert(legend.warnings.end(), sight.warnings().begin(), sight.warnings().end());
            if (!choice.has_no_legend) add_legend(image, legend, views, sight.text_of(screen));
            if (!choice.has_no_legend && !sight.is_off_axis() && sight.mode_of(0) == display::StereoMode::mono)
                display::add_scale_bar(image, camera.metres_per_pixel(image.height));
            std::string name = fmt::format("frame_{:04}", frame);
            if (sight.screens() > 1) name += "_" + file_part(sight.display_file()->screens[screen].name);
            name += ".png";
            try {
                display::write_png(image, (folder / name).string());
                files.push_back(name);
            } catch (const Error& error) {
                losses.emplace_back(error.what());
            }
        }
    }
};

FrameWriter::FrameWriter(const FrameChoice& choice, SceneOutline outline, double seconds,
                         std::filesystem::path folder) {
    if (outline.empty()) throw Error("this patch has nothing to draw: no bone, scene, blade, proxy, gripper or pose");
    state_ = std::make_unique<State>(choice, std::move(outline), seconds, std::move(folder));
}

FrameWriter::~FrameWriter() = default;

observe::Observer& FrameWriter::observer() { return state_->observer; }

void FrameWriter::advance(double seconds) {
    for (; state_->next <= state_->choice.frames && state_->time_of(state_->next) <= seconds + 1e-9; ++state_->next)
        state_->draw(state_->next);
}

const std::vector<std::string>& FrameWriter::files() const { return state_->files; }

const std::vector<std::string>& FrameWriter::losses() const { return state_->losses; }

}  // namespace tactus::render
