// SPDX-License-Identifier: Apache-2.0
#include "tests/nodes/forces/force_sweep.hpp"

#include "dsp/contact/shape.hpp"
#include "dsp/control/energy_cap.hpp"
#include "dsp/control/stated_hand.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/triangle_tree.hpp"
#include "dsp/volume/bricks.hpp"
#include "graph/node/task_asset.hpp"
#include "nodes/catalogue.hpp"
#include "tests/nodes/contact/closed_paths.hpp"
#include "tests/nodes/plan/flap_case.hpp"
#include "tests/support/node_harness.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace tactus::test {

namespace {

const Quat blade_down = rotation_by({-0.5 * std::numbers::pi, 0.0, 0.0});

// In one tick: N, N·m, and a share of the largest force, a third of what a hand can tell apart (L. A. Jones, 1989: 7 %).
constexpr double jump_force = 0.2, jump_torque = 0.01, jump_share = 0.02;
constexpr double touch = 1e-3;  // N, from which a contact counts
constexpr double lever = 0.05;  // m, that makes a force of a torque
constexpr int refined = 16;

/// Node types that jump, or give energy, on purpose, and why. What a hand feels of it is what device_output passes.
using Exceptions = std::map<std::string_view, std::string_view>;
const Exceptions jumps{
    {"passivity_observer", "takes a force away at once, as the energy cap does"},
};
const Exceptions gives_energy{
    {"held_weight", "a weight that slides through the fingers gives its potential energy"},
    {"force_shaping", "its low-pass adds delay, as its declaration states"},
};

double size_of(const Wrench& w) { return glm::length(w.force) + glm::length(w.torque) / lever; }

/// Random numbers one after the other.
struct Draws {
    Random random;
    std::uint64_t at = 0;

    double uniform() { return random.uniform(at++); }
    double between(double low, double high) { return low * std::pow(high / low, uniform()); }
    bool chance(double probability) { return uniform() < probability; }
    std::size_t index(std::size_t count) {
        return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
    }
};

std::string_view exception_of(const ForceTrial& trial, const Exceptions& exceptions) {
    const auto word = trial.setting.words.find("direction");
    if (word != trial.setting.words.end() && word->second == "shell_normal")
        return "a force along the normals of points is the gradient of no energy: a law of the thesis, kept for "
               "comparison";
    const auto found = exceptions.find(trial.type->name);
    return found == exceptions.end() ? std::string_view{} : found->second;
}

// Members of a node type.

/// One member that a patch sets.
struct Factor {
    std::string name;
    std::vector<std::string> words;  // of a choice or a flag
    double low = 0.0, high = 0.0;  // of a parameter
    bool is_whole = false;
    bool is_in_corners = true;

    bool is_number() const { return words.empty(); }
    std::size_t levels() const { return is_number() ? 2 : words.size(); }
    void put(std::size_t level, NodeSetting& setting) const {
        if (is_number()) setting.numbers[name] = level == 0 ? low : high;
        else setting.words[name] = words[level];
    }
};

struct Port {
    std::string name, unit;
    const ValueType* type;
    bool is_optional, is_of_world;
};

struct Declared final : MemberVisitor {
    explicit Declared(const NodeType& type) {
        void* const node = type.create();
        type.visit(node, *this);
        type.destroy(node);
        // Behind all others, whose random numbers stay the same.
        if (guide_stiffness) {
            factors.push_back({"guide", {"none", "slot"}, 0.0, 0.0, false, false});
            factors.push_back(*guide_stiffness);
        }
    }
    void input(std::string_view name, Input& port) override {
        inputs.push_back({std::string(name), port.unit, port.type, port.is_optional, port.is_of_world});
    }
    void output(std::string_view name, Output& port) override {
        if (port.type == &value_type<Wrench>() && force.empty()) force = name;
    }
    void param(std::string_view name, Param& p) override {
        // The scene decides which body is held. A bound on the computing time of a tick cuts an evaluation off, and the
        // force with it: what it does to a force is not judged.
        if (name == "held") has_held = true;
        else if (name == "guide_stiffness") {
            if (is_tool()) guide_stiffness = {"guide_stiffness", {}, p.min, p.max, false, false};
        } else if (!p.is_trigger && name != "budget" && name != "iterations")
            factors.push_back({std::string(name), {}, p.min, p.max, p.is_discrete});
    }
    void choice(std::string_view name, Choice& c) override { factors.push_back({std::string(name), c.options, 0, 0}); }
    void flag(std::string_view name, Flag&) override {
        factors.push_back({std::string(name), {"false", "true"}, 0, 0});
    }

    std::vector<Port> inputs;
    std::vector<Factor> factors;
    std::string force;
    bool has_held = false;

private:
    bool is_tool() const {
        return std::ranges::any_of(inputs, [](const Port& port) { return port.name == "bone"; });
    }
    std::optional<Factor> guide_stiffness;
};

// The world around a node.

struct Part {
    contact::Pointshell shell;
    contact::Voxmap map;
    geometry::TriangleTree triangles;

    template <class Shape>
    Part(const Shape& shape, double spacing, double voxel)
        : shell(contact::make_pointshell(shape.points(spacing))),
          map(contact::voxmap_of(shape, voxel, 3.0 * mm)),
          triangles(geometry::iso_surface(map.grid, 0.0f, false)) {}
};

/// Place 0: a table of 90 × 90 × 10 mm, its top at z = 0: no path leaves it over an edge, where a force ends at once. Place 1: a
/// box of 10 mm, which the hand holds.
const coupling::Scene& swept_scene() {
    static const Part table(contact::Box{Vec3(90.0, 90.0, 10.0) * mm}, 1.0 * mm, 0.75 * mm);
    static const Part box(contact::Box{Vec3(10.0 * mm)}, 1.0 * mm, 0.5 * mm);
    static const coupling::Scene scene = [] {
        const Quat upright(1.0, 0.0, 0.0, 0.0);
        coupling::Scene made;
        made.count = 2;
        made.objects[0] = {{&table.shell, &table.map, &table.triangles, {}, 1, 1}, {{0.0, 0.0, -5.0 * mm}, upright}};
        made.objects[1] = {{&box.shell, &box.map, &box.triangles, {}, 1, 2}, {{300.0 * mm, 0.0, 60.0 * mm}, upright}};
        made.content_hash = coupling::hash_of(made);
        return made;
    }();
    return scene;
}

/// A plate of bone of 70 × 70 mm and `thickness` m, its top at z = 0.
volume::BoneEditor plate(double thickness) {
    const contact::Box box{Vec3(70.0 * mm, 70.0 * mm, thickness)};
    volume::Grid distance{{150, 150, 40}, Vec3(-37.5 * mm, -37.5 * mm, -10.0 * mm), Vec3(0.5 * mm), {}};
    distance.values.resize(distance.count());
    volume::Grid density = distance;
    for (int k = 0; k < distance.size[2]; ++k)
        for (int j = 0; j < distance.size[1]; ++j)
            for (int i = 0; i < distance.size[0]; ++i) {
                distance.at(i, j, k) = static_cast<float>(box.distance(distance.position(i, j, k)));
                density.at(i, j, k) = 1600.0f;
            }
    distance.origin.z -= 0.5 * thickness;
    density.origin = distance.origin;
    return {distance, density, {.band = 0.1, .max_dirty = 1, .max_versions = 1}};
}

const volume::BoneEditor& swept_bone(bool is_thin) {
    static const volume::BoneEditor block = plate(12.0 * mm), thin = plate(1.5 * mm);
    return is_thin ? thin : block;
}

/// A guide on the bone with a slot for a blade of that kerf, whose teeth point down.
std::shared_ptr<const training::Task> guide_for(double kerf) {
    const double half = 0.5 * kerf + 0.15 * mm;
    auto task = std::make_shared<training::Task>();
    saw::GuideSlot slot;
    slot.frame = {Vec3(0.0), blade_down};
    slot.low = -15.0 * mm, slot.high = 15.0 * mm, slot.top = -10.5 * mm, slot.bottom = -0.5 * mm;
    slot.wall = -half, slot.other_wall = half;
    task->slots = {slot};
    const contact::Box walls{Vec3(34.0, 14.0, 10.0) * mm};
    auto body = std::make_shared<bone::Bone>();
    volume::Grid& distance = body->distance;
    distance = {{76, 36, 28}, Vec3(-19.0 * mm, -9.0 * mm, -1.5 * mm), Vec3(0.5 * mm), {}};
    distance.values.resize(distance.count());
    for (int k = 0; k < distance.size[2]; ++k)
        for (int j = 0; j < distance.size[1]; ++j)
            for (int i = 0; i < distance.size[0]; ++i) {
                const Vec3 p = distance.position(i, j, k);
                const double hole = std::max(std::abs(p.x) - 15.0 * mm, std::abs(p.y) - half);
                distance.at(i, j, k) =
                    static_cast<float>(std::max(walls.distance(p - Vec3(0.0, 0.0, 5.5 * mm)), -hole));
            }
    body->density = distance;
    task->guide = training::GuideFile{"guide.vdb", {0.0, 0.0, 1.0}, 1};
    task->guide_body = std::move(body);
    return task;
}

bool is_guided(const NodeSetting& setting) {
    const auto guide = setting.words.find("guide");
    return guide != setting.words.end() && guide->second != "none";
}

/// A node and what it is wired to. Inputs of the hand follow `hand`; all others stand still.
class DrivenNode {
public:
    explicit DrivenNode(const ForceTrial& trial)
        : node_(*trial.type, {.period = static_cast<Flicks>(std::llround(flicks_per_second / trial.hand.rate))}),
          declared_(*trial.type) {
        Draws draws{{mix(trial.seed ^ 0xf0)}};
        wall_stiffness_ = draws.between(100.0, 200e3);
        wall_depth_ = draws.chance(0.5) ? draws.between(0.1 * mm, 5.0 * mm) : 1.0;
        for (const auto& [name, number] : trial.setting.numbers) node_.set_value(name, number);
        for (const auto& [name, word] : trial.setting.words)
            if (name != "guide") node_.set(name, word);
        if (is_guided(trial.setting)) {
            const auto kerf = trial.setting.numbers.find("kerf");
            node_.asset("guide", guide_for(kerf == trial.setting.numbers.end() ? 1.0 * mm : kerf->second));
        }
        if (declared_.has_held) node_.set("held", "1");
        node_.disconnect_optional();
        if (trial.type->name == "vessel") hold_segment(trial.setting.numbers.contains("pedicle"));
        else
            for (const Port& port : declared_.inputs) wire(port, draws);
        node_.prepare();
    }

    Wrench step(const Pose& hand, const Twist& twist, const Wrench& applied) {
        hand_ = hand;
        twist_ = twist;
        applied_ = applied;
        node_.run(1);
        asked_ = node_.last<Wrench>(declared_.force);
        node_.forget();
        return asked_;
    }
    Wrench step(const Pose& hand) { return step(hand, {}, asked_); }

    /// The tool of the node is driven: it may give energy.
    bool is_powered() const { return is_powered_; }

private:
    /// The hand holds the upper segment of a flap, whose pedicle is sewn 60 mm above it: it pulls as the hand goes down.
    void hold_segment(bool has_pedicle) {
        static const FlapScene flap_scene;
        node_.asset("plan", flap()).asset("course", vessel_course());
        node_.set("pieces", "segment").set("site_at", "0 mm, 0 mm, 160 mm");
        if (!has_pedicle) node_.set("pedicle", "60 mm");
        node_.feed("scene", flap_scene.moved({})).feed("held", 2.0);
        const Pose home = flap_scene.scene.objects[2].body.home;
        for (const char* port : {"hand", "pose"})
            node_.feed<Pose>(port, [this, home](std::int64_t) { return hand_ * home; });
        node_.connect("held").connect("hand").connect("pose");
    }

    /// Force of the wall z = 0 on the hand; beyond `wall_depth_` it grows no further.
    double wall() const { return wall_stiffness_ * std::clamp(-hand_.position.z, 0.0, wall_depth_); }

    void wire(const Port& port, Draws& draws) {
        const std::string& name = port.name;
        const ValueType* const type = port.type;
        if (type == &value_type<Pose>()) {
            const bool is_hand =
                !port.is_of_world && (!has_hand_ || name == "hand" || name == "pose" || name == "point");
            if (port.is_optional && !is_hand) return;
            has_hand_ = has_hand_ || is_hand;
            if (is_hand) node_.feed<Pose>(name, [this](std::int64_t) { return hand_; });
            // The axes of a device are at its handle, and torques about it.
            else if (name == "frame" && !port.is_of_world)
                node_.feed<Pose>(name, [this](std::int64_t) { return Pose{hand_.position, {1.0, 0.0, 0.0, 0.0}}; });
            else node_.feed(name, Pose{});
        } else if (type == &value_type<Twist>()) {
            const bool is_hand = !std::exchange(has_twist_, true);
            if (port.is_optional && draws.chance(0.5)) return;
            if (is_hand) node_.feed<Twist>(name, [this](std::int64_t) { return twist_; });
            else node_.feed(name, Twist{});
        } else if (type == &value_type<Wrench>()) {
            if (name == "applied") node_.feed<Wrench>(name, [this](std::int64_t) { return applied_; });
            else if (name == "asked") node_.feed<Wrench>(name, [this](std::int64_t) { return asked_; });
            else node_.feed<Wrench>(name, [this](std::int64_t) { return Wrench{{0.0, 0.0, wall()}, {}}; });
        } else if (type == &value_type<Vec3>()) {
            const bool is_force = port.unit == "N";
            node_.feed<Vec3>(name, [this, is_force](std::int64_t) { return Vec3(0.0, 0.0, is_force ? wall() : 0.0); });
        } else if (type == &value_type<bool>()) {
            if (port.is_optional && draws.chance(0.5)) return is_running(name, true);
            const bool is_on = draws.chance(0.5);
            is_running(name, is_on);
            node_.feed(name, is_on);
        } else if (type == &value_type<double>()) {
            if (port.is_optional && name != "held") return;
            const auto stiffness = [this](std::int64_t) {
                const double depth = -hand_.position.z;
                return depth > 0.0 && depth < wall_depth_ ? wall_stiffness_ : 0.0;
            };
            if (port.unit == "N/m") node_.feed<double>(name, stiffness);
            else node_.feed(name, port.unit == "N" ? 5.0 : 1.0);
        } else if (type == &value::snapshot<volume::BoneSnapshot>) {
            node_.feed(name, swept_bone(draws.chance(0.3)).current());
        } else if (type == &value::snapshot<coupling::Scene>) {
            node_.feed(name, swept_scene());
        } else if (port.is_optional) {
            return;
        }
        if (port.is_optional) node_.connect(name);
    }

    void is_running(const std::string& name, bool is_on) { is_powered_ = is_powered_ || (name == "running" && is_on); }

    NodeHarness node_;
    Declared declared_;
    Pose hand_;
    Twist twist_;
    Wrench asked_, applied_;
    double wall_stiffness_ = 0.0, wall_depth_ = 0.0;
    bool has_hand_ = false, has_twist_ = false, is_powered_ = false;
};

// Where the force begins.

struct Surface {
    double z = 0.0;  // m, where the force begins
    double side = 1.0;  // 1: the hand is free above it; −1: below
    double depth = 1e-3;  // m, at which the wanted force is reached
};

/// Heights to try, from above to below: in steps of a hand of 0.5 m/s around the origin, or to beyond a surface of 2 m.
std::vector<double> heights(double rate, bool is_far) {
    std::vector<double> all{0.0};
    const double step = std::min(0.4 * mm, 0.5 / rate), end = is_far ? 2.2 : 70.0 * mm;
    for (double z = step; z < end; z += is_far ? std::max(step, 0.02 * z) : step) {
        all.push_back(z);
        all.push_back(-z);
    }
    std::ranges::sort(all, std::greater{});
    return all;
}

/// The hand begins at rest where it is free: what a body with mass would keep of a way there is no work of the path. A vessel is
/// sewn first: while its end moves to its site, at 0.3 m/s, the needle works on the hand.
void rest_at(DrivenNode& node, const Pose& at, const ForceTrial& trial) {
    const int ticks = trial.type->name == "vessel" ? static_cast<int>(0.6 * trial.hand.rate) : 50;
    for (int k = 0; k < ticks; ++k) node.step(at);
}

Surface surface_of(const ForceTrial& trial, const Quat& rest) {
    Surface found;
    bool is_found = false;
    for (const bool is_far : {false, true}) {
        if (is_found) break;
        DrivenNode node(trial);
        double last_z = 0.0, last = 0.0;
        bool is_first = true;
        for (const double z : heights(trial.hand.rate, is_far)) {
            const double now = size_of(node.step({{0.0, 0.0, z}, rest}));
            if (!is_first && (last > touch) != (now > touch)) {
                found.side = now > touch ? 1.0 : -1.0;
                found.z = now > touch ? last_z : z;
                is_found = true;
                if (found.side > 0.0) break;
            }
            last_z = z;
            last = now;
            is_first = false;
        }
    }
    if (!is_found) return found;
    DrivenNode node(trial);
    const double from = found.z;
    const double step = std::max(0.05 * mm, 1e-3 * std::abs(from));
    bool is_touching = false;
    rest_at(node, {{0.0, 0.0, from}, rest}, trial);
    for (int k = 0; k < 400; ++k) {
        const double z = from - found.side * step * k;
        const double force = size_of(node.step({{0.0, 0.0, z}, rest}));
        if (!is_touching && force > touch) {
            is_touching = true;
            found.z = z + found.side * step;
        }
        if (!is_touching) continue;
        found.depth = std::abs(z - found.z);
        if (force > trial.hand.force || found.depth > 5.0 * mm) break;
    }
    return found;
}

// Closed paths.

struct ClosedPath {
    Path at;
    int ticks = 0;
    double side = 1.0;  // of the free hand
};

ClosedPath closed_path(const ForceTrial& trial, const Surface& surface, const Quat& rest, Draws& draws) {
    const double turn = draws.between(0.02, 0.3);
    const std::size_t which = draws.index(17);
    double scale = 1.0;
    ClosedPath made;
    made.side = surface.side;
    for (int attempt = 0; attempt < 3; ++attempt) {
        const Motion motion = motions(surface.depth / scale, turn, rest)[which];
        made.at = [=](double s) {
            Pose pose = motion.path(s);
            pose.position *= scale;
            pose.position.z = surface.z + surface.side * pose.position.z;
            return pose;
        };
        double length = 0.0;
        for (int k = 0; k < 200; ++k)
            length += glm::length(made.at((k + 1) / 200.0).position - made.at(k / 200.0).position);
        const double ticks = length / trial.hand.speed * trial.hand.rate;
        made.ticks = static_cast<int>(std::clamp(ticks, 30.0, static_cast<double>(trial.max_ticks)));
        if (ticks > trial.max_ticks) scale *= std::max(0.02, trial.max_ticks / ticks);
        else if (ticks < 30.0) scale *= std::min(2.0, 30.0 / ticks);
        else break;
    }
    return made;
}

/// Times along the path, 0 to 1: `parts` per tick, and `more` times as many in the ticks around `window`.
std::vector<double> times(int ticks, int parts, std::optional<int> window = {}, int more = 1) {
    std::vector<double> all;
    for (int k = 0; k < ticks; ++k) {
        const int steps = parts * (window && std::abs(k - *window) <= 1 ? more : 1);
        for (int i = 0; i < steps; ++i) all.push_back((k + static_cast<double>(i) / steps) / ticks);
    }
    all.push_back(1.0);
    return all;
}

struct Replay {
    std::vector<Pose> poses;
    std::vector<Wrench> forces;
    bool is_powered = false;

    Vec3 move(std::size_t k) const { return poses[k + 1].position - poses[k].position; }
    Vec3 turn(std::size_t k) const { return rotation_between(poses[k].orientation, poses[k + 1].orientation); }
    Wrench change(std::size_t k) const { return forces[k + 1] + forces[k] * -1.0; }
};

Replay replay(const ForceTrial& trial, const ClosedPath& path, const std::vector<double>& at) {
    DrivenNode node(trial);
    Replay made;
    made.is_powered = node.is_powered();
    rest_at(node, path.at(0.0), trial);
    Wrench last;
    for (const double s : at) {
        const Pose pose = path.at(s);
        // Of a motion that takes as long as the ticks of this replay.
        constexpr double h = 1e-5;
        const Pose before = path.at(s - h), after = path.at(s + h);
        const double per_second = trial.hand.rate / (2.0 * h * static_cast<double>(at.size() - 1));
        const Twist twist{(after.position - before.position) * per_second,
                          rotation_between(before.orientation, after.orientation) * per_second};
        last = node.step(pose, twist, last);
        made.poses.push_back(pose);
        made.forces.push_back(last);
    }
    return made;
}

/// Work on the hand beyond what sampling explains, and the rounding of solvers.
double unexplained_work(const Replay& r, double residual) {
    double work = 0.0, explained = 0.0, length = 0.0;
    for (std::size_t k = 0; k + 1 < r.poses.size(); ++k) {
        const Vec3 move = r.move(k), turn = r.turn(k);
        const Wrench change = r.change(k);
        work += glm::dot(r.forces[k].force, move) + glm::dot(r.forces[k].torque, turn);
        explained += std::abs(glm::dot(change.force, move)) + std::abs(glm::dot(change.torque, turn));
        length += glm::length(move) + lever * glm::length(turn);
    }
    return work - explained - residual * length;
}

void judge_path(const ForceTrial& trial, const ClosedPath& path, ForceOutcome& outcome) {
    const Replay coarse = replay(trial, path, times(path.ticks, 1));
    const Replay fine = replay(trial, path, times(path.ticks, refined));
    for (const Replay* r : {&coarse, &fine})
        for (const Wrench& w : r->forces) {
            if (!is_finite(w)) {
                outcome.failures.push_back("a force is not finite");
                return;
            }
            outcome.largest_N = std::max(outcome.largest_N, glm::length(w.force));
            outcome.largest_Nm = std::max(outcome.largest_Nm, glm::length(w.torque));
        }
    // A solver may leave a residual that its setting states.
    const auto stated = trial.setting.numbers.find("tolerance");
    const double residual =
        2e-3 + 1e-3 * outcome.largest_N + (stated == trial.setting.numbers.end() ? 0.0 : 2.0 * stated->second);
    if (!coarse.is_powered && exception_of(trial, gives_energy).empty()) {
        outcome.work_J = std::max(unexplained_work(coarse, residual), unexplained_work(fine, residual));
        if (outcome.work_J > 1e-6)
            outcome.failures.push_back(fmt::format("{:.3g} mJ on a closed path beyond sampling", outcome.work_J * 1e3));
    }
    if (!exception_of(trial, jumps).empty()) return;
    const double min_jump = jump_force + jump_share * outcome.largest_N + residual;
    const double min_turn = jump_torque + jump_share * outcome.largest_Nm + lever * residual;
    // The largest changes of the refined path, each in a tick of its own.
    std::vector<std::pair<double, int>> suspects;
    for (std::size_t k = 1; k + 1 < fine.forces.size(); ++k) {
        const Wrench change = fine.change(k);
        const double excess = std::max(glm::length(change.force) / min_jump, glm::length(change.torque) / min_turn);
        const int tick = static_cast<int>(k) / refined;
        if (excess <= 1.0) continue;
        if (!suspects.empty() && suspects.back().second == tick)
            suspects.back().first = std::max(suspects.back().first, excess);
        else suspects.emplace_back(excess, tick);
    }
    std::ranges::sort(suspects, std::greater{});
    if (suspects.size() > 3) suspects.resize(3);
    for (const auto& [excess, tick] : suspects) {
        const Replay finer = replay(trial, path, times(path.ticks, refined, tick, refined));
        const std::size_t first = static_cast<std::size_t>(std::max(0, tick - 1)) * refined;
        const std::size_t window = tick == 0 ? 2 : 3;  // ticks
        const std::size_t last = std::min(first + window * refined * refined - 1, finer.forces.size() - 2);
        for (std::size_t k = std::max<std::size_t>(first, 1); k <= last; ++k) {
            const double force = glm::length(finer.change(k).force), torque = glm::length(finer.change(k).torque);
            const double now = std::max(force / min_jump, torque / min_turn);
            if (now <= 1.0 || now < 0.5 * excess) continue;
            // A powered tool breaks through.
            if (finer.is_powered && glm::length(finer.forces[k + 1].force) < glm::length(finer.forces[k].force))
                continue;
            outcome.jump_N = std::max(outcome.jump_N, force);
            outcome.jump_Nm = std::max(outcome.jump_Nm, torque);
        }
    }
    if (outcome.jump_N > 0.0 || outcome.jump_Nm > 0.0)
        outcome.failures.push_back(fmt::format("jumps by {:.3g} N, {:.3g} N m", outcome.jump_N, outcome.jump_Nm));
}

// A free hand at a device.

void judge_device(const ForceTrial& trial, const Surface& surface, const Quat& rest, ForceOutcome& outcome) {
    Draws draws{{mix(trial.seed ^ 0xde)}};
    const auto flicks = static_cast<Flicks>(std::llround(flicks_per_second / trial.hand.rate));
    const double period = seconds(flicks), mass = draws.between(0.1, 1.0);
    const double max_force = draws.between(1.0, 50.0), max_torque = draws.between(0.01, 5.0);
    const double slew = draws.between(100.0, 100e3);  // N/s
    NodeHarness output("device_output", {.period = flicks});
    output.set_value("max_force", max_force).set_value("max_torque", max_torque).set_value("slew", slew);
    output.set("engage_time", "0 ms").disconnect_optional();
    Wrench wanted;
    output.feed<Wrench>("wrench", [&](std::int64_t) { return wanted; });
    auto owned = std::make_unique<DevicePort>();
    DevicePort& port = *owned;
    port.info.actuates_torque = true;
    output.host.devices[""] = std::move(owned);
    control::EnergyCapSettings cap;
    cap.period_s = period;
    Pose pose{{0.0, 0.0, surface.z + surface.side * (0.5 * mm + 3.0 * trial.hand.speed * period)}, rest};
    Twist twist;
    std::int64_t count = 0;
    output.device_feed = [&](std::int64_t, DevicePort& p) {
        p.sample = {};
        p.sample.pose = pose;
        p.sample.twist = twist;
        p.sample.counter = ++count;
        p.sample.valid = true;
    };
    output.prepare();
    // It flies before the force comes: nobody can foresee a speed that arises within the first hold.
    constexpr int flown = 10;
    const Vec3 flight(0.0, 0.0, -surface.side * trial.hand.speed * period);
    pose.position -= static_cast<double>(flown) * flight;
    output.run(static_cast<std::int64_t>(0.02 / period) + 10);
    twist.linear.z = -surface.side * trial.hand.speed;
    for (int k = 0; k < flown; ++k) {
        output.run(1);
        pose.position += flight;
    }
    DrivenNode node(trial);
    rest_at(node, pose, trial);
    const int ticks = static_cast<int>(0.2 / period);
    double work = 0.0, damped = 0.0, taken = 0.0, gained = 0.0, last = 0.0;
    int apart = 0, contacts = 0;
    bool is_pushed = false;
    for (int k = 0; k < ticks && apart < 3; ++k) {
        wanted = node.step(pose, twist, port.wrench);
        output.run(1);
        output.forget();
        const double given = glm::length(port.wrench.force);
        outcome.given_N = std::max(outcome.given_N, given / max_force);
        if (given > max_force * (1.0 + 1e-9) || glm::length(port.wrench.torque) > max_torque * (1.0 + 1e-9))
            outcome.failures.push_back(fmt::format("{:.3g} N beyond the limit of {:.3g} N", given, max_force));
        if (given - last > slew * period * (1.0 + 1e-9))
            outcome.failures.push_back(fmt::format("rises by {:.3g} N in a tick", given - last));
        last = given;
        // The hand presses, and pulls away in the second half.
        const double owner = (k < ticks / 2 ? -1.0 : 0.5) * surface.side * trial.hand.force;
        const int steps = std::max(8, static_cast<int>(period / 5e-5));
        const double h = period / steps, before = work;
        for (int i = 0; i < steps; ++i) {
            const Vec3 drag = -control::StatedHand::damping * twist.linear;
            const Vec3 speed_up = (port.wrench.force + Vec3(0.0, 0.0, owner) + drag) / mass;
            const Vec3 moved = twist.linear * h + 0.5 * h * h * speed_up;
            work += glm::dot(port.wrench.force, moved);
            damped += control::StatedHand::damping * glm::dot(twist.linear, twist.linear) * h;
            pose.position += moved;
            twist.linear += speed_up * h;
        }
        // Of all that it took: a hand on a spring puts energy in on either side, again and again.
        taken += std::max(0.0, before - work);
        gained = std::max(gained, work - damped - 0.05 * taken);
        apart = taken > 0.0 && given == 0.0 ? apart + 1 : 0;
        contacts += given > control::EnergyCap::end_force && !is_pushed;
        is_pushed = given > control::EnergyCap::end_force;
        if (!outcome.failures.empty() && given > 0.0 && outcome.failures.back().starts_with("rises")) return;
    }
    // The bound is that of a free hand: its owner moves it further during a hold, and counts as holding it until it is no longer
    // slow.
    const double by_owner = max_force * trial.hand.force * period * period / mass +
                            0.5 * mass * control::EnergyCap::slow_m_s * control::EnergyCap::slow_m_s;
    // The bound is that of a contact, and one begins whenever the hand comes through the middle of a spring.
    outcome.gained_J =
        gained - by_owner -
        std::max(contacts, 1) * control::EnergyCap::max_gain(cap, std::numeric_limits<double>::infinity(), max_force);
    if (outcome.gained_J > 0.0 && !node.is_powered())
        outcome.failures.push_back(
            fmt::format("device_output gives {:.3g} mJ beyond the bound of the cap", outcome.gained_J * 1e3));
}

}  // namespace

std::string NodeSetting::text() const {
    std::string all;
    for (const auto& [name, number] : numbers) all += fmt::format("{}{}={:.6g}", all.empty() ? "" : " ", name, number);
    for (const auto& [name, word] : words) all += fmt::format("{}{}={}", all.empty() ? "" : " ", name, word);
    return all.empty() ? "defaults" : all;
}

std::vector<const NodeType*> force_types() {
    std::vector<const NodeType*> all;
    for (const NodeType* type : nodes::catalogue())
        if (type->role != NodeRole::hand_sink && !Declared(*type).force.empty()) all.push_back(type);
    return all;
}

std::vector<NodeSetting> pairwise_corners(const NodeType& type) {
    std::vector<Factor> factors = Declared(type).factors;
    std::erase_if(factors, [](const Factor& factor) { return !factor.is_in_corners; });
    const std::size_t count = factors.size();
    using Level = std::pair<std::size_t, std::size_t>;  // factor, level
    std::set<std::pair<Level, Level>> open;
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = a + 1; b < count; ++b)
            for (std::size_t i = 0; i < factors[a].levels(); ++i)
                for (std::size_t j = 0; j < factors[b].levels(); ++j) open.insert({{a, i}, {b, j}});
    std::vector<NodeSetting> rows;
    while (!open.empty()) {
        // Greedy, as AETG (Cohen, Dalal, Fredman, Patton, IEEE Trans. Software Engineering 23, 1997).
        std::vector<std::optional<std::size_t>> row(count);
        const auto [one, other] = *open.begin();
        row[one.first] = one.second;
        row[other.first] = other.second;
        for (std::size_t f = 0; f < count; ++f) {
            if (row[f]) continue;
            std::size_t best = 0, most = 0;
            for (std::size_t level = 0; level < factors[f].levels(); ++level) {
                std::size_t covered = 0;
                for (std::size_t g = 0; g < count; ++g)
                    if (row[g])
                        covered +=
                            g < f ? open.count({{g, *row[g]}, {f, level}}) : open.count({{f, level}, {g, *row[g]}});
                if (covered > most) {
                    most = covered;
                    best = level;
                }
            }
            row[f] = best;
        }
        NodeSetting setting;
        for (std::size_t f = 0; f < count; ++f) factors[f].put(*row[f], setting);
        for (std::size_t a = 0; a < count; ++a)
            for (std::size_t b = a + 1; b < count; ++b) open.erase({{a, *row[a]}, {b, *row[b]}});
        rows.push_back(std::move(setting));
    }
    return rows;
}

namespace {

/// False where the node refuses what its parameters are together.
bool is_accepted(const NodeType& type, const NodeSetting& setting) {
    try {
        const DrivenNode node({.type = &type, .setting = setting, .hand = {}});
        return true;
    } catch (const Error&) {
        return false;
    }
}

NodeSetting drawn_setting(const NodeType& type, std::uint64_t seed) {
    Draws draws{{mix(seed)}};
    NodeSetting setting;
    for (const Factor& factor : Declared(type).factors) {
        const bool is_default = draws.chance(0.3);
        const double u = draws.uniform();
        if (is_default) continue;
        if (!factor.is_number()) {
            setting.words[factor.name] =
                factor.words[static_cast<std::size_t>(u * static_cast<double>(factor.words.size()))];
            continue;
        }
        const double low = factor.low, high = factor.high;
        double value = low > 0.0    ? low * std::pow(high / low, u)
                       : low == 0.0 ? (u < 0.1 ? 0.0 : high * std::pow(1e-4, (1.0 - u) / 0.9))
                                    : low + (high - low) * u;
        if (factor.is_whole) value = std::round(value);
        setting.numbers[factor.name] = std::clamp(value, low, high);
    }
    return setting;
}

/// Members that contradict each other keep their defaults, as few as it finds in a random order.
NodeSetting repaired(const NodeType& type, NodeSetting setting, std::uint64_t seed) {
    std::vector<std::string> names;
    for (const auto& [name, number] : setting.numbers) names.push_back(name);
    for (const auto& [name, word] : setting.words) names.push_back(name);
    Draws draws{{mix(seed ^ 0xface)}};
    for (std::size_t n = names.size(); n > 1; --n) std::swap(names[n - 1], names[draws.index(n)]);
    const auto without = [](NodeSetting from, const std::string& name) {
        from.numbers.erase(name);
        from.words.erase(name);
        return from;
    };
    for (const std::string& name : names)
        if (NodeSetting one = without(setting, name); is_accepted(type, one)) return one;
    for (const std::string& name : names) {
        setting = without(std::move(setting), name);
        if (is_accepted(type, setting)) break;
    }
    return setting;
}

}  // namespace

NodeSetting random_setting(const NodeType& type, std::uint64_t n) {
    constexpr std::uint64_t attempts = 16;
    const std::uint64_t seed = n ^ 0x5e77;
    NodeSetting setting = drawn_setting(type, seed);
    for (std::uint64_t k = 1; k < attempts && !is_accepted(type, setting); ++k)
        setting = drawn_setting(type, seed + (k << 32));
    return is_accepted(type, setting) ? setting : repaired(type, std::move(setting), seed);
}

std::vector<NodeSetting> bench_settings(const NodeType& type, std::uint64_t random_count) {
    std::vector<NodeSetting> settings(5);
    for (NodeSetting& corner : pairwise_corners(type))
        settings.push_back(is_accepted(type, corner) ? std::move(corner)
                                                     : repaired(type, std::move(corner), settings.size()));
    for (std::uint64_t n = 0; n < random_count; ++n) settings.push_back(random_setting(type, n));
    return settings;
}

SweptHand random_hand(std::uint64_t n) {
    Draws draws{{mix(n ^ 0x4a4d)}};
    return {draws.between(0.5, 20.0), draws.between(0.01, 1.0), draws.between(500.0, 4000.0)};
}

ForceOutcome run_trial(const ForceTrial& trial) {
    ForceOutcome outcome;
    Draws draws{{mix(trial.seed)}};
    // Tools cut along their y axis.
    const bool is_upright = draws.chance(0.5) || is_guided(trial.setting);
    const Quat rest = is_upright ? blade_down : Quat(1.0, 0.0, 0.0, 0.0);
    try {
        const Surface surface = surface_of(trial, rest);
        judge_path(trial, closed_path(trial, surface, rest, draws), outcome);
        judge_device(trial, surface, rest, outcome);
    } catch (const Error& error) {
        outcome.refusal = error.what();
    }
    return outcome;
}

}  // namespace tactus::test
