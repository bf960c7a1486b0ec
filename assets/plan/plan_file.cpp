// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_file.hpp"

#include "assets/file/json.hpp"
#include "assets/file/utc_text.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/plan/plan_command.hpp"
#include "assets/reconstruction/flap_json.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

namespace tactus::plan {

namespace {

using file::Json;

constexpr std::string_view format_name = "tactus plan";

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

Json json_of(const Pose& pose) {
    const Vec3& p = pose.position;
    const Quat& q = pose.orientation;
    return {{"position_m", {p.x, p.y, p.z}}, {"quaternion_wxyz", {q.w, q.x, q.y, q.z}}};
}

Json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

Json json_of(const PlanFit& fit) {
    return {{"partner", fit.partner},
            {"verdict", fit.verdict},
            {"score", fit.score},
            {"margin", fit.margin},
            {"rms_m", fit.rms},
            {"gap_m", fit.gap},
            {"penetration_m", fit.penetration},
            {"overlap_m2", fit.overlap}};
}

Json json_of(const MirrorTarget& mirror) {
    return {{"file", mirror.file},
            {"hash", hex(mirror.hash)},
            {"mirrored", mirror.is_mirrored},
            {"plane_normal", json_of(mirror.plane_normal)},
            {"plane_offset_m", mirror.plane_offset},
            {"pose", json_of(mirror.pose)},
            {"residual_m", mirror.residual}};
}

Json json_of(const CasePlan& plan, const PlanStep& step) {
    Json json{{"after", step.before}, {"kind", name_of(step.kind)}, {"by", step.by}};
    if (!step.time.empty()) json["time"] = step.time;
    if (step.run_second) json["run_s"] = *step.run_second;
    Json names = Json::array(), poses = Json::array();
    for (const int n : step.fragments) names.push_back(plan.fragments[static_cast<std::size_t>(n)].name);
    for (const Pose& pose : step.poses) poses.push_back(json_of(pose));
    if (!step.fragments.empty()) json["fragments"] = names;
    if (!step.poses.empty()) json["poses"] = poses;
    if (!step.group.empty()) json["group"] = step.group;
    if (step.fit) json["fit"] = json_of(*step.fit);
    if (step.mirror) json["mirror"] = json_of(*step.mirror);
    if (step.reconstruction) json["reconstruction"] = reconstruction::json_of(*step.reconstruction);
    if (step.painted) json["painted"] = {{"file", step.painted->file}, {"hash", hex(step.painted->hash)}};
    if (step.vessels) json["vessels"] = reconstruction::json_of(*step.vessels);
    return json;
}

/// A text without line breaks, as names and paths must be.
bool is_plain(const std::string& text) {
    return std::ranges::none_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
}

/// The objects of a file that were read, and which members of each.
struct ReadObjects {
    struct Object {
        std::string place;
        std::vector<std::string> names;
    };

    const std::string& file;
    std::map<const Json*, Object> all;

    /// Throws Error for a member that was not asked for: the next change of the plan would lose it.
    void refuse_others() const {
        for (const auto& [json, object] : all) file::refuse_unknown(*json, object.place, object.names);
    }
};

/// A JSON object with its position in the file, such as "steps[3].poses[0]", for messages.
class Item {
public:
    Item(const Json& json, std::string where, ReadObjects& read)
        : json_(json), where_(std::move(where)), read_(read), names_(read.all[&json].names) {
        read_.all[&json].place = place();
        if (!json.is_object()) fail("is not an object");
    }

    [[noreturn]] void fail(const std::string& what) const { throw Error(fmt::format("{} {}", place(), what)); }
    bool has(const char* key) const {
        if (std::ranges::find(names_, key) == names_.end()) names_.emplace_back(key);
        return json_.contains(key);
    }
    const Json& json() const { return json_; }
    std::string place() const { return fmt::format("{}: {}", read_.file, where_.empty() ? "the plan" : where_); }
    /// The place of a member, for messages.
    std::string place(const char* key) const { return fmt::format("{}: {}", read_.file, inside(key)); }
    const Json& at(const char* key) const {
        if (!has(key)) fail(fmt::format("has no '{}'", key));
        const auto found = json_.find(key);
        return *found;
    }
    std::string text(const char* key) const {
        const Json& value = at(key);
        if (!value.is_string() || !is_plain(value.as_text()))
            fail(fmt::format("has a '{}' that is not a one-line text", key));
        return value.get<std::string>();
    }
    double number(const char* key) const { return number(at(key), key); }
    double number(const Json& value, const char* key) const {
        if (!value.is_number()) fail(fmt::format("has a '{}' that is not a number", key));
        const double number = value.get<double>();
        if (!std::isfinite(number)) fail(fmt::format("has a '{}' that is not finite", key));
        return number;
    }
    bool truth(const char* key) const {
        const Json& value = at(key);
        if (!value.is_boolean()) fail(fmt::format("has a '{}' that is neither true nor false", key));
        return value.get<bool>();
    }
    int index(const char* key, std::size_t count) const {
        const Json& value = at(key);
        if (!value.is_number_integer() || value.get<std::int64_t>() < -1 ||
            value.get<std::int64_t>() >= static_cast<std::int64_t>(count))
            fail(fmt::format("has a '{}' that is not an earlier step", key));
        return static_cast<int>(value.get<std::int64_t>());
    }
    const Json& list(const char* key) const {
        const Json& value = at(key);
        if (!value.is_array()) fail(fmt::format("has a '{}' that is not a list", key));
        return value;
    }
    std::vector<double> numbers(const char* key, std::size_t count) const {
        std::vector<double> numbers;
        for (const Json& value : list(key)) numbers.push_back(number(value, key));
        if (numbers.size() != count) fail(fmt::format("has a '{}' that does not have {} numbers", key, count));
        return numbers;
    }
    Vec3 vector(const char* key) const {
        const auto v = numbers(key, 3);
        return {v[0], v[1], v[2]};
    }
    std::uint64_t hash(const char* key) const {
        const std::string digits = text(key);
        if (digits.size() != 16 || digits.find_first_not_of("0123456789abcdef") != std::string::npos)
            fail(fmt::format("has a '{}' that is not a hash", key));
        return std::stoull(digits, nullptr, 16);
    }
    Item item(const char* key) const { return {at(key), inside(key), read_}; }
    Item item(const char* key, const Json& value, std::size_t n) const {
        return {value, fmt::format("{}[{}]", inside(key), n), read_};
    }
    Pose pose() const {
        const auto q = numbers("quaternion_wxyz", 4);
        const Pose pose{vector("position_m"), {q[0], q[1], q[2], q[3]}};
        if (!is_valid(pose)) fail("is not a pose: its quaternion does not have unit length");
        return pose;
    }

private:
    std::string inside(const char* key) const { return where_.empty() ? key : where_ + "." + key; }

    const Json& json_;
    std::string where_;
    ReadObjects& read_;
    std::vector<std::string>& names_;
};

PlanFit read_fit(const Item& item) {
    return {item.text("partner"), item.text("verdict"), item.number("score"),         item.number("margin"),
            item.number("rms_m"), item.number("gap_m"), item.number("penetration_m"), item.number("overlap_m2")};
}

MirrorTarget read_mirror(const Item& item) {
    const Vec3 normal = item.vector("plane_normal");
    if (!(std::abs(glm::length(normal) - 1.0) < 1e-6)) item.fail("has a 'plane_normal' that does not have unit length");
    return {item.text("file"),
            item.hash("hash"),
            !item.has("mirrored") || item.truth("mirrored"),
            normal,
            item.number("plane_offset_m"),
            item.item("pose").pose(),
            item.number("residual_m")};
}

StepKind read_kind(const Item& item) {
    const std::string name = item.text("kind");
    for (int n = 0; n <= static_cast<int>(StepKind::vessels); ++n)
        if (name == name_of(static_cast<StepKind>(n))) return static_cast<StepKind>(n);
    item.fail(fmt::format("has the unknown kind '{}'", name));
}

PlanStep read_step(const CasePlan& plan, const Item& item) {
    PlanStep step;
    step.before = item.index("after", plan.steps.size());
    step.kind = read_kind(item);
    step.by = item.text("by");
    if (item.has("time")) step.time = item.text("time");
    if (item.has("run_s")) step.run_second = item.number("run_s");
    if (item.has("group")) step.group = item.text("group");
    if (item.has("fragments"))
        for (const Json& name : item.list("fragments")) {
            if (!name.is_string() || !is_plain(name.as_text()))
                item.fail("has a 'fragments' list with an element that is not a name");
            try {
                step.fragments.push_back(find_fragment(plan, name.get<std::string>()));
            } catch (const Error& error) {
                item.fail("is wrong: " + error.message());
            }
        }
    if (item.has("poses")) {
        std::size_t n = 0;
        for (const Json& pose : item.list("poses")) step.poses.push_back(item.item("poses", pose, n++).pose());
    }
    if (item.has("fit")) step.fit = read_fit(item.item("fit"));
    if (item.has("mirror")) step.mirror = read_mirror(item.item("mirror"));
    if (item.has("reconstruction"))
        step.reconstruction = std::make_shared<reconstruction::Reconstruction>(
            reconstruction::reconstruction_of(item.at("reconstruction"), item.place("reconstruction")));
    if (item.has("painted")) {
        const Item painted = item.item("painted");
        step.painted = HashedFile{painted.text("file"), painted.hash("hash")};
    }
    if (item.has("vessels"))
        step.vessels = std::make_shared<std::vector<reconstruction::FlapVessel>>(
            reconstruction::vessels_of(item.json(), item.place()));
    return step;
}

void read_fragments(CasePlan& plan, const Item& top) {
    const Json& list = top.list("fragments");
    if (list.size() > max_fragments) top.fail(fmt::format("has more than {} fragments", max_fragments));
    std::set<std::string> names;
    for (std::size_t n = 0; n < list.size(); ++n) {
        const Item item = top.item("fragments", list[n], n);
        PlanFragment fragment{item.text("name"), item.text("file"), item.hash("hash"), item.vector("colour")};
        if (fragment.name.empty()) item.fail("has an empty name");
        if (!names.insert(fragment.name).second)
            item.fail(fmt::format("has the name '{}', which another fragment has", fragment.name));
        plan.fragments.push_back(std::move(fragment));
    }
}

void check_steps(const CasePlan& plan, const Item& top) {
    try {
        visit_steps(plan, [](int, const PlanState&, const PlanState&) {});
    } catch (const Error& error) {
        top.fail(error.message());
    }
}

void read_alternatives(CasePlan& plan, const Item& top) {
    plan.alternatives.clear();
    const auto before = plan.before();
    std::size_t n = 0;
    for (const Json& json : top.list("alternatives")) {
        const Item item = top.item("alternatives", json, n++);
        PlanAlternative alternative{item.text("name"),
                                    {item.index("head", plan.steps.size()), item.index("tip", plan.steps.size())}};
        if (alternative.name.empty() || std::ranges::any_of(plan.alternatives, [&](const PlanAlternative& other) {
                return other.name == alternative.name;
            }))
            item.fail(fmt::format("has the name '{}', which is empty or taken", alternative.name));
        if (!fit::is_on_way(before, alternative.place.head, alternative.place.tip))
            item.fail("has a head that is not on the path to its tip");
        plan.alternatives.push_back(std::move(alternative));
    }
    const std::string current = top.text("current");
    const auto found = std::ranges::find(plan.alternatives, current, &PlanAlternative::name);
    if (found == plan.alternatives.end())
        top.fail(fmt::format("has the current alternative '{}', which does not exist", current));
    plan.current = static_cast<int>(found - plan.alternatives.begin());
}

Json parsed(std::string_view text, const std::string& file) {
    try {
        return Json::parse(text);
    } catch (const file::JsonSyntaxError& error) {
        // The parser counts bytes from 1 and reports the byte after the text when the text ends too early.
        const bool cut = error.byte > text.size();
        throw Error(fmt::format("{}: {} at byte {} of {}; {}", file, cut ? "the plan is cut short" : "not JSON",
                                error.byte, text.size(), cut ? "copy the whole file again" : "a plan is a JSON file"));
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", file, error.message()));
    }
}

}  // namespace

std::string plan_text(const CasePlan& plan) {
    Json json{{"format", format_name},
              {"version", plan_file_version},
              {"title", plan.title},
              {"frame", "LPS"},
              {"unit", "m"},
              {"pose", "p_case = R p_file + t"},
              {"fragments", Json::array()},
              {"current", plan.alternatives[static_cast<std::size_t>(plan.current)].name},
              {"alternatives", Json::array()},
              {"steps", Json::array()}};
    for (const PlanFragment& f : plan.fragments)
        json["fragments"].push_back(
            {{"name", f.name}, {"file", f.file}, {"hash", hex(f.hash)}, {"colour", json_of(f.colour)}});
    for (const PlanAlternative& a : plan.alternatives)
        json["alternatives"].push_back({{"name", a.name}, {"head", a.place.head}, {"tip", a.place.tip}});
    for (const PlanStep& step : plan.steps) json["steps"].push_back(json_of(plan, step));
    return json.dump(1) + "\n";
}

CasePlan read_plan_text(std::string_view text, const std::string& file) {
    const Json json = parsed(text, file);
    ReadObjects read{file, {}};
    const Item top(json, "", read);
    if (!top.has("format") || json["format"] != format_name)
        throw Error(fmt::format("{}: is not a plan; a plan has \"format\": \"{}\"", file, format_name));
    if (const Json& version = top.at("version"); version != plan_file_version)
        throw Error(fmt::format("{}: the plan has version {}, but this program reads version {}; nothing was changed",
                                file, version.dump(), plan_file_version));
    top.has("pose");  // for readers of the file: how a pose is to be understood
    if (top.text("frame") != "LPS" || top.text("unit") != "m") top.fail("must have frame \"LPS\" and unit \"m\"");
    CasePlan plan;
    plan.title = top.text("title");
    read_fragments(plan, top);
    std::size_t n = 0;
    for (const Json& step : top.list("steps")) plan.steps.push_back(read_step(plan, top.item("steps", step, n++)));
    read_alternatives(plan, top);
    read.refuse_others();
    check_steps(plan, top);
    return plan;
}

CasePlan load_case_plan(const std::filesystem::path& path) {
    return read_plan_text(file::read_whole_file(path), path.string());
}

void save_case_plan(const CasePlan& plan, const std::filesystem::path& path) {
    file::write_durable_file(path, plan_text(plan));
}

std::string time_of_day() { return file::utc_text(std::chrono::system_clock::now(), true); }

}  // namespace tactus::plan
