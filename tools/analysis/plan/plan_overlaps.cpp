// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_overlaps.hpp"

#include "assets/plan/kept_result.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/gap.hpp"
#include "dsp/fit/overlap.hpp"
#include "tools/analysis/workers.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

namespace tactus::analysis {

namespace {

// To be raised with every change of code that changes what lies in what: import of meshes, sampling, dsp/fit/overlap.
constexpr int overlap_algorithm = 3;

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Box {
    Vec3 low{infinite}, high{-infinite};  // m

    void add(const Vec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
    bool meets(const Box& other) const {
        for (int axis = 0; axis < 3; ++axis)
            if (low[axis] > other.high[axis] || other.low[axis] > high[axis]) return false;
        return true;
    }
    /// The box around this one at `pose`.
    Box at(const Pose& pose) const {
        Box around;
        for (int corner = 0; corner < 8; ++corner)
            around.add(pose.apply({(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                                   (corner & 4) != 0 ? high.z : low.z}));
        return around;
    }
};

/// A fragment is loaded when a result with it is not known.
class Overlaps {
public:
    Overlaps(const plan::CasePlan& plan, const std::filesystem::path& folder, std::vector<std::string>& notes)
        : state_(plan::state_of(plan)),
          fragments_(plan::fragments_of(plan, state_)),
          folder_(folder),
          notes_(notes),
          loaded_(fragments_.size()),
          boxes_(fragments_.size()) {
        plan::check_files(plan, folder);
    }

    std::vector<PlanOverlap> run() {
        load_unknown();
        std::vector<PlanOverlap> found;
        for (int a = 0; a < static_cast<int>(fragments_.size()); ++a)
            for (int b = a + 1; b < static_cast<int>(fragments_.size()); ++b) {
                if (state_.arrangement.is_hidden(a) || state_.arrangement.is_hidden(b)) continue;
                const Pose between = pose(b).inverse() * pose(a);
                if (!box(a).at(between).meets(box(b)) || !box(b).at(between.inverse()).meets(box(a))) continue;
                if (const auto volume = volume_in_both(a, b, between)) found.push_back({a, b, *volume});
            }
        return found;
    }

private:
    const Pose& pose(int n) const { return state_.arrangement.pose(n); }

    /// Sampling the surface of a whole bone takes a second or more: those that are needed are loaded together.
    void load_unknown() {
        std::vector<int> unknown;
        for (int n = 0; n < static_cast<int>(fragments_.size()); ++n) {
            std::string note;
            if (!state_.arrangement.is_hidden(n) && !plan::kept_result(box_key(n), note)) unknown.push_back(n);
        }
        on_threads()(static_cast<int>(unknown.size()), [&](int k) { loaded(unknown[static_cast<std::size_t>(k)]); });
    }

    const CaseFragment& loaded(int n) {
        auto& one = loaded_[static_cast<std::size_t>(n)];
        if (!one) one = load_fragment(fragments_[static_cast<std::size_t>(n)], folder_);
        return *one;
    }

    plan::ResultKey key_of(const char* what, std::initializer_list<int> of) const {
        plan::ResultKey key(what, overlap_algorithm);
        for (const int n : of) key.add_file(plan::file_of(fragments_[static_cast<std::size_t>(n)].file, folder_));
        return key;
    }

    plan::ResultKey box_key(int n) const { return key_of("box around a fragment", {n}); }

    void tell(const std::string& note) {
        if (!note.empty()) notes_.push_back(note);
    }

    const Box& box(int n) {
        auto& known = boxes_[static_cast<std::size_t>(n)];
        if (known) return *known;
        std::string note;
        const std::vector<double> sides = plan::result_of(box_key(n), 6, note, [&] {
            Box around;
            for (const contact::SurfacePoint& p : loaded(n).bone.points) around.add(p.position);
            return std::vector<double>{around.low.x,  around.low.y,  around.low.z,
                                       around.high.x, around.high.y, around.high.z};
        });
        tell(note);
        known = Box{{sides[0], sides[1], sides[2]}, {sides[3], sides[4], sides[5]}};
        return *known;
    }

    /// m³; none when they do not lie in each other. One result per pair of files is kept, with its pose.
    std::optional<double> volume_in_both(int a, int b, const Pose& between) {
        const plan::ResultKey key = key_of("fragments that lie in each other", {a, b});
        const Vec3& p = between.position;
        const Quat& q = between.orientation;
        const std::array<double, 7> here{p.x, p.y, p.z, q.w, q.x, q.y, q.z};
        std::string note;
        const auto known = plan::kept_result(key, note);
        tell(note);
        if (known && known->size() == 9 && std::equal(here.begin(), here.end(), known->begin()))
            return (*known)[7] > 0.0 ? std::optional((*known)[8]) : std::nullopt;
        const CaseFragment &one = loaded(a), &other = loaded(b);
        const bool lie = fit::lie_in_each_other(placed_bone(one, pose(a)), placed_bone(other, pose(b)),
                                                fit::FitSettings{}.max_penetration);
        const double volume = lie ? fit::overlap_volume(one.map.grid, pose(a), other.map, pose(b)) : 0.0;
        std::vector<double> numbers(here.begin(), here.end());
        numbers.insert(numbers.end(), {lie ? 1.0 : 0.0, volume});
        plan::keep_result(key, numbers);
        return lie ? std::optional(volume) : std::nullopt;
    }

    plan::PlanState state_;
    std::vector<plan::PlanFragment> fragments_;
    const std::filesystem::path& folder_;
    std::vector<std::string>& notes_;
    std::vector<std::optional<CaseFragment>> loaded_;
    std::vector<std::optional<Box>> boxes_;
};

}  // namespace

std::vector<PlanOverlap> plan_overlaps(const plan::CasePlan& plan, const std::filesystem::path& folder,
                                       std::vector<std::string>& notes) {
    return Overlaps(plan, folder, notes).run();
}

std::string overlap_words(const plan::CasePlan& plan, const PlanOverlap& overlap) {
    return fmt::format("'{}' and '{}' lie in each other with {:.0f} mm³; move or hide one of them",
                       plan.fragments[static_cast<std::size_t>(overlap.first)].name,
                       plan.fragments[static_cast<std::size_t>(overlap.second)].name, overlap.volume * 1e9);
}

}  // namespace tactus::analysis
