// SPDX-License-Identifier: Apache-2.0
// Runs one node of any type outside of an engine: buffers on its ports, values that depend on the activation only, and
// an outside world that is memory.
#pragma once

#include "graph/node/node.hpp"
#include "graph/node/sound_input.hpp"

#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::test {

/// A recorder or sound card that keeps what it is given, up to `capacity` bytes.
struct MemoryStream final : RecordStream {
    MemoryStream(StreamFormat format_, std::size_t capacity);
    bool write(std::int64_t first, const void* values, std::size_t count, std::ptrdiff_t stride) noexcept override;

    template <class T>
    std::vector<T> values() const {
        std::vector<T> all(used / sizeof(T));
        std::memcpy(all.data(), bytes.data(), all.size() * sizeof(T));
        return all;
    }

    StreamFormat format;
    std::vector<std::byte> bytes;
    std::size_t used = 0;
    std::int64_t expected = 0;  ///< activation that must come next
    bool gapless = true;
};

struct FakeHost final : Host, SoundInputs {
    DevicePort& device(const std::string& name, DeviceUse use, const SourceLocation& where) override;
    RecordStream& record(const StreamFormat& format, const SourceLocation& where) override;
    RecordStream& audio(const StreamFormat& format, const SoundPlace& place) override;
    RecordStream& send(const StreamFormat& format, const SourceLocation& where) override;
    const SoundInPort& listen(const SoundPlace& place, Flicks period,
                              std::optional<std::vector<float>> instead) override;

    std::map<std::string, std::unique_ptr<DevicePort>> devices;
    bool driven = false;  ///< a node asked to drive one
    std::vector<std::unique_ptr<MemoryStream>> records, sounds;
    std::vector<std::unique_ptr<SoundInPort>> heard;  ///< what they hear follows the feed
};

/// What the inputs without a function of their own carry.
enum class Feed {
    ordinary,  ///< finite values of everyday size
    hostile,   ///< also NaN, infinite, huge and denormal ones
};

/// Asset of that type, made in memory. Throws Error for a type it does not know.
std::shared_ptr<const void> sample_asset(std::string_view type_name);

/// The ball of bone that sample_asset makes, with voxels of 0.94 mm instead of 0.31 mm.
std::shared_ptr<const void> coarse_ball();

struct HarnessOptions {
    Flicks period = flicks_per_second / 48000;
    int max_frames = 64;
    std::uint64_t seed = 1;
    Feed feed = Feed::ordinary;
    bool drive_params = false;             ///< live parameters change now and then, as if driven by wires
    const ValueType* any = &value::number;  ///< of inputs that take any type
};

/// The rate of a force loop.
inline constexpr HarnessOptions servo{.period = flicks_per_second / 1000};

class NodeHarness {
public:
    using Options = HarnessOptions;

    explicit NodeHarness(const NodeType& type, Options options = {});
    explicit NodeHarness(std::string_view type_name, Options options = {});
    ~NodeHarness();
    NodeHarness(const NodeHarness&) = delete;
    NodeHarness& operator=(const NodeHarness&) = delete;

    /// Sets a parameter as a patch does.
    NodeHarness& set(const std::string& param, std::string_view text);
    /// Sets a numeric parameter to a value in SI. Throws Error if it is out of range.
    NodeHarness& set_value(const std::string& param, double value);
    NodeHarness& asset(const std::string& param, std::shared_ptr<const void> loaded);
    /// Leaves an optional input without a wire.
    NodeHarness& disconnect(const std::string& input);
    NodeHarness& disconnect_optional();
    /// Gives an optional input its wire back.
    NodeHarness& connect(const std::string& input);
    /// Feeds an input by a function of the activation index.
    template <class T>
    NodeHarness& feed(const std::string& input, std::function<T(std::int64_t)> function) {
        return feed_bytes(input, [f = std::move(function)](std::int64_t k, void* out) {
            const T value = f(k);
            std::memcpy(out, &value, sizeof(T));
        });
    }
    template <class T>
    NodeHarness& feed(const std::string& input, const T& constant) {
        return feed<T>(input, std::function<T(std::int64_t)>([constant](std::int64_t) { return constant; }));
    }

    void prepare();
    /// Runs so many activations. Blocks have random lengths drawn from `partition`; 0 means the longest allowed. Every
    /// call of the node is inside a RealtimeScope; everything else here is outside.
    void run(std::int64_t activations, std::uint64_t partition = 0);

    /// Every value an output had so far, one per activation.
    template <class T>
    std::vector<T> values(const std::string& output) const {
        const std::vector<std::byte>& bytes = trace(output);
        std::vector<T> all;
        for (std::size_t at = 0; at < bytes.size(); at += sizeof(T)) {
            T value;
            std::memcpy(static_cast<void*>(&value), bytes.data() + at, sizeof(T));
            all.push_back(value);
        }
        return all;
    }
    template <class T>
    T last(const std::string& output) const {
        return values<T>(output).back();
    }
    std::uint64_t output_hash() const;  ///< over every value of every output, in order
    bool finite() const { return finite_; }  ///< every number of every output so far
    /// Empties what `values`, `output_hash` and `finite` look at.
    void forget();
    void feed_with(Feed feed) { options_.feed = feed; }
    /// What the node adds to the report of others.
    Report report(Report report = {}) const;

    bool takes_blocks() const { return takes_blocks_; }
    /// What an input of several types takes; 0: there is none.
    ValueKinds takes() const;
    FakeHost host;

    /// Ticks that were left out before an activation; by default none.
    std::function<int(std::int64_t)> left_out;
    /// The values of a device before each activation; by default they follow the feed.
    std::function<void(std::int64_t, DevicePort&)> device_feed;

private:
    struct InputSlot;
    struct OutputSlot;
    struct Members;

    NodeHarness& feed_bytes(const std::string& input, std::function<void(std::int64_t, void*)> function);
    const std::vector<std::byte>& trace(const std::string& output) const;
    void fill_inputs(std::int64_t first, int frames);
    /// In an engine the place of a signal is another's between calls; here it holds NaN.
    void spoil_signals();
    void drive_params(std::int64_t first);
    void collect(int frames);
    int next_block(std::int64_t left, std::uint64_t partition) const;

    Options options_;
    const NodeType& type_;
    void* node_;
    std::unique_ptr<Members> members_;
    std::int64_t index_ = 0;
    Hash hash_;
    bool takes_blocks_ = false, finite_ = true;
};

}  // namespace tactus::test
