// SPDX-License-Identifier: Apache-2.0
#include "assets/display/display_file.hpp"

#include "assets/file/toml_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "dsp/coupling/placement.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace tactus::display {

namespace {

constexpr std::size_t max_screens = 64;

class DisplayReader : file::TomlFile {
public:
    explicit DisplayReader(const std::filesystem::path& path) : file::TomlFile(path, "a display file") {}

    DisplayFile read() {
        const toml::table& root = this->root();
        know(root, {"title", "between_eyes", "offset", "head", "device", "mirror", "screens"});
        DisplayFile file;
        if (const auto* node = root.get("title")) file.title = word(*node);
        if (const auto* node = root.get("between_eyes")) file.geometry.between_eyes = length(*node, 0.0, 0.2);
        if (const auto* node = root.get("offset")) file.geometry.visuo_haptic_offset = vector(*node, "mm");
        if (const auto* node = root.get("head")) read_head(as_table(*node), file);
        if (const auto* node = root.get("device")) read_device(as_table(*node), file.geometry);
        if (const auto* node = root.get("mirror")) read_mirror(as_table(*node), file.geometry);
        const auto* screens = root.get("screens");
        if (!screens || !screens->is_array() || screens->as_array()->empty())
            throw Error({this->file(), 0, 0},
                        "a display needs at least one [[screens]] with low_left, low_right, high_left");
        if (screens->as_array()->size() > max_screens)
            fail(*screens, fmt::format("a display has {} screens at most", max_screens));
        for (const toml::node& node : *screens->as_array()) read_screen(node, file);
        return file;
    }

private:
    void read_head(const toml::table& table, DisplayFile& file) const {
        know(table, {"position", "rotation", "orientation", "away"});
        file.eyes_in_head = pose(table);
        if (const auto* node = table.get("away")) file.head_away = length(*node, 0.05, 20.0);
    }

    void read_device(const toml::table& table, DisplayGeometry& geometry) const {
        know(table, {"position", "rotation", "orientation", "stretch"});
        geometry.haptic_world = pose(table);
        const auto* node = table.get("stretch");
        if (!node) return;
        const auto* rows = node->as_array();
        if (!rows || rows->size() != 3) fail(*node, "a stretch has three rows of three numbers");
        for (std::size_t row = 0; row < 3; ++row) {
            const std::vector<double> numbers = list(*rows->get(row), 3, "a stretch has three rows of three numbers");
            for (int column = 0; column < 3; ++column)
                geometry.haptic_stretch[column][static_cast<int>(row)] = numbers[static_cast<std::size_t>(column)];
        }
        const double volume = glm::determinant(geometry.haptic_stretch);
        if (!(volume > 0.1 && volume < 10.0))
            fail(*node, "this stretch turns space inside out or is singular; calibrate the device again");
    }

    void read_mirror(const toml::table& table, DisplayGeometry& geometry) const {
        know(table, {"point", "normal"});
        const auto *point = table.get("point"), *normal = table.get("normal");
        if (!point || !normal) fail(table, "a mirror needs a point and a normal");
        const std::vector<double> n = list(*normal, 3, "a normal has three numbers");
        const Vec3 direction(n[0], n[1], n[2]);
        if (!(glm::length(direction) > 1e-6)) fail(*normal, "a normal must have a length");
        geometry.mirror = Plane{vector(*point, "mm"), glm::normalize(direction)};
    }

    void read_screen(const toml::node& node, DisplayFile& file) const {
        const toml::table& table = as_table(node);
        know(table,
             {"name", "low_left", "low_right", "high_left", "in_mirror", "eyes", "eye", "stereo", "monitor", "window"});
        ScreenSettings way;
        way.name = table.get("name") ? word(*table.get("name")) : fmt::format("screen {}", file.screens.size() + 1);
        if (way.name.empty() || way.name.find_first_of("/\\\n") != std::string::npos)
            fail(node, "the name of a screen becomes part of file names: no slashes, no line ends, not empty");
        if (std::ranges::find(file.screens, way.name, &ScreenSettings::name) != file.screens.end())
            fail(node, fmt::format("two screens are called '{}'", way.name));
        Screen screen;
        for (const auto& [key, corner] :
             {std::pair("low_left", &screen.low_left), std::pair("low_right", &screen.low_right),
              std::pair("high_left", &screen.high_left)}) {
            const auto* given = table.get(key);
            if (!given) fail(node, fmt::format("screen '{}' needs {}, as in \"0 mm, 0 mm, 0 mm\"", way.name, key));
            *corner = vector(*given, "mm");
        }
        if (const auto* in_mirror = table.get("in_mirror")) screen.in_mirror = flag(*in_mirror);
        if (const auto* eyes = table.get("eyes")) way.eyes = static_cast<ScreenEyes>(choice(*eyes, screen_eye_names));
        if (const auto* eye = table.get("eye")) way.eye = vector(*eye, "mm");
        if (const auto* stereo = table.get("stereo"))
            way.stereo = static_cast<StereoMode>(choice(*stereo, stereo_names));
        if (const auto* monitor = table.get("monitor")) {
            way.monitor = static_cast<int>(monitor->value_or<std::int64_t>(0));
            if (way.monitor < 1 || way.monitor > 64) fail(*monitor, "monitors are numbered from 1");
        }
        if (const auto* window = table.get("window")) {
            const std::vector<double> numbers = list(*window, 4, "a window has x, y, width and height in pixels");
            for (std::size_t i = 0; i < 4; ++i) {
                if (!(std::abs(numbers[i]) <= 1e5)) fail(*window, "this window lies outside every desktop");
                way.window[i] = static_cast<int>(numbers[i]);
            }
            if (way.window[2] < 1 || way.window[3] < 1) fail(*window, "a window needs a width and a height, pixels");
        }
        file.geometry.screens.push_back(screen);
        file.screens.push_back(std::move(way));
        const std::size_t last = file.screens.size() - 1;
        try {
            // Reports a screen that the eye cannot see, with its line.
            const Pose head = file.geometry.place_before(last, 0.6);
            file.geometry.view(last, file.screens.back().eye.value_or(head.position), {});
        } catch (const Error& error) {
            fail(node, fmt::format("screen '{}': {}", file.screens.back().name, error.message()));
        }
    }

    bool flag(const toml::node& node) const {
        if (!node.is_boolean()) fail(node, "true or false is expected here");
        return node.as_boolean()->get();
    }
    template <std::size_t n>
    std::size_t choice(const toml::node& node, const std::array<std::string_view, n>& names) const {
        const std::string text = word(node);
        const auto found = std::ranges::find(names, text);
        if (found == names.end())
            fail(node, fmt::format("'{}' is none of {}{}", text, fmt::join(names, ", "),
                                   did_you_mean(text, std::vector<std::string>(names.begin(), names.end()))));
        return static_cast<std::size_t>(found - names.begin());
    }
    std::vector<double> list(const toml::node& node, std::size_t count, std::string_view what) const {
        const auto* array = node.as_array();
        if (!array || array->size() != count) fail(node, std::string(what));
        std::vector<double> numbers;
        for (const toml::node& one : *array) {
            const auto value = one.value<double>();
            if (!value || !std::isfinite(*value)) fail(one, std::string(what));
            numbers.push_back(*value);
        }
        return numbers;
    }
    Vec3 vector(const toml::node& node, std::string_view unit) const {
        try {
            return parse_vector(word(node), unit);
        } catch (const Error& error) {
            fail(node, error.message());
        }
    }
    double length(const toml::node& node, double least, double most) const {
        double value = 0.0;
        try {
            value = parse_as(word(node), "m");
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
            fail(node, error.message());
        }
        if (!(value >= least && value <= most))
            fail(node, fmt::format("this length must be {} to {}", format_quantity(least, "mm"),
                                   format_quantity(most, "mm")));
        return value;
    }
    Pose pose(const toml::table& table) const {
        Pose pose;
        if (const auto* node = table.get("position")) pose.position = vector(*node, "mm");
        const auto *turns = table.get("rotation"), *quaternion = table.get("orientation");
        if (turns && quaternion) fail(*turns, "give either rotation or orientation");
        if (turns) pose.orientation = coupling::rotation_xyz(vector(*turns, "deg"));
        if (quaternion) {
            const std::vector<double> q = list(*quaternion, 4, "an orientation is a quaternion: w, x, y, z");
            pose.orientation = Quat(q[0], q[1], q[2], q[3]);
            if (!is_valid(pose)) fail(*quaternion, "this quaternion is not of unit length");
            pose.orientation = glm::normalize(pose.orientation);
        }
        return pose;
    }
};

std::string text_of(const Vec3& v) {
    return fmt::format("\"{:.6f} mm, {:.6f} mm, {:.6f} mm\"", v.x * 1e3, v.y * 1e3, v.z * 1e3);
}
std::string text_of(const Quat& q) { return fmt::format("[{:.15f}, {:.15f}, {:.15f}, {:.15f}]", q.w, q.x, q.y, q.z); }
/// Quotes a text as a TOML basic string.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) >= 0x20) out += c;
    }
    return out + '"';
}

}  // namespace

Vec3 parse_vector(std::string_view text, std::string_view unit) {
    Vec3 v;
    std::size_t begin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = axis < 2 ? text.find(',', begin) : text.size();
        if (comma == std::string_view::npos)
            throw Error(fmt::format("'{}' needs three parts, as in \"0 {}, 0 {}, 0 {}\"", text, unit, unit, unit));
        v[axis] = parse_as(text.substr(begin, comma - begin), unit);
        begin = comma + 1;
    }
    if (!is_finite(v)) throw Error(fmt::format("'{}' is not finite", text));
    return v;
}

DisplayFile load_display_file(const std::filesystem::path& path) { return DisplayReader(path).read(); }

std::string display_text(const DisplayFile& file, const std::vector<std::string>& about) {
    std::string text;
    for (const std::string& line : about) text += line.empty() ? "#\n" : fmt::format("# {}\n", line);
    if (!file.title.empty()) text += fmt::format("title = {}\n", quoted(file.title));
    const DisplayGeometry& geometry = file.geometry;
    text += fmt::format(
        "between_eyes = \"{:.3f} mm\"\noffset = {}     # shift of the picture against the haptic position\n",
        geometry.between_eyes * 1e3, text_of(geometry.visuo_haptic_offset));
    text += fmt::format(
        "\n[head]     # the point between the eyes, in the frame of the tracked body\n"
        "position    = {}\norientation = {}\naway        = \"{:.3f} mm\"\n",
        text_of(file.eyes_in_head.position), text_of(file.eyes_in_head.orientation), file.head_away * 1e3);
    text += fmt::format("\n[device]     # its frame, in the world of the viewer\nposition    = {}\norientation = {}\n",
                        text_of(geometry.haptic_world.position), text_of(geometry.haptic_world.orientation));
    if (geometry.haptic_stretch != Mat3(1.0)) {
        const Mat3& m = geometry.haptic_stretch;
        text += "stretch     = [";
        for (int row = 0; row < 3; ++row)
            text += fmt::format("{}[{:.15f}, {:.15f}, {:.15f}]", row > 0 ? ", " : "", m[0][row], m[1][row], m[2][row]);
        text += "]\n";
    }
    if (geometry.mirror)
        text += fmt::format("\n[mirror]\npoint  = {}\nnormal = [{:.15f}, {:.15f}, {:.15f}]\n",
                            text_of(geometry.mirror->point), geometry.mirror->normal.x, geometry.mirror->normal.y,
                            geometry.mirror->normal.z);
    for (std::size_t i = 0; i < geometry.screens.size(); ++i) {
        const Screen& screen = geometry.screens[i];
        const ScreenSettings& way = file.screens[i];
        text += fmt::format("\n[[screens]]\nname      = {}\nlow_left  = {}\nlow_right = {}\nhigh_left = {}\n",
                            quoted(way.name), text_of(screen.low_left), text_of(screen.low_right),
                            text_of(screen.high_left));
        if (geometry.mirror) text += fmt::format("in_mirror = {}\n", screen.in_mirror);
        if (way.eyes != ScreenEyes::both)
            text += fmt::format("eyes      = \"{}\"\n", screen_eye_names[static_cast<std::size_t>(way.eyes)]);
        if (way.eye) text += fmt::format("eye       = {}\n", text_of(*way.eye));
        if (way.stereo)
            text += fmt::format("stereo    = \"{}\"\n", stereo_names[static_cast<std::size_t>(*way.stereo)]);
        if (way.monitor > 0) text += fmt::format("monitor   = {}\n", way.monitor);
        if (way.window[2] > 0) text += fmt::format("window    = [{}]\n", fmt::join(way.window, ", "));
    }
    return text;
}

}  // namespace tactus::display
