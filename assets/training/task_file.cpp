// SPDX-License-Identifier: Apache-2.0
#include "assets/training/task_file.hpp"

#include "assets/file/toml_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::training {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_spared = 64, max_cuts = 32, max_settings = 256, longest_name = 64;

class TaskReader : file::TomlFile {
public:
    explicit TaskReader(const fs::path& path) : file::TomlFile(path, "a task file"), path_(fs::absolute(path)) {}

    TaskFile read() {
        const toml::table& root = this->root();
        know(root, {"format", "title", "about", "bone", "patch", "settings", "length", "blade", "cut", "guide", "spare",
                    "limits"});
        check_format(root);
        TaskFile task;
        task.file = path_;
        task.title = line(need(root, "title", "a task needs a title"));
        if (const auto* node = root.get("about")) task.about = word(*node);
        task.bone = beside(need(root, "bone", "a task needs a bone: bone = \"FILE.vdb\""));
        if (const auto* node = root.get("patch")) task.patch = patch(*node);
        if (const auto* node = root.get("settings")) task.settings = settings(*node);
        if (const auto* node = root.get("length")) task.length = quantity(*node, "s", 1.0, 3600.0);
        if (const auto* node = root.get("blade")) read_blade(as_table(*node), task.blade);
        if (const auto* node = root.get("guide")) read_guide(*node, task);
        read_cuts(need(root, "cut", "a task needs a table [cut]"), task);
        if (const auto* node = root.get("spare")) read_spared(*node, task);
        if (const auto* node = root.get("limits")) read_limits(as_table(*node), task.limits);
        return task;
    }

private:
    void check_format(const toml::table& root) const {
        const toml::node& node = need(root, "format", fmt::format("a task begins with format = {}", task_format));
        const auto format = node.value_exact<std::int64_t>();
        if (!format) fail(node, "the format is a whole number");
        if (*format != task_format)
            fail(node, fmt::format("the task has format {}, but this program reads format {}", *format, task_format));
    }

    void read_blade(const toml::table& table, BladeSize& blade) const {
        know(table, {"length", "height", "kerf", "stroke"});
        const auto set = [&](const char* name, double& value, double least, double most) {
            if (const auto* node = table.get(name)) value = quantity(*node, "mm", least, most);
        };
        set("length", blade.length, 1e-3, 0.3);
        set("height", blade.height, 1e-3, 0.3);
        set("kerf", blade.kerf, 0.05e-3, 20e-3);
        set("stroke", blade.stroke, 0.0, 50e-3);
    }

    void read_guide(const toml::node& node, TaskFile& task) const {
        const toml::table& table = as_table(node);
        know(table, {"bone", "removal"});
        GuideFile guide;
        guide.line = static_cast<int>(node.source().begin.line);
        guide.bone = beside(need(node, table, "bone", "a guide needs 'bone', its file: bone = \"FILE.vdb\""));
        guide.removal = direction(need(node, table, "removal", "a guide needs 'removal', along which it is taken off"));
        task.guide = std::move(guide);
    }

    /// One table, or several.
    void read_cuts(const toml::node& node, TaskFile& task) const {
        task.cuts.clear();
        const toml::array* const array = node.as_array();
        if (!array) {
            task.cuts.push_back(read_cut(node, as_table(node), task));
            return;
        }
        if (array->empty()) fail(node, "a task needs a cut");
        if (array->size() > max_cuts) fail(node, fmt::format("a task has at most {} cuts", max_cuts));
        for (const toml::node& one : *array) {
            PlannedCut cut = read_cut(one, as_table(one), task);
            if (cut.name.empty()) cut.name = fmt::format("{}", task.cuts.size() + 1);
            if (std::ranges::any_of(task.cuts, [&](const PlannedCut& other) { return other.name == cut.name; }))
                fail(one, fmt::format("two cuts are called '{}'", cut.name));
            task.cuts.push_back(std::move(cut));
        }
    }

    void read_slot(const toml::node& node, const PlannedCut& cut, TaskFile& task) const {
        if (!task.guide) fail(node, "a slot needs a table [guide]");
        const toml::table& table = as_table(node);
        know(table, {"wall", "width", "top", "bottom", "low", "high"});
        const auto length = [&](const char* name, const char* what) {
            return quantity(need(node, table, name, fmt::format("a slot needs '{}', {}", name, what)), "mm", -0.2, 0.2);
        };
        saw::GuideSlot slot;
        slot.frame = {cut.point, glm::normalize(glm::quat_cast(cut.axes()))};
        slot.wall = length("wall", "the wall on the kept side, along the normal");
        slot.other_wall = std::numeric_limits<double>::infinity();
        if (const auto* width = table.get("width"))
            slot.other_wall = slot.wall + quantity(*width, "mm", 0.05e-3, 20e-3);
        slot.top = -length("top", "the height of its mouth above 'point'");
        slot.bottom = -length("bottom", "the height of its lower end above 'point'");
        slot.low = length("low", "where it begins along the stroke");
        slot.high = length("high", "where it ends along the stroke");
        if (!(slot.top < slot.bottom)) fail(node, "the mouth of the slot is not above its lower end");
        if (!(slot.low < slot.high)) fail(node, "the slot ends before it begins");
        task.slots.push_back(slot);
    }

    PlannedCut read_cut(const toml::node& where, const toml::table& table, TaskFile& task) const {
        know(table, {"name", "kind", "point", "normal", "from", "to", "feed", "depth", "tolerance", "depth_tolerance",
                     "angle_tolerance", "slot"});
        PlannedCut cut;
        if (const auto* node = table.get("name")) cut.name = line(*node);
        const toml::node& kind = need(where, table, "kind", "a cut is of the kind \"plane\" or \"line\"");
        const std::string name = word(kind);
        // Files may still have the old name of a line.
        const bool is_line = name == "line" || name == "guide";
        if (name != "plane" && !is_line)
            fail(kind, fmt::format("'{}' is neither \"plane\" nor \"line\"{}", name,
                                   did_you_mean(name, std::vector<std::string>{"plane", "line"})));
        for (const char* other : {"point", "normal"})
            if (const auto* node = table.get(other); node && is_line)
                fail(*node, fmt::format("a line has 'from' and 'to' instead of '{}'", other));
        for (const char* other : {"from", "to"})
            if (const auto* node = table.get(other); node && !is_line)
                fail(*node, fmt::format("a plane has 'point' and 'normal' instead of '{}'", other));
        const toml::node& feed =
            need(where, table, "feed", "a cut needs 'feed', the direction into the bone, as [x, y, z]");
        const Vec3 into = direction(feed);
        if (is_line) {
            const toml::node &from = need(where, table, "from", "a line needs 'from', the point where it begins"),
                             &to = need(where, table, "to", "a line needs 'to', the point where it ends");
            const Vec3 begin = vector(from), line = vector(to) - begin;
            const double length = glm::length(line);
            if (!(length > 1e-3)) fail(to, "the line is shorter than 1 mm");
            cut.stroke = line / length;
            cut.point = begin + 0.5 * line;
            cut.half_length = 0.5 * length;
            const Vec3 down = into - glm::dot(into, cut.stroke) * cut.stroke;
            if (!(glm::length(down) > 0.5)) fail(feed, "the feed is not across the line");
            cut.feed = glm::normalize(down);
        } else {
            cut.point = vector(need(where, table, "point", "a plane needs 'point', where the blade enters the bone"));
            const Vec3 normal = direction(need(where, table, "normal", "a plane needs 'normal' as [x, y, z]"));
            const Vec3 down = into - glm::dot(into, normal) * normal;
            if (!(glm::length(down) > 0.5)) fail(feed, "the feed does not lie in the plane");
            cut.feed = glm::normalize(down);
            cut.stroke = glm::normalize(glm::cross(cut.feed, normal));
        }
        cut.normal = glm::cross(cut.stroke, cut.feed);
        cut.depth = quantity(need(where, table, "depth", "a cut needs 'depth', the depth stop along the feed"), "mm",
                             0.1e-3, 0.3);
        if (const auto* node = table.get("tolerance")) cut.tolerance = quantity(*node, "mm", 0.01e-3, 50e-3);
        cut.depth_tolerance = cut.tolerance;
        if (const auto* node = table.get("depth_tolerance")) cut.depth_tolerance = quantity(*node, "mm", 0.0, 50e-3);
        if (const auto* node = table.get("angle_tolerance"))
            cut.angle_tolerance = quantity(*node, "deg", 0.01 * degree, 90.0 * degree);
        if (const auto* node = table.get("slot")) read_slot(*node, cut, task);
        return cut;
    }

    void read_spared(const toml::node& node, TaskFile& task) const {
        const auto* array = node.as_array();
        if (!array) fail(node, "structures are tables [[spare]]");
        if (array->size() > max_spared) fail(node, fmt::format("a task spares at most {} structures", max_spared));
        for (const toml::node& one : *array) {
            const toml::table& table = as_table(one);
            know(table, {"name", "file", "label", "margin"});
            SparedFile spared;
            spared.line = static_cast<int>(one.source().begin.line);
            const toml::node& name = need(one, table, "name", "a structure needs a name");
            spared.name = line(name);
            if (std::ranges::any_of(task.spare, [&](const SparedFile& other) { return other.name == spared.name; }))
                fail(name, fmt::format("two structures are called '{}'", spared.name));
            spared.file = beside(need(one, table, "file", "a structure needs 'file', a label map"));
            if (const auto* label = table.get("label")) {
                const auto value = label->value_exact<std::int64_t>();
                if (!value || *value < 1 || *value > 65535) fail(*label, "a label is a whole number from 1 to 65535");
                spared.label = static_cast<int>(*value);
            }
            if (const auto* margin = table.get("margin")) spared.margin = quantity(*margin, "mm", 0.0, 50e-3);
            task.spare.push_back(std::move(spared));
        }
    }

    void read_limits(const toml::table& table, TaskLimits& limits) const {
        know(table, {"force", "time", "heat"});
        if (const auto* node = table.get("force")) limits.force = quantity(*node, "N", 0.01, 1000.0);
        if (const auto* node = table.get("time")) limits.time = quantity(*node, "s", 0.1, 36000.0);
        if (const auto* node = table.get("heat")) limits.heat = quantity(*node, "s", 0.0, 36000.0);
    }

    const toml::node& need(const toml::table& table, const char* name, const std::string& message) const {
        if (const auto* node = table.get(name)) return *node;
        throw Error(SourceLocation{file(), 1, 1}, message);
    }
    /// A missing key is reported where its table begins.
    const toml::node& need(const toml::node& where, const toml::table& table, const char* name,
                           const std::string& message) const {
        if (const auto* node = table.get(name)) return *node;
        fail(where, message);
    }
    /// A name for tables and pages: one line, not too long.
    std::string line(const toml::node& node) const {
        const std::string text = word(node);
        if (text.empty() || text.size() > longest_name ||
            std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
            fail(node, fmt::format("a name is one line of 1 to {} bytes", longest_name));
        return text;
    }
    fs::path beside(const toml::node& node) const {
        const std::string name = word(node);
        if (name.empty() || name.find('\0') != std::string::npos) fail(node, "a file name is expected here");
        return (path_.parent_path() / name).lexically_normal();
    }
    /// A bare name is one of the library; anything else is a file beside the task.
    std::string patch(const toml::node& node) const {
        const std::string name = word(node);
        if (name.find('/') == std::string::npos && !name.ends_with(".toml") && !name.empty()) return name;
        return beside(node).string();
    }
    std::vector<std::string> settings(const toml::node& node) const {
        const auto* array = node.as_array();
        if (!array) fail(node, "settings are a list of texts: [\"NODE.PARAM=VALUE\"]");
        if (array->size() > max_settings) fail(node, fmt::format("a task has at most {} settings", max_settings));
        std::vector<std::string> all;
        for (const toml::node& one : *array) {
            all.push_back(word(one));
            const std::size_t dot = all.back().find('.'), equals = all.back().find('=');
            if (dot == std::string::npos || equals == std::string::npos || equals < dot)
                fail(one, fmt::format("'{}' is not NODE.PARAM=VALUE", all.back()));
        }
        return all;
    }
    double quantity(const toml::node& node, std::string_view unit, double least, double most) const {
        double value = 0.0;
        try {
            value = parse_as(word(node), unit);
        } catch (const Error& error) {
            if (error.where().line > 0) throw;
            fail(node, error.message());
        }
        if (!(value >= least && value <= most))
            fail(node, fmt::format("must be {} to {}", format_quantity(least, unit), format_quantity(most, unit)));
        return value;
    }
    Vec3 vector(const toml::node& node) const {
        const std::string text = word(node);
        Vec3 v;
        std::size_t begin = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const std::size_t comma = axis < 2 ? text.find(',', begin) : text.size();
            if (comma == std::string::npos) fail(node, "a point needs three parts, as in \"0 mm, 0 mm, 0 mm\"");
            try {
                v[axis] = parse_as(std::string_view(text).substr(begin, comma - begin), "mm");
            } catch (const Error& error) {
                fail(node, error.message());
            }
            begin = comma + 1;
        }
        if (!is_finite(v) || glm::length(v) > 10.0) fail(node, "the point lies more than 10 m away");
        return v;
    }
    Vec3 direction(const toml::node& node) const {
        const auto* array = node.as_array();
        if (!array || array->size() != 3) fail(node, "a direction has three numbers, as in [0, 0, -1]");
        Vec3 v;
        for (int axis = 0; axis < 3; ++axis) {
            const toml::node& one = *array->get(static_cast<std::size_t>(axis));
            const auto value = one.is_number() ? one.value<double>() : std::nullopt;
            if (!value || !(std::abs(*value) < 1e6)) fail(one, "a direction has three finite numbers");
            v[axis] = *value;
        }
        if (!(glm::length(v) > 1e-6)) fail(node, "this direction is zero");
        return glm::normalize(v);
    }

    fs::path path_;
};

}  // namespace

TaskFile load_task_file(const fs::path& path) { return TaskReader(path).read(); }

}  // namespace tactus::training
