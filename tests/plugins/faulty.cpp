// SPDX-License-Identifier: Apache-2.0
// A plug-in with one fault, which TACTUS_FAULT chooses.
#include <tactus/graph/node/plugin.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#define FAULT_none 0
#define FAULT_clash 1
#define FAULT_range 2
#define FAULT_unit 3
#define FAULT_throws 4
#define FAULT_no_entry 5
#define FAULT_other_headers 6
#define FAULT_other_compiler 7
#define FAULT_undefined 8
#define FAULT_allocates 9
#define FAULT_blocks 10
#define FAULT_nan 11
#define FAULT_shares 12
#define FAULT_crashes 13
#define FAULT_reserved 14
#define FAULT_JOIN(a, b) a##b
#define FAULT_OF(name) FAULT_JOIN(FAULT_, name)
#define FAULT FAULT_OF(TACTUS_FAULT)

using namespace tactus;

#if FAULT == FAULT_undefined
namespace tactus {
double not_in_this_version(double v);
}
#endif

struct Faulty {
    static constexpr auto about = "Adds what it had before.";
    In<Signal> in{"signal"};
    Out<Signal> out{"in, a little later"};
#if FAULT == FAULT_range
    Param depth{"3", "0", "1", "out of its range"};
#elif FAULT == FAULT_unit
    Param depth{"3 parsecs", "0 parsecs", "10 parsecs", "in no unit"};
#else
    Param depth{"0.5", "0", "1", "how much"};
#endif
#if FAULT == FAULT_reserved
    Param rate{"1", "0", "2", "a key of every node"};
#endif

#if FAULT == FAULT_throws
    Faulty() { throw std::runtime_error("the laboratory is closed"); }
#endif

    void process(const Tick& tick) noexcept {
#if FAULT == FAULT_allocates
        const std::vector<float> work(static_cast<std::size_t>(tick.frames));
        const float* volatile seen = work.data();
        static_cast<void>(seen);
#endif
#if FAULT == FAULT_shares
        static float last_ = 0.0f;
#endif
        for (int i = 0; i < tick.frames; ++i) {
#if FAULT == FAULT_nan
            out[i] = in[i] / static_cast<float>(1.0 - depth);
#elif FAULT == FAULT_crashes
            if (!(in[i] == in[i])) *static_cast<volatile int*>(nullptr) = 1;
            out[i] = in[i];
#elif FAULT == FAULT_undefined
            out[i] = static_cast<float>(not_in_this_version(static_cast<double>(in[i])));
#else
            const float v = std::isfinite(in[i]) ? std::clamp(in[i], -1e6f, 1e6f) : 0.0f;
            last_ = v + static_cast<float>(depth) * 0.5f * last_;
            out[i] = last_;
#endif
        }
#if FAULT == FAULT_blocks
        last_ = 0.0f;
#endif
    }

#if FAULT != FAULT_shares
private:
    float last_ = 0.0f;
#endif
};
#if FAULT == FAULT_reserved
TACTUS_NODE(Faulty, in, out, depth, rate)
#else
TACTUS_NODE(Faulty, in, out, depth)
#endif

#if FAULT == FAULT_other_headers || FAULT == FAULT_other_compiler
constexpr Abi other_abi() {
    Abi abi = this_abi();
#if FAULT == FAULT_other_headers
    abi.headers = "0.0.9-0123456789abcdef";
#else
    abi.compiler = "GCC 4";
#endif
    return abi;
}
extern "C" {
[[gnu::visibility("default")]] extern const PluginEntry tactus_plugin;
constexpr PluginEntry tactus_plugin{PluginEntry::mark, other_abi(), "test-other", "1", nullptr};
}
#elif FAULT == FAULT_clash
struct Gain : Faulty {};
TACTUS_NODE(Gain, in, out, depth)
TACTUS_PLUGIN("test-faulty", "0.1", Faulty, Gain)
#elif FAULT != FAULT_no_entry
TACTUS_PLUGIN("test-faulty", "0.1", Faulty)
#endif
