// SPDX-License-Identifier: Apache-2.0
// Which card and channel a node plays on.
#include "devices/audio/portaudio.hpp"
#include "engine/io/host.hpp"
#include "graph/compile/sounds.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::io {

bool EngineHost::is_in_use(const SoundCard& card, int channel) const {
    return std::ranges::any_of(sounds_in_use_, [&](const SoundChannel* sound) {
        return &sound->card() == &card && sound->index() == channel;
    });
}

std::unique_ptr<SoundCard> EngineHost::open_card(const StreamFormat& format, const SoundPlace& place) const {
    const std::string chosen = audio_.device == "default" ? "" : audio_.device;
    CardUse use{format.period, audio_.margin_s, group_, place.card, place.channel > 0, place.max_frames};
    return std::make_unique<SoundCard>(
        audio::make_portaudio_sink(place.card.empty() ? chosen : place.card, audio_.margin_s), std::move(use));
}

SoundChannel& EngineHost::opened_channel(std::unique_ptr<SoundCard> card, const std::vector<std::string>& names,
                                         int index) {
    card->open(names);
    opened_.notices.push_back(fmt::format("playing on {}", card->name()));
    return opened_.cards.emplace_back(std::move(card))->channel(index);
}

SoundChannel& EngineHost::own_channel(const StreamFormat& format, const SoundPlace& place) {
    // A card whose node an edit took away plays on, and only one thread ever writes to it.
    for (const auto& card : cards) {
        const CardUse& use = card->use();
        if (!card->is_lost() && !use.is_shared && use.group == group_ && use.period == format.period &&
            use.wanted == place.card && !is_in_use(*card, 0))
            return card->channel(0);
    }
    return opened_channel(open_card(format, place), {place.name}, 0);
}

SoundChannel& EngineHost::shared_channel(const StreamFormat& format, const SoundPlace& place) {
    const int index = place.channel - 1;
    for (const auto* list : {&cards, &opened_.cards})
        for (const auto& card : *list) {
            const CardUse& use = card->use();
            if (card->is_lost() || !use.is_shared || use.wanted != place.card || use.group != group_) continue;
            if (index >= card->channels())
                throw Error(place.where, fmt::format("{} plays {} channels in this run; channel {} takes effect at the "
                                                     "next start",
                                                     card->name(), card->channels(), place.channel));
            return card->channel(index);
        }
    const auto names = channel_names_.find(place.card);
    return opened_channel(open_card(format, place),
                          names == channel_names_.end() ? std::vector<std::string>(place.channel) : names->second,
                          index);
}

void EngineHost::expect_sounds(const compile::Plan& plan) {
    channel_names_.clear();
    for (const compile::PlanNode& node : plan.nodes)
        if (const std::optional<compile::SoundTarget> target = compile::sound_target(node)) {
            std::vector<std::string>& names = channel_names_[target->card];
            const auto index = static_cast<std::size_t>(target->channel - 1);
            if (index >= names.size()) names.resize(index + 1);
            names[index] = node.name;
        }
}

RecordStream& EngineHost::audio(const StreamFormat& format, const SoundPlace& place) {
    if (!live_ || audio_.device == "file") return record(format, place.where);
    if (audio_.device == "none") {
        StreamFormat unheard = format;
        unheard.file.clear();
        opened_.streams.push_back(std::make_unique<Stream>(unheard, make_null_sink()));
        uses_->streams.push_back(opened_.streams.back().get());
        return *opened_.streams.back();
    }
    try {
        SoundChannel& channel = place.channel > 0 ? shared_channel(format, place) : own_channel(format, place);
        if (std::ranges::find(opened_.cards, &channel.card(), &std::unique_ptr<SoundCard>::get) != opened_.cards.end())
            channel.card().expect(channel.index());
        sounds_in_use_.push_back(&channel);
        uses_->sounds.push_back(&channel);
        return channel;
    } catch (const Error& error) {
        if (audio_.is_required() || !error.where().file.empty()) throw Error(place.where, error.message());
        opened_.notices.push_back(
            fmt::format("no sound card ({}); the sound goes to {}", error.message(), format.file));
    }
    return record(format, place.where);
}

}  // namespace tactus::io
