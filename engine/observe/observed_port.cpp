// SPDX-License-Identifier: Apache-2.0
#include "engine/observe/observed_port.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace tactus::observe {

namespace {

constexpr std::size_t bone_ring_bytes = std::size_t{1} << 23;
constexpr std::size_t min_ring_bytes = std::size_t{1} << 14, max_ring_bytes = std::size_t{1} << 20;
constexpr double kept_seconds = 1.0;

bool is_bone(const ValueType& type) { return type == value::snapshot<volume::BoneSnapshot>; }
bool is_scene(const ValueType& type) { return type == value::snapshot<coupling::Scene>; }
bool is_rope(const ValueType& type) { return type == value::snapshot<rope::RopeShape>; }
bool is_body(const ValueType& type) { return type == value::snapshot<coupling::Body>; }

std::size_t words_of(std::size_t bytes) { return (bytes + 7) / 8; }

std::shared_ptr<const SeenBody> copy_of(const coupling::Body& body, const std::string& port) {
    auto seen = std::make_shared<SeenBody>();
    seen->port = port;
    seen->content_hash = body.content_hash;
    seen->home = body.home;
    if (body.map) seen->distance = body.map->grid;
    if (body.shell) {
        seen->points = body.shell->position;
        seen->labels = body.shell->label;
    }
    return seen;
}

}  // namespace

SeenBone::SeenBone(const volume::BoneSnapshot& from)
    : layout(from.layout()),
      version(from.version),
      first_version(from.version),
      changed_at(from.root->distance.size(), 1) {
    const auto copy = [](const std::vector<const float*>& bricks, std::vector<std::unique_ptr<float[]>>& own,
                         std::vector<const float*>& table) {
        for (const float* brick : bricks) {
            auto& mine = own.emplace_back();
            if (brick) {
                mine = std::make_unique_for_overwrite<float[]>(volume::brick_samples);
                std::copy_n(brick, volume::brick_samples, mine.get());
            }
            table.push_back(mine.get());
        }
    };
    root.layout = &layout;
    copy(from.root->distance, distance, root.distance);
    copy(from.root->density, density, root.density);
}

std::vector<std::uint32_t> SeenBone::changed_since(std::uint64_t since) const {
    std::vector<std::uint32_t> changed;
    for (std::size_t b = 0; b < changed_at.size(); ++b)
        if (changed_at[b] > since) changed.push_back(static_cast<std::uint32_t>(b));
    return changed;
}

bool LatestValue::read(std::uint64_t* words) const noexcept {
    constexpr int tries = 1000;
    for (int i = 0; i < tries; ++i) {
        const std::uint64_t before = sequence_.load(std::memory_order_acquire);
        if (before == 0) return false;
        if (before % 2 != 0) continue;
        for (std::size_t w = 0; w < words_.size(); ++w) words[w] = words_[w].load(std::memory_order_acquire);
        if (sequence_.load(std::memory_order_relaxed) == before) return true;
    }
    return false;
}

BoneFeed::BoneFeed(const volume::BoneSnapshot& initial)
    : sent_(initial.root->distance), is_waiting_(sent_.size(), 0), version_(initial.version) {
    waiting_.reserve(2 * sent_.size() + 1);
}

void BoneFeed::mark(std::uint32_t brick) noexcept {
    if (is_waiting_[brick]) return;
    is_waiting_[brick] = 1;
    waiting_.push_back(brick);
}

bool BoneFeed::see(std::int64_t index, const volume::BoneSnapshot& now, bool was_watched,
                   Ring<std::byte>& ring) noexcept {
    const std::vector<const float*>& bricks = now.root->distance;
    if (bricks.size() != sent_.size()) return true;
    if (now.version == version_ && first_waiting_ == waiting_.size() && is_complete_) return true;
    std::size_t budget = catching_up;
    if (now.version != version_) {
        // Brick memory is reused: unless every version was seen, equal addresses do not mean equal content.
        const std::size_t before = waiting_.size();
        for (std::size_t b = 0; b < bricks.size(); ++b)
            if (bricks[b] != sent_[b] || (!was_watched && bricks[b])) {
                mark(static_cast<std::uint32_t>(b));
                sent_[b] = bricks[b];
            }
        if (was_watched) budget += waiting_.size() - before;
        version_ = now.version;
        is_complete_ = false;
    }
    Brick brick;
    for (; budget > 0 && first_waiting_ < waiting_.size(); --budget, ++first_waiting_) {
        const std::uint32_t b = waiting_[first_waiting_];
        if (ring.space() < sizeof brick) break;
        is_waiting_[b] = 0;
        if (!bricks[b]) continue;
        brick.piece = {index, now.version, static_cast<std::int64_t>(b)};
        std::copy_n(bricks[b], volume::brick_samples, brick.samples);
        ring.push(reinterpret_cast<const std::byte*>(&brick), sizeof brick);
    }
    if (first_waiting_ < waiting_.size()) {
        // Room for all that may be marked before the list is empty again.
        if (first_waiting_ > 0) {
            waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(first_waiting_));
            first_waiting_ = 0;
        }
        return budget == 0;
    }
    waiting_.clear();
    first_waiting_ = 0;
    const Piece all{index, now.version, -1};
    if (ring.space() < sizeof all) return false;
    ring.push(reinterpret_cast<const std::byte*>(&all), sizeof all);
    is_complete_ = true;
    return true;
}

ObservedPort::ObservedPort(Identity who, const ValueType& of, const std::byte* initial, bool lossless,
                           std::atomic<bool>* pressing)
    : identity(std::move(who)), type(of), lossless_(lossless), pressing_(pressing) {
    if (is_bone(type)) {
        const auto& bone = *reinterpret_cast<const volume::BoneSnapshot*>(initial);
        initial_bone = std::make_unique<SeenBone>(bone);
        feed_ = std::make_unique<BoneFeed>(bone);
        return;
    }
    if (is_body(type)) {
        bodies.push_back(copy_of(*reinterpret_cast<const coupling::Body*>(initial), identity.name));
        return;
    }
    if (is_scene(type)) {
        value_size_ = sizeof(SeenScene);
        const auto& scene = *reinterpret_cast<const coupling::Scene*>(initial);
        for (std::size_t i = 0; i < scene.count; ++i)
            if (const coupling::Body& body = scene.objects[i].body; body.map || body.shell)
                bodies.push_back(copy_of(body, identity.name));
    }
    if ((!type.version || is_rope(type)) && value_size_ == 0) value_size_ = type.size;
    if (value_size_ == 0) return;
    latest_ = std::make_unique<LatestValue>(1 + words_of(value_size_));
    words_.resize(1 + words_of(value_size_));
    initial_value.resize(value_size_);
    encode(initial, initial_value.data());
}

void ObservedPort::encode(const std::byte* value, std::byte* into) const noexcept {
    if (!is_scene(type)) {
        std::memcpy(into, value, value_size_);
        return;
    }
    const auto& scene = *reinterpret_cast<const coupling::Scene*>(value);
    SeenScene seen;
    seen.count = scene.count;
    for (std::size_t i = 0; i < scene.count; ++i)
        seen.objects[i] = {scene.objects[i].body.content_hash, scene.objects[i].pose, scene.objects[i].unit,
                           scene.objects[i].hangs_on, scene.objects[i].stands ? 1 : 0};
    std::memcpy(into, &seen, sizeof seen);
}

void ObservedPort::watch(Watch how) {
    const bool needs_ring = how != Watch::nothing && (feed_ || how == Watch::every || lossless_);
    if (needs_ring && (feed_ || value_size_ > 0) && !owned_ring_) make_ring();
    watch_.store(static_cast<std::uint8_t>(how), std::memory_order_release);
}

/// It is kept as long as the port, because the group's thread may be using it.
void ObservedPort::make_ring() {
    std::size_t bytes = bone_ring_bytes;
    if (!feed_) {
        const std::size_t longest = sizeof(Head) + static_cast<std::size_t>(identity.max_frames) * value_size_;
        packed_.resize(longest);
        // Every value may have a head of its own.
        const double wanted =
            kept_seconds * rate_of(identity.period) *
            static_cast<double>(value_size_ + sizeof(Head) / static_cast<std::size_t>(identity.max_frames) + 1);
        bytes = std::bit_ceil(std::clamp(static_cast<std::size_t>(wanted), min_ring_bytes, max_ring_bytes));
        bytes = std::max(bytes, std::bit_ceil(4 * longest));
    }
    owned_ring_ = std::make_unique<Ring<std::byte>>(bytes);
    ring_.store(owned_ring_.get(), std::memory_order_release);
}

void ObservedPort::see(std::int64_t first, const std::byte* values, std::size_t count, std::ptrdiff_t stride) noexcept {
    if (!has_run_.load(std::memory_order_relaxed)) has_run_.store(true, std::memory_order_release);
    const auto how = static_cast<Watch>(watch_.load(std::memory_order_acquire));
    if (how == Watch::nothing) {
        was_watched_ = false;
        return;
    }
    Ring<std::byte>* const ring = ring_.load(std::memory_order_acquire);
    const std::byte* const last = values + static_cast<std::ptrdiff_t>(count - 1) * stride;
    if (feed_) {
        const auto index = first + static_cast<std::int64_t>(count) - 1;
        if (!feed_->see(index, *reinterpret_cast<const volume::BoneSnapshot*>(last), was_watched_, *ring))
            lost_.fetch_add(1, std::memory_order_relaxed);
        was_watched_ = true;
    } else if (latest_) {
        words_.front() = static_cast<std::uint64_t>(first + static_cast<std::int64_t>(count) - 1);
        encode(last, reinterpret_cast<std::byte*>(words_.data() + 1));
        latest_->write(words_.data());
        if (ring && (how == Watch::every || lossless_)) send(first, values, count, stride);
    }
    if (ring && ring->size() * 2 > ring->capacity()) pressing_->store(true, std::memory_order_relaxed);
}

void ObservedPort::send(std::int64_t first, const std::byte* values, std::size_t count,
                        std::ptrdiff_t stride) noexcept {
    Ring<std::byte>& ring = *owned_ring_;
    const Head head{first, count};
    const std::size_t bytes = sizeof head + count * value_size_;
    if (bytes > packed_.size() || ring.space() < bytes) {
        lost_.fetch_add(count, std::memory_order_relaxed);
        return;
    }
    std::memcpy(packed_.data(), &head, sizeof head);
    for (std::size_t i = 0; i < count; ++i)
        encode(values + static_cast<std::ptrdiff_t>(i) * stride, packed_.data() + sizeof head + i * value_size_);
    ring.push(packed_.data(), bytes);
}

bool ObservedPort::latest(std::byte* value, std::int64_t& index) const noexcept {
    if (!latest_) return false;
    static_assert(sizeof(SeenScene) >= sizeof(Events) && sizeof(SeenScene) >= sizeof(rope::RopeShape),
                  "the largest value fits");
    std::uint64_t words[1 + (sizeof(SeenScene) + 7) / 8];
    if (!latest_->read(words)) return false;
    index = static_cast<std::int64_t>(words[0]);
    std::memcpy(value, words + 1, value_size_);
    return true;
}

bool ObservedPort::pop(Piece& piece) {
    if (!owned_ring_) return false;
    const auto pop = [this](void* into, std::size_t bytes) {
        return owned_ring_->pop(static_cast<std::byte*>(into), bytes) == bytes;
    };
    // A piece is pushed whole, so once its head is there the rest is too.
    if (feed_) {
        BoneFeed::Piece head;
        if (!pop(&head, sizeof head)) return false;
        piece = Piece{head.index, 1, {}, head.version, head.brick, {}};
        if (head.brick < 0) return true;
        piece.samples = std::make_unique_for_overwrite<float[]>(volume::brick_samples + 1);
        return pop(piece.samples.get(), sizeof(BoneFeed::Brick) - sizeof head);
    }
    Head head;
    if (!pop(&head, sizeof head)) return false;
    piece = Piece{head.first, head.count, std::vector<std::byte>(head.count * value_size_), 0, -1, {}};
    return pop(piece.values.data(), piece.values.size());
}

}  // namespace tactus::observe
