// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_command.hpp"

namespace tactus::plan {

namespace {

class Fields {
public:
    explicit Fields(Hash& hash) : hash_(hash) {}

    void operator()(const PlaceFragment& c) const noexcept { add(c.fragment), add(c.pose); }
    void operator()(const SettleFragment& c) const noexcept {
        add(c.fragment), add(c.partner), add(c.pose);
        hash_.add_bytes(&c.fit, sizeof c.fit);
    }
    void operator()(const JoinFragments& c) const noexcept { add(c.fragment), add(c.other); }
    void operator()(const SplitFragment& c) const noexcept { add(c.fragment); }
    void operator()(const LockFragment& c) const noexcept { add(c.fragment), add(c.is_locked ? 1 : 0); }
    void operator()(const HideFragment& c) const noexcept { add(c.fragment); }
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
    Hash& hash_;
};

}  // namespace

void add_to(Hash& hash, const PlanCommand& command) noexcept {
    hash.add_word(command.index());
    std::visit(Fields(hash), command);
}

}  // namespace tactus::plan
