// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/signal_hash.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

using namespace tactus;

namespace {

std::vector<float> noise(std::size_t count) {
    std::vector<float> samples;
    for (std::size_t i = 0; i < count; ++i) samples.push_back(static_cast<float>(Random{3}.uniform(i) - 0.5));
    return samples;
}

std::uint64_t hash_of(const std::vector<float>& samples, std::size_t block) {
    SignalHash hash;
    for (std::size_t at = 0; at < samples.size(); at += block)
        hash.add(at, samples.data() + at, std::min(block, samples.size() - at));
    return hash.value(samples.size());
}

}  // namespace

TEST_CASE("the hash of a signal is the same for any partition into blocks") {
    const std::vector<float> samples = noise(1000);
    SignalHash single;
    for (std::size_t i = 0; i < samples.size(); ++i) single.add(i, samples[i]);
    for (const std::size_t block : {1, 3, 16, 48, 64, 256, 257, 1000})
        CHECK(hash_of(samples, block) == single.value(samples.size()));
}

TEST_CASE("one bit of one sample, an exchange, and one sample more each change the hash of a signal") {
    const std::vector<float> samples = noise(600);
    std::set<std::uint64_t> seen{hash_of(samples, 64)};
    std::size_t made = 1;
    for (std::size_t i = 0; i < samples.size(); ++i)
        for (int bit = 0; bit < 32; ++bit, ++made) {
            std::vector<float> changed = samples;
            changed[i] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(samples[i]) ^ (1u << bit));
            seen.insert(hash_of(changed, 64));
        }
    for (std::size_t i = 1; i < samples.size(); ++i, ++made) {
        std::vector<float> changed = samples;
        std::swap(changed[i - 1], changed[i]);
        seen.insert(hash_of(changed, 64));
    }
    for (std::size_t more = 1; more < 300; ++more, ++made) {
        std::vector<float> longer = samples;
        longer.resize(samples.size() + more, 0.0f);
        seen.insert(hash_of(longer, 64));
    }
    CHECK(seen.size() == made);
}
