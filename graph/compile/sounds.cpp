// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/sounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace tactus::compile {

namespace {

std::optional<SoundTarget> channel_of(const ScheduleNode& node) {
    const auto channel = node.params.find("channel");
    const auto card = node.texts.find("card");
    if (channel == node.params.end() || card == node.texts.end() || channel->second->value < 1.0) return std::nullopt;
    return SoundTarget{card->second->value, static_cast<int>(channel->second->value)};
}

}  // namespace

std::optional<SoundTarget> sound_target(const ScheduleNode& node) {
    return node.type && node.type->role == NodeRole::sound_sink ? channel_of(node) : std::nullopt;
}

std::optional<SoundTarget> sound_source(const ScheduleNode& node) {
    return node.texts.contains("sensor") ? channel_of(node) : std::nullopt;
}

void join_heard_cards(Schedule& plan) {
    for (ScheduleNode& node : plan.nodes) {
        if (!node.type || node.type->role != NodeRole::sound_sink) continue;
        const auto channel = node.params.find("channel");
        const auto card = node.texts.find("card");
        if (channel == node.params.end() || card == node.texts.end() || channel->second->value != 0.0) continue;
        const auto on_card = [&](const std::optional<SoundTarget>& other) {
            return other && other->card == card->second->value;
        };
        const bool is_heard = std::ranges::any_of(plan.nodes, [&](const ScheduleNode& other) {
            return on_card(sound_source(other)) && other.group == node.group;
        });
        const bool is_free = std::ranges::none_of(plan.nodes, [&](const ScheduleNode& other) {
            const std::optional<SoundTarget> target = sound_target(other);
            return on_card(target) && (target->channel == 1 || other.group != node.group);
        });
        if (is_heard && is_free) channel->second->value = 1.0;
    }
}

void check_sounds(const Schedule& plan, patch::Problems& problems) {
    std::map<std::string, const ScheduleNode*> cards;
    std::map<std::pair<std::string, int>, const ScheduleNode*> channels;
    for (const ScheduleNode& node : plan.nodes) {
        const std::optional<SoundTarget> target = sound_target(node), source = sound_source(node);
        if (!target && !source) continue;
        const auto& [card, channel] = target ? *target : *source;
        const std::string of_card = card.empty() ? "of the sound card" : fmt::format("of card '{}'", card);
        if (!target) {
            // Any number of nodes may read one channel.
        } else if (const auto [first, is_new] = channels.try_emplace({card, channel}, &node); !is_new)
            problems.add(node.where, fmt::format("node '{}' plays on channel {} {}, and so does '{}'", node.name,
                                                 channel, of_card, first->second->name));
        if (const auto [first, is_new] = cards.try_emplace(card, &node); first->second->group != node.group)
            problems.add(node.where,
                         fmt::format("nodes '{}' and '{}' use channels {}, so they need one rate and one group",
                                     first->second->name, node.name, of_card));
    }
}

}  // namespace tactus::compile
