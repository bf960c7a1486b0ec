// SPDX-License-Identifier: Apache-2.0
// Declaring a node type: a plain struct whose members are ports and parameters, and one TACTUS_NODE line.
//
//     struct Gain {
//         static constexpr auto about = "Multiplies a signal.";
//         In<Signal> in{"signal"};
//         Out<Signal> out{"product"};
//         Param gain{"1", "-100", "100", "factor"};
//         void process(const Tick& tick) noexcept {
//             for (int i = 0; i < tick.frames; ++i) out[i] = in[i] * static_cast<float>(gain);
//         }
//     };
//     TACTUS_NODE(Gain, in, out, gain)
//
// Parameters that several types share are a struct with a TACTUS_GROUP line. A node has it as a member and lists it
// like a parameter. In a patch its parameters are parameters of the node:
//
//     struct WaveParameters {
//         Param height{"0 mm", "0 mm", "2 mm", "of the waves"};
//         Param length{"2 mm", "0.1 mm", "100 mm", "of one wave"};
//         TACTUS_GROUP(height, length)
//     };
//
// Optional members: `void prepare(const Setup&)` may allocate and throw Error, and sets the initial value of each
// output; `void report(Report&) const` adds results after the run; `static constexpr NodeRole role` is the type's role
// at the border of a patch; `static constexpr bool shapes_values = true` says that it makes a force as stiff as its law;
// `std::vector<PortSlope> slopes() const` bounds how stiff that is; `static constexpr UnitRule units` says how the units of
// its inputs make those of its outputs, `std::string unit_of(std::string_view port) const` which one its texts give a port.
#pragma once

#include "graph/node/node_memory.hpp"
#include "graph/node/param.hpp"
#include "graph/node/port.hpp"
#include "graph/node/setup.hpp"

#include <concepts>
#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace tactus {

class MemberVisitor;

/// A struct of ports and parameters with a TACTUS_GROUP line.
template <class G>
concept MemberGroup = requires(G& group, MemberVisitor& visitor) { group.each(visitor); };

/// Is called with each declared member of a node, in the order of the TACTUS_NODE line. Members of a group come one by
/// one.
class MemberVisitor {
public:
    virtual ~MemberVisitor() = default;
    virtual void input(std::string_view, Input&) {}
    virtual void output(std::string_view, Output&) {}
    virtual void param(std::string_view, Param&) {}
    virtual void choice(std::string_view, Choice&) {}
    virtual void text(std::string_view, Text&) {}
    virtual void flag(std::string_view, Flag&) {}
    virtual void vector(std::string_view, Vector&) {}
    virtual void asset(std::string_view, AssetParam&) {}

    template <class M>
    void member(std::string_view name, M& m) {
        if constexpr (MemberGroup<M>) m.each(*this);
        else if constexpr (std::derived_from<M, Input>) input(name, m);
        else if constexpr (std::derived_from<M, Output>) output(name, m);
        else if constexpr (std::derived_from<M, AssetParam>) asset(name, m);
        else if constexpr (std::same_as<M, Param>) param(name, m);
        else if constexpr (std::same_as<M, Choice>) choice(name, m);
        else if constexpr (std::same_as<M, Text>) text(name, m);
        else if constexpr (std::same_as<M, Flag>) flag(name, m);
        else {
            static_assert(std::same_as<M, Vector>, "a listed member must be a port, a parameter or a group");
            vector(name, m);
        }
    }
};

/// Role of a node type at the border of a patch. Analyses of a plan look for a role, never for the name of a type.
enum class NodeRole : std::uint8_t {
    inner,  ///< none of the others
    hand_source,  ///< gives the pose of a hand; has a text parameter `device`
    hand_sink,  ///< sends a force to a hand; has a text parameter `device`
    motor_sink,  ///< drives the motors of a device; has a text parameter `device`
    placement,  ///< places a device in the scene; has a parameter `scale`: metres of the scene per metre of the device
    sound_sink,  ///< sends a signal to a sound card; has `card` and `channel` where nodes can share one
    file_sink  ///< writes a file
};

/// How units pass through a node: its ports of several types, numbers, signals and vectors that state no unit.
enum class UnitRule : std::uint8_t {
    none,  ///< nothing is known of them
    same,  ///< all have one unit
    product,  ///< each output has the product of the units of the inputs
    quotient,  ///< each output has the unit of the first input per that of the second
    rate,  ///< each output has the unit of the input per second
    integral,  ///< each output has the unit of the input times seconds
};

/// The largest slope of a node's output over one of its inputs, in SI units. An input that is not listed has none that
/// is known.
struct PortSlope {
    std::string input;
    double largest = 0.0;
};

/// A node type as the catalogue lists it. The functions take a node that `create` made; `prepare` may throw Error.
struct NodeType {
    std::string name;  ///< "blade_contact"
    std::string_view about;
    NodeRole role = NodeRole::inner;
    bool shapes_values = false;  ///< by a law that no stiffness parameter states; on a force path `check` names it
    void* (*create)() = nullptr;
    void (*destroy)(void*) = nullptr;
    void (*visit)(void*, MemberVisitor&) = nullptr;
    void (*prepare)(void*, const Setup&) = nullptr;
    void (*process)(void*, const Tick&) noexcept = nullptr;
    void (*report)(const void*, Report&) = nullptr;
    UnitRule units = UnitRule::none;
    /// The unit that the texts of a node give a port, "" for none; null: they give none. Before `prepare`; throws Error.
    std::string (*unit_of)(const void*, std::string_view port) = nullptr;
    /// Null: no slope of it is known. Before `prepare`; throws Error.
    std::vector<PortSlope> (*slopes)(const void*) = nullptr;
};

/// "BladeContact" → "blade_contact".
std::string type_name_of(std::string_view struct_name);

template <class T>
constexpr NodeRole role_of() {
    if constexpr (requires { T::role; }) return T::role;
    else return NodeRole::inner;
}

template <class T>
constexpr bool shapes_values() {
    if constexpr (requires { T::shapes_values; }) return T::shapes_values;
    else return false;
}

template <class T>
constexpr UnitRule units_of() {
    if constexpr (requires { T::units; }) return T::units;
    else return UnitRule::none;
}

template <class T>
NodeType make_node_type(std::string_view struct_name, void (*visit)(void*, MemberVisitor&)) {
    static_assert(noexcept(std::declval<T&>().process(std::declval<const Tick&>())), "process must be noexcept");
    static_assert(alignof(T) <= node_offset, "a node is aligned to 16 bytes");
    NodeType type{
        .name = type_name_of(struct_name),
        .about = T::about,
        .role = role_of<T>(),
        .shapes_values = shapes_values<T>(),
        .create = []() -> void* {
            void* const memory = take_node_memory(sizeof(T));
            try {
                return new (memory) T;
            } catch (...) {
                give_back_node_memory(memory, sizeof(T));
                throw;
            }
        },
        .destroy =
            [](void* node) {
                std::destroy_at(static_cast<T*>(node));
                give_back_node_memory(node, sizeof(T));
            },
        .visit = visit,
        .prepare =
            [](void* node, const Setup& setup) {
                if constexpr (requires(T& t) { t.prepare(setup); }) static_cast<T*>(node)->prepare(setup);
            },
        .process = [](void* node, const Tick& tick) noexcept { static_cast<T*>(node)->process(tick); },
        .report =
            [](const void* node, Report& report) {
                if constexpr (requires(const T& t) { t.report(report); }) static_cast<const T*>(node)->report(report);
            },
        .units = units_of<T>(),
    };
    if constexpr (requires(const T& t) { t.unit_of(std::string_view()); })
        type.unit_of = [](const void* node, std::string_view port) -> std::string {
            return static_cast<const T*>(node)->unit_of(port);
        };
    if constexpr (requires(const T& t) { t.slopes(); })
        type.slopes = [](const void* node) { return static_cast<const T*>(node)->slopes(); };
    return type;
}

}  // namespace tactus

// TACTUS_EACH(f, a, b, …) expands to f(a) f(b) … for up to 256 names, by recursive rescanning (C++20 __VA_OPT__).
#define TACTUS_PARENS ()
#define TACTUS_EXPAND(...) TACTUS_EXPAND3(TACTUS_EXPAND3(TACTUS_EXPAND3(TACTUS_EXPAND3(__VA_ARGS__))))
#define TACTUS_EXPAND3(...) TACTUS_EXPAND2(TACTUS_EXPAND2(TACTUS_EXPAND2(TACTUS_EXPAND2(__VA_ARGS__))))
#define TACTUS_EXPAND2(...) TACTUS_EXPAND1(TACTUS_EXPAND1(TACTUS_EXPAND1(TACTUS_EXPAND1(__VA_ARGS__))))
#define TACTUS_EXPAND1(...) __VA_ARGS__
#define TACTUS_EACH(f, ...) __VA_OPT__(TACTUS_EXPAND(TACTUS_EACH_NEXT(f, __VA_ARGS__)))
#define TACTUS_EACH_NEXT(f, a, ...) f(a) __VA_OPT__(TACTUS_EACH_AGAIN TACTUS_PARENS(f, __VA_ARGS__))
#define TACTUS_EACH_AGAIN() TACTUS_EACH_NEXT
#define TACTUS_VISIT_MEMBER(m) visitor.member(#m, node.m);

/// Declares `Type` as a node with the listed ports and parameters; nodes/catalogue.cpp names it once more.
#define TACTUS_NODE(Type, ...)                                                                                     \
    const ::tactus::NodeType& node_type_##Type() {                                                                 \
        static const ::tactus::NodeType type =                                                                     \
            ::tactus::make_node_type<Type>(#Type, [](void* p, [[maybe_unused]] ::tactus::MemberVisitor& visitor) { \
                [[maybe_unused]] Type& node = *static_cast<Type*>(p);                                              \
                TACTUS_EACH(TACTUS_VISIT_MEMBER, __VA_ARGS__)                                                      \
            });                                                                                                    \
        return type;                                                                                               \
    }

/// Within a struct: declares the listed members as a group.
#define TACTUS_GROUP(...)                             \
    void each(::tactus::MemberVisitor& visitor) {     \
        auto& node = *this;                           \
        TACTUS_EACH(TACTUS_VISIT_MEMBER, __VA_ARGS__) \
    }
