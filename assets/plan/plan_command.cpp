// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_command.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace tactus::plan {

namespace {

class Fields {
public:
    explicit Fields(Hash& hash) : hash_(hash) {}

    void operator()(const PlaceFragment& c) const noexcept { add(c.fragment), add(c.pose); }
    void operator()(const SettleFragment& c) const noexcept {
        add(c.fragment), add(c.partner), add(c.pose);
        hash_.add_bytes(&c.fit, sizeof c.fit);
        add(static_cast<int>(c.basis));
    }
    void operator()(const JoinFragments& c) const noexcept { add(c.fragments); }
    void operator()(const AddFragments& c) const noexcept { add(c.group), add(c.fragments); }
    void operator()(const SplitFragments& c) const noexcept { add(c.fragments); }
    void operator()(const DissolveGroup& c) const noexcept { add(c.group); }
    void operator()(const LockFragments& c) const noexcept { add(c.fragments), add(c.is_locked ? 1 : 0); }
    void operator()(const HideFragments& c) const noexcept { add(c.fragments), add(c.is_hidden ? 1 : 0); }
    void operator()(const GoToAlternative& c) const noexcept { add(c.alternative); }
    void operator()(const DropAlternative& c) const noexcept { add(c.alternative); }
    template <class Bare>
    void operator()(const Bare&) const noexcept {
        static_assert(std::is_empty_v<Bare>, "a command whose fields are not in the hash");
    }

private:
    void add(int number) const noexcept {
        hash_.add_word(static_cast<std::uint64_t>(static_cast<std::int64_t>(number)));
    }
    void add(const Pose& pose) const noexcept {
        static_assert(sizeof(Pose) == 7 * sizeof(double));
        hash_.add_bytes(&pose, sizeof pose);
    }
    void add(const FragmentSet& fragments) const noexcept {
        add(static_cast<int>(fragments.count()));
        for (std::size_t n = 0; n < fragments.size(); ++n)
            if (fragments[n]) add(static_cast<int>(n));
    }
    Hash& hash_;
};

consteval std::size_t place_of(std::string_view name) {
    std::size_t n = 0;
    while (plan_command_port.at(n).name != name) ++n;
    return n;
}
constexpr std::size_t at_kind = place_of("command"), at_first = place_of("command_first"),
                      at_second = place_of("command_second"), at_set = place_of("command_set"),
                      at_switch = place_of("command_switch"), at_pose = place_of("command_x"),
                      at_fit = place_of("command_score");
static_assert(plan_command_port[at_kind].most == "13" && std::variant_size_v<PlanCommand> == 13,
              "the port names every kind");

class CommandWriter {
public:
    explicit CommandWriter(PlanCommandNumbers& to) : to_(to) {}

    void operator()(const PlaceFragment& c) const noexcept { first(c.fragment), pose(c.pose); }
    void operator()(const SettleFragment& c) const noexcept {
        first(c.fragment), second(c.partner), pose(c.pose);
        to_[at_switch] = static_cast<double>(c.basis);
        const FitNumbers& f = c.fit;
        put(at_fit, {f.score, f.margin, f.rms, f.gap, f.penetration, f.overlap});
    }
    void operator()(const JoinFragments& c) const noexcept { set(c.fragments); }
    void operator()(const AddFragments& c) const noexcept { first(c.group), set(c.fragments); }
    void operator()(const SplitFragments& c) const noexcept { set(c.fragments); }
    void operator()(const DissolveGroup& c) const noexcept { first(c.group); }
    void operator()(const LockFragments& c) const noexcept {
        set(c.fragments), to_[at_switch] = c.is_locked ? 1.0 : 0.0;
    }
    void operator()(const HideFragments& c) const noexcept {
        set(c.fragments), to_[at_switch] = c.is_hidden ? 1.0 : 0.0;
    }
    void operator()(const GoToAlternative& c) const noexcept { first(c.alternative); }
    void operator()(const DropAlternative& c) const noexcept { first(c.alternative); }
    template <class Bare>
    void operator()(const Bare&) const noexcept {
        static_assert(std::is_empty_v<Bare>, "a command whose fields are not among the numbers");
    }

private:
    void first(int place) const noexcept { to_[at_first] = place; }
    void second(int place) const noexcept { to_[at_second] = place; }
    void set(const FragmentSet& fragments) const noexcept {
        double sum = 0.0, power = 1.0;
        for (std::size_t n = 0; n < max_port_fragments; ++n, power *= 2.0)
            if (fragments[n]) sum += power;
        to_[at_set] = sum;
        if ((fragments >> max_port_fragments).any()) to_[at_kind] = 0.0;
    }
    void pose(const Pose& p) const noexcept {
        const Vec3& at = p.position;
        const Quat& q = p.orientation;
        put(at_pose, {at.x, at.y, at.z, q.w, q.x, q.y, q.z});
    }
    void put(std::size_t from, std::initializer_list<double> values) const noexcept {
        std::ranges::copy(values, to_.begin() + static_cast<std::ptrdiff_t>(from));
    }
    PlanCommandNumbers& to_;
};

struct CommandReader {
    const PlanCommandNumbers& from;

    int whole(std::size_t at) const noexcept { return static_cast<int>(from[at]); }
    FragmentSet set() const noexcept { return {static_cast<unsigned long long>(from[at_set])}; }
    Pose pose() const noexcept {
        const double* const p = from.data() + at_pose;
        return {Vec3(p[0], p[1], p[2]), Quat(p[3], p[4], p[5], p[6])};
    }
    void into(PlaceFragment& c) const noexcept { c = {whole(at_first), pose()}; }
    void into(SettleFragment& c) const noexcept {
        const double* const f = from.data() + at_fit;
        c = {whole(at_first),
             whole(at_second),
             pose(),
             {f[0], f[1], f[2], f[3], f[4], f[5]},
             static_cast<FitBasis>(whole(at_switch))};
    }
    void into(JoinFragments& c) const noexcept { c = {set()}; }
    void into(AddFragments& c) const noexcept { c = {whole(at_first), set()}; }
    void into(SplitFragments& c) const noexcept { c = {set()}; }
    void into(DissolveGroup& c) const noexcept { c = {whole(at_first)}; }
    void into(LockFragments& c) const noexcept { c = {set(), from[at_switch] != 0.0}; }
    void into(HideFragments& c) const noexcept { c = {set(), from[at_switch] != 0.0}; }
    void into(GoToAlternative& c) const noexcept { c = {whole(at_first)}; }
    void into(DropAlternative& c) const noexcept { c = {whole(at_first)}; }
    template <class Bare>
    void into(Bare&) const noexcept {
        static_assert(std::is_empty_v<Bare>, "a command whose fields are not among the numbers");
    }

    template <std::size_t kind = 0>
    PlanCommand of_kind(std::size_t wanted) const noexcept {
        if constexpr (kind + 1 < std::variant_size_v<PlanCommand>)
            if (wanted != kind) return of_kind<kind + 1>(wanted);
        std::variant_alternative_t<kind, PlanCommand> command;
        into(command);
        return command;
    }
};

}  // namespace

FragmentSet set_of(std::span<const int> fragments) noexcept {
    FragmentSet set;
    for (const int n : fragments)
        if (n >= 0 && static_cast<std::size_t>(n) < set.size()) set[static_cast<std::size_t>(n)] = true;
    return set;
}

PlanCommandNumbers numbers_of(const PlanCommand& command) noexcept {
    PlanCommandNumbers numbers{};
    numbers[at_kind] = static_cast<double>(command.index() + 1);
    std::visit(CommandWriter(numbers), command);
    return numbers;
}

std::optional<PlanCommand> command_of(const PlanCommandNumbers& numbers) noexcept {
    for (const std::size_t at : {at_kind, at_first, at_second, at_set, at_switch})
        if (!(std::abs(numbers[at]) <= 1e6) || numbers[at] != std::floor(numbers[at])) return std::nullopt;
    const double kind = numbers[at_kind];
    if (kind < 1.0 || kind > static_cast<double>(std::variant_size_v<PlanCommand>)) return std::nullopt;
    if (numbers[at_switch] < 0.0 || numbers[at_switch] > static_cast<double>(FitBasis::plan)) return std::nullopt;
    if (numbers[at_set] < 0.0 || numbers[at_set] >= 1 << max_port_fragments) return std::nullopt;
    return CommandReader{numbers}.of_kind(static_cast<std::size_t>(kind) - 1);
}

void add_to(Hash& hash, const PlanCommand& command) noexcept {
    hash.add_word(command.index());
    std::visit(Fields(hash), command);
}

}  // namespace tactus::plan
